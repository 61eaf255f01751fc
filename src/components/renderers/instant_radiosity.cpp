// Instant radiosity (Keller 1997, "Instant radiosity"; Kollig & Keller 2004, "Illumination in the presence of weak
// singularities").
//
// Each step has n light subpaths. All their vertices y with smooth lobes are virtual lights, which light the first non-specular
// vertex z of each camera subpath:
//     L(z) = (direct light) + 1/n sum_y w f_z G V f_y alpha_y + (1 - w) (the continued camera subpath at its next vertex)
// (render/virtual_lights.h defines w). Neighbouring pixels are lit by the same virtual lights: the image has little noise but
// many faint shadow edges, which fade as steps with other virtual lights are added.

#include "etendue/render/virtual_lights.h"

namespace etendue {

class InstantRadiosity final : public Renderer {
 public:
  int max_depth = VirtualLightSettings().max_depth, roulette_depth = VirtualLightSettings().roulette_depth;
  Heuristic heuristic = VirtualLightSettings().heuristic;
  int walks = 16;
  float nearest = 30;
  bool compensate = VirtualLightSettings().compensate;

  static void describe(Description<InstantRadiosity>& d) {
    d.summary("Walks from luminaires leave virtual lights that light all pixels of a step.",
              "Keller 1997; Kollig & Keller 2004");
    describe_virtual_lights<&InstantRadiosity::max_depth, &InstantRadiosity::roulette_depth, &InstantRadiosity::heuristic,
                            &InstantRadiosity::nearest, &InstantRadiosity::compensate>(d);
    d.member<&InstantRadiosity::walks>("walks", "1", "from luminaires in each step: every vertex lights every pixel",
                                       range(1, 100000), soft(1, 64), logarithmic);
  }

  PathClasses finds() const override { return compensate ? compensated_virtual_lights_find : bounded_virtual_lights_find; }
  Expectation expectation() const override { return compensate ? Expectation::unbiased : Expectation::biased; }
  Estimator estimator() const override { return Estimator::correlated; }
  std::uint32_t samples_per_step(std::uint32_t) const override { return 1; }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class InstantRadiosityProcess final : public VirtualLightProcess {
 public:
  InstantRadiosityProcess(const InstantRadiosity& r, const RenderContext& c)
      : VirtualLightProcess(r, c, {r.max_depth, r.roulette_depth, r.heuristic, r.compensate}, r.nearest),
        walks_(std::uint64_t(r.walks)) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    share(step);
    virtual_ = make_lights(schedule, step, walks_);
  }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    return follow(ray, sample, [&](auto& walk) {
      NumberStream numbers = walk.numbers.fork("virtual lights", std::uint32_t(walk.length));
      for (const VirtualLight& y : virtual_.lights) {
        if (y.vertices + walk.length > settings().max_depth) continue;
        if (sample.aborted()) return;
        add_light(y, walk, numbers, float(virtual_.walks));
      }
    });
  }

 private:
  const std::uint64_t walks_;
  VirtualLights virtual_;
};

std::unique_ptr<RenderProcess> InstantRadiosity::begin(const RenderContext& context) const {
  return std::make_unique<InstantRadiosityProcess>(*this, context);
}

static const Register<InstantRadiosity> registered;

}  // namespace etendue
