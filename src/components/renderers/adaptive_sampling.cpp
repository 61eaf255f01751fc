// Adaptive sampling without bias, around any renderer whose samples contribute to their own pixel only.
//
// Let the samples of pixel i have the mean Y_i and the variance V_i. Of N samples in all, pixel i gets n_i. The sum of squared
// relative errors sum_i V_i / (n_i (Y_i + e)^2) is least when
//     n_i ~ sqrt(V_i) / (Y_i + e)
// (by a Lagrange multiplier). V and Y are unknown, and are estimated from the samples so far, over the neighbouring pixels.
//
// To stop sampling a pixel where few samples suggest a small error is biased: a pixel that happened to miss a rare bright path
// stops, while in one that found it further samples average it away (Kirk & Arvo 1991, "Unbiased sampling techniques for image
// synthesis"). Therefore
//   - every pixel gets at least one sample in every step, and
//   - each step has the same weight in every pixel, however many samples it has there:
//         I_i = 1/K sum_k m_ik,    m_ik the mean of the n_ik samples of step k.
// All n_ik of an epoch are computed from the steps before it. The samples of an epoch have a random seed of their own and are
// independent of earlier steps, so given the past E[m_ik] = I_i for any n_ik, and the expectation of the sum is I_i: exactly,
// not only in the limit. The price is that a step with few samples in a pixel weighs as much there as one with many. Epochs
// have 1, 1, 2, 4, 8, ... steps: within an epoch a pixel's samples are well stratified. The error of the film is estimated from
// the variance between whole steps and does not depend on their numbers of samples.

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "etendue/core/math.h"
#include "etendue/describe/registry.h"
#include "etendue/render/follows_polarization.h"
#include "etendue/transport/light_groups.h"
#include "film/pixel_area.h"

namespace etendue {
namespace {

class AdaptiveSampling final : public Renderer, public FollowsPolarization {
 public:
  Ref<Renderer> inner = ref_cast<Renderer>(Registry::instance().create("PathTracer"));
  int most = 8;
  float dark = 0.05f;

  static void describe(Description<AdaptiveSampling>& d) {
    d.summary(
         "Takes more samples of another renderer where the picture is noisy, and fewer where it is not; `samples` are the mean "
         "over all pixels. Without bias, since steps count alike in every pixel however many samples they have there. Steps "
         "are "
         "of eight samples in the mean, and the error is known after eight of them. They depend on those before, so parts "
         "cannot be rendered apart, samples cannot be replayed, and a crop has other samples than the whole picture.",
         "Kirk & Arvo 1991, Unbiased sampling techniques for image synthesis")
        .without("light_sampler", "the renderer inside chooses luminaires (inner.light_sampler)")
        .without("map_filter", "the renderer inside has it (inner.map_filter)")
        .member<&AdaptiveSampling::inner>(
            "inner", "",
            "the renderer, whose samples must stay in their own pixels; how many samples there are and their sampler are said "
            "out here, and refused in there")
        .member<&AdaptiveSampling::most>("most", "1", "samples of a pixel, in relation to the mean; 1: as many everywhere",
                                         range(1, 1024), soft(1, 64), logarithmic)
        .member<&AdaptiveSampling::dark>(
            "dark", "1",
            "errors count in relation to a pixel's luminance plus this much of the mean luminance: "
            "what is darker is not looked at closely",
            range(1e-4, 1), logarithmic);
  }

  std::uint32_t samples_per_step(std::uint32_t) const override { return mean_samples; }
  bool steps_depend() const override { return true; }
  Estimator estimator() const override { return Estimator::correlated; }
  void prepare() override { map_filter = inner ? inner->map_filter : 0; }
  Expectation expectation() const override { return inner ? inner->expectation() : Expectation::unbiased; }
  PathClasses finds() const override { return inner ? inner->finds() : no_paths; }
  bool follows_polarization() const override { return inner && etendue::follows_polarization(*inner); }
  bool keeps_stokes() const override { return inner && etendue::keeps_stokes(*inner); }

  /// Mean samples per pixel in a whole step: enough that some pixels can have fewer.
  static constexpr std::uint32_t mean_samples = 8;

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

/// Statistics of a pixel's samples: their number and the sums of their luminances and squared luminances.
struct Luminances {
  double count = 0, sum = 0, squares = 0;
  void add(const Luminances& more) {
    count += more.count;
    sum += more.sum;
    squares += more.squares;
  }
};

class AdaptiveProcess final : public RenderProcess {
 public:
  AdaptiveProcess(const AdaptiveSampling& r, const RenderContext& c)
      : RenderProcess(r, c),
        settings_(r),
        inner_(r.inner->start(c)),
        area_(c.image.sampled_area()),
        known_(size_t(area_.width()) * size_t(area_.height())),
        planned_(known_.size(), AdaptiveSampling::mean_samples) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    inner_->prepare_step(schedule, step);
    // An epoch begins with steps 0, 1, 2, 4, 8, ...
    if (step.number == 0 || std::has_single_bit(step.number)) plan();
  }

