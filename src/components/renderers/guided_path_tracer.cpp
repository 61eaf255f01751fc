// Path guiding: path tracing that learns the distribution of incident light from its own paths.
//
// As in path tracing, radiance along a ray is the sum over the vertices x_k of a random walk
//     L = sum_k T_k [ L_e(x_k) + direct(x_k) ],   T_{k+1} = T_k f |cos| / p,
// with next event estimation and emitter hits weighted against each other (path_tracer.cpp). Directions are sampled from a
// mixture p of the scattering's pdf and a learned pdf (guiding/guided_scattering.h, guiding/guide.h). The algorithm follows
// Müller, Gross & Novák 2017, "Practical path guiding for efficient light-transport simulation", with the distributions of
// Ruppert, Herholz & Lensch 2020, "Robust fitting of parallax-aware mixtures for path guiding".
//
// For each vertex x_k a path records the light that arrived along the sampled direction, divided by the throughput there:
//     X_k = mean over wavelengths of (L - L_earlier) / T_k,
// with L_earlier the radiance gathered before and at x_k, over the path's wavelengths, which are sampled in proportion to the
// eye's sensitivity; and the distance of the next vertex. The guide learns after each step, and the samples of a step use the
// guide of the steps before: each sample is unbiased, so all have the same weight in the image.
//
// Russian roulette uses the throughput that the path would have if scattering alone had sampled the same directions: T itself
// is small just where a guide leads into light. It ends fewer walks than in a path tracer: where the guide leaves little
// variance in directions, most of the remaining variance is from roulette (docs/decisions/028-guiding.md has the numbers).

#include "etendue/guiding/guided_scattering.h"
#include "etendue/render/adaptive_lights.h"
#include "etendue/render/guided_process.h"
#include "etendue/render/renderer.h"
#include "etendue/transport/camera_walk.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/roulette.h"

namespace etendue {

class GuidedPathTracer final : public Renderer {
 public:
  int max_depth = 64;
  int roulette_depth = 8;
  Heuristic heuristic = Heuristic::power;
  bool next_event = true;
  bool learn_share = true;
  float share = 0.5f;
  float region_samples = 4000;
  int memory = 512;

  static void describe(Description<GuidedPathTracer>& d) {
    d.summary(
        "Path tracing that learns, from its own paths, in which directions light is found from each place: so a crop, which "
        "learns from its own paths alone, has other samples than the whole picture.",
        "Müller, Gross & Novák 2017; Ruppert, Herholz & Lensch 2020");
    d.group("Paths");
    describe_max_depth<&GuidedPathTracer::max_depth>(d);
    describe_roulette_depth<&GuidedPathTracer::roulette_depth>(d);
    describe_heuristic<&GuidedPathTracer::heuristic>(d, when("next_event"));
    d.member<&GuidedPathTracer::next_event>("next_event", "",
                                            "whether luminaires are sampled; without, paths must meet them by chance");
    d.group("Guide")
        .member<&GuidedPathTracer::learn_share>(
            "learn_share", "", "whether each region learns how often its guide chooses the direction, rather than the surface")
        .member<&GuidedPathTracer::share>(
            "share", "1", "how often the guide chooses: at first, or always if that is not learned", range(0.05, 0.95))
        .member<&GuidedPathTracer::region_samples>(
            "region_samples", "1",
            "effective samples, as many as tell as much if all found the same, with which a region of space is divided",
            range(8, 1e9), logarithmic);
    describe_guide_memory<&GuidedPathTracer::memory>(d);
  }

  std::uint32_t samples_per_step(std::uint32_t usual) const override { return LearnedGuide::samples_per_step(usual); }
  bool steps_depend() const override { return true; }
  PathClasses finds() const override {
    const PathClasses lost = delta_caustics | delta_caustics_in_mirrors;
    return all_paths & ~(next_event ? lost : lost | delta_light);
  }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

namespace {

/// The training samples of a path: one for each vertex it left, up to `longest`.
class Trail {
 public:
  static constexpr int longest = 16;  ///< deeper vertices of a path give no training samples

  void left(const GuideSample& sample, const Spectrum& throughput) {
    waits_ = length_ < longest;
    if (!waits_) return;
    if (!sample.specular) begun_ = length_;  // distances through mirrors are summed over the specular chain
    left_[length_++] = {sample, throughput, {}, 0};
  }
  /// Completes the last segment, of length `distance` [m]. `earlier`: the radiance of the path without light from this segment
  /// on.
  void arrived(const Spectrum& earlier, float distance) {
    if (!waits_) return;
    for (int i = begun_; i < length_; ++i) left_[i].distance += distance;
    left_[length_ - 1].earlier = earlier;
    waits_ = false;
  }
  /// Computes X of all vertices from the radiance of the whole path, and stores the training samples.
  void record(const Spectrum& all, SampleContext& sample) {
    for (int i = 0; i < length_; ++i) {
      GuideSample& s = left_[i].sample;
      s.found = left_[i].found(all);
      if (!(s.found > 0)) continue;
      s.nearness = 1 / left_[i].distance;
      sample.sink.records.add(s);
    }
  }

