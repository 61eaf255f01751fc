#pragma once
// The report of a comparison as one self-contained HTML file.

#include "etendue/tone_map.h"
#include "summary.h"

namespace etendue::verify {

/// Data for a report in addition to the comparison itself.
struct ReportContext {
  std::string file, command_line;
  const ToneMap* tone_map = nullptr;  ///< for the renderers' images; prepared
};

std::string html_report(const ReportContext&, const Choice&, const Collected&, const Agreement&);

}  // namespace etendue::verify