  void step(Schedule& schedule, const Step& step) override;

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override { return inner_->radiance(ray, sample); }
  Wavelengths wavelengths(SampleKey key, float u) const override { return inner_->wavelengths(key, u); }
  float time(float u) const override { return inner_->time(u); }
  CameraSample sample(int, int, std::uint32_t, Arena&, const PathSink&) const override {
    renderer.fail({}, "how many samples a pixel has follows from all steps before, so that none can be replayed by itself");
  }

  // The plan depends on the steps before the epoch, so it is saved with the state.
  std::vector<std::byte> save_state() const override {
    std::vector<std::byte> bytes(known_.size() * (sizeof(Luminances) + sizeof(std::uint32_t)));
    std::memcpy(bytes.data(), known_.data(), known_.size() * sizeof(Luminances));
    std::memcpy(bytes.data() + known_.size() * sizeof(Luminances), planned_.data(), planned_.size() * sizeof(std::uint32_t));
    return bytes;
  }
  void load_state(std::span<const std::byte> bytes) override {
    if (bytes.size() != known_.size() * (sizeof(Luminances) + sizeof(std::uint32_t)))
      throw Error("the state of adaptive sampling is not of this picture");
    std::memcpy(known_.data(), bytes.data(), known_.size() * sizeof(Luminances));
    std::memcpy(planned_.data(), bytes.data() + known_.size() * sizeof(Luminances), planned_.size() * sizeof(std::uint32_t));
    const std::uint32_t highest = std::uint32_t(settings_.most + 1) * AdaptiveSampling::mean_samples;
    for (const std::uint32_t n : planned_)
      if (n < 1 || n > highest) throw Error("the state of adaptive sampling plans an impossible number of samples");
  }

 private:
  static constexpr int tile = 8;

  size_t place(int x, int y) const { return size_t(y - area_.y0) * size_t(area_.width()) + size_t(x - area_.x0); }
  // Tiles are aligned to the whole image, so that the sums of a crop are over the same tiles.
  int first_column() const { return area_.x0 / tile; }
  int first_row() const { return area_.y0 / tile; }
  std::uint64_t columns() const { return std::uint64_t((area_.x1 + tile - 1) / tile - first_column()); }
  std::uint64_t rows() const { return std::uint64_t((area_.y1 + tile - 1) / tile - first_row()); }
  PixelArea item_area(std::uint64_t item) const {
    const int x = (first_column() + int(item % columns())) * tile, y = (first_row() + int(item / columns())) * tile;
    return intersection({x, y, x + tile, y + tile}, area_);
  }
  void plan();
  std::vector<float> wishes() const;

