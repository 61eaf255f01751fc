// Multiplexed Metropolis light transport (Hachisuka, Kaplanyan & Dachsbacher 2014, "Multiplexed Metropolis light transport").
//
// A bidirectional path tracer makes all paths that its two subpaths can make, most of which contribute little. Here primary
// samples choose one path: its number of segments k with the probability P(k), and uniformly the strategy that makes it, which
// takes s of its k + 1 vertices from the light subpath. The subpaths are traced only as far as this strategy needs, and
//     F = (number of strategies / P(k)) w_s C_s,
// with C_s the unweighted contribution of the strategy and w_s its multiple importance sampling weight
// (transport/bidirectional_subpaths.h). The mean of F over the primary samples is all light of all lengths. Chains mutate the
// primary samples (render/primary_sample_chains.h), including those that choose k and s: so a path is made most often by the
// strategies that contribute most to it, in proportion to w_s.
//
// P may be any distribution that is positive for all lengths. Each step of the render estimates it from a few paths of its own:
// 3/4 in proportion to the light that was found with k segments, and 1/4 in proportion to 1 / k.

#include <numeric>

#include "etendue/render/primary_sample_chains.h"
#include "etendue/transport/bidirectional_subpaths.h"
#include "etendue/transport/renderer_members.h"

namespace etendue {

class MultiplexedMetropolis final : public Renderer {
 public:
  int max_depth = 64;
  Heuristic heuristic = Heuristic::power;
  bool direct = true;
  int mutations_per_sample = 4, chains = ChainSettings().chains;
  float bootstrap = ChainSettings().bootstrap, large_steps = ChainSettings().large_steps, deviation = ChainSettings().deviation;
  bool even_errors = ChainSettings().even_errors;

  static void describe(Description<MultiplexedMetropolis>& d) {
    d.summary("Metropolis light transport that mutates one bidirectional path at a time, and the strategy that makes it.",
              "Hachisuka, Kaplanyan & Dachsbacher 2014; Kelemen et al. 2002");
    d.group("Paths");
    describe_max_depth<&MultiplexedMetropolis::max_depth>(d, stored_subpath_depth, range(1, longest_stored_subpath));
    describe_heuristic<&MultiplexedMetropolis::heuristic>(d);
    d.member<&MultiplexedMetropolis::direct>(
        "direct", "", "whether paths of one or two segments are found sample by sample, by all strategies, and not by chains");
    describe_chains<&MultiplexedMetropolis::mutations_per_sample, &MultiplexedMetropolis::chains,
                    &MultiplexedMetropolis::bootstrap, &MultiplexedMetropolis::large_steps, &MultiplexedMetropolis::deviation,
                    &MultiplexedMetropolis::even_errors>(d);
  }

