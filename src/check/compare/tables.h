#pragma once
// The results as tables for other programs, and as texts.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "analysis.h"

namespace etendue::comparing {

/// One row for each scene, variant and mark.
std::string results_csv(const Results&);
/// All results as JSON.
std::string results_json(const Results&, const std::string& command_line);

/// Remarks on a variant for the user: missed light, declared bias, bad samples; empty: none.
std::vector<std::string> remarks(const SceneResult&, const VariantResult&);
/// "FOUND in 3 of 108 tiles, +1.20 ± 0.10 % of the light", "none found, …", "undecided, …", "unknown: it alone is the
/// reference"
std::string bias_text(const VariantResult&);
/// "PathTracer, significantly better than each other variant" or "PathTracer, but not significantly better than each other
/// variant"
std::string winner_text(const SceneResult&, const Winner&);
/// "-0.98 ± 0.02"
std::string slope_text(const std::optional<Estimate>&);
/// The mean over the runs; empty if there are none.
std::optional<Estimate> mean_error(const std::vector<double>&);
/// A note on the significance test, for below the tables.
std::string significance_text(const Results&);

}  // namespace etendue::comparing
