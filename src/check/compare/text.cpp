#include "text.h"

#include <fmt/format.h>

#include "tables.h"

namespace etendue::comparing {

namespace {

std::string error_text(const std::vector<double>& errors) {
  const std::optional<Estimate> e = mean_error(errors);
  if (!e) return "-";
  return fmt::format("{:.3g} ± {:.0f} %", e->value, 100 * e->error / e->value);
}

std::string scene_text(const SceneResult& scene) {
  std::string text = fmt::format("{}  ({} x {} pixels, {} runs of each variant)\nreference: {}\n", scene.file, scene.width,
                                 scene.height, scene.runs, scene.reference);
  if (!scene.reference_is_exact)
    text += fmt::format("  its own relative variance, {:.2g}, is subtracted from errors\n", scene.reference_noise);
  size_t width = 7;
  for (const VariantResult& v : scene.variants) width = std::max(width, v.name.size());
  text += fmt::format("\n{:<{}}  {:>16}  {:>16}  {:>14}  {:>10}  {:>9}  bias\n", "relMSE", width,
                      fmt::format("after {:.3g} s", scene.equal_seconds), fmt::format("{} samples", scene.equal_samples),
                      "falls with time", "samples/s", "samples");
  for (const VariantResult& v : scene.variants)
    text += fmt::format("{:<{}}  {:>16}  {:>16}  {:>15}  {:>10.3g}  {:>9.4g}  {}\n", v.name, width, error_text(v.at_time),
                        error_text(v.at_samples), slope_text(v.slope_over_time), v.samples / std::max(v.seconds, 1e-9),
                        v.samples, bias_text(v));
  for (const VariantResult& v : scene.variants)
    for (const std::string& remark : remarks(scene, v)) text += fmt::format("{}: {}\n", v.name, remark);
  text += fmt::format("least error at equal time: {}\n", winner_text(scene, scene.at_time));
  text += fmt::format("least error at equal samples: {}\n\n", winner_text(scene, scene.at_samples));
  return text;
}

}  // namespace

std::string results_text(const Results& results) {
  std::string text;
  for (const SceneResult& scene : results.scenes) text += scene_text(scene);
  if (results.scenes.size() > 1) {
    text += fmt::format("geometric mean over the scenes, error at equal time over that of {}:\n",
                        results.scenes.front().variants.front().name);
    for (size_t v = 1; v < results.geometric_means.size(); ++v) {
      const GeometricMean& mean = results.geometric_means[v];
      text += fmt::format("  {}: {:.3g} ± {:.1f} %  ({} scenes)\n", results.scenes.front().variants[v].name, mean.value,
                          100 * mean.relative_error, mean.scenes);
    }
  }
  return text + significance_text(results) + ".\nSeconds are CPU time, summed over all threads.\n";
}

}  // namespace etendue::comparing