 private:
  struct Left {
    GuideSample sample;
    Spectrum throughput, earlier;
    float distance;

    /// X, as a mean over the wavelengths that the path still carried.
    float found(const Spectrum& all) const {
      float sum = 0;
      int carried = 0;
      for (int i = 0; i < spectrum_size; ++i)
        if (throughput[i] > 0) {
          sum += std::max(all[i] - earlier[i], 0.0f) / throughput[i];
          ++carried;
        }
      return carried > 0 ? sum / float(carried) : 0;
    }
  };

  Left left_[longest];
  int length_ = 0, begun_ = 0;
  bool waits_ = false;
};

class GuidedPathProcess final : public GuidedProcess<ShownProcess> {
 public:
  GuidedPathProcess(const GuidedPathTracer& r, const RenderContext& c)
      : GuidedProcess(r, c, guide_settings(r), r.memory, Trail::longest),
        settings_(r),
        lights_(*r.light_sampler, c.scene),
        clear_(!c.scene.has_interiors() && !c.scene.has_null_surfaces() && !c.scene.has_fluorescence()) {}

  void prepare_step(Schedule& schedule, const Step&) override { lights_.learn(schedule, *this); }
  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    Trail* const trail = trail_of(sample);  // allocated before the walk, which rewinds the arena to its own beginning
    return clear_ ? follow(CameraWalk<true>(context.scene, sample, ray, settings_.max_depth), trail)
                  : follow(CameraWalk<false>(context.scene, sample, ray, settings_.max_depth), trail);
  }

 private:
  static GuideSettings guide_settings(const GuidedPathTracer& r) {
    GuideSettings s;
    s.region_samples = r.region_samples;
    s.share = r.share;
    s.learn_share = r.learn_share;
    return s;
  }

  /// The trail of a path, in the sample's arena; null: the path is no training path.
  Trail* trail_of(const SampleContext& sample) const { return guide()->teaches(sample) ? sample.arena.make<Trail>() : nullptr; }

  /// Factor of the survival probability of Russian roulette.
  static constexpr float kept = 2;

  template <class Walk>
  [[gnu::always_inline]] Spectrum follow(Walk&& walk, Trail* trail) const {
    const LightSampler& lights = lights_;
    walk.reradiates = walk.reradiates_in_media = context.scene.has_fluorescence();
    const Roulette roulette{settings_.roulette_depth};
    float more = 1;  // the product of p / p_scatter; T times this is the throughput without a guide
    const auto met = [&](const SurfacePoint& luminaire) {
      return settings_.next_event ? walk.emitter_hit_weight(lights, settings_.heuristic, luminaire) : 1.0f;
    };
    const auto next_vertex = [&] {
      const bool goes_on = walk.next_vertex(met);
      if (trail) trail->arrived(walk.earlier, goes_on ? distance(walk.from, walk.vertex.point.position) : infinity);
      return goes_on;
    };
    while (next_vertex() && !walk.at_end()) {
      const NumberStream::Bounce u = walk.numbers.next_bounce();
      const GuidedScattering guided(guide()->guide(), walk.vertex, walk.vertex.out);
      if (settings_.next_event) walk.add_direct(lights, u, settings_.heuristic, guided);
      const GuidedScattering::Choice choice =
          guided.sample(u.lobe_choice, u.direction, [&](float lobe) { return walk.sample_direction(lobe, u.direction); });
      if (!choice.next) continue;
      const ScatterSample& next = *choice.next;
      if (trail) {
        GuideSample note;
        note.position = walk.vertex.point.position;
        note.direction = next.direction;
        note.region = guided.region();
        note.scatter = choice.scatter;
        note.specular = guided.alone(next);
        trail->left(note, walk.throughput);
      }
      more *= choice.more;
      if (walk.go_on(next) && !roulette.survives(walk, kept * walk.roulette_weight() * more)) walk.end();
    }
    if (trail) trail->record(walk.radiance, walk.sample);
    return walk.radiance;
  }

  const GuidedPathTracer& settings_;
  AdaptiveLights lights_;
  const bool clear_;
};

}  // namespace

std::unique_ptr<RenderProcess> GuidedPathTracer::begin(const RenderContext& context) const {
  return std::make_unique<GuidedPathProcess>(*this, context);
}

static const Register<GuidedPathTracer> registered;

}  // namespace etendue
