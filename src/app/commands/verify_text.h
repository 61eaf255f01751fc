#pragma once
// What `etendue verify` prints.

#include <nlohmann/json.hpp>
#include <string>

#include "check/verify/summary.h"

namespace etendue {

/// The renderers and what was left out, then each pair: its verdict, and where it disagrees.
std::string verify_text(const verify::Choice&, const verify::Collected&, const verify::Agreement&);

/// All of it, each tile's z and corrected p included, for programs.
nlohmann::ordered_json verify_json(const verify::Choice&, const verify::Collected&, const verify::Agreement&);

}  // namespace etendue
