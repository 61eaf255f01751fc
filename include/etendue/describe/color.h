#pragma once
// Functions that make colours and spectra: RGB spaces, illuminants, black bodies, glasses, metals, measured spectra.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "etendue/core/spectral_function.h"
#include "etendue/describe/value.h"

namespace etendue {

class RgbTable;

/// A set of primaries and a white. Matrices are row major.
struct RgbSpace {
  std::string name;
  std::array<std::array<double, 2>, 3> primaries{};  ///< x, y of red, green, blue
  std::array<double, 2> white{};                     ///< x, y
  std::array<double, 9> to_xyz{}, from_xyz{};        ///< RGB (1,1,1) has Y = 1
  Color illuminant;                                  ///< the white's spectral distribution, with Y = 1
  std::shared_ptr<RgbTable> table;                   ///< sigmoid coefficients, computed at first use; shared by copies
};

/// "srgb" (= "rec709"), "display_p3", "rec2020", "adobe_rgb", "aces2065-1", "acescg", "xyz" (primaries X Y Z, white E).
/// Throws Error with a suggestion for an unknown name.
const RgbSpace& rgb_space(const std::string& name);
std::vector<std::string> rgb_space_names();
/// An RGB space with given primaries and white point.
RgbSpace make_rgb_space(const std::string& name, const std::array<std::array<double, 2>, 3>& primaries,
                        const std::array<double, 2>& white);

/// Transfer functions: "linear", "srgb", "rec709", "gamma2.2". encode maps a linear value in [0, 1] to the encoded value in [0,
/// 1] of a file; decode is the inverse.
double encode_transfer(const std::string& transfer, double linear);
double decode_transfer(const std::string& transfer, double encoded);
std::vector<std::string> transfer_names();

/// CIE 1931 2 degree colour-matching functions, linear between the values at 1 nm; 0 outside 360-830 nm.
Xyz observer(float wavelength);
/// The integral of ybar [nm], 106.856917.
double observer_y_integral();
/// XYZ of a whole spectrum: the sum in steps of 1 nm over 360-830 nm, divided by the integral of ybar. With an illuminant: XYZ
/// of that light reflected by the spectrum, relative to a perfect white (Y = 1).
Xyz to_xyz(const SpectralFunction&, ColorUse, const SpectralFunction* illuminant = nullptr);

// Each throws Error for unknown names and unusable values.
Color rgb_color(const std::string& space, double r, double g, double b);  ///< linear components
Color srgb_color(double r, double g, double b);                           ///< encoded components in [0, 1]
Color xyz_color(double x, double y, double z);
Color blackbody_spectrum(double kelvin);             ///< Planck's radiance [W m^-2 sr^-1 nm^-1]
Color illuminant_spectrum(const std::string& name);  ///< "A" "D50" "D65" "E" "F2" "F11", scaled to Y = 1
Color glass_index(const std::string& name);  ///< refractive index: "N-BK7", "N-SF11", "F2", "fused silica", "diamond", "water"
Color metal_index(const std::string& name);  ///< complex: "Au" "Ag" "Al" "Cu" "Cr"
Color complex_index(Color n, Color k);
/// Values at increasing wavelengths [nm], interpolated linearly, 0 outside.
Color table_spectrum(std::vector<float> wavelengths, std::vector<float> values);
/// From a CSV or SPD file with two columns, wavelength [nm] and value; `column` is the name or number of another value column
/// of a CSV.
Color file_spectrum(const FilePath&, const std::string& column = {});
/// A spectrum multiplied by a factor.
Color scaled_spectrum(double factor, Color);
/// A spectrum with a fixed ColorUse, whatever use it is evaluated for: for example an RGB coefficient with the spectrum of an
/// RGB reflectance.
Color used_spectrum(ColorUse, Color);
Color used_spectrum(const std::string& use, Color);  ///< "reflectance" "radiance" "coefficient"

std::vector<std::string> illuminant_names();
std::vector<std::string> glass_names();
std::vector<std::string> metal_names();

/// A reflectance from linear RGB, per texel: three coefficients of a sigmoid of a quadratic (Jakob & Hanika 2019).
struct RgbCoefficients {
  float c0 = 0, c1 = 0, c2 = 0;
  Spectrum evaluate(const Wavelengths&) const;
};
/// The coefficients for components in [0, 1] (clamped), from a table that is computed once for each space; accurate to 1e-3 in
/// RGB.
RgbCoefficients rgb_coefficients(const RgbSpace&, float r, float g, float b);
/// The spectrum of an RGB value for a use: reflectances clamp to [0, 1]; radiances are scale * sigmoid * illuminant;
/// coefficients scale * sigmoid.
Spectrum rgb_spectrum(const RgbSpace&, float r, float g, float b, ColorUse, const Wavelengths&);

}  // namespace etendue
