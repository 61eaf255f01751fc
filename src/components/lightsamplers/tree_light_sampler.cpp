// TreeLightSampler: chooses luminaires by a bound of their contribution at a point, for scenes with many luminaires.

#include "etendue/light_sampler.h"
#include "geometry/light_tree.h"
#include "luminaire_power.h"

namespace etendue {
namespace {

// Luminaires with bounds are in the tree. Luminaires at infinity (and those without bounds) are independent of the point: with
// probability q = n / (n + 1) for n of them (1 if the tree is empty) one of them is chosen, in proportion to its power. So
// neither a sky nor lamps are undersampled.
class TreeLightSampler final : public LightSampler {
 public:
  static void describe(Description<TreeLightSampler>& d) {
    d.summary(
        "Chooses luminaires by a bound of the light they send to the point, from a tree over their places, directions and "
        "powers.",
        "Conty Estevez & Kulla 2018, Importance sampling of many lights with adaptive tree splitting");
  }

  void build(const Scene& scene) override {
    const auto all = scene.luminaires();
    only_ = all.size() == 1 ? all.front() : nullptr;
    const std::vector<double> powers = luminaire_powers(all);
    by_power_.build(all, powers);
    std::vector<LightBounds> placed;
    std::vector<const SceneObject*> everywhere;
    std::vector<double> everywhere_powers;
    luminaires_.clear();
    places_.assign(all.size(), nowhere);
    for (size_t i = 0; i < all.size(); ++i) {
      LightBounds light;
      const LuminaireBounds bounds = all[i]->luminaire_bounds();
      if (!all[i]->infinite()) light.bounds = bounds.box;
      if (light.bounds.empty()) {
        everywhere.push_back(all[i]);
        everywhere_powers.push_back(powers[i]);
        continue;
      }
      const Sides sides = all[i]->emission->sides;
      light.normals = bounds.normals;
      if (sides == Sides::back) light.normals.axis = -light.normals.axis;
      light.both_sides = sides == Sides::both;
      light.power = float(powers[i]);
      places_[i] = std::uint32_t(placed.size());
      placed.push_back(light);
      luminaires_.push_back(all[i]);
    }
    tree_.build(placed);
    double total = 0;
    for (const double p : everywhere_powers) total += p;
    everywhere_ = std::move(everywhere);
    shares_.clear();
    for (const double p : everywhere_powers) shares_.push_back(float(p / total));
    const float n = float(everywhere_.size());
    outside_ = everywhere_.empty() ? 0 : tree_.empty() ? 1 : n / (n + 1);
  }

  LightChoice choose(const Point3& point, const Normal3& normal, float number) const override {
    if (only_) return {only_, 1};
    if (number < outside_) {
      float rest = number / outside_;
      size_t i = 0;
      for (; i + 1 < everywhere_.size() && rest >= shares_[i]; ++i) rest -= shares_[i];
      return {everywhere_[i], outside_ * shares_[i]};
    }
    if (tree_.empty()) return {};
    // The 24 bits of a float are too few for a deep tree; the bits below are filled with a hash of the point and the number.
    const std::uint64_t bits = (std::uint64_t(std::bit_cast<std::uint32_t>(point.x)) << 32) ^
                               std::bit_cast<std::uint32_t>(point.y) ^
                               (std::uint64_t(std::bit_cast<std::uint32_t>(number)) << 16);
    const double fine = double(number) + double(mix_bits(bits) >> 11) * 0x1p-77;
    double u = std::min((fine - double(outside_)) / (1 - double(outside_)), 1 - 0x1p-53);
    const LightTree::Choice choice = tree_.sample(point, normal, u);
    if (!(choice.probability > 0)) return {};
    return {luminaires_[choice.emitter], (1 - outside_) * choice.probability};
  }
  float probability(const Point3& point, const Normal3& normal, const SceneObject& luminaire) const override {
    if (only_) return &luminaire == only_ ? 1 : 0;
    const size_t index = size_t(luminaire.luminaire_index());
    if (index >= places_.size() || by_power_.luminaires()[index] != &luminaire) return 0;
    if (places_[index] != nowhere) return (1 - outside_) * tree_.probability(point, normal, places_[index]);
    for (size_t i = 0; i < everywhere_.size(); ++i)
      if (everywhere_[i] == &luminaire) return outside_ * shares_[i];
    return 0;
  }
  LightChoice choose(float u) const override { return by_power_.choose(u); }
  float probability(const SceneObject& luminaire) const override { return by_power_.probability(luminaire); }

 private:
  static constexpr std::uint32_t nowhere = ~0u;

  const SceneObject* only_ = nullptr;  ///< the luminaire in a scene with one luminaire, which needs no tree; else null
  PowerTable by_power_;
  LightTree tree_;
  std::vector<const SceneObject*> luminaires_, everywhere_;
  std::vector<float> shares_;
  std::vector<std::uint32_t> places_;  ///< index in the tree, by luminaire_index; `nowhere`: not in the tree
  float outside_ = 0;
};

const Register<TreeLightSampler> registered;

}  // namespace
}  // namespace etendue
