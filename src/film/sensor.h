#pragma once
// A digital sensor behind a lens: from the bands of a spectral image to the digital numbers of three channels, and from these
// to a colour picture.

#include <array>
#include <cstdint>
#include <optional>

#include "etendue/core/image.h"
#include "etendue/core/spectral_function.h"

namespace etendue {

/// Noise of a sensor, in electrons.
struct SensorNoise {
  double full_well = 50000;  ///< electrons of a saturated channel
  double read = 3;           ///< standard deviation of the read-out
  std::uint64_t seed = 0;
};

struct Sensor {
  std::array<Color, 3> sensitivities;  ///< relative, of red, green and blue
  double iso = 100;
  double shutter = 0.01;  ///< [s]
  double f_number = 8;
  int bits = 14;  ///< of a digital number, at most 16
  std::optional<SensorNoise> noise;
};

/// The digital numbers as channels R, G, B of whole numbers from 0 to 2^bits - 1 (see sensor.cpp for the formula). Metadata:
/// "sensor", and "clipped", the fraction of pixels with a saturated channel. Throws Error if the image has no radiance in
/// bands, a sensitivity is negative or zero, or more than 1 % of the sensor's response lies outside of the bands.
Image digital_numbers(const Image& spectral, const Sensor&);

/// A picture in linear sRGB from digital numbers: the channels are scaled so that `white` (a light) becomes neutral, von Kries'
/// rule in the sensor's own space, and a matrix turns them into colours under D65. A perfect white that saturates a channel
/// is 1.
Image developed(const Image& digital_numbers, const Sensor&, const SpectralFunction& white);

/// The exposure value at ISO 100 of a luminance [cd/m^2]: log2(L S / K) with S = 100 and K = 12.5 (ISO 2720).
double exposure_value(double luminance);

}  // namespace etendue
