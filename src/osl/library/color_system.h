#pragma once
// ColorSystem: an RGB space, for functions of colours: luminance, blackbody, wavelength_color, transformc.

#include <string_view>
#include <vector>

#include "osl/values/triple.h"

namespace etendue::osl {

class ColorSystem {
 public:
  /// Primaries and white as chromaticities x, y of CIE 1931.
  struct Chromaticity {
    float x, y;
  };
  ColorSystem(Chromaticity red, Chromaticity green, Chromaticity blue, Chromaticity white);

  /// ITU-R BT.709 with the white of D65: the default.
  static const ColorSystem& rec709();
  /// "Rec709", "sRGB", "NTSC", "EBU", "PAL", "SECAM", "SMPTE", "HDTV", "CIE", "AdobeRGB", "XYZ", "ACEScg", "ACES2065-1"; null
  /// if unknown.
  static const ColorSystem* named(std::string_view);

  Triple to_xyz(const Triple& rgb) const;
  Triple from_xyz(const Triple& xyz) const;
  float luminance(const Triple& rgb) const;
  /// The colour of a black body: its radiant exitance [W/m^2 per m of wavelength] times the matching functions, integrated over
  /// wavelengths. Below 800 K a very dark red.
  Triple blackbody(float kelvin) const;
  /// The colour of a spectral line [nm], scaled and with negative parts removed, for display.
  Triple wavelength(float nanometres) const;

 private:
  Triple to_xyz_[3];    // the XYZ of red, green, blue
  Triple from_xyz_[3];  // the rows of the inverse
  std::vector<Triple> blackbodies_;
};

}  // namespace etendue::osl
