#pragma once
// What a digital sensor recorded, as files that programs for developing raw pictures read.

#include <string>

#include "film/sensor.h"

namespace etendue {

/// Digital Negative (DNG 1.4, Adobe 2012): the digital numbers, the sensor's colour matrices for the illuminants A and D65, the
/// channels of a perfect white in `white`, the levels of black and white, and the exposure. `mosaic` is the order of the
/// colours in a square of 2 x 2 pixels, such as "RGGB", of which each pixel keeps one; empty: all three are kept ("linear
/// raw"). Throws Error for another order and as write_whole_file does.
void write_dng(const Image& digital_numbers, const Sensor&, const std::string& camera, const SpectralFunction& white,
               const std::string& mosaic, const std::string& path);

/// The orders of colours in a mosaic.
std::vector<std::string> mosaic_names();

/// TIFF, 16 bits. R, G and B are divided by `largest`, which becomes 65535; nothing else is done to them.
void write_linear_tiff(const Image&, double largest, const std::string& path);

}  // namespace etendue