  const AdaptiveSampling& settings_;
  const std::unique_ptr<RenderProcess> inner_;
  const PixelArea area_;
  std::vector<Luminances> known_;       // for each pixel, from all steps so far
  std::vector<std::uint32_t> planned_;  // samples of each pixel in a step of this epoch
};

/// The relative errors sqrt(V) / (Y + e) of all pixels, to which their samples are proportional. Variances within pixels and
/// means are averaged over 5 x 5 pixels around each. All are 1 before the first samples.
std::vector<float> AdaptiveProcess::wishes() const {
  constexpr int reach = 2;
  double total = 0, count = 0;
  for (const Luminances& l : known_) total += l.sum, count += l.count;
  std::vector<float> wishes(known_.size(), 1.0f);
  if (!(count > 0 && total > 0)) return wishes;
  const double dark = double(settings_.dark) * total / count;
  for (int y = area_.y0; y < area_.y1; ++y)
    for (int x = area_.x0; x < area_.x1; ++x) {
      double spread = 0, freedom = 0, luminance = 0, pixels = 0;
      for (int j = std::max(y - reach, area_.y0); j <= std::min(y + reach, area_.y1 - 1); ++j)
        for (int i = std::max(x - reach, area_.x0); i <= std::min(x + reach, area_.x1 - 1); ++i) {
          const Luminances& l = known_[place(i, j)];
          if (!(l.count > 1)) continue;
          spread += std::max(l.squares - l.sum * l.sum / l.count, 0.0);
          freedom += l.count - 1;
          luminance += l.sum / l.count;
          pixels += 1;
        }
      if (freedom > 0) wishes[place(x, y)] = float(std::sqrt(spread / freedom) / (luminance / pixels + dark));
    }
  return wishes;
}

/// Plans the samples of the next epoch: one for each pixel, and (mean - 1) times the number of pixels distributed in proportion
/// to `wishes`, up to `most` times the mean per pixel. Samples that this limit cuts off are distributed among the other pixels
/// in a few rounds, and the remainder evenly over all pixels, since the film expects the full number of samples in each step.
/// The numbers are rounded so that running sums are exact to one sample.
void AdaptiveProcess::plan() {
  const std::vector<float> wished = wishes();
  constexpr double mean = AdaptiveSampling::mean_samples;
  const double rest = (mean - 1) * double(wished.size()), highest = double(settings_.most) * mean - 1;
  const auto share = [&](float wish, double factor) { return std::min(factor * double(wish), highest); };
  double factor = 0, left = rest;
  for (int round = 0; round < 16; ++round) {
    double open = 0, given = 0;
    for (const float w : wished) {
      given += share(w, factor);
      if (factor * double(w) < highest) open += double(w);
    }
    left = std::max(rest - given, 0.0);
    if (!(open > 0) || left < 1) break;
    factor += left / open;
  }
  double sum = 0, given = 0;
  for (const float w : wished) given += share(w, factor);
  const double even = std::max(rest - given, 0.0) / double(wished.size());
  std::uint64_t planned = 0;
  for (size_t i = 0; i < wished.size(); ++i) {
    sum += share(wished[i], factor) + even;
    const auto up_to = std::uint64_t(sum + 0.5);
    planned_[i] = 1 + std::uint32_t(up_to - planned);
    planned = up_to;
  }
}

void AdaptiveProcess::step(Schedule& schedule, const Step& step) {
  const std::uint32_t epoch = std::uint32_t(std::bit_width(step.number)),
                      first_step = step.number == 0 ? 0 : std::bit_floor(step.number),
                      count = step.samples.end - step.samples.begin;
  // A partial step, when the render ends within a step, is sampled evenly with its own random seed.
  const bool whole = count == AdaptiveSampling::mean_samples && step.samples.begin % count == 0;
  const std::uint64_t seed = mix_bits(context.seed + mix_bits(whole ? epoch : std::uint64_t(step.samples.begin) + 64));
  const LightGroups groups(context.scene, context.image);
  const std::uint64_t items = columns() * rows();
  const std::vector<Luminances> found = schedule.film_and_collect<Luminances>(
      items, [&](std::uint64_t item, ImageTile& film, std::vector<Luminances>& results, Arena& arena) {
        const PixelArea area = item_area(item);
        film.begin(context.image, area);
        LightParts parts(context.image, groups);
        const PathSink sink{.lengths = parts.lengths(), .abort = schedule.abort};
        for (int y = area.y0; y < area.y1; ++y)
          for (int x = area.x0; x < area.x1; ++x) {
            const std::uint32_t n = whole ? planned_[place(x, y)] : count, first = whole ? (step.number - first_step) * n : 0;
            Luminances of_pixel;
            for (SampleKey key(seed, x, y, first); key.sample < first + n; ++key.sample) {
              if (schedule.aborted()) return;
              parts.clear();
              const CameraSample s = path({x, y, x + 1, y + 1}, *renderer.sampler, key, arena, sink);
              film.count_path();
              parts.require_all(s.value, s.wavelengths);
              film.contribute(s.film, x, y, key.sample, s.value, s.wavelengths, float(count) / float(n), parts.all());
              const double luminance = to_xyz(s.value, s.wavelengths).y;
              if (std::isfinite(luminance)) of_pixel.add({1, luminance, luminance * luminance});
            }
            results.push_back(of_pixel);
          }
      });
  if (schedule.aborted()) return;  // the samples of an aborted step are discarded
  size_t next = 0;
  for (std::uint64_t item = 0; item < items; ++item) {
    const PixelArea area = item_area(item);
    for (int y = area.y0; y < area.y1; ++y)
      for (int x = area.x0; x < area.x1; ++x) known_[place(x, y)].add(found[next++]);
  }
}

std::unique_ptr<RenderProcess> AdaptiveSampling::begin(const RenderContext& context) const {
  if (!inner) fail("inner", "needs a renderer whose samples it takes");
  if (inner->splats())
    fail("inner",
         inner->class_info().name +
             " brings light to other places of the film than a sample's own pixel: there is no more or less of it in a pixel");
  if (inner->estimator() == Estimator::correlated || inner->steps_depend())
    fail("inner", inner->class_info().name + " does not take its samples one by one, independent of each other");
  refuse_samples_of(*inner);
  return std::make_unique<AdaptiveProcess>(*this, context);
}

const Register<AdaptiveSampling> registered;

}  // namespace
}  // namespace etendue
