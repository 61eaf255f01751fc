#pragma once
// The report of a comparison as one HTML file that needs nothing else.

#include "etendue/tone_map.h"
#include "summary.h"

namespace etendue::verify {

/// What a report tells besides the comparison itself.
struct ReportContext {
  std::string file, command_line;
  const ToneMap* tone_map = nullptr;  ///< for the renderers' pictures; prepared
};

std::string html_report(const ReportContext&, const Choice&, const Collected&, const Agreement&);

}  // namespace etendue::verify
