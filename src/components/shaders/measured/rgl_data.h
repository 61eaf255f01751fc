#pragma once
// RglData: a material measured in the adaptive parameterization of Dupuy & Jakob 2018.
//
// The measured directions are adapted to the material: its normal distribution was measured first, and the half-vectors at
// which f is tabulated follow the distribution of visible normals from the incident direction w_i. For each w_i of a grid over
// (phi_i, theta_i), a warp of the unit square (`vndf`) maps a point s to the half-vector, in coordinates
//     u = (sqrt(2 theta / pi), (phi + pi) / (2 pi)),   dw_m = 2 pi^2 u_x sin(theta) du,
// where phi is measured from phi_i if the material is isotropic. At s the file holds the factor `spectra` of
//     f(w_i, w_o) cos(w_o) = spectra(s; w_i, lambda) ndf(u) / (4 sigma(w_i))                                   [1/sr]
// sigma being the projected area of the microsurface (files without the factor ndf / (4 sigma) have jacobian = 0). A second
// warp (`luminance`) has a pdf over s that follows the remaining variation of f cos. So sampling goes from uniform numbers
// through `luminance`, then through `vndf`, to u, the half-vector m and w_o = 2 (w_i . m) m - w_i:
//     p(w_o) = p_luminance(s) p_vndf(u) / (2 pi^2 u_x sin(theta_m) 4 (w_i . m))                                [1/sr]

#include <string>

#include "etendue/core/vector.h"
#include "etendue/describe/color.h"
#include "warp2d.h"

namespace etendue {

/// The channels of a material between which a path's wavelengths are interpolated.
struct RglChannels {
  bool spectral = false;  ///< else the three channels are RGB
  std::array<std::uint32_t, spectrum_size> index{};
  std::array<float, spectrum_size> fraction{};
};

class RglData {
 public:
  /// Throws Error with a description of what is wrong with the file. `symmetric` concerns the albedo only: it is computed for
  /// the mean over both orders of the directions (see rgl_shader.cpp), or for the unchanged f of the file.
  RglData(const std::string& path, bool symmetric);

  RglChannels channels(const Wavelengths&) const;
  /// f(from, to) cos(to) [1/sr] for two directions above the surface (z > 0), as in the file: `from` is w_i.
  Spectrum evaluate(const Vector3& from, const Vector3& to, const RglChannels&, const Wavelengths&) const;
  /// The pdf [1/sr] of `sample`.
  float pdf(const Vector3& from, const Vector3& to) const;
  /// Samples a direction; it may lie below the surface.
  Vector3 sample(const Vector3& from, Point2 u) const;
  /// An estimate of the fraction of light from one direction that is reflected.
  Spectrum albedo(const Vector3& from, const RglChannels&, const Wavelengths&) const;
  /// The largest albedo in any direction and channel of the file.
  float largest_albedo() const { return largest_albedo_; }

  bool isotropic() const { return isotropic_; }
  /// Whether the file holds spectra, else RGB.
  bool spectral() const { return !wavelengths_.empty(); }
  const std::string& description() const { return description_; }

 private:
  /// An incident direction mirrored into the range that the file covers, and the tables to blend for it.
  struct Incident {
    Vector3 direction;
    float phi = 0, flip_x = 1, flip_y = 1;
    float area = 1;  // sigma
    TableBlend blend;
  };
  Incident incident(const Vector3& from) const;
  /// The half-vector's coordinates u in the unit square.
  Point2 place(const Vector3& half, float phi_incident) const;
  /// f cos without the spectrum: the point s at which the spectrum is tabulated, and the factor of the spectrum [1/sr].
  struct Answer {
    Point2 place;
    float factor = 1;
    TableBlend blend;
  };
  Answer answer(const Vector3& from, const Vector3& to) const;
  void estimate_albedo(bool symmetric);

  const RgbSpace* space_;
  std::string description_;
  ParameterGrid grid_;  // phi_i, theta_i [rad]
  SquareTables ndf_, sigma_, spectra_;
  Warp2D vndf_, luminance_;
  std::vector<float> wavelengths_;  // [nm]; none when the channels are RGB
  std::vector<float> albedo_;       // for each table of spectra_, its channels
  float largest_albedo_ = 0;
  bool isotropic_ = true, jacobian_ = true;
  int symmetry_ = 1;  // phi_i covers the full circle divided by this
};

}  // namespace etendue
