#pragma once
// The power of luminaires, and a table for choosing luminaires in proportion to their power.

#include <unordered_map>

#include "etendue/light_sampler.h"

namespace etendue {

/// Power [W] over the visible range: the mean over 64 wavelengths at equal steps, times the range.
inline double luminaire_power(const SceneObject& luminaire) {
  constexpr int sets = 16;
  constexpr float range = wavelength_high - wavelength_low, step = range / (sets * spectrum_size);
  double sum = 0;
  for (int set = 0; set < sets; ++set) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, wavelength_low + (float(i * sets + set) + 0.5f) * step, 1 / range);
    sum += double(luminaire.emission->power(luminaire, w).average());
  }
  const double watts = sum / sets * double(range);
  if (!(watts >= 0 && std::isfinite(watts)))
    luminaire.emission->fail({}, "the power of the luminaire is not a finite number: " + fmt::format("{} W", watts));
  return watts;
}

/// Powers of luminaires that may have many placements, without an integration of maps for each placement. The power of an
/// emission is the same for all sizes if an amount is requested, and proportional to the area if a radiance is given. Two
/// placements of different area give the exponent k in P ~ A^k, which is used for the other placements. Only for choosing
/// among luminaires, as a transform that is not a similarity may change more than the area.
class PlacedPowers {
 public:
  double of(const SceneObject& luminaire) {
    if (&luminaire.original() == &luminaire) return luminaire_power(luminaire);
    Known& k = known_[&luminaire.original()];
    const double area = double(luminaire.area());
    const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-4 * b; };
    if (k.count > 0 && same(area, k.area)) return k.watts;
    if (k.count == 2) return k.watts * std::pow(area / k.area, k.exponent);
    const double watts = luminaire_power(luminaire);
    if (!(area > 0 && watts > 0)) return watts;
    if (k.count++ == 0) {
      k.area = area;
      k.watts = watts;
    } else {
      k.exponent = std::clamp(std::log(watts / k.watts) / std::log(area / k.area), 0.0, 1.0);
    }
    return watts;
  }

 private:
  struct Known {
    int count = 0;
    double area = 0, watts = 0, exponent = 0;
  };
  std::unordered_map<const SceneObject*, Known> known_;
};

/// The powers of a scene's luminaires. A power may be an estimate (for a map, from samples) that misses small emitting parts.
/// As no luminaire that emits may have probability 0, a thousandth of the mean is added to each; if all powers are 0 all
/// results are equal.
inline std::vector<double> luminaire_powers(std::span<const SceneObject* const> luminaires) {
  std::vector<double> powers;
  double total = 0;
  PlacedPowers known;
  for (const SceneObject* luminaire : luminaires) total += powers.emplace_back(known.of(*luminaire));
  const double least = total > 0 ? 1e-3 * total / double(powers.size()) : 1;
  for (double& p : powers) p += least;
  return powers;
}

/// Chooses luminaires in proportion to their powers. Random numbers have 24 bits, so probabilities are multiples of 2^-24, at
/// least 2^-24 for each luminaire: the probabilities that are returned are then exact.
class PowerTable {
 public:
  void build(std::span<const SceneObject* const> luminaires, std::span<const double> powers) {
    luminaires_.assign(luminaires.begin(), luminaires.end());
    double total = 0, sum = 0;
    for (const double p : powers) total += p;
    cumulative_.clear();
    probabilities_.clear();
    constexpr double steps = 1 << 24;
    const double n = double(powers.size()), spare = std::max(steps - n, 0.0);
    double before = 0;
    for (size_t i = 0; i < powers.size(); ++i) {
      sum += powers[i];
      const double edge = i + 1 == powers.size() ? 1 : std::min((double(i + 1) + std::floor(spare * sum / total)) / steps, 1.0);
      probabilities_.push_back(float(edge - before));
      cumulative_.push_back(float(edge));
      before = edge;
    }
  }
  std::span<const SceneObject* const> luminaires() const { return luminaires_; }
  LightChoice choose(float u) const {
    if (luminaires_.empty()) return {};
    const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), u);
    const size_t i = std::min(size_t(found - cumulative_.begin()), luminaires_.size() - 1);
    return {luminaires_[i], probabilities_[i]};
  }
  float probability(const SceneObject& luminaire) const {
    const size_t index = size_t(luminaire.luminaire_index());
    return index < luminaires_.size() && luminaires_[index] == &luminaire ? probabilities_[index] : 0;
  }

 private:
  std::vector<const SceneObject*> luminaires_;
  std::vector<float> probabilities_, cumulative_;
};

}  // namespace etendue
