#pragma once
// The results of a comparison in words, for the terminal and for the report.

#include "agreement.h"
#include "collect.h"
#include "limit.h"

namespace etendue::verify {

std::string_view name(Verdict);
/// "all lengths", "all lengths, X", "length 3", "length 9 and longer"
std::string layer_text(const Layout&, size_t layer);
/// "the whole picture", "x 0 to 8, y 16 to 24"
std::string place_text(const Layout&, size_t place);
/// The reason why a test is undecided.
std::string_view doubt_text(Doubt);

/// The tests of one layer of a pair.
struct LayerSummary {
  size_t layer = 0;
  const MeanTest* whole = nullptr;
  const MeanTest* worst = nullptr;  ///< of all its places, the test with the smallest corrected p
  size_t disagreeing_tiles = 0, undecided_tiles = 0;
  Verdict verdict = Verdict::agrees;
};
std::vector<LayerSummary> summarize(const Layout&, const PairAgreement&);

/// The tests with a verdict, the clearest first.
std::vector<const MeanTest*> tests_with(const PairAgreement&, Verdict);

/// Mean Y of the whole picture, with its relative standard error.
struct MeanLight {
  double mean = 0, relative_error = 0;
};
MeanLight mean_light(const Layout&, const Measured&);

/// The convergence of a pair's consistent renderer towards the other's mean; empty if both or neither are consistent.
struct PairConvergence {
  size_t renderer = 0;  ///< index of the consistent one
  Convergence convergence;
};
std::optional<PairConvergence> convergence_of(const Collected&, const PairAgreement&);
/// As a text without a line break: "its bias in tiles is 3.1 ± 0.2 % of the light after 1 samples, … and falls as N^-0.33 ±
/// 0.02".
std::string convergence_text(const Convergence&);

/// Remarks on a renderer's measurements for the user; empty: none.
std::string remark(const Measured&, const RendererRun&, const Candidate&);

}  // namespace etendue::verify
