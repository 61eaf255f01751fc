// The exposure of a focal plane by a lens of the f-number N, focused far away, is H = q L t / N^2 [lx s] for the luminance L,
// where q = 0.65 holds the lens's transmittance, vignetting and cos^4 (ISO 12232:2019). The speed S says which exposure H_sat
// saturates the sensor (SpeedRule). The channel c with the sensitivity s_c has the relative exposure
//   e_c = q t / N^2  683 lm/W  k int L(lambda) s_c(lambda) dlambda / H_sat,   k = int D ybar / max_c int D s_c,
// so that under D65 (D) the most sensitive channel of a grey is exposed as the photometric rule says.
//
// At the base speed S_0 saturation is the full well of n_full electrons; at S the amplification S / S_0 lets n_sat = n_full
// S_0 / S electrons reach the largest voltage, n_full g for the conversion gain g. So (after the EMVA standard 1288, 3.2)
//   electrons  n_c = e_c n_sat, with noise n_c ~ Poisson(e_c n_sat + d t) + Normal(0, read^2) for the dark current d,
//   volts      u_c = n_c g S / S_0,
//   number     black + (2^bits - 1 - black) n_c / n_sat, rounded and clipped to 0 to 2^bits - 1.
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
#include "sensor_integrals.h"

namespace etendue {
namespace {

constexpr double lens_factor = 0.65, lumens_per_watt = 683;

double saturation_exposure(const Sensor& sensor) {
  return (sensor.speed_rule == SpeedRule::saturation ? 78 : 10 / 0.18) / sensor.iso;
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
  const auto light = [&](double l) { return value_at(*daylight, l, ColorUse::radiance); };
  std::array<double, 3> whole{}, under_daylight{};
  for (size_t c = 0; c < 3; ++c) {
    if (range_of(*sensor.sensitivities[c], ColorUse::coefficient).least < 0) throw Error("a sensitivity is negative");
    whole[c] = whole_integral([&](double l) { return sensitivity(sensor, c, l); });
    under_daylight[c] = whole_integral([&](double l) { return light(l) * sensitivity(sensor, c, l); });
    if (!(under_daylight[c] > 0)) throw Error("a sensitivity is zero at all wavelengths");
  }
  const double luminous = whole_integral([&](double l) { return light(l) * observer(float(l)).y; });
  const double scale = lens_factor * sensor.shutter / (sensor.f_number * sensor.f_number) * lumens_per_watt *
                       (luminous / *std::ranges::max_element(under_daylight)) / saturation_exposure(sensor);
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

/// The electrons that the read-out reports where `expected` are freed on the average. They depend on the seed and the place
/// alone.
double with_noise(double expected, const SensorNoise& noise, std::uint64_t place) {
  std::mt19937_64 random(mix_bits(noise.seed + mix_bits(place + 1)));
  // For many electrons Poisson's distribution is normal.
  double read = expected > 1e6 ? expected + std::sqrt(expected) * std::normal_distribution<double>()(random)
                : expected > 0 ? double(std::poisson_distribution<std::int64_t>(expected)(random))
                               : 0;
  if (noise.read > 0) read += std::normal_distribution<double>(0, noise.read)(random);
  return read;
}

/// From the relative exposure of a channel to what is recorded.
class ReadOut {
 public:
  ReadOut(const Sensor& sensor, SensorQuantity quantity)
      : sensor_(sensor), quantity_(quantity), most_(std::exp2(sensor.bits) - 1) {
    const Photosites& p = sensor.photosites;
    // Digital numbers without noise do not depend on electrons.
    if ((sensor.noise || quantity != SensorQuantity::numbers) && sensor.iso < p.base_iso)
      throw Error(fmt::format("ISO {:g} is below the base speed {:g}: the photosites would overflow before the numbers end",
                              sensor.iso, p.base_iso));
    if (sensor.black_level < 0 || sensor.black_level >= most_)
      throw Error(fmt::format("the black level {} leaves no room: digital numbers end at {:g}", sensor.black_level, most_));
    saturated_ = p.full_well * p.base_iso / sensor.iso;
  }

  /// A value, and whether it is clipped. `place` numbers the photosites.
  double operator()(double exposure, std::uint64_t place, bool& clipped) const {
    if (!(exposure == exposure)) exposure = 0;
    if (sensor_.noise) {
      const double dark = sensor_.noise->dark_current * sensor_.shutter;
      exposure = with_noise(std::clamp(exposure, 0.0, 1e9) * saturated_ + dark, *sensor_.noise, place) / saturated_;
    }
    if (quantity_ == SensorQuantity::numbers) {
      clipped |= exposure >= 1;
      const double black = sensor_.black_level;
      return std::round(std::clamp(black + (most_ - black) * exposure, 0.0, most_));
    }
    const Photosites& p = sensor_.photosites;
    const double electrons = std::min(exposure * saturated_, p.full_well);
    clipped |= electrons >= p.full_well;
    if (quantity_ == SensorQuantity::electrons) return electrons;
    clipped |= exposure >= 1;
    return std::min(electrons * p.conversion_gain * 1e-6 * sensor_.iso / p.base_iso, p.full_well * p.conversion_gain * 1e-6);
  }

 private:
  const Sensor& sensor_;
  SensorQuantity quantity_;
  double most_, saturated_ = 1;
};

void describe(Image& raw, const Sensor& sensor, SensorQuantity quantity) {
  const Photosites& p = sensor.photosites;
  raw.metadata["color_space"] = "srgb";
  raw.metadata["transfer"] = "linear";
  raw.metadata["sensor"] =
      fmt::format("ISO {:g} ({}), {:g} s, f/{:g}, {} bits", sensor.iso,
                  sensor.speed_rule == SpeedRule::saturation ? "saturation based" : "standard output sensitivity",
                  sensor.shutter, sensor.f_number, sensor.bits);
  raw.metadata["sensor_quantity"] =
      quantity == SensorQuantity::numbers
          ? fmt::format("digital numbers from {} to {:g}", sensor.black_level, std::exp2(sensor.bits) - 1)
      : quantity == SensorQuantity::electrons ? fmt::format("electrons, {:g} at most", p.full_well)
                                              : fmt::format("volts, {:g} at most", p.full_well * p.conversion_gain * 1e-6);
  raw.metadata["noise"] =
      !sensor.noise ? "none"
                    : fmt::format(
                          "of photons, full well {:g} electrons at ISO {:g}; of the read-out, {:g} electrons; dark "
                          "current {:g} electrons/s; seed {}",
                          p.full_well, p.base_iso, sensor.noise->read, sensor.noise->dark_current, sensor.noise->seed);
}

}  // namespace

Image recorded(const Image& spectral, const Sensor& sensor, SensorQuantity quantity) {
  const std::vector<ImageBand> bands = bands_of(spectral);
  if (bands.empty()) throw Error("the picture has no spectrum: none of its channels is named as 'S0.550nm'");
  std::vector<double> edges = band_edges_of(spectral);
  if (edges.empty()) edges = assumed_edges(bands);
  const std::vector<std::array<double, 3>> factor = factors(sensor, edges);
  const ReadOut read_out(sensor, quantity);

  Image raw(spectral.width, spectral.height, {"R", "G", "B"});
  raw.metadata = spectral.metadata;
  describe(raw, sensor, quantity);
  size_t clipped = 0;
  const size_t stride = spectral.channels.size(), pixels = raw.values.size() / 3;
  for (size_t p = 0; p < pixels; ++p) {
    bool full = false;
    for (size_t c = 0; c < 3; ++c) {
      double exposure = 0;
      for (size_t b = 0; b < bands.size(); ++b) exposure += factor[b][c] * spectral.values[p * stride + bands[b].channel];
      raw.values[3 * p + c] = read_out(exposure, 3 * p + c, full);
    }
    clipped += full;
  }
  raw.metadata["clipped"] = fmt::format("{:.4g}", double(clipped) / double(pixels));
  return raw;
}

double exposure_value(double luminance) { return std::log2(luminance * 100 / 12.5); }

double exposure_value(const Sensor& sensor) {
  return std::log2(sensor.f_number * sensor.f_number / sensor.shutter) - std::log2(sensor.iso / 100);
}

}  // namespace etendue