  bool splats() const override { return true; }
  PathClasses finds() const override { return all_paths & ~(delta_caustics_in_mirrors | subsurface_light | fluorescence); }
  Estimator estimator() const override { return Estimator::correlated; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

namespace {

/// Subpaths without Russian roulette: their length is already chosen.
SubpathLimits exactly(int segments) { return {segments, segments + 1}; }

/// Estimates F: each sample is one path, made by one strategy.
class StrategyProcess final : public RenderProcess {
 public:
  StrategyProcess(const MultiplexedMetropolis& r, const RenderContext& c)
      : RenderProcess(r, c), settings_(r), first_(r.direct ? MutatedPaths::direct_length + 1 : 1) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    std::vector<double> falling;
    for (int k = first_; k <= settings_.max_depth; ++k) falling.push_back(1.0 / k);
    choose_lengths_by(falling);
    if (falling.empty()) return;
    std::vector<double> light = light_by_length(schedule, step);
    const double all = std::accumulate(light.begin(), light.end(), 0.0), sum = sums_.back();
    if (!(all > 0)) return;
    light.resize(falling.size());
    for (size_t i = 0; i < light.size(); ++i) light[i] = 0.75 * light[i] / all + 0.25 * falling[i] / sum;
    choose_lengths_by(light);
  }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    if (sums_.empty()) return {};
    const double u = double(sample.numbers.fork("length").next()) * sums_.back();
    const auto i = std::min(size_t(std::ranges::upper_bound(sums_, u) - sums_.begin()), sums_.size() - 1);
    const double P = (sums_[i] - (i > 0 ? sums_[i - 1] : 0)) / sums_.back();
    const int k = first_ + int(i);
    // For k = 1, only emitter hits (s = 0) are used; the luminaire is not connected to the lens.
    const int strategies = k == 1 ? 1 : k + 1;
    const int s = std::min(int(sample.numbers.fork("strategy").next() * float(strategies)), strategies - 1), t = k + 1 - s;

    BidirectionalSubpaths walks(context, *settings_.light_sampler, sample, {settings_.heuristic});
    ContributionSum sum(sample, walks, [&](PathContribution& found) {
      if (found.s != s || found.t != t) return false;
      found.light *= float(strategies / P);
      return true;
    });
    if (t > 1) {
      walks.from_camera(ray, exactly(t - 1));
      sum.add(walks.segment_emission());
      if (walks.camera_vertices() < t) return sum.radiance;
      if (s > 0 && !walks.camera_vertex(t).connectable()) return {};
    }
    if (s > 1) {
      walks.from_luminaire(ray.time, exactly(s - 1));
      if (walks.light_vertices() < s || !walks.light_vertex(s).connectable()) return {};
    }
    if (s == 0)
      sum.add(walks.emitter_hits(t));
    else if (s == 1)
      sum.add(walks.next_event(t));
    else
      sum.add(t == 1 ? walks.connect_to_lens(s) : walks.connect(s, t));
    return sum.radiance;
  }

 private:
  const MultiplexedMetropolis& settings_;
  const int first_;           ///< length of the shortest paths
  std::vector<double> sums_;  ///< the cumulative distribution of P, times a constant

  void choose_lengths_by(const std::vector<double>& weights) {
    sums_.resize(weights.size());
    std::partial_sum(weights.begin(), weights.end(), sums_.begin());
  }

  /// The luminance of each path length from first_ to at most 64, times a constant, from a quarter as many paths as the
  /// bootstrap pool has.
  std::vector<double> light_by_length(Schedule& schedule, const Step& step) const {
    constexpr std::uint32_t item_size = 256;
    const PixelArea area = context.image.sampled_area();
    const double mutations = double(area.width()) * area.height() * (step.samples.end - step.samples.begin);
    const auto items = std::uint64_t(mutations * double(settings_.bootstrap) / (4 * item_size)) + 1;
    const auto told = size_t(std::min(settings_.max_depth, 64));
    const std::vector<double> all =
        schedule.collect<double>(items, [&](std::uint64_t item, std::vector<double>& sums, Arena& arena) {
          sums.resize(told);
          std::vector<Spectrum> lengths(told);
          std::vector<Splat> splats;
          const PathSink sink{.lengths = lengths, .splats = &splats, .abort = schedule.abort};
          for (std::uint32_t i = 0; i < item_size && !schedule.aborted(); ++i) {
            splats.clear();
            std::ranges::fill(lengths, Spectrum());
            const SampleKey key(context.seed, -1, int(step.number), std::uint32_t(item) * item_size + i);
            const CameraSample s = path(area, *settings_.sampler, key, arena, sink);
            const auto add = [&](int length, const Spectrum& light, const Wavelengths& w) {
              const double y = to_xyz(light, w).y;
              if (length <= int(told) && std::isfinite(y)) sums[size_t(length - 1)] += y;
            };
            for (size_t l = 0; l < told; ++l) add(int(l) + 1, lengths[l], s.wavelengths);
            for (const Splat& splat : splats) add(splat.length, splat.value, splat.wavelengths);
          }
        });
    std::vector<double> sums(told);
    for (size_t i = 0; i < all.size(); ++i) sums[i % told] += all[i];
    sums.erase(sums.begin(), sums.begin() + std::min(std::ptrdiff_t(told), std::ptrdiff_t(first_ - 1)));
    return sums;
  }
};

/// Visible emitters and direct light, by all strategies with up to two segments.
class DirectProcess final : public RenderProcess {
 public:
  DirectProcess(const MultiplexedMetropolis& r, const RenderContext& c) : RenderProcess(r, c), settings_(r) {}
  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    const int longest = std::min(settings_.max_depth, MutatedPaths::direct_length);
    BidirectionalSubpaths walks(context, *settings_.light_sampler, sample, {settings_.heuristic});
    ContributionSum sum(sample, walks, [](const PathContribution&) { return true; });
    walks.from_camera(ray, exactly(longest));
    sum.add(walks.segment_emission());
    for (int t = 2; t <= walks.camera_vertices(); ++t) sum.add(walks.emitter_hits(t));
    if (longest < 2) return sum.radiance;
    walks.from_luminaire(ray.time, exactly(1));
    if (walks.camera_vertices() > 1 && walks.camera_vertex(2).connectable()) sum.add(walks.next_event(2));
    if (walks.light_vertices() > 1 && walks.light_vertex(2).connectable()) sum.add(walks.connect_to_lens(2));
    return sum.radiance;
  }

 private:
  const MultiplexedMetropolis& settings_;
};

}  // namespace

std::unique_ptr<RenderProcess> MultiplexedMetropolis::begin(const RenderContext& context) const {
  return std::make_unique<MutatedPaths>(
      *this, context, ChainSettings{mutations_per_sample, chains, bootstrap, large_steps, deviation, even_errors},
      std::make_unique<StrategyProcess>(*this, context), direct ? std::make_unique<DirectProcess>(*this, context) : nullptr);
}

static const Register<MultiplexedMetropolis> registered;

}  // namespace etendue
