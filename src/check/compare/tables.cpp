#include "tables.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "check/verify/summary.h"

namespace etendue::comparing {
namespace {

using Json = nlohmann::ordered_json;

/// JSON has no infinity: unknown values are null.
Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
template <class T>
Json number(const std::optional<T>& x) {
  return x ? Json(*x) : Json(nullptr);
}

Json estimate(const Estimate& e) {
  Json json = {{"value", number(e.value)}, {"standard_error", number(e.error)}};
  if (const std::optional<Band> b = band(e, band_probability)) json["band"] = {number(b->low), number(b->high)};
  return json;
}
Json estimate(const std::optional<Estimate>& e) { return e ? estimate(*e) : Json(nullptr); }

Json curve_json(const VariantResult& v) {
  Json curve = Json::array();
  for (const CurvePoint& p : v.curve)
    curve.push_back({{"samples", p.samples},
                     {"seconds", p.seconds},
                     {"relative_mean_square_error", estimate(p.error)},
                     {"symmetric_error", estimate(p.symmetric)},
                     {"variance", number(p.variance)},
                     {"square_bias", v.bias.known ? estimate(p.square_bias) : Json(nullptr)}});
  return curve;
}

Json variant_json(const VariantResult& v) {
  Json json = {{"name", v.name},
               {"misses", v.misses},
               {"says_of_itself", v.says.empty() ? Json(nullptr) : Json(v.says)},
               {"weight_in_reference", v.in_reference ? Json(v.weight) : Json(nullptr)},
               {"samples", v.samples},
               {"processor_seconds", v.seconds},
               {"wall_seconds", v.wall_seconds},
               {"bad_samples", v.bad_samples},
               {"at_equal_time",
                {{"relative_mean_square_error", estimate(mean_error(v.at_time))},
                 {"runs", v.at_time},
                 {"symmetric_error", number(v.symmetric_at_time)}}},
               {"at_equal_samples",
                {{"relative_mean_square_error", estimate(mean_error(v.at_samples))},
                 {"runs", v.at_samples},
                 {"symmetric_error", number(v.symmetric_at_samples)}}},
               {"exponent_over_samples", estimate(v.slope_over_samples)},
               {"exponent_over_time", estimate(v.slope_over_time)}};
  Json bias = {{"known", v.bias.known}};
  if (v.bias.known) {
    const verify::MeanTest& whole = v.bias.test.tests.front();
    size_t tiles = 0;
    for (const verify::MeanTest& t : v.bias.test.tests) tiles += t.verdict == verify::Verdict::disagrees;
    bias["found"] = v.bias.found();
    bias["verdict"] = verify::name(v.bias.test.verdict);
    bias["relative_mean"] = number(v.bias.relative);
    bias["standard_error"] = number(v.bias.error);
    bias["places_that_differ"] = tiles;
    bias["smallest_corrected_p"] = whole.corrected;
    for (const verify::MeanTest& t : v.bias.test.tests)
      if (t.corrected < bias["smallest_corrected_p"].get<double>()) bias["smallest_corrected_p"] = t.corrected;
    bias["would_notice"] = number(v.bias.test.noticeable);
  }
  json["bias"] = std::move(bias);
  json["curve"] = curve_json(v);
  return json;
}

Json contests_json(const Results& results, const std::vector<Contest>& contests) {
  Json list = Json::array();
  for (const Contest& c : contests)
    list.push_back({{"scene", results.scenes[c.scene].file},
                    {"a", results.scenes[c.scene].variants[c.a].name},
                    {"b", results.scenes[c.scene].variants[c.b].name},
                    {"ratio", number(c.ratio)},
                    {"p", c.p},
                    {"corrected_p", c.corrected},
                    {"significant", c.significant}});
  return list;
}

Json winner_json(const SceneResult& scene, const Winner& w) {
  if (!w.variant) return nullptr;
  return {{"variant", scene.variants[*w.variant].name}, {"significant", w.significant}};
}

/// A cell of CSV, quoted if necessary (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}
std::string cell(double x) { return std::isfinite(x) ? fmt::format("{}", x) : std::string(); }

}  // namespace

std::string results_csv(const Results& results) {
  std::string text =
      "scene,variant,samples,processor_seconds,relative_mean_square_error,standard_error,band_low,band_high,symmetric_error,"
      "symmetric_standard_error,variance,square_bias,square_bias_standard_error\r\n";
  for (const SceneResult& scene : results.scenes)
    for (const VariantResult& v : scene.variants)
      for (const CurvePoint& p : v.curve) {
        const std::optional<Band> b = band(p.error, band_probability);
        text += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{}\r\n", cell(scene.file), cell(v.name), cell(p.samples),
                            cell(p.seconds), cell(p.error.value), cell(p.error.error), cell(b ? b->low : NAN),
                            cell(b ? b->high : NAN), cell(p.symmetric.value), cell(p.symmetric.error), cell(p.variance),
                            cell(v.bias.known ? p.square_bias.value : NAN), cell(v.bias.known ? p.square_bias.error : NAN));
      }
  return text;
}

