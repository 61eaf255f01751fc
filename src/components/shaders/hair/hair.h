#pragma once
// Scattering by a single fibre of hair or fur: the functions of Chiang et al. 2016, "A practical and controllable hair and fur
// model for production path tracing", after Marschner et al. 2003 and d'Eon et al. 2011.

#include <array>

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"

namespace etendue {

/// How a fibre scatters; the same for all points of it. Angles are against the plane across the fibre (theta) and around the
/// fibre (phi).
class HairFibre {
 public:
  /// Lobes by number p of segments within the fibre: reflected at the surface (R), through it (TT), reflected inside once
  /// (TRT), and everything after that together, which leaves in all azimuths alike.
  static constexpr int lobes = 4;

  /// Roughnesses in [0, 1], along and around the fibre; tilt of the cuticle's scales [rad]; index over that outside.
  HairFibre(float along, float around, float tilt, float eta);

  /// What an infinitely thin ray at one place across the fibre meets.
  struct Section {
    float offset_angle;  ///< between the ray and the normal outside, in projection along the fibre [rad]
    float offset_angle_inside;
    std::array<Spectrum, lobes> attenuation;  ///< A_p; their sum is 1 without absorption
  };
  /// `sine` and `cosine` of theta of `out`; h in [-1, 1], the offset from the axis in radii; absorption per radius.
  Section section(float sine, float cosine, float h, Spectrum absorption) const;

  /// M_p: density of sin(theta) of `in`, over [-1, 1]; so is M_p / (2 pi) one by solid angle, alike in all azimuths.
  float longitudinal(int p, float sine_out, float cosine_out, float sine_in, float cosine_in) const;
  /// Draws sin(theta) of `in` with that density.
  float sample_longitudinal(int p, float sine_out, float cosine_out, Point2 u) const;
  /// N_p: density of the azimuth of `in` less that of `out` [1/rad].
  float azimuthal(int p, const Section&, float difference) const;
  float sample_azimuthal(int p, const Section&, float u) const;
  /// The integral of N_p over the half turn of differences that begins at `from`.
  float azimuthal_share(int p, const Section&, float from) const;

  /// The absorption per radius that gives dense hair a color (Chiang et al. 2016, eq. 9).
  Spectrum absorption_of(Spectrum color) const;

 private:
  /// `out` as if the fibre were straightened by the tilt.
  void tilted(int p, float& sine, float& cosine) const;
  /// The change of azimuth of a ray that is not scattered: Phi.
  static float turn(int p, const Section&);

  std::array<float, lobes> variance_, tilt_sine_, tilt_cosine_;  // of M_p
  float scale_;                                                  // of N_p, a logistic distribution [rad]
  float scale_norm_;                                             // its integral over [-pi, pi]
  float around_, eta_;
};

}  // namespace etendue
