#include "text.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/number_text.h"

namespace etendue::verify {

namespace {

using Json = nlohmann::ordered_json;

std::string p_text(double p) { return p >= 1 ? "1" : fmt::format("{:.2g}", p); }

std::string noticeable_text(const PairAgreement& pair) {
  if (!std::isfinite(pair.noticeable)) return "the picture is black, so nothing was compared";
  return fmt::format("would notice a difference of {:.2g} % of the whole picture's light", 100 * pair.noticeable);
}

std::string renderers_text(const Choice& choice, const Collected& collected) {
  size_t width = 8;
  for (const Measured& m : collected.measured) width = std::max(width, m.name.size());
  std::string text = fmt::format("{:<{}}      mean Y  rel. error  passes      time  Msamples/s\n", "renderer", width);
  std::string remarks;
  for (size_t i = 0; i < collected.measured.size(); ++i) {
    const Measured& measured = collected.measured[i];
    const RendererRun& run = collected.runs[i];
    const MeanLight light = mean_light(collected.layout, measured);
    text += fmt::format("{:<{}}  {:>10.6g}  {:>8.3f} %  {:>6}  {:>8}  {:>10.2f}\n", measured.name, width, light.mean,
                        100 * light.relative_error, measured.passes.size(), duration_text(run.seconds),
                        double(run.samples) / std::max(run.seconds, 1e-9) * 1e-6);
    if (const std::string note = remark(measured, run, choice.candidates[i]); !note.empty())
      remarks += fmt::format("{}: {}\n", measured.name, note);
  }
  for (const LeftOut& left : choice.left_out) remarks += fmt::format("left out: {}: {}\n", left.name, left.reason);
  return text + remarks;
}

/// For example "DISAGREE in the whole and 57 of 64 tiles (7 undecided)".
std::string layer_verdict(const Layout& layout, const LayerSummary& s) {
  std::string text(name(s.verdict));
  const bool whole = s.whole->verdict == s.verdict, disagrees = s.verdict == Verdict::disagrees;
  const size_t tiles = disagrees ? s.disagreeing_tiles : s.undecided_tiles;
  if (s.verdict == Verdict::agrees) return text;
  if (whole) text += " in the whole";
  if (tiles > 0) text += fmt::format("{}{} of {} tiles", whole ? " and " : " in ", tiles, layout.tiles.size());
  if (disagrees && s.undecided_tiles > 0) text += fmt::format(" ({} undecided)", s.undecided_tiles);
  return text;
}

/// The means over the whole image for each layer, with the numbers of tiles that disagree or are undecided.
std::string layers_text(const Layout& layout, const PairAgreement& pair) {
  std::string text = fmt::format("  {:<20} {:>12} {:>12} {:>10} {:>7}  {:>8}   {}\n", "whole picture", "A", "B", "A / B", "z",
                                 "corr. p", "verdict");
  for (const LayerSummary& s : summarize(layout, pair)) {
    const MeanTest& t = *s.whole;
    text += fmt::format("  {:<20} {:>12.6g} {:>12.6g} {:>10} {:>+7.1f}  {:>8}   {}\n", layer_text(layout, s.layer), t.mean_a,
                        t.mean_b, t.mean_b != 0 ? fmt::format("{:.5f}", t.ratio()) : "-", t.z, p_text(t.corrected),
                        layer_verdict(layout, s));
  }
  return text;
}

std::string test_text(const Layout& layout, const MeanTest& t) {
  return fmt::format("{}, {}: A {:.6g}, B {:.6g}{}, z {:+.1f}, corrected p {}", place_text(layout, t.place),
                     layer_text(layout, t.layer), t.mean_a, t.mean_b,
                     t.mean_b != 0 ? fmt::format(", A / B {:.5f}", t.ratio()) : "", t.z, p_text(t.corrected));
}

std::string pair_text(const Collected& collected, const PairAgreement& pair) {
  const Layout& layout = collected.layout;
  std::string text = fmt::format("\n{} and {}: {}  ({})\n", collected.measured[pair.a].name, collected.measured[pair.b].name,
                                 name(pair.verdict), noticeable_text(pair));
  if (const std::optional<PairConvergence> c = convergence_of(collected, pair))
    text += fmt::format("  {}: {}\n", collected.measured[c->renderer].name, convergence_text(c->convergence));
  if (pair.verdict == Verdict::agrees) {
    const MeanTest* worst = nullptr;
    for (const LayerSummary& s : summarize(layout, pair))
      if (!worst || s.worst->corrected < worst->corrected ||
          (s.worst->corrected == worst->corrected && std::abs(s.worst->z) > std::abs(worst->z)))
        worst = s.worst;
    return text + "  farthest apart: " + test_text(layout, *worst) + "\n";
  }
  text += layers_text(layout, pair);
  constexpr size_t most = 5;
  const std::vector<const MeanTest*> list = tests_with(pair, pair.verdict);
  text += pair.verdict == Verdict::disagrees ? "  clearest:\n" : "  undecided:\n";
  for (size_t i = 0; i < std::min(list.size(), most); ++i) {
    text += "    " + test_text(layout, *list[i]) + "\n";
    if (pair.verdict == Verdict::undecided) text += fmt::format("      {}\n", doubt_text(list[i]->doubt));
  }
  if (list.size() > most) text += fmt::format("    and {} more\n", list.size() - most);
  return text;
}

Json test_json(const Layout& layout, const MeanTest& t) {
  const PixelArea area = layout.area(t.place);
  const Layer& layer = layout.layers[t.layer];
  Json json = {{"area", {area.x0, area.y0, area.x1, area.y1}},
               {"whole_picture", t.place == layout.whole()},
               {"length", layer.length},
               {"channel", std::string(1, layer.channel)},
               {"mean_a", t.mean_a},
               {"mean_b", t.mean_b},
               {"ratio", t.ratio()},
               {"z", t.z},
               {"plain_p", t.plain_p},
               {"p", t.p},
               {"corrected_p", t.corrected},
               {"verdict", name(t.verdict)}};
  if (t.doubt != Doubt::none) json["why"] = doubt_text(t.doubt);
  return json;
}

Json pair_json(const Collected& collected, const PairAgreement& pair) {
  const Layout& layout = collected.layout;
  Json json = {{"a", collected.measured[pair.a].name},
               {"b", collected.measured[pair.b].name},
               {"verdict", name(pair.verdict)},
               {"would_notice", pair.noticeable},
               {"by_length", pair.by_length}};
  if (const std::optional<PairConvergence> c = convergence_of(collected, pair)) {
    const Convergence& of = c->convergence;
    json["convergence"] = {{"renderer", collected.measured[c->renderer].name},
                           {"samples", of.samples},
                           {"relative_bias_in_tiles", of.bias},
                           {"standard_error", of.error}};
    if (of.rate) json["convergence"]["rate"] = {{"value", of.rate->value}, {"standard_error", of.rate->error}};
  }
  for (const LayerSummary& s : summarize(layout, pair)) {
    Json layer = {{"name", layer_text(layout, s.layer)},
                  {"verdict", name(s.verdict)},
                  {"tiles_that_disagree", s.disagreeing_tiles},
                  {"tiles_undecided", s.undecided_tiles},
                  {"whole", test_json(layout, *s.whole)}};
    for (const MeanTest& t : pair.tests)
      if (t.layer == s.layer && t.place != layout.whole()) {
        layer["tiles"]["mean_a"].push_back(t.mean_a);
        layer["tiles"]["mean_b"].push_back(t.mean_b);
        layer["tiles"]["z"].push_back(t.z);
        layer["tiles"]["corrected_p"].push_back(t.corrected);
      }
    json["layers"].push_back(std::move(layer));
  }
  for (const Verdict verdict : {Verdict::disagrees, Verdict::undecided}) {
    Json list = Json::array();
    for (const MeanTest* t : tests_with(pair, verdict)) list.push_back(test_json(layout, *t));
    json[verdict == Verdict::disagrees ? "disagreements" : "undecided"] = std::move(list);
  }
  return json;
}

}  // namespace

std::string results_text(const Choice& choice, const Collected& collected, const Agreement& agreement) {
  std::string text = renderers_text(choice, collected);
  for (const PairAgreement& pair : agreement.pairs) text += pair_text(collected, pair);
  bool undecided = false;
  for (const PairAgreement& pair : agreement.pairs) undecided |= pair.verdict == Verdict::undecided;
  return text + fmt::format("\n{}: {} comparisons, significance {} for all of them together\n",
                            agreement.disagrees() ? "They do not all agree"
                            : undecided           ? "No disagreement, but some tests are undecided and need more samples"
                                                  : "They agree",
                            grouped(agreement.tests), agreement.significance);
}

std::string results_json(const Choice& choice, const Collected& collected, const Agreement& agreement) {
  const Layout& layout = collected.layout;
  Json json = {{"agree", !agreement.disagrees()}, {"significance", agreement.significance}, {"comparisons", agreement.tests}};
  for (const PixelArea& tile : layout.tiles) json["tiles"].push_back({tile.x0, tile.y0, tile.x1, tile.y1});
  for (size_t i = 0; i < collected.measured.size(); ++i) {
    const Measured& measured = collected.measured[i];
    const RendererRun& run = collected.runs[i];
    const MeanLight light = mean_light(layout, measured);
    json["renderers"].push_back({{"name", measured.name},
                                 {"mean", light.mean},
                                 {"relative_error", light.relative_error},
                                 {"passes", measured.passes.size()},
                                 {"samples", run.samples},
                                 {"bad_samples", run.bad_samples},
                                 {"seconds", run.seconds},
                                 {"samples_per_second", double(run.samples) / std::max(run.seconds, 1e-9)},
                                 {"tells_lengths", measured.tells_lengths},
                                 {"remark", remark(measured, run, choice.candidates[i])}});
  }
  json["left_out"] = Json::array();
  for (const LeftOut& left : choice.left_out) json["left_out"].push_back({{"name", left.name}, {"reason", left.reason}});
  for (const PairAgreement& pair : agreement.pairs) json["pairs"].push_back(pair_json(collected, pair));
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace etendue::verify
