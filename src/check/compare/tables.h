#pragma once
// The results as tables for other programs, and in words.

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "analysis.h"

namespace etendue::comparing {

/// One row for each scene, variant and mark.
std::string results_csv(const Results&);
/// All of it.
std::string results_json(const Results&, const std::string& command_line);

/// What should be known of a variant beside its numbers: what it misses, its bias, bad samples; empty: nothing.
std::vector<std::string> remarks(const SceneResult&, const VariantResult&);
/// "found (+1.2 % of the light, z +9)", "not found", "unknown: it is the reference"
std::string bias_text(const VariantResult&);
/// "PathTracer, significantly" or "PathTracer, not significantly better"
std::string winner_text(const SceneResult&, const Winner&);
/// "-0.98 ± 0.02"
std::string slope_text(const std::optional<Estimate>&);
/// The mean over the runs; empty where there is none.
std::optional<Estimate> mean_error(const std::vector<double>&);
/// How the winner was found, for the foot of tables.
std::string significance_text(const Results&);

}  // namespace etendue::comparing
