// PowerLightSampler: luminaires by the power they emit.

#include "etendue/light_sampler.h"

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
    luminaires_.assign(scene.luminaires().begin(), scene.luminaires().end());
    std::vector<double> powers;
    double total = 0;
    for (const SceneObject* luminaire : luminaires_) {
      powers.push_back(power(*luminaire));
      total += powers.back();
    }
    // A power may be an estimate (of a map, by samples) that misses what little there is: nothing that emits may have
    // probability 0, so each gets at least a thousandth of the mean. Without any power, all are alike.
    const double count = double(powers.size());
    const double least = total > 0 ? 1e-3 * total / count : 1;
    total += least * count;
    cumulative_.clear();
    probabilities_.clear();
    double sum = 0;
    for (const double p : powers) {
      sum += p + least;
      probabilities_.push_back(float((p + least) / total));
      cumulative_.push_back(float(sum / total));
    }
  }

  // P = uniform / n + (1 - uniform) P_power.
  LightChoice choose(const Point3&, const Normal3&, float u) const override {
    if (luminaires_.size() < 2) return choose(u);
    const SceneObject* luminaire = nullptr;
    if (u < uniform) {
      const size_t i = size_t(u / uniform * float(luminaires_.size()));
      luminaire = luminaires_[std::min(i, luminaires_.size() - 1)];
    } else {
      luminaire = choose(std::min((u - uniform) / (1 - uniform), one_minus_epsilon)).luminaire;
    }
    return {luminaire, mixed(probability(*luminaire))};
  }
  float probability(const Point3&, const Normal3&, const SceneObject& luminaire) const override {
    const float by_power = probability(luminaire);
    return by_power > 0 && luminaires_.size() > 1 ? mixed(by_power) : by_power;
  }
  LightChoice choose(float u) const override {
    if (luminaires_.empty()) return {};
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u);
    const size_t i = std::min(size_t(found - cumulative_.begin()), luminaires_.size() - 1);
    return {luminaires_[i], probabilities_[i]};
  }
  float probability(const SceneObject& luminaire) const override {
    const size_t index = size_t(luminaire.luminaire_index);
    return index < luminaires_.size() && luminaires_[index] == &luminaire ? probabilities_[index] : 0;
  }

  float uniform = 0.5f;

 private:
  float mixed(float by_power) const { return uniform / float(luminaires_.size()) + (1 - uniform) * by_power; }

  /// Power [W] over the visible range: the mean over 64 wavelengths at equal steps, times the range.
  static double power(const SceneObject& luminaire) {
    constexpr int sets = 16;
    constexpr float range = wavelength_high - wavelength_low, step = range / (sets * spectrum_size);
    double sum = 0;
    for (int set = 0; set < sets; ++set) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, wavelength_low + (float(i * sets + set) + 0.5f) * step, 1 / range);
      sum += double(luminaire.emission->power(luminaire, w).average());
    }
    double watts = sum / sets * double(range);
    if (!(watts >= 0 && std::isfinite(watts)))
      luminaire.emission->fail({}, "the power of the luminaire is not a finite number: " + std::to_string(watts) + " W");
    return watts;
  }

  std::vector<const SceneObject*> luminaires_;
  std::vector<float> probabilities_, cumulative_;
};

const Register<PowerLightSampler> registered;

}  // namespace
}  // namespace etendue
