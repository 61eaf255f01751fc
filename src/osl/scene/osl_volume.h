#pragma once
// GroupVolume: a participating medium of the description that is the closure Ci which a group of volume shaders makes.

#include <atomic>

#include "etendue/volume_shader.h"
#include "group_run.h"

namespace etendue::osl {

/// The name of the member that bounds the extinction, and of an output that does.
inline constexpr char bound_name[] = "bound";
inline constexpr char bound_text[] =
    "an upper bound of the extinction: denser matter is made as dense as this, and the closer to the largest there is, the "
    "faster. 0: the shader's output `bound` says it";

class GroupVolume : public VolumeShader, public RunsGroup {
 public:
  VolumeCoefficients coefficients(const Point3&, float time, const Wavelengths&) const final;
  bool homogeneous() const final { return !network().varies(); }
  bool emits() const final { return uses().emits; }
  Spectrum majorant(const Wavelengths&) const final;
  float phase(const Point3&, const Vector3& out, const Vector3& in) const final;
  Vector3 sample_phase(const Point3&, const Vector3& out, Point2 u, float& pdf) const final;

 protected:
  /// `bound` [1/m] as the member bound_name says it.
  void build_volume(const Component& self, Network, const std::string& last, float bound);

 private:
  VolumeCoefficients unbounded(const SurfacePoint&, const Wavelengths&) const;
  float bound_ = 0;
  mutable std::atomic<bool> told_{false};  ///< that the extinction exceeds it
};

}  // namespace etendue::osl
