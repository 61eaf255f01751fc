#pragma once
// A digital sensor behind a lens: from the bands of a spectral image to the electrons, volts and digital numbers of three
// channels, and from these to a colour picture.

#include <array>
#include <cstdint>
#include <optional>

#include "etendue/core/image.h"
#include "etendue/core/spectral_function.h"

namespace etendue {

/// What the speed S of a sensor says about the exposure H_sat [lx s] that saturates it (ISO 12232:2019).
enum class SpeedRule : std::uint8_t {
  saturation,       ///< H_sat = 78 / S
  standard_output,  ///< H = 10 / S gives the output 0.461 of an sRGB picture, 18 % of saturation: H_sat = 10 / (0.18 S)
};

/// Photosites and their read-out.
struct Photosites {
  double full_well = 50000;     ///< electrons that one can hold; they fill the range of digital numbers at the base speed
  double base_iso = 100;        ///< the lowest speed; higher ones amplify, so that fewer electrons fill the range
  double conversion_gain = 20;  ///< at the base speed, before amplification [microvolt / electron]
};

/// Noise of a sensor, in electrons. That of photons always belongs to it.
struct SensorNoise {
  double read = 3;          ///< standard deviation of the read-out
  double dark_current = 0;  ///< [electrons / s]
  std::uint64_t seed = 0;
};

struct Sensor {
  std::array<Color, 3> sensitivities;  ///< relative, of red, green and blue
  double iso = 100;
  SpeedRule speed_rule = SpeedRule::saturation;
  double shutter = 0.01;  ///< [s]
  double f_number = 8;
  int bits = 14;        ///< of a digital number, at most 16
  int black_level = 0;  ///< the digital number of no light
  Photosites photosites;
  std::optional<SensorNoise> noise;
};

enum class SensorQuantity : std::uint8_t {
  numbers,    ///< whole, from 0 to 2^bits - 1
  electrons,  ///< in the photosites, with the noise of the read-out if there is noise
  volts,      ///< amplified
};

/// What the sensor records of a spectral picture, as channels R, G, B (see sensor.cpp for the formulas). Metadata: "sensor";
/// "sensor_quantity"; "noise", "none" without noise; and "clipped", the fraction of pixels with a saturated channel. Throws
/// Error if the image has no radiance in bands, a sensitivity is negative or zero, more than 1 % of the sensor's response lies
/// outside of the bands, the black level leaves no room, or the speed is below the base speed.
Image recorded(const Image& spectral, const Sensor&, SensorQuantity = SensorQuantity::numbers);

/// A picture in linear sRGB from digital numbers: the channels are scaled so that `white` (a light) becomes neutral, von Kries'
/// rule in the sensor's own space, and a matrix turns them into colours under D65. A perfect white that saturates a channel
/// is 1.
Image developed(const Image& digital_numbers, const Sensor&, const SpectralFunction& white);

using SensorMatrix = std::array<std::array<double, 3>, 3>;

/// The channels of a perfect white in this light; the strongest is 1.
std::array<double, 3> sensor_neutral(const Sensor&, const SpectralFunction& light);

/// The matrix from balanced channels (divided by those of a perfect white in `light`) to X, Y, Z under `seen_in`, with the
/// least squared error over smooth reflectances. A perfect white is exact.
SensorMatrix sensor_matrix(const Sensor&, const SpectralFunction& light, const SpectralFunction& seen_in);

SensorMatrix inverse(const SensorMatrix&);

/// The exposure value at ISO 100 of a luminance [cd/m^2]: log2(L S / K) with S = 100 and K = 12.5 (ISO 2720).
double exposure_value(double luminance);
/// That of a camera's settings at ISO 100: log2(N^2 / t) - log2(S / 100). The picture of a luminance with the same value has
/// the exposure that a light meter would choose.
double exposure_value(const Sensor&);

}  // namespace etendue
