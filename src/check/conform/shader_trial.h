#pragma once
// Shared by the checks of shaders: a shader bound to a point of a sphere, directions, and comparisons that allow for rounding.

#include <array>
#include <string>
#include <vector>

#include "conformance.h"
#include "etendue/core/arena.h"
#include "etendue/shader.h"

namespace etendue::conform {

/// Wavelengths at equal steps through the visible range, the hero [nm] first.
Wavelengths spread_wavelengths(float hero);
/// "diffuse_reflection|glossy_reflection"
std::string lobe_names(Lobes);
/// All subsets of some lobes but the empty one, the whole set first.
std::vector<Lobes> subsets_of(Lobes);

/// A point on a sphere that has the shader, and the bound Scatter there.
class BoundShader {
 public:
  /// `tilt` [rad]: the angle between the shading normal and the geometric normal.
  BoundShader(const Shader&, const Ref<SceneObject>& carrier, Point2 u, float hero, float tilt, float tilt_azimuth);

  /// Null: nothing is scattered here.
  const Scatter* scatter() const { return scatter_; }
  const SurfacePoint& point() const { return point_; }
  const Wavelengths& wavelengths() const { return wavelengths_; }
  /// A direction with this polar angle [deg] and azimuth [rad] around the shading normal; more than 90 degrees: behind the
  /// surface.
  Vector3 at_angle(double angle, double azimuth) const;
  /// The angle [deg] of a direction to the shading normal.
  double angle(const Vector3&) const;
  std::string name(const Vector3& direction) const;
  /// The fraction of the hero's power that specular lobes scatter from `out`.
  double specular_fraction(const Vector3& out, Lobes specular) const;
  /// Whether the shading normal differs from the geometric one, by `tilt` or by a normal map in the shader. Then radiance and
  /// importance have different weights of reflection, and the power relative to the geometric normal is not the model's, which
  /// is relative to the shading normal.
  bool turned() const { return turned_; }

 private:
  SurfacePoint point_;
  Wavelengths wavelengths_;
  Arena arena_;
  const Scatter* scatter_;
  bool turned_ = false;
};

/// The relative index by which a lobe refracts at a point, at each wavelength: the index on the side that light enters over
/// that on the side it comes from. A sample gives it for the hero only, so each wavelength is made the hero in turn.
class RelativeIndex {
 public:
  RelativeIndex() = default;
  RelativeIndex(Trial&, const BoundShader&, Lobes);
  /// For light that comes from the front or from behind. Null: the index is not the same for all samples, or there are none.
  const Spectrum* from(bool front) const { return known_[front] ? &index_[front] : nullptr; }
  /// Whether some sample is dispersive, so that it holds for the hero only.
  bool dispersive() const { return dispersive_; }

 private:
  Spectrum index_[2];
  bool known_[2] = {false, false}, dispersive_ = false;
};

/// A sphere whose shader is the given one.
Ref<SceneObject> carrier_of(Shader&);

/// The largest change of a function of a direction under rounding errors of the direction.
template <class F>
Spectrum rounding_of(F&& f, const Vector3& direction) {
  const Spectrum middle = f(direction);
  Spectrum most;
  for (int axis = 0; axis < 3; ++axis)
    for (const float step : {-2.5e-7f, 2.5e-7f}) {
      Vector3 v = direction;
      v[axis] += step;
      const Spectrum off = f(v) - middle;
      for (int i = 0; i < spectrum_size; ++i) most.set(i, std::max(most[i], std::abs(off[i])));
    }
  return most;
}

/// Whether two values agree to a relative tolerance, at the hero only or at all wavelengths. If they do not, `rounding` is
/// called for a further tolerance.
template <class F>
bool agree(const Spectrum& a, const Spectrum& b, float relative, bool hero_alone, F&& rounding) {
  const int lanes = hero_alone ? 1 : spectrum_size;
  bool all = true;
  for (int i = 0; i < lanes; ++i)
    all = all && std::abs(a[i] - b[i]) <= relative * std::max(std::abs(a[i]), std::abs(b[i])) + 1e-9f;
  if (all) return true;
  const Spectrum r = rounding();
  for (int i = 0; i < lanes; ++i)
    if (!(std::abs(a[i] - b[i]) <= relative * std::max(std::abs(a[i]), std::abs(b[i])) + 1e-9f + 4 * r[i])) return false;
  return true;
}

void check_shader_values(Trial&, const BoundShader& plain, const BoundShader& tilted);
void check_shader_reversal(Trial&, const BoundShader& plain, const BoundShader& tilted);
void check_shader_sampling(Trial&, const BoundShader& plain, const BoundShader& tilted);
/// For shaders whose `evaluate` is a stochastic estimate.
void check_shader_estimates(Trial&, const BoundShader& plain);

}  // namespace etendue::conform
