#pragma once
// The results of a comparison as the text and the JSON that `etendue verify` prints.

#include <string>

#include "summary.h"

namespace etendue::verify {

/// The renderers and those left out, then each pair of renderers: its verdict, and where it disagrees.
std::string results_text(const Choice&, const Collected&, const Agreement&);

/// All results as JSON, including z and corrected p of each tile.
std::string results_json(const Choice&, const Collected&, const Agreement&);

}  // namespace etendue::verify
