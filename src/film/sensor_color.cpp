// From a sensor's channels to colours: white balance, and matrices fitted to smooth reflectances.

#include <algorithm>
#include <cmath>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "sensor.h"
#include "sensor_integrals.h"

namespace etendue {
namespace {

/// Solves A x = b for a symmetric positive definite A, by elimination.
std::array<double, 3> solve(SensorMatrix a, std::array<double, 3> b) {
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = i + 1; j < 3; ++j) {
      const double f = a[j][i] / a[i][i];
      for (size_t k = i; k < 3; ++k) a[j][k] -= f * a[i][k];
      b[j] -= f * b[i];
    }
  for (size_t i = 3; i-- > 0;) {
    for (size_t k = i + 1; k < 3; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  return b;
}

}  // namespace

// Over reflectances r of a grid of RGB colours (Jakob & Hanika 2019): M = argmin sum_r |M c_r - x_r|^2 with the balanced
// channels c_r and the colours x_r, by the normal equations. That of a perfect white counts so much that it is exact.
SensorMatrix sensor_matrix(const Sensor& sensor, const SpectralFunction& light, const SpectralFunction& seen_in) {
  constexpr int first = 360, count = 471;
  std::vector<std::array<double, 3>> channels(count), colors(count);
  std::array<double, 3> neutral{};
  double luminous = 0;
  for (int i = 0; i < count; ++i) {
    const double l = first + i, lit = value_at(light, l, ColorUse::radiance), seen = value_at(seen_in, l, ColorUse::radiance);
    const Xyz eye = observer(float(l));
    colors[size_t(i)] = {seen * eye.x, seen * eye.y, seen * eye.z};
    luminous += seen * eye.y;
    for (size_t c = 0; c < 3; ++c) neutral[c] += channels[size_t(i)][c] = lit * sensitivity(sensor, c, l);
  }
  for (const double n : neutral)
    if (!(n > 0)) throw Error("the white has no light where a channel is sensitive");

  SensorMatrix squares{}, products{};
  const auto add = [&](const SpectralFunction& reflectance, double weight) {
    std::array<double, 3> raw{}, xyz{};
    for (int i = 0; i < count; ++i) {
      const double r = value_at(reflectance, first + i, ColorUse::reflectance);
      for (size_t c = 0; c < 3; ++c) {
        raw[c] += r * channels[size_t(i)][c] / neutral[c];
        xyz[c] += r * colors[size_t(i)][c] / luminous;
      }
    }
    for (size_t i = 0; i < 3; ++i)
      for (size_t j = 0; j < 3; ++j) {
        squares[i][j] += weight * raw[i] * raw[j];
        products[i][j] += weight * xyz[i] * raw[j];
      }
  };
  for (const double r : {0.1, 0.35, 0.6, 0.85})
    for (const double g : {0.1, 0.35, 0.6, 0.85})
      for (const double b : {0.1, 0.35, 0.6, 0.85}) add(*rgb_color("srgb", r, g, b), 1);
  add(*flat_spectrum(1), 1e6);
  SensorMatrix matrix;
  for (size_t i = 0; i < 3; ++i) matrix[i] = solve(squares, products[i]);
  return matrix;
}

std::array<double, 3> sensor_neutral(const Sensor& sensor, const SpectralFunction& light) {
  std::array<double, 3> neutral{};
  for (size_t c = 0; c < 3; ++c)
    neutral[c] = whole_integral([&](double l) { return value_at(light, l, ColorUse::radiance) * sensitivity(sensor, c, l); });
  const double strongest = *std::ranges::max_element(neutral);
  if (!(strongest > 0)) throw Error("the white has no light where the sensor is sensitive");
  for (double& n : neutral) n /= strongest;
  return neutral;
}

// By cofactors.
SensorMatrix inverse(const SensorMatrix& m) {
  SensorMatrix result;
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) {
      const size_t a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      result[i][j] = m[a][c] * m[b][d] - m[a][d] * m[b][c];
    }
  const double determinant = m[0][0] * result[0][0] + m[0][1] * result[1][0] + m[0][2] * result[2][0];
  if (determinant == 0) throw Error("the sensor's channels are not independent: no colour can be computed from them");
  for (auto& row : result)
    for (double& x : row) x /= determinant;
  return result;
}

Image developed(const Image& raw, const Sensor& sensor, const SpectralFunction& white) {
  const SensorMatrix to_xyz = sensor_matrix(sensor, white, *illuminant_spectrum("D65"));
  const std::array<double, 3> neutral = sensor_neutral(sensor, white);
  const double black = sensor.black_level, most = std::exp2(sensor.bits) - 1;
  const std::array<double, 9>& from_xyz = rgb_space("srgb").from_xyz;
  Image picture = raw;
  for (size_t p = 0; p < raw.values.size(); p += 3) {
    std::array<double, 3> balanced, xyz{};
    // Beyond the level at which the first channel of a white saturates, the others would tint it.
    for (size_t c = 0; c < 3; ++c) balanced[c] = std::min((raw.values[p + c] - black) / (most - black) / neutral[c], 1.0);
    for (size_t i = 0; i < 3; ++i)
      for (size_t c = 0; c < 3; ++c) xyz[i] += to_xyz[i][c] * balanced[c];
    for (size_t i = 0; i < 3; ++i)
      picture.values[p + i] = from_xyz[3 * i] * xyz[0] + from_xyz[3 * i + 1] * xyz[1] + from_xyz[3 * i + 2] * xyz[2];
  }
  return picture;
}

}  // namespace etendue
