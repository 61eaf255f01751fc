#pragma once
// IES photometric files: the measured intensity of a lamp in all directions.

#include <string>
#include <string_view>
#include <vector>

namespace etendue {

/// Coordinate systems of goniophotometers (IES LM-75). In type C the pole is the lamp's downward axis; in types A and B the
/// pole is perpendicular to the beam, upwards (A) or to the side (B).
enum class Photometry { c = 1, b = 2, a = 3 };

/// A distribution of luminous intensity [cd], for all types on the same kind of grid: `polar` angles [deg] from a pole, within
/// [0, 180], and `azimuth` [deg] around the pole, over at most 360, both increasing; symmetries are unfolded. Between the
/// angles the intensity is bilinear in the angles, beyond them it is zero.
///   type C  pole along the axis (down), azimuth 0 across it, counted counter-clockwise as seen from above;
///   type A  pole up, azimuth 0 along the axis (the beam), positive to the right as seen along it;
///   type B  pole to the right, azimuth 0 along the axis, positive upwards.
struct IesDistribution {
  Photometry type = Photometry::c;
  std::vector<double> polar, azimuth;
  std::vector<float> candelas;                    ///< at azimuth i and polar angle k: [i * polar.size() + k]
  double greatest = 0;                            ///< [cd]
  double input_watts = 0;                         ///< electrical power, as the file says [W]
  std::vector<double> tilt_angles, tilt_factors;  ///< of TILT=INCLUDE, else empty

  float at(double polar_angle, double azimuth_angle) const;
  /// The flux [lm] within polar angles [from, to]: the exact integral of the bilinear intensity.
  double lumens(double from = 0, double to = 180) const;
  /// The factor of the intensity when the lamp is tilted; linear between the angles, 1 for files without tilt factors.
  double tilt_factor(double degrees) const;
};

/// IESNA LM-63-1986, -1991, -1995, -2002 and -2019. Throws Error naming the file, the line and the reason.
IesDistribution read_ies_file(const std::string& path);
/// The same from a text; `name` is for messages.
IesDistribution parse_ies(std::string_view text, const std::string& name);

}  // namespace etendue