std::string results_json(const Results& results, const std::string& command_line) {
  Json scenes = Json::array();
  for (const SceneResult& scene : results.scenes) {
    Json variants = Json::array();
    for (const VariantResult& v : scene.variants) variants.push_back(variant_json(v));
    scenes.push_back({{"scene", scene.file},
                      {"width", scene.width},
                      {"height", scene.height},
                      {"runs", scene.runs},
                      {"reference", scene.reference},
                      {"reference_relative_variance", scene.reference_is_exact ? Json(nullptr) : Json(scene.reference_noise)},
                      {"equal_samples", scene.equal_samples},
                      {"equal_processor_seconds", scene.equal_seconds},
                      {"winner_at_equal_time", winner_json(scene, scene.at_time)},
                      {"winner_at_equal_samples", winner_json(scene, scene.at_samples)},
                      {"variants", std::move(variants)}});
  }
  Json means = Json::array();
  for (size_t v = 0; v < results.geometric_means.size(); ++v)
    means.push_back({{"variant", results.scenes.front().variants[v].name},
                     {"scenes", results.geometric_means[v].scenes},
                     {"value", number(results.geometric_means[v].value)},
                     {"relative_standard_error", number(results.geometric_means[v].relative_error)}});
  const Json json = {{"command", command_line},
                     {"significance", results.significance},
                     {"band_probability", band_probability},
                     {"scenes", std::move(scenes)},
                     {"contests_at_equal_time", contests_json(results, results.at_time)},
                     {"contests_at_equal_samples", contests_json(results, results.at_samples)},
                     {"geometric_mean_error_over_that_of_the_first_at_equal_time", std::move(means)}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

// ---- words
// --------------------------------------------------------------------------------------------------------------------

std::optional<Estimate> mean_error(const std::vector<double>& errors) {
  if (errors.empty()) return {};
  return mean_of(errors);
}

namespace {

/// The places where a bias was found: "the whole picture", "3 of 108 tiles".
std::string places_text(const Bias& bias) {
  std::set<size_t> places, differing;
  for (const verify::MeanTest& t : bias.test.tests) {
    places.insert(t.place);
    if (t.verdict == verify::Verdict::disagrees) differing.insert(t.place);
  }
  const size_t whole = *places.rbegin();  // the whole image has the largest index
  if (differing.contains(whole)) return "the whole picture";
  return fmt::format("{} of {} tiles", differing.size(), whole);
}

}  // namespace

std::string bias_text(const VariantResult& v) {
  if (!v.bias.known) return "unknown: it alone is the reference";
  const std::string mean = fmt::format("{:+.2f} ± {:.2f} % of the light", 100 * v.bias.relative, 100 * v.bias.error);
  switch (v.bias.test.verdict) {
    case verify::Verdict::agrees: return "none found, " + mean;
    case verify::Verdict::undecided: return "undecided, " + mean;
    case verify::Verdict::disagrees: return fmt::format("FOUND in {}, {}", places_text(v.bias), mean);
  }
  return {};
}

std::vector<std::string> remarks(const SceneResult& scene, const VariantResult& v) {
  std::vector<std::string> list;
  for (const std::string& lost : v.misses) list.push_back("misses " + lost + ": it is biased here");
  if (!v.says.empty()) list.push_back("says of itself: " + v.says);
  if (v.bias.found() && v.in_reference)
    list.push_back(
        "differs from the other variants though all of them should have the same mean: one of them is wrong, or has not met "
        "rare, "
        "bright paths; more runs tell, and so does etendue verify");
  if (v.bad_samples > 0)
    list.push_back(fmt::format("{} samples were negative or not finite and count as black", v.bad_samples));
  if (v.at_time.empty())
    list.push_back(fmt::format("has no error at {:.3g} s: its first step took longer", scene.equal_seconds));
  if (v.at_samples.empty()) list.push_back("has no error at the common number of samples: its first step had more");
  return list;
}

std::string winner_text(const SceneResult& scene, const Winner& w) {
  if (!w.variant) return "none";
  return scene.variants[*w.variant].name + (w.significant ? ", significantly better than each other variant"
                                                          : ", but not significantly better than each other variant");
}

std::string slope_text(const std::optional<Estimate>& e) {
  if (!e) return "-";
  if (!std::isfinite(e->error)) return fmt::format("{:.2f}", e->value);
  return fmt::format("{:.2f} ± {:.2f}", e->value, e->error);
}

std::string significance_text(const Results& results) {
  return fmt::format(
      "Significance: Welch's t-test of the logarithms of the runs' errors, two-sided, all {} pairs of variants and scenes "
      "corrected together by Holm's method at the level {}",
      results.at_time.size(), results.significance);
}

}  // namespace etendue::comparing
