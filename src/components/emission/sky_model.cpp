// The Hosek-Wilkie sky.

#include "sky_model.h"

#include <cmath>

#include "sky_tables.h"

namespace etendue {
namespace {

using namespace sky_tables;
static_assert(SkyModel::channels == sky_tables::channels);

constexpr double half_pi = 3.14159265358979323846 / 2;

/// A Bezier curve of fifth degree, control points `stride` apart.
double bezier(const float* points, int stride, double x) {
  constexpr double binomials[] = {1, 5, 10, 10, 5, 1};
  double sum = 0;
  for (int i = 0; i < controls; ++i)
    sum += binomials[i] * std::pow(x, i) * std::pow(1 - x, controls - 1 - i) * double(points[i * stride]);
  return sum;
}

}  // namespace

SkyModel::SkyModel(float turbidity, const std::array<float, channels>& albedo, float elevation) {
  const double place = std::clamp(double(turbidity), 1.0, double(turbidities)) - 1;
  const size_t level = std::min(size_t(place), size_t(turbidities) - 2);
  const double t = place - double(level);
  const double x = std::cbrt(std::clamp(double(elevation) / half_pi, 0.0, 1.0));
  // One number from a table of [turbidity][albedo][control][channel][width], linear in turbidity and albedo.
  const auto find = [&](const float* table, int width, int channel, int k) {
    const double a = std::clamp(double(albedo[size_t(channel)]), 0.0, 1.0);
    const auto at = [&](size_t turbid, size_t bright) {
      const float* first = table + ((turbid * albedos + bright) * controls * channels + size_t(channel)) * size_t(width) + k;
      return bezier(first, channels * width, x);
    };
    return (1 - t) * ((1 - a) * at(level, 0) + a * at(level, 1)) + t * ((1 - a) * at(level + 1, 0) + a * at(level + 1, 1));
  };
  for (int c = 0; c < channels; ++c) {
    for (int k = 0; k < shapes; ++k) shape_[size_t(c)][size_t(k)] = float(find(shape, shapes, c, k));
    radiance_[size_t(c)] = float(find(radiance, 1, c, 0));

    constexpr size_t numbers = 2 * sun_nodes;
    for (size_t i = 0; i < numbers; ++i) {
      const auto at = [&](size_t turbid) { return double(sky_tables::sun[(turbid * channels + size_t(c)) * numbers + i]); };
      sun_[size_t(c)][i] = float((1 - t) * at(level) + t * at(level + 1));
    }
    // The mean of cos^j psi over the disc is 2 / (j + 2).
    double mean = 0;
    for (size_t j = 0; j < limbs; ++j) mean += double(limb[size_t(c) * limbs + j]) * 2 / double(j + 2);
    for (size_t j = 0; j < limbs; ++j) limb_[size_t(c)][j] = float(double(limb[size_t(c) * limbs + j]) / mean);
  }
}

SkyModel::View::View(float cos_theta, float gamma_)
    : gamma(gamma_), cosine(std::cos(gamma_)), inverse_zenith(1 / (cos_theta + 0.01f)), root(safe_sqrt(cos_theta)) {}

float SkyModel::sky(int channel, const View& v) const {
  const std::array<float, 9>& p = shape_[size_t(channel)];
  const float squared = square(v.cosine), base = std::max(1 + square(p[8]) - 2 * p[8] * v.cosine, 1e-6f);
  const float chi = (1 + squared) / (base * std::sqrt(base));
  const float value = (1 + p[0] * std::exp(p[1] * v.inverse_zenith)) *
                      (p[2] + p[3] * std::exp(p[4] * v.gamma) + p[5] * squared + p[6] * chi + p[7] * v.root);
  return std::max(value * radiance_[size_t(channel)], 0.0f);  // for a few extreme parameters the fit is negative
}

Spectrum SkyModel::sky(float cos_theta, float gamma, const Wavelengths& w) const {
  const View view(cos_theta, gamma);
  return between_channels(w, [&](int c) { return sky(c, view); });
}

SkyModel::Piece::Piece(float elevation) {
  constexpr int last = sun_nodes - 1;
  const double e = std::clamp(double(elevation) / half_pi, 0.0, 1.0);
  const int i = std::min(int(std::cbrt(e) * last), last - 1);
  const auto cube = [](double x) { return x * x * x; };
  const double low = cube(double(i) / last), high = cube(double(i + 1) / last);
  node = size_t(i);
  t = float((e - low) / (high - low));
  width = float((high - low) * half_pi);
}

/// The cubic between two nodes with given values and slopes there (Hermite).
float SkyModel::sun(int channel, const Piece& piece) const {
  const float* n = &sun_[size_t(channel)][2 * piece.node];
  const float t = piece.t, s = 1 - t;
  const float value =
      s * s * (n[0] * (1 + 2 * t) + n[1] * piece.width * t) + t * t * (n[2] * (1 + 2 * s) - n[3] * piece.width * s);
  return std::max(value, 0.0f);
}

Spectrum SkyModel::sun(float elevation, float cos_psi, const Wavelengths& w) const {
  const Piece piece(elevation);
  return between_channels(w, [&](int c) {
    const std::array<float, 6>& l = limb_[size_t(c)];
    float darkening = 0;
    for (size_t j = limbs; j-- > 0;) darkening = darkening * cos_psi + l[j];
    return sun(c, piece) * darkening;
  });
}

const Xyz& SkyModel::color_of_channel(int channel) {
  static const std::array<Xyz, channels> colors = [] {
    std::array<Xyz, channels> sums{};
    for (float lambda = wavelength_low; lambda <= wavelength_high; ++lambda) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, lambda, 1);
      for (int c = 0; c < channels; ++c) {
        const Spectrum hat = between_channels(w, [&](int k) { return k == c ? 1.0f : 0.0f; });
        sums[size_t(c)] += double(hat[0]) / observer_y_integral() * observer(lambda);
      }
    }
    return sums;
  }();
  return colors[size_t(channel)];
}

float SkyModel::beyond(float wavelength) {
  // Planck: lambda^-5 / (e^(c_2 / (lambda T)) - 1), c_2 = 1.438777e7 nm K.
  const auto planck = [](float l) { return 1 / (l * l * l * l * l * 1e-14f * std::expm1(1.438777e7f / (l * 5778))); };
  static const float end = planck(720);
  return planck(wavelength) / end;
}

}  // namespace etendue
