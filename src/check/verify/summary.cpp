#include "summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace etendue::verify {

std::string_view name(Verdict verdict) {
  switch (verdict) {
    case Verdict::agrees: return "agree";
    case Verdict::undecided: return "undecided";
    case Verdict::disagrees: return "DISAGREE";
  }
  return "";
}

std::string layer_text(const Layout& layout, size_t layer) {
  const auto [length, channel] = layout.layers[layer];
  if (length == 0) return channel == 'Y' ? "all lengths" : fmt::format("all lengths, {}", channel);
  return fmt::format("length {}{}", length, length == layout.lengths ? " and longer" : "");
}

std::string place_text(const Layout& layout, size_t place) {
  if (place == layout.whole()) return "the whole picture";
  const PixelArea area = layout.area(place);
  return fmt::format("x {} to {}, y {} to {}", area.x0, area.x1, area.y0, area.y1);
}

std::string_view doubt_text(Doubt doubt) {
  switch (doubt) {
    case Doubt::none: return "";
    case Doubt::one_pass: return "too few samples: one pass holds more than half of what a renderer found";
    case Doubt::rare_events: return "too few samples: a few rare, bright paths not met yet could make the difference";
  }
  return "";
}

std::vector<LayerSummary> summarize(const Layout& layout, const PairAgreement& pair) {
  std::vector<LayerSummary> list;
  for (const MeanTest& test : pair.tests) {
    if (list.empty() || list.back().layer != test.layer) list.emplace_back().layer = test.layer;
    LayerSummary& s = list.back();
    if (test.place == layout.whole())
      s.whole = &test;
    else if (test.verdict == Verdict::disagrees)
      ++s.disagreeing_tiles;
    else if (test.verdict == Verdict::undecided)
      ++s.undecided_tiles;
    if (!s.worst || test.corrected < s.worst->corrected ||
        (test.corrected == s.worst->corrected && std::abs(test.z) > std::abs(s.worst->z)))
      s.worst = &test;
    s.verdict = std::max(s.verdict, test.verdict);
  }
  return list;
}

std::vector<const MeanTest*> tests_with(const PairAgreement& pair, Verdict verdict) {
  std::vector<const MeanTest*> list;
  for (const MeanTest& test : pair.tests)
    if (test.verdict == verdict) list.push_back(&test);
  std::stable_sort(list.begin(), list.end(), [](const MeanTest* a, const MeanTest* b) {
    return std::tuple(a->corrected, a->plain_p, -std::abs(a->z)) < std::tuple(b->corrected, b->plain_p, -std::abs(b->z));
  });
  return list;
}

MeanLight mean_light(const Layout& layout, const Measured& measured) {
  const Moments m = moments(layout, measured, 0, layout.whole());
  return {m.mean, m.mean > 0 ? m.error() / m.mean : 0};
}

std::optional<PairConvergence> convergence_of(const Collected& collected, const PairAgreement& pair) {
  const bool a = !collected.runs[pair.a].marks.empty(), b = !collected.runs[pair.b].marks.empty();
  if (a == b) return {};
  const size_t consistent = a ? pair.a : pair.b, other = a ? pair.b : pair.a;
  std::vector<std::vector<double>> truth;
  for (const auto& pass : collected.measured[other].passes)
    truth.emplace_back(pass.begin(), pass.begin() + std::ptrdiff_t(collected.layout.tiles.size()));
  const RendererRun& run = collected.runs[consistent];
  return PairConvergence{consistent, convergence(run.marks, run.tiles_at_marks, truth)};
}

std::string convergence_text(const Convergence& c) {
  const auto seen = [&](size_t i) { return c.bias[i] > 0; };
  size_t first = 0, last = c.bias.size();
  while (first < c.bias.size() && !seen(first)) ++first;
  if (first == c.bias.size())
    return fmt::format("its bias is lost in noise: below {:.2g} % of the light in tiles", 100 * c.error.back());
  while (!seen(last - 1)) --last;
  std::string text = fmt::format("its bias in tiles is {:.2g} ± {:.1g} % of the light after {} samples", 100 * c.bias[first],
                                 100 * c.error[first], c.samples[first]);
  if (last - 1 > first)
    text += fmt::format(", {:.2g} ± {:.1g} % after {}", 100 * c.bias[last - 1], 100 * c.error[last - 1], c.samples[last - 1]);
  if (c.rate) text += fmt::format(", and falls as N^{:.2f} ± {:.2f}", -c.rate->value, c.rate->error);
  return text;
}

std::string remark(const Measured& measured, const RendererRun& run, const Candidate& candidate) {
  std::string text;
  const auto add = [&](const std::string& more) { text += (text.empty() ? "" : "; ") + more; };
  for (const std::string& lost : candidate.misses) add("misses " + lost);
  if (!run.marks.empty())
    add(fmt::format(
        "what it goes to is compared, extrapolated from its steps, which has {:.1f} times the noise of a pass's end",
        run.limit_noise));
  else if (const std::string bias = candidate.renderer->bias(); !bias.empty())
    add("biased: " + bias);
  // Where one renderer refuses layers of path lengths, none is asked for them: the remark is about that one.
  const bool blamed = run.lengths_asked || candidate.renderer->class_info().declared;
  if (!measured.tells_lengths && blamed)
    add("does not tell path lengths apart, so only all lengths together are compared");
  else if (measured.tells_lengths && std::abs(run.length_share - 1) > 1e-3)
    add(fmt::format("tells the path length of {:.2f} % of its light only", 100 * run.length_share));
  if (run.bad_samples > 0)
    add(fmt::format("{} of {} samples were negative or not finite and count as black", run.bad_samples, run.samples));
  return text;
}

}  // namespace etendue::verify
