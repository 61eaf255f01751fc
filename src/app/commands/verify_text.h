#pragma once
// The text that `etendue verify` prints.

#include <nlohmann/json.hpp>
#include <string>

#include "check/verify/summary.h"

namespace etendue {

/// The renderers and those left out, then each pair of renderers: its verdict, and where it disagrees.
std::string verify_text(const verify::Choice&, const verify::Collected&, const verify::Agreement&);

/// All results as JSON, including z and corrected p of each tile.
nlohmann::ordered_json verify_json(const verify::Choice&, const verify::Collected&, const verify::Agreement&);

}  // namespace etendue
