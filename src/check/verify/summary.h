#pragma once
// What came out of a comparison, put into words: for the terminal and for the report.

#include "agreement.h"
#include "collect.h"
#include "limit.h"

namespace etendue::verify {

std::string_view name(Verdict);
/// "all lengths", "all lengths, X", "length 3", "length 9 and longer"
std::string layer_text(const Layout&, size_t layer);
/// "the whole picture", "x 0 to 8, y 16 to 24"
std::string place_text(const Layout&, size_t place);
/// Why a test was not decided.
std::string_view doubt_text(Doubt);

/// The tests of one layer of a pair.
struct LayerSummary {
  size_t layer = 0;
  const MeanTest* whole = nullptr;
  const MeanTest* worst = nullptr;  ///< of all its places
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

/// How the bias of a pair's consistent renderer goes away, against the other's mean; empty when neither or both are such.
struct PairConvergence {
  size_t renderer = 0;  ///< which of all
  Convergence convergence;
};
std::optional<PairConvergence> convergence_of(const Collected&, const PairAgreement&);
/// In words, without a line's end: "its bias is 3.1 % of the light after 1 sample, … and falls as N^-0.33 ± 0.02".
std::string convergence_text(const Convergence&);

/// What should be known of a renderer's measurements; empty: nothing.
std::string remark(const Measured&, const RendererRun&, const Candidate&);

}  // namespace etendue::verify
