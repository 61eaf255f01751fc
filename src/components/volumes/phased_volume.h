#pragma once
// PhasedVolume: base class of media with one phase function that is the same everywhere; the density may vary.

#include "etendue/polarizing_scatter.h"
#include "etendue/volume_shader.h"

namespace etendue {

/// The largest extinction [1/m] that media may have: in denser matter walks would not come to an end.
inline constexpr float most_extinction = 1e12f;
inline constexpr char too_dense[] = "the extinction may become {:g} per metre, which light cannot be followed through";

class PhasedVolume : public VolumeShader, public PolarizingVolume {
 public:
  float phase(const Point3&, const Vector3& out, const Vector3& in) const final;
  Vector3 sample_phase(const Point3&, const Vector3& out, Point2 u, float& pdf) const final;
  /// Henyey's and Greenstein's function depolarizes.
  bool polarization(const Vector3& out, const Vector3& in, Polarization& event) const final;

  Ref<PhaseFunction> phase_function;
  float anisotropy = 0;

 protected:
  template <class T>
  static void describe_phase(Description<T>& d) {
    d.group("Phase function")
        .template member<&T::phase_function>(
            "phase", "", "where scattered light goes; none: Henyey's and Greenstein's function with `anisotropy`")
        .template member<&T::anisotropy>("anisotropy", "1",
                                         "mean cosine of the angle light turns by, between -1 (all back) and 1 (all straight "
                                         "on), both excluded; 0 scatters alike in all directions",
                                         range(-1, 1), unless("phase"));
  }
  void check_phase() const;

 private:
  /// The direction of the phase function's peak, given the direction `out` back along the path: -out (forward) or out
  /// (backward).
  Vector3 peak(const Vector3& out) const { return anisotropy < 0 ? out : -out; }
};

}  // namespace etendue
