// SheenLobe: values, and the table of its albedo.

#include "sheen.h"

#include <memory>

namespace etendue {

// E by roughness, at equal steps, and by the cosine, at equal steps of its root, because E falls steeply towards grazing
// angles. Computed by the midpoint rule over cosines, denser towards 0, and azimuths; within 2e-3 of E.
class SheenTable {
 public:
  static constexpr int rows = 16, columns = 24;

  SheenTable() {
    constexpr int cosines = 32, azimuths = 20;
    for (int i = 0; i < rows; ++i) {
      const SheenLobe lobe(roughness_at(i));
      for (int k = 0; k < columns; ++k) {
        const float c = cosine_at(k);
        const Vector3 out{safe_sqrt(1 - c * c), 0, c};
        double sum = 0;
        for (int a = 0; a < cosines; ++a) {
          const float x = (float(a) + 0.5f) / cosines, mu = x * x, sine = safe_sqrt(1 - mu * mu);
          for (int b = 0; b < azimuths; ++b) {
            const float t = (float(b) + 0.5f) / azimuths, azimuth = pi * t * t * (2 - t);  // denser around 0
            const float weight = 2 * x * pi * t * (4 - 3 * t);
            sum += double(lobe.value(out, {sine * std::cos(azimuth), sine * std::sin(azimuth), mu}) * mu * weight);
          }
        }
        albedo_[i][k] = std::min(float(2 * sum / (cosines * azimuths)), 1.0f);
      }
      double mean = 0;
      constexpr int steps = 64;
      for (int k = 0; k < steps; ++k) {
        const float c = std::sqrt((float(k) + 0.5f) / steps);
        mean += double(albedo(float(i), c)) / steps;
      }
      mean_[i] = float(mean);
    }
  }

  float albedo(float row, float cosine) const {
    const float x = std::sqrt(cosine) * (columns - 1);
    const int i = std::min(int(row), rows - 2), k = std::min(int(x), columns - 2);
    const float s = row - float(i), t = x - float(k);
    return lerp(s, lerp(t, albedo_[i][k], albedo_[i][k + 1]), lerp(t, albedo_[i + 1][k], albedo_[i + 1][k + 1]));
  }
  float mean(float row) const {
    const int i = std::min(int(row), rows - 2);
    return lerp(row - float(i), mean_[i], mean_[i + 1]);
  }

  static float row_of(float roughness) { return (roughness - SheenLobe::sharpest) / (1 - SheenLobe::sharpest) * (rows - 1); }

 private:
  static float roughness_at(int row) { return lerp(float(row) / (rows - 1), SheenLobe::sharpest, 1); }
  static float cosine_at(int column) { return std::max(square(float(column) / (columns - 1)), 1e-4f); }

  float albedo_[rows][columns] = {}, mean_[rows] = {};
};

namespace {

const SheenTable& table() {
  static const auto made = std::make_unique<const SheenTable>();
  return *made;
}

}  // namespace

// The masking's coefficients are fitted at roughness 0 and 1 (Estevez & Kulla 2017), and mixed by (1 - a)^2.
SheenLobe::SheenLobe(float roughness) {
  constexpr float smooth[] = {25.3245f, 3.32435f, 0.16801f, -1.27393f, -4.85967f};
  constexpr float rough[] = {21.5473f, 3.82987f, 0.19823f, -1.97760f, -4.32054f};
  const float a = roughness > sharpest ? std::min(roughness, 1.0f) : sharpest, mix = square(1 - a);
  inverse_roughness_ = 1 / a;
  for (int i = 0; i < 5; ++i) fit_[i] = lerp(mix, rough[i], smooth[i]);
  row_ = SheenTable::row_of(a);
}

float SheenLobe::value(const Vector3& out, const Vector3& in) const {
  const Vector3 h = out + in;
  const float squared = length_squared(h), sine2 = (h.x * h.x + h.y * h.y) / std::max(squared, 1e-12f);
  const float d = (2 + inverse_roughness_) * std::pow(std::min(sine2, 1.0f), 0.5f * inverse_roughness_) / (2 * pi);
  const float mu_out = std::abs(out.z), mu_in = std::abs(in.z);
  return d / (4 * std::max(mu_out * mu_in, 1e-12f) * (1 + masked(mu_out) + masked(mu_in)));
}

/// lambda, the area of masked fibres over that of visible ones.
float SheenLobe::masked(float cosine) const {
  const auto exponent = [this](float x) { return fit_[0] / (1 + fit_[1] * std::pow(x, fit_[2])) + fit_[3] * x + fit_[4]; };
  return std::exp(cosine < 0.5f ? exponent(cosine) : 2 * exponent(0.5f) - exponent(std::max(1 - cosine, 0.0f)));
}

float SheenLobe::albedo(const Vector3& v) const { return table().albedo(row_, std::min(std::abs(v.z), 1.0f)); }

float SheenLobe::mean_albedo() const { return table().mean(row_); }

}  // namespace etendue
