// Many lights: so many virtual lights that each shading point samples only a few of them (Walter et al. 2005, "Lightcuts: a
// scalable approach to illumination"; Yuksel 2019, "Stochastic lightcuts").
//
// As in instant radiosity (instant_radiosity.cpp) each step has n light subpaths, whose vertices light the first non-specular
// vertex z of each camera subpath; but there are thousands of virtual lights, in a tree (virtual_light_tree.h). A cut through
// the tree, chosen for z, divides them into groups. One light y of each group, sampled with the probability P(y), represents
// the group:
//     L(z) = (direct light) + 1/n sum_{groups} w f_z G V f_y alpha_y / P(y)
//            + (1 - w) (the continued camera subpath at its next vertex).
// The original lightcuts use one fixed representative light per group, with a bounded error. Here the representative is
// sampled, so the mean is right, and the differences within a group are noise instead of a bias.

#include "virtual_light_tree.h"

namespace etendue {

class ManyLights final : public Renderer {
 public:
  int max_depth = VirtualLightSettings().max_depth, roulette_depth = VirtualLightSettings().roulette_depth;
  Heuristic heuristic = VirtualLightSettings().heuristic;
  int walks = 10000, cut = 8, samples_per_tree = 4;
  float nearest = 30;
  bool compensate = VirtualLightSettings().compensate;

  static void describe(Description<ManyLights>& d) {
    d.summary("Thousands of virtual lights in a tree, of which each place takes a few, chosen by how much they may bring.",
              "Walter et al. 2005; Conty Estevez & Kulla 2018; Yuksel 2019");
    describe_virtual_lights<&ManyLights::max_depth, &ManyLights::roulette_depth, &ManyLights::heuristic, &ManyLights::nearest,
                            &ManyLights::compensate>(d);
    d.member<&ManyLights::walks>("walks", "1", "from luminaires in each step: every vertex is a light, which takes about 1 kB",
                                 range(1, 1e6), soft(10, 2000), logarithmic)
        .member<&ManyLights::cut>("cut", "1", "groups of lights at each place, of which one light each is taken",
                                  range(1, 4096), soft(1, 64), logarithmic)
        .member<&ManyLights::samples_per_tree>("samples_per_tree", "1",
                                               "samples of each pixel in a step, after which there are other lights",
                                               range(1, 65536), soft(1, 16), logarithmic);
  }

  PathClasses finds() const override { return compensate ? compensated_virtual_lights_find : bounded_virtual_lights_find; }
  Expectation expectation() const override { return compensate ? Expectation::unbiased : Expectation::biased; }
  Estimator estimator() const override { return Estimator::correlated; }
  std::uint32_t samples_per_step(std::uint32_t) const override { return std::uint32_t(samples_per_tree); }

 private:
  std::unique_ptr<RenderProcess> begin(const RenderContext&) const override;
};

class ManyLightsProcess final : public VirtualLightProcess {
 public:
  ManyLightsProcess(const ManyLights& r, const RenderContext& c)
      : VirtualLightProcess(r, c, {r.max_depth, r.roulette_depth, r.heuristic, r.compensate}, r.nearest),
        walks_(std::uint64_t(r.walks)),
        cut_(size_t(r.cut)) {}

  void prepare_step(Schedule& schedule, const Step& step) override {
    share(step);
    virtual_ = {};
    virtual_ = make_lights(schedule, step, walks_);
    tree_.build(virtual_.lights);
  }

  Spectrum radiance(const Ray& ray, SampleContext& sample) const override {
    static thread_local std::vector<VirtualLightTree::Sample> taken;
    return follow(ray, sample, [&](auto& walk) {
      NumberStream numbers = walk.numbers.fork("virtual lights", std::uint32_t(walk.length));
      tree_.cut(VirtualLightTree::place(walk.vertex, 1 / std::sqrt(settings().bound)), cut_, numbers, taken);
      for (const auto& [light, probability] : taken) {
        const VirtualLight& y = virtual_.lights[light];
        if (y.vertices + walk.length > settings().max_depth) continue;
        add_light(y, walk, numbers, float(virtual_.walks * probability));
      }
    });
  }

 private:
  const std::uint64_t walks_;
  const size_t cut_;
  VirtualLights virtual_;
  VirtualLightTree tree_;
};

std::unique_ptr<RenderProcess> ManyLights::begin(const RenderContext& context) const {
  return std::make_unique<ManyLightsProcess>(*this, context);
}

static const Register<ManyLights> registered;

}  // namespace etendue
