// UniformLightSampler: chooses all luminaires with equal probability.

#include "etendue/light_sampler.h"
#include "luminaire_power.h"

namespace etendue {
namespace {

class UniformLightSampler final : public LightSampler {
 public:
  static void describe(Description<UniformLightSampler>& d) { d.summary("Chooses every luminaire with the same probability."); }

  void build(const Scene& scene) override {
    luminaires_.assign(scene.luminaires().begin(), scene.luminaires().end());
    luminaire_powers(luminaires_);  // only checks: throws Error if a power is negative or not finite
  }

  LightChoice choose(const Point3&, const Normal3&, float u) const override { return choose(u); }
  float probability(const Point3&, const Normal3&, const SceneObject& luminaire) const override {
    return probability(luminaire);
  }
  LightChoice choose(float u) const override {
    if (luminaires_.empty()) return {};
    const size_t count = luminaires_.size();
    return {luminaires_[std::min(size_t(double(u) * double(count)), count - 1)], 1 / float(count)};
  }
  float probability(const SceneObject& luminaire) const override {
    const size_t index = size_t(luminaire.luminaire_index());
    return index < luminaires_.size() && luminaires_[index] == &luminaire ? 1 / float(luminaires_.size()) : 0;
  }

 private:
  std::vector<const SceneObject*> luminaires_;
};

const Register<UniformLightSampler> registered;

}  // namespace
}  // namespace etendue
