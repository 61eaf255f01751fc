#pragma once
// Scattering by a single fibre of hair or fur: the functions of Chiang et al. 2016, "A practical and controllable hair and fur
// model for production path tracing", after Marschner et al. 2003 and d'Eon et al. 2011.

#include <array>

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"

namespace etendue {

/// The scattering functions of a fibre with constant parameters. theta is the angle of a direction against the plane across the
/// fibre, phi its azimuth around the fibre.
class HairFibre {
 public:
  /// The lobes by the number p of path segments inside the fibre: reflected at the surface (R), transmitted (TT), internally
  /// reflected once (TRT), and a residual lobe for all longer paths, which is uniform in azimuth.
  static constexpr int lobes = 4;

  /// `along` and `around`: the longitudinal and azimuthal roughness, in [0, 1]; `tilt` of the cuticle's scales [rad]; `eta`:
  /// index of the fibre over that outside.
  HairFibre(float along, float around, float tilt, float eta);

  /// Refraction and attenuation of rays at one offset across the fibre.
  struct Section {
    float offset_angle;         ///< gamma: between the ray and the normal outside, in projection along the fibre [rad]
    float offset_angle_inside;  ///< gamma': the same of the refracted ray
    std::array<Spectrum, lobes> attenuation;  ///< A_p; their sum is 1 without absorption
  };
  /// `sine` and `cosine` of theta of `out`; h in [-1, 1], the offset from the axis in radii; absorption per radius.
  Section section(float sine, float cosine, float h, Spectrum absorption) const;

  /// M_p: the pdf of sin(theta) of `in`, over [-1, 1]; with uniform azimuth, M_p / (2 pi) is a pdf per solid angle [1/sr].
  float longitudinal(int p, float sine_out, float cosine_out, float sine_in, float cosine_in) const;
  /// Samples sin(theta) of `in` with the pdf M_p.
  float sample_longitudinal(int p, float sine_out, float cosine_out, Point2 u) const;
  /// N_p: the pdf of the azimuth of `in` minus that of `out` [1/rad].
  float azimuthal(int p, const Section&, float difference) const;
  float sample_azimuthal(int p, const Section&, float u) const;
  /// The integral of N_p over the differences from `from` to `from` + pi.
  float azimuthal_share(int p, const Section&, float from) const;

  /// The absorption per radius that gives dense hair a color (Chiang et al. 2016, eq. 9).
  Spectrum absorption_of(Spectrum color) const;

 private:
  /// Rotates theta of `out` by the tilt of lobe p.
  void tilted(int p, float& sine, float& cosine) const;
  /// Phi: the change of azimuth of lobe p for a perfectly smooth fibre.
  static float turn(int p, const Section&);

  std::array<float, lobes> variance_, tilt_sine_, tilt_cosine_;  // of M_p
  float scale_;                                                  // of N_p, a logistic distribution [rad]
  float scale_norm_;                                             // its integral over [-pi, pi]
  float around_, eta_;
};

}  // namespace etendue
