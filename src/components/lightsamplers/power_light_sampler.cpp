// PowerLightSampler: chooses luminaires in proportion to the power they emit.

#include "etendue/light_sampler.h"
#include "luminaire_power.h"

namespace etendue {
namespace {

class PowerLightSampler final : public LightSampler {
 public:
  static void describe(Description<PowerLightSampler>& d) {
    d.summary("Chooses luminaires in proportion to the power they emit, mixed with choosing all alike.",
              "Shirley, Wang & Zimmerman 1996, Monte Carlo techniques for direct lighting calculations")
        .member<&PowerLightSampler::uniform>(
            "uniform", "1",
            "share of choices made without regard to power, so that a lamp nearby is not starved by "
            "a sky that is far stronger in all",
            range(0, 1));
  }

  void build(const Scene& scene) override {
    table_.build(scene.luminaires(), luminaire_powers(scene.luminaires()));
    only_ = choose(0);
  }

  // P = uniform / n + (1 - uniform) P_power.
  LightChoice choose(const Point3&, const Normal3&, float u) const override {
    if (count() < 2) return only_;
    const SceneObject* luminaire = nullptr;
    if (u < uniform) {
      const size_t i = size_t(u / uniform * float(count()));
      luminaire = table_.luminaires()[std::min(i, count() - 1)];
    } else {
      luminaire = choose(std::min((u - uniform) / (1 - uniform), one_minus_epsilon)).luminaire;
    }
    return {luminaire, mixed(probability(*luminaire))};
  }
  float probability(const Point3&, const Normal3&, const SceneObject& luminaire) const override {
    const float by_power = probability(luminaire);
    return by_power > 0 && count() > 1 ? mixed(by_power) : by_power;
  }
  LightChoice choose(float u) const override { return table_.choose(u); }
  float probability(const SceneObject& luminaire) const override { return table_.probability(luminaire); }

  float uniform = 0.5f;

 private:
  size_t count() const { return table_.luminaires().size(); }
  float mixed(float by_power) const { return uniform / float(count()) + (1 - uniform) * by_power; }

  PowerTable table_;
  LightChoice only_;  // the choice in a scene with one luminaire
};

const Register<PowerLightSampler> registered;

}  // namespace
}  // namespace etendue
