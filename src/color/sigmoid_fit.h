#pragma once
// Reflectances as a sigmoid of a quadratic in the wavelength, fitted to RGB values (Jakob & Hanika 2019).

#include <array>
#include <cmath>
#include <vector>

#include "etendue/core/spectrum.h"

namespace etendue {

struct RgbSpace;

/// The quadratic's variable: the wavelength [nm] mapped to [-1, 1]. Centred, so that its terms do not cancel in float.
constexpr double sigmoid_variable(double wavelength) { return (wavelength - 595) * (1 / 235.0); }
/// S(x) = 1/2 + x / (2 sqrt(1 + x^2)), in [0, 1].
inline double sigmoid(double x) { return 0.5 + x / (2 * std::sqrt(1 + x * x)); }

using Coefficients = std::array<double, 3>;  ///< c0 t^2 + c1 t + c2

/// The coefficients whose sigmoid is this value at every wavelength; those of 0 and 1 are exactly black and white.
Coefficients flat_coefficients(double value);
double evaluate_sigmoid(const Coefficients&, double wavelength);
Spectrum evaluate_sigmoid(float c0, float c1, float c2, const Wavelengths&);

/// Fits coefficients to the RGB a reflectance has under the white of a space. The integrals over 360-830 nm become
/// sums over nodes `step` nm apart, whose weights are those of the 1 nm sum for a reflectance linear between the nodes.
class SigmoidFit {
 public:
  SigmoidFit(const RgbSpace&, int step);

  /// Improves `c` until the RGB error is below `tolerance` or does not decrease; returns the remaining error.
  double solve(const std::array<double, 3>& rgb, Coefficients& c, double tolerance, int iterations) const;
  /// For any RGB in [0, 1]^3, without an initial guess. A colour that no reflectance has is replaced approximately by the
  /// nearest one that a reflectance has.
  Coefficients solve(const std::array<double, 3>& rgb) const;
  /// The RGB values of a reflectance with these coefficients.
  std::array<double, 3> rgb_of(const Coefficients&) const;

 private:
  struct Point {
    std::array<double, 3> rgb;
    std::array<double, 9> derivative;  ///< of rgb with respect to c, row major
  };
  void evaluate(const Coefficients&, Point&) const;

  int nodes_ = 0;                              // a multiple of 4
  std::vector<double> variable_;               // t at each node
  std::array<std::vector<double>, 3> weight_;  // of each node for R, G and B; the weights of each sum to 1
};

}  // namespace etendue
