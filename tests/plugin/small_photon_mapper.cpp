// A photon mapper, in one file, out of tree.
//
// Light subpaths store a photon with the flux phi [W/nm] at each surface with smooth (non-delta) lobes. At the first such
// surface of a camera subpath, the photons within a radius r estimate the reflected radiance
//     L = 1 / (N pi r^2)  sum f phi          (Jensen 1996, "Global illumination using photon maps").
// Each step has N new photons and a smaller radius, r_{i+1}^2 = r_i^2 (i + alpha) / (i + 1), so the mean over steps converges
// to the true value (Knaus & Zwicker 2011, "Progressive photon mapping: a probabilistic approach"). All paths of a step share
// the same wavelengths, so that photons and camera subpaths have spectra at the same wavelengths.
#include <unordered_map>

#include "etendue/render/renderer.h"
#include "etendue/render/shrinking_bias.h"
#include "etendue/transport/renderer_members.h"
#include "etendue/transport/subpath.h"
#include "etendue/transport/walk.h"

using namespace etendue;

class SmallPhotonMapper final : public Renderer, public ShrinkingBias {
 public:
  int photons = 20000, max_depth = 16;
  float radius = 0.02f, alpha = 0.7f;

  static void describe(Description<SmallPhotonMapper>& d) {
    d.summary("Progressive photon mapping.", "Knaus & Zwicker 2011")
        .member<&SmallPhotonMapper::photons>("photons", "1", "photon walks of each step", range(1, 1e8))
        .member<&SmallPhotonMapper::radius>("radius", "1", "of the first step, over that of the scene", range(1e-6, 1))
        .member<&SmallPhotonMapper::alpha>("alpha", "1", "how slowly the radius shrinks", range(0.01, 1));
    describe_max_depth<&SmallPhotonMapper::max_depth>(d);
  }
  PathClasses finds() const override {
    return all_paths & ~(scattering_media | emitting_media | heterogeneous_media | subsurface_light | light_through_surfaces |
                         fluorescence);
  }
  Expectation expectation() const override { return Expectation::consistent; }
  std::uint32_t samples_per_step(std::uint32_t) const override { return 1; }
  Estimator estimator() const override { return Estimator::correlated; }
  /// r_i / r_1, from r_{i+1}^2 = r_i^2 (i + alpha) / (i + 1).
  double bias_width(std::uint32_t step) const override {
    double area = 1;
    for (std::uint32_t i = 1; i <= step; ++i) area *= (i - 1 + double(alpha)) / i;
    return std::sqrt(area);
  }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class PhotonProcess final : public RenderProcess {
  struct Photon {
    Point3 position;
    Vector3 direction;  ///< to the previous vertex of the light subpath
    Spectrum flux;
    int length = 0;
    bool hero_only = false;
  };
  const SmallPhotonMapper& settings_;
  std::vector<Photon> photons_;
  std::unordered_multimap<std::uint64_t, const Photon*> cells_;
  Wavelengths wavelengths_;
  float radius_ = 0;

  std::uint64_t cell(const Point3& p, int dx, int dy, int dz) const {
    const auto at = [&](float x, int d) { return std::uint64_t(std::int64_t(std::floor(x / radius_)) + d); };
    return mix_bits(at(p.x, dx) + 0x9e3779b97f4a7c15ull * mix_bits(at(p.y, dy) + 0x9e3779b97f4a7c15ull * at(p.z, dz)));
  }

 public:
  PhotonProcess(const SmallPhotonMapper& r, const RenderContext& c) : RenderProcess(r, c), settings_(r) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    radius_ = settings_.radius * context.scene.radius() * float(settings_.bias_width(step.number));
    const SampleKey key(context.seed, -1, -1, step.number);
    wavelengths_ = context.wavelengths.sample(key, NumberStream(*settings_.sampler, key).next());

    const auto item_size = 1000u, items = (unsigned(settings_.photons) + item_size - 1) / item_size;
    photons_ = schedule.collect<Photon>(items, [&](std::uint64_t item, std::vector<Photon>& out, Arena& arena) {
      std::vector<SubpathVertex> walk;
      const auto first = unsigned(item) * item_size, last = std::min(first + item_size, unsigned(settings_.photons));
      for (unsigned n = first; n < last; ++n) {
        const ArenaScope memory(arena);
        Wavelengths w = wavelengths_;
        SampleContext sample{w, {*settings_.sampler, SampleKey(context.seed, -2, int(step.number), n)}, arena};
        EmittedLight light;
        generate_light_subpath(context.scene, *settings_.light_sampler, context.camera.shutter_open,
                               {settings_.max_depth - 1, 5}, sample, walk, light);
        for (size_t i = 1; i < walk.size(); ++i)
          if (walk[i].scatters_smoothly())
            out.push_back({walk[i].point.position, walk[i].out, walk[i].throughput / float(settings_.photons), int(i) + 1,
                           walk[i].hero_only});
      }
    });
    cells_.clear();
    for (const Photon& p : photons_) cells_.emplace(cell(p.position, 0, 0, 0), &p);
  }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    sample.wavelengths = wavelengths_;
    Spectrum light;
    const auto add = [&](int length, const Spectrum& value) {
      light += value;
      sample.sink.light(length, value);
    };
    Walk<true> walk(context.scene, sample, ray, settings_.max_depth);
    while (walk.next_vertex()) {
      const PathVertex& v = walk.vertex;
      if (v.kind == PathVertex::Kind::escape) {
        for (const SceneObject* far : context.scene.infinite_luminaires(walk.ray)) {
          SurfacePoint p;
          far->surface_point(walk.ray, walk.hit, p);
          add(walk.length, walk.throughput * far->emission->radiance(p, v.out, sample.wavelengths));
        }
        break;
      }
      if (v.point.object->luminaire())
        add(walk.length, walk.throughput * v.point.object->emission->radiance(v.point, v.out, sample.wavelengths));
      if (v.scatters_smoothly()) gather(walk, add);
      const NumberStream::Bounce u = walk.numbers.next_bounce();
      const auto next =
          v.scatter ? v.scatter->sample(v.out, u.lobe_choice, u.direction, {.lobes = specular_lobes}) : std::nullopt;
      if (!next) break;
      walk.leave(*next);
    }
    return light;
  }

 private:
  template <class Add>
  void gather(const Walk<true>& walk, const Add& add) const {
    const PathVertex& v = walk.vertex;
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const auto [begin, end] = cells_.equal_range(cell(v.point.position, dx, dy, dz));
          for (auto each = begin; each != end; ++each) {
            const Photon& p = *each->second;
            const int length = walk.length + p.length - 1;
            const float cosine = std::abs(dot(v.point.normal, p.direction));
            if (length > settings_.max_depth || !(cosine > 0) ||
                length_squared(p.position - v.point.position) > square(radius_))
              continue;
            Spectrum f = v.scatter->evaluate(v.out, p.direction) / cosine;  // the photon density contains the cosine
            if (p.hero_only)  // it carries the hero alone, times the number of wavelengths: a factor that may count only once
              for (int i = 1; i < spectrum_size; ++i) f.set(i, 0);
            if (p.hero_only && walk.sample.wavelengths.single()) f /= float(spectrum_size);
            add(length, walk.throughput * f * p.flux / (pi * square(radius_)));
          }
        }
  }
};

std::unique_ptr<RenderProcess> SmallPhotonMapper::begin(const RenderContext& context) const {
  return std::make_unique<PhotonProcess>(*this, context);
}

static const Register<SmallPhotonMapper> registered;
