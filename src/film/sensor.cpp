// The exposure of a focal plane by a lens of the f-number N, focused far away, is H = q L t / N^2 [lx s] for the luminance L,
// where q = 0.65 holds the lens's transmittance, vignetting and cos^4 (ISO 12232:2019). A sensor of the speed S saturates at
// H_sat = 78 / S lx s (saturation based speed). The channel c with the sensitivity s_c has the relative exposure
//   e_c = q t / N^2  683 lm/W  k int L(lambda) s_c(lambda) dlambda / H_sat,   k = int D ybar / max_c int D s_c,
// so that under D65 (D) the most sensitive channel of a grey is exposed as the photometric rule says. The digital number is e_c
// times 2^bits - 1, rounded and clipped.
//
// With bands of the edges l_b the integral is sum_b L_b int_{l_b}^{l_b+1} s_c dlambda.

#include "sensor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "etendue/core/error.h"
#include "etendue/core/math.h"
#include "etendue/describe/color.h"
#include "image_bands.h"

namespace etendue {
namespace {

constexpr double lens_factor = 0.65, saturation_exposure = 78, lumens_per_watt = 683;

/// The integral of a function of the wavelength over an interval [nm], by midpoints.
template <class F>
double integral(double low, double high, const F& f) {
  const int steps = std::max(1, int(std::ceil((high - low) / 0.25)));
  const double step = (high - low) / steps;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(low + (i + 0.5) * step);
  return sum * step;
}

template <class F>
double whole_integral(const F& f) {
  return integral(double(wavelength_low), double(wavelength_high), f);
}

double at(const SpectralFunction& f, double wavelength, ColorUse use) { return double(f.at(float(wavelength), use)); }
double sensitivity(const Sensor& sensor, size_t c, double wavelength) {
  return at(*sensor.sensitivities[c], wavelength, ColorUse::coefficient);
}

/// Edges of bands whose file does not state them: half way between their wavelengths.
std::vector<double> assumed_edges(const std::vector<ImageBand>& bands) {
  std::vector<double> edges;
  for (size_t b = 0; b + 1 < bands.size(); ++b) edges.push_back((bands[b].wavelength + bands[b + 1].wavelength) / 2);
  if (edges.empty()) throw Error("the picture has a single band, of unknown width");
  edges.insert(edges.begin(), 2 * bands.front().wavelength - edges.front());
  edges.push_back(2 * bands.back().wavelength - edges.back());
  return edges;
}

/// The factor from radiance in a band to the relative exposure of a channel: [band][channel].
std::vector<std::array<double, 3>> factors(const Sensor& sensor, const std::vector<double>& edges) {
  const Color daylight = illuminant_spectrum("D65");
  const auto light = [&](double l) { return at(*daylight, l, ColorUse::radiance); };
  std::array<double, 3> whole{}, under_daylight{};
  for (size_t c = 0; c < 3; ++c) {
    if (range_of(*sensor.sensitivities[c], ColorUse::coefficient).least < 0) throw Error("a sensitivity is negative");
    whole[c] = whole_integral([&](double l) { return sensitivity(sensor, c, l); });
    under_daylight[c] = whole_integral([&](double l) { return light(l) * sensitivity(sensor, c, l); });
    if (!(under_daylight[c] > 0)) throw Error("a sensitivity is zero at all wavelengths");
  }
  const double luminous = whole_integral([&](double l) { return light(l) * observer(float(l)).y; });
  const double scale = lens_factor * sensor.shutter / (sensor.f_number * sensor.f_number) * lumens_per_watt *
                       (luminous / *std::ranges::max_element(under_daylight)) * sensor.iso / saturation_exposure;
  std::vector<std::array<double, 3>> all(edges.size() - 1);
  for (size_t c = 0; c < 3; ++c) {
    double covered = 0;
    for (size_t b = 0; b < all.size(); ++b) {
      const double in_band = integral(edges[b], edges[b + 1], [&](double l) { return sensitivity(sensor, c, l); });
      covered += in_band;
      all[b][c] = scale * in_band;
    }
    if (covered < 0.99 * whole[c])
      throw Error(fmt::format("the bands from {:g} to {:g} nm hold only {:.1f} % of a channel's sensitivity", edges.front(),
                              edges.back(), 100 * covered / whole[c]));
  }
  return all;
}

/// A relative exposure as the sensor reads it: the number of electrons follows a Poisson distribution, and the read-out adds a
/// normally distributed error. The numbers depend on the seed and the place alone.
double with_noise(double exposure, const SensorNoise& noise, std::uint64_t place) {
  std::mt19937_64 random(mix_bits(noise.seed + mix_bits(place + 1)));
  const double electrons = exposure * noise.full_well;
  // For many electrons the distribution is normal.
  double read = electrons > 1e6 ? electrons + std::sqrt(electrons) * std::normal_distribution<double>()(random)
                : electrons > 0 ? double(std::poisson_distribution<std::int64_t>(electrons)(random))
                                : 0;
  if (noise.read > 0) read += std::normal_distribution<double>(0, noise.read)(random);
  return read / noise.full_well;
}

}  // namespace

Image digital_numbers(const Image& spectral, const Sensor& sensor) {
  const std::vector<ImageBand> bands = bands_of(spectral);
  if (bands.empty()) throw Error("the picture has no spectrum: none of its channels is named as 'S0.550nm'");
  std::vector<double> edges = band_edges_of(spectral);
  if (edges.empty()) edges = assumed_edges(bands);
  const std::vector<std::array<double, 3>> factor = factors(sensor, edges);
  const double most = std::exp2(sensor.bits) - 1;

  Image raw(spectral.width, spectral.height, {"R", "G", "B"});
  raw.metadata = spectral.metadata;
  size_t clipped = 0;
  const size_t stride = spectral.channels.size(), pixels = raw.values.size() / 3;
  for (size_t p = 0; p < pixels; ++p) {
    bool full = false;
    for (size_t c = 0; c < 3; ++c) {
      double exposure = 0;
      for (size_t b = 0; b < bands.size(); ++b) exposure += factor[b][c] * spectral.values[p * stride + bands[b].channel];
      if (sensor.noise) exposure = with_noise(std::min(exposure, 1e9), *sensor.noise, 3 * p + c);
      full |= exposure >= 1;
      raw.values[3 * p + c] = std::round(std::clamp(exposure, 0.0, 1.0) * most);  // NaN becomes 0
      if (!(exposure == exposure)) raw.values[3 * p + c] = 0;
    }
    clipped += full;
  }
  raw.metadata["color_space"] = "srgb";
  raw.metadata["transfer"] = "linear";
  raw.metadata["sensor"] =
      fmt::format("ISO {:g}, {:g} s, f/{:g}, {} bits", sensor.iso, sensor.shutter, sensor.f_number, sensor.bits);
  raw.metadata["clipped"] = fmt::format("{:.4g}", double(clipped) / double(pixels));
  if (sensor.noise)
    raw.metadata["noise"] =
        fmt::format("photons at {:g} electrons, read-out {:g} electrons", sensor.noise->full_well, sensor.noise->read);
  return raw;
}

namespace {

using Matrix = std::array<std::array<double, 3>, 3>;

/// Solves A x = b for a symmetric positive definite A, by elimination.
std::array<double, 3> solve(Matrix a, std::array<double, 3> b) {
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

/// The matrix from balanced channels to X, Y, Z under D65 with the least squared error over smooth reflectances (those of a
/// grid of RGB colours, Jakob & Hanika 2019) in the light `white`; that of a perfect white counts so much that it is exact.
Matrix color_matrix(const Sensor& sensor, const SpectralFunction& white) {
  const Color daylight = illuminant_spectrum("D65");
  constexpr int first = 360, count = 471;
  std::vector<std::array<double, 3>> channels(count), colors(count);
  std::array<double, 3> neutral{};
  double luminous = 0;
  for (int i = 0; i < count; ++i) {
    const double l = first + i, light = at(white, l, ColorUse::radiance), day = at(*daylight, l, ColorUse::radiance);
    const Xyz eye = observer(float(l));
    colors[size_t(i)] = {day * eye.x, day * eye.y, day * eye.z};
    luminous += day * eye.y;
    for (size_t c = 0; c < 3; ++c) neutral[c] += channels[size_t(i)][c] = light * sensitivity(sensor, c, l);
  }
  for (const double n : neutral)
    if (!(n > 0)) throw Error("the white has no light where a channel is sensitive");

  Matrix squares{}, products{};
  const auto add = [&](const SpectralFunction& reflectance, double weight) {
    std::array<double, 3> raw{}, xyz{};
    for (int i = 0; i < count; ++i) {
      const double r = at(reflectance, first + i, ColorUse::reflectance);
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
  Matrix matrix;
  for (size_t i = 0; i < 3; ++i) matrix[i] = solve(squares, products[i]);
  return matrix;
}

}  // namespace

Image developed(const Image& raw, const Sensor& sensor, const SpectralFunction& white) {
  const Matrix to_xyz = color_matrix(sensor, white);
  std::array<double, 3> neutral{};
  for (size_t c = 0; c < 3; ++c)
    neutral[c] = whole_integral([&](double l) { return at(white, l, ColorUse::radiance) * sensitivity(sensor, c, l); });
  const double strongest = *std::ranges::max_element(neutral), most = std::exp2(sensor.bits) - 1;
  const std::array<double, 9>& from_xyz = rgb_space("srgb").from_xyz;
  Image picture = raw;
  for (size_t p = 0; p < raw.values.size(); p += 3) {
    std::array<double, 3> balanced, xyz{};
    for (size_t c = 0; c < 3; ++c) balanced[c] = raw.values[p + c] / most * strongest / neutral[c];
    // Beyond the level at which the first channel of a white saturates, the others would tint it.
    for (double& b : balanced) b = std::min(b, 1.0);
    for (size_t i = 0; i < 3; ++i)
      for (size_t c = 0; c < 3; ++c) xyz[i] += to_xyz[i][c] * balanced[c];
    for (size_t i = 0; i < 3; ++i)
      picture.values[p + i] = from_xyz[3 * i] * xyz[0] + from_xyz[3 * i + 1] * xyz[1] + from_xyz[3 * i + 2] * xyz[2];
  }
  return picture;
}

double exposure_value(double luminance) { return std::log2(luminance * 100 / 12.5); }

}  // namespace etendue
