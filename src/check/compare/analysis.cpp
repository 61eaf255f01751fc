// Analysis of a scene's runs. The formulas are in docs/compare.md.

#include "analysis.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace etendue::comparing {
namespace {

/// Means over tiles and over the whole image, in the layout of verify's tests.
std::vector<double> tile_means(const verify::Layout& layout, int width, std::span<const double> pixels) {
  std::vector<double> means(layout.count());
  for (size_t layer = 0; layer < layout.layers.size(); ++layer)
    for (size_t tile = 0; tile < layout.tiles.size(); ++tile) {
      const PixelArea& area = layout.tiles[tile];
      const auto channel = size_t(layout.layers[layer].channel - 'X');
      double sum = 0;
      for (int y = area.y0; y < area.y1; ++y)
        for (int x = area.x0; x < area.x1; ++x) sum += pixels[3 * (size_t(y) * size_t(width) + size_t(x)) + channel];
      means[layout.index(layer, tile)] = sum / layout.pixels(tile);
      means[layout.index(layer, layout.whole())] += sum / layout.pixels(layout.whole());
    }
  return means;
}

class SceneAnalysis {
 public:
  SceneAnalysis(const RunStore& store, const SceneRuns& runs, double significance)
      : store_(store), runs_(runs), significance_(significance) {
    layout_ = verify::Layout::of({0, 0, runs.width, runs.height}, runs.tile, 0);
  }

  SceneResult result(SceneImages* images);

 private:
  using Means = std::vector<std::vector<double>>;  // means of the tiles, for each run
  size_t numbers() const { return 3 * size_t(runs_.width) * size_t(runs_.height); }
  RunKey key(size_t variant, size_t run) const { return {runs_.scene, variant, run}; }
  Pixels last_picture(size_t variant, size_t run) const {
    return store_.picture(key(variant, run), store_.run(key(variant, run)).marks.size() - 1);
  }
  RunSums sums_of(size_t variant, size_t runs, Means& means) const;
  void choose_reference(SceneResult&);
  /// The reference for the error of a run.
  Reference reference_for(size_t variant, std::span<const float> last) const;
  void curves(VariantResult&, size_t variant);
  void split_error(VariantResult&, size_t variant, const Reference& other);
  void bias(VariantResult&, size_t variant) const;
  void equal_budgets(SceneResult&) const;
  void draw(SceneImages&) const;

  /// The errors of one run at its marks.
  struct RunCurve {
    std::vector<double> samples, seconds, error, symmetric;
  };

  const RunStore& store_;
  const SceneRuns& runs_;
  const double significance_;
  verify::Layout layout_;
  std::vector<RunSums> sums_;
  std::vector<Means> means_;
  std::optional<AgreedMean> agreed_;
  Reference reference_;  // for all runs that are not part of it
  Means reference_means_;
  std::vector<double> weights_;
  std::vector<std::vector<RunCurve>> run_curves_;
};

RunSums SceneAnalysis::sums_of(size_t variant, size_t runs, Means& means) const {
  RunSums sums(numbers());
  for (size_t run = 0; run < runs; ++run) {
    const Pixels pixels = last_picture(variant, run);
    sums.add(pixels);
    means.push_back(tile_means(layout_, runs_.width, std::vector<double>(pixels.begin(), pixels.end())));
  }
  return sums;
}

void SceneAnalysis::choose_reference(SceneResult& result) {
  const ReferenceSource& source = runs_.reference;
  result.reference = source.text;
  if (source.picture) {
    reference_ = *source.picture;
    reference_means_.assign(3, tile_means(layout_, runs_.width, reference_.mean));
    result.reference_is_exact = true;
  } else if (source.variant) {
    const RunSums sums = sums_of(*source.variant, source.runs, reference_means_);
    for (size_t i = 0; i < numbers(); ++i) {
      reference_.mean.push_back(sums.mean(i));
      reference_.variance.push_back(sums.variance(i) / sums.runs());
    }
  } else {
    std::vector<const RunSums*> members;
    std::string names;
    for (size_t v = 0; v < runs_.subjects.size(); ++v) {
      const bool member = runs_.subjects[v].reaches_truth();
      members.push_back(member ? &sums_[v] : nullptr);
      if (member) names += (names.empty() ? "" : ", ") + runs_.subjects[v].name;
    }
    if (names.empty())
      throw Error(
          fmt::format("{}: every variant is biased or misses light of the scene, so their mean is no reference: give "
                      "--reference, or add a variant that finds all light",
                      runs_.file));
    agreed_.emplace(std::move(members));
    reference_ = agreed_->whole();
    result.reference = fmt::format(
        "the mean of all runs of {}, weighted by inverse variance (no picture from elsewhere). The error of a run is told from "
        "the mean without that run, the bias of a variant from the mean without that variant",
        names);
  }
  weights_ = relative_weights(reference_.mean);
  if (reference_.variance.empty()) return;
  for (size_t i = 0; i < numbers(); ++i) result.reference_noise += weights_[i] * reference_.variance[i] / double(numbers());
}

Reference SceneAnalysis::reference_for(size_t variant, std::span<const float> last) const {
  return agreed_ && agreed_->has(variant) ? agreed_->without_run(variant, last) : reference_;
}

void SceneAnalysis::curves(VariantResult& v, size_t variant) {
  size_t marks = SIZE_MAX;
  std::vector<RunCurve>& curves = run_curves_[variant];
  for (size_t r = 0; r < runs_.runs; ++r) {
    const Run& run = store_.run(key(variant, r));
    const bool own = agreed_ && agreed_->has(variant);
    const Reference without = own ? reference_for(variant, last_picture(variant, r)) : Reference{};
    const Reference& reference = own ? without : reference_;
    RunCurve curve;
    for (size_t m = 0; m < run.marks.size(); ++m) {
      const Pixels pixels = store_.picture(key(variant, r), m);
      curve.samples.push_back(run.marks[m].samples);
      curve.seconds.push_back(run.marks[m].seconds);
      curve.error.push_back(relative_square_error(pixels, reference, weights_));
      curve.symmetric.push_back(symmetric_error(pixels, reference.mean));
    }
    marks = std::min(marks, run.marks.size());
    v.samples += double(run.marks.back().samples);
    v.seconds += run.marks.back().seconds;
    v.wall_seconds += run.wall_seconds;
    v.bad_samples += run.bad_samples;
    curves.push_back(std::move(curve));
  }
  for (double* sum : {&v.samples, &v.seconds, &v.wall_seconds}) *sum /= double(runs_.runs);
  std::vector<double> samples, seconds;
  std::vector<std::vector<double>> errors(curves.size());
  for (size_t m = 0; m < marks; ++m) {
    CurvePoint point;
    std::vector<double> error, symmetric;
    for (size_t r = 0; r < curves.size(); ++r) {
      point.samples += curves[r].samples[m];
      point.seconds += curves[r].seconds[m];
      error.push_back(curves[r].error[m]);
      symmetric.push_back(curves[r].symmetric[m]);
      errors[r].push_back(error.back());
    }
    point.samples /= double(curves.size());
    point.seconds /= double(curves.size());
    point.error = mean_of(error);
    point.symmetric = mean_of(symmetric);
    samples.push_back(point.samples);
    seconds.push_back(point.seconds);
    v.curve.push_back(std::move(point));
  }
  v.slope_over_samples = exponent_of_mean(samples, errors);
  v.slope_over_time = exponent_of_mean(seconds, errors);
}

void SceneAnalysis::split_error(VariantResult& v, size_t variant, const Reference& other) {
  for (size_t m = 0; m < v.curve.size(); ++m) {
    RunSums sums(numbers());
    for (size_t r = 0; r < runs_.runs; ++r) sums.add(store_.picture(key(variant, r), m));
    CurvePoint& point = v.curve[m];
    point.variance = sums.relative_variance(weights_);
    point.error_of_mean = point.variance / sums.runs();
    if (other.mean.empty()) continue;
    std::vector<double> without_each;
    for (size_t r = 0; r < runs_.runs; ++r)
      without_each.push_back(sums.relative_square_bias_without(store_.picture(key(variant, r), m), other, weights_));
    point.square_bias = jackknife(sums.relative_square_bias(other, weights_), without_each);
  }
}

void SceneAnalysis::bias(VariantResult& v, size_t variant) const {
  verify::Measured own{v.name, means_[variant], true, {}}, other{"the reference", reference_means_, true, {}};
  if (agreed_) {
    // The mean of the other members, run by run: as many independent images.
    const double rest = 1 - (agreed_->has(variant) ? agreed_->weight(variant) : 0);
    other.passes.assign(runs_.runs, std::vector<double>(layout_.count()));
    for (size_t s = 0; s < runs_.subjects.size(); ++s)
      for (size_t r = 0; agreed_->has(s) && s != variant && r < runs_.runs; ++r)
        for (size_t i = 0; i < layout_.count(); ++i) other.passes[r][i] += agreed_->weight(s) / rest * means_[s][r][i];
  }
  v.bias.known = true;
  v.bias.test = std::move(verify::compare(layout_, {own, other}, significance_).pairs.front());
  const verify::Moments a = verify::moments(layout_, own, 0, layout_.whole()),
                        b = verify::moments(layout_, other, 0, layout_.whole());
  if (!(b.mean > 0)) return;
  v.bias.relative = a.mean / b.mean - 1;
  v.bias.error = std::sqrt(a.error() * a.error() + b.error() * b.error()) / b.mean;
}

void SceneAnalysis::equal_budgets(SceneResult& result) const {
  double samples = HUGE_VAL, seconds = HUGE_VAL;
  for (const auto& curves : run_curves_)
    for (const RunCurve& c : curves) {
      samples = std::min(samples, c.samples.back());
      seconds = std::min(seconds, c.seconds.back());
    }
  // A run limited by time ends with the first step that exceeds it; its error is interpolated at that time.
  if (runs_.budget.seconds > 0) seconds = std::min(seconds, runs_.budget.seconds);
  result.equal_samples = samples;
  result.equal_seconds = seconds;
  for (size_t v = 0; v < result.variants.size(); ++v) {
    VariantResult& variant = result.variants[v];
    const auto read = [&](auto of, auto what, double at) {
      std::vector<double> list;
      for (const RunCurve& c : run_curves_[v])
        if (const std::optional<double> e = read_curve(c.*of, c.*what, at)) list.push_back(*e);
      return list.size() == run_curves_[v].size() ? list : std::vector<double>();
    };
    variant.at_samples = read(&RunCurve::samples, &RunCurve::error, samples);
    variant.at_time = read(&RunCurve::seconds, &RunCurve::error, seconds);
    if (const auto list = read(&RunCurve::samples, &RunCurve::symmetric, samples); !list.empty())
      variant.symmetric_at_samples = mean_of(list).value;
    if (const auto list = read(&RunCurve::seconds, &RunCurve::symmetric, seconds); !list.empty())
      variant.symmetric_at_time = mean_of(list).value;
  }
}

void SceneAnalysis::draw(SceneImages& images) const {
  images.reference = reference_.mean;
  images.layout = layout_;
  for (size_t v = 0; v < runs_.subjects.size(); ++v) {
    SceneImages::One one{last_picture(v, 0), {}, {}};
    for (size_t i = 0; i < numbers(); ++i) one.mean.push_back(sums_[v].mean(i));
    for (size_t i = 1; i < numbers(); i += 3) one.variance.push_back(sums_[v].variance(i));
    images.variants.push_back(std::move(one));
  }
}

SceneResult SceneAnalysis::result(SceneImages* images) {
  SceneResult result;
  result.file = runs_.file;
  result.width = runs_.width;
  result.height = runs_.height;
  result.runs = runs_.runs;
  const size_t count = runs_.subjects.size();
  means_.resize(count);
  run_curves_.resize(count);
  for (size_t v = 0; v < count; ++v) sums_.push_back(sums_of(v, runs_.runs, means_[v]));
  choose_reference(result);
  for (size_t v = 0; v < count; ++v) {
    VariantResult variant;
    variant.name = runs_.subjects[v].name;
    variant.misses = runs_.subjects[v].misses;
    variant.says = runs_.subjects[v].bias;
    variant.in_reference = agreed_ && agreed_->has(v);
    if (variant.in_reference) variant.weight = agreed_->weight(v);
    curves(variant, v);
    const bool other = !variant.in_reference || agreed_->members() > 1;
    split_error(variant, v, !other ? Reference{} : variant.in_reference ? agreed_->without(v) : reference_);
    if (other) bias(variant, v);
    result.variants.push_back(std::move(variant));
  }
  equal_budgets(result);
  if (images) draw(*images);
  return result;
}

/// The errors of all runs of a scene's variants; empty for a variant without an error at this budget.
std::vector<std::vector<double>> errors_of(const SceneResult& scene, std::vector<double> VariantResult::* which) {
  std::vector<std::vector<double>> errors;
  bool positive = true;
  for (const VariantResult& v : scene.variants) {
    errors.push_back(v.*which);
    for (const double e : errors.back()) positive = positive && e > 0;
  }
  // An error below the reference's noise may be negative after its subtraction; then the noise is added back to all errors.
  if (!positive)
    for (auto& list : errors)
      for (double& e : list) e += scene.reference_noise;
  return errors;
}

}  // namespace

SceneResult analyse(const RunStore& store, const SceneRuns& runs, double significance, SceneImages* images) {
  return SceneAnalysis(store, runs, significance).result(images);
}

void judge(Results& results) {
  std::vector<std::vector<std::vector<double>>> at_samples, at_time;
  for (const SceneResult& scene : results.scenes) {
    at_samples.push_back(errors_of(scene, &VariantResult::at_samples));
    at_time.push_back(errors_of(scene, &VariantResult::at_time));
  }
  results.at_samples = contests(at_samples, results.significance);
  results.at_time = contests(at_time, results.significance);
  for (size_t s = 0; s < results.scenes.size(); ++s) {
    results.scenes[s].at_samples = winner(at_samples[s], results.at_samples, s);
    results.scenes[s].at_time = winner(at_time[s], results.at_time, s);
  }
  if (results.scenes.empty()) return;
  for (size_t v = 0; v < results.scenes.front().variants.size(); ++v) {
    std::vector<Estimate> logs;
    for (size_t s = 0; s < results.scenes.size(); ++s)
      if (!at_time[s][v].empty() && !at_time[s][0].empty())
        logs.push_back(v == 0 ? Estimate{0, 0, 1} : log_ratio(at_time[s][v], at_time[s][0]));
    results.geometric_means.push_back(geometric_mean(logs));
  }
}

}  // namespace etendue::comparing
