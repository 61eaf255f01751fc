#pragma once
// How algorithms get the BSDF at a point of a surface: `scattering_at` binds the object's shader and applies the sides that
// scatter.

#include "etendue/describe/component.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue {

/// The lobes whose scattering is a vertex of a path: all but null scattering.
inline constexpr Lobes vertex_lobes = Lobes(all_lobes & ~null_scattering);

/// The shader's BSDF at a point. An exception from Shader::bind is rethrown with the class of the shader; without one there is
/// no cost.
inline const Scatter* bound(const Shader& shader, const SurfacePoint& point, const Wavelengths& wavelengths, Arena& arena) {
  try {
    return shader.bind(point, wavelengths, arena);
  } catch (...) {
    blame(shader, "binding");
  }
}

/// The scattering on the black side of a one-sided surface: null scattering alone, through holes and thin panes.
class StraightScatter final : public Scatter {
 public:
  StraightScatter(const SurfacePoint& point, const Scatter& whole) : Scatter(point, null_scattering), whole_(whole) {
    has_choice_ = false;
  }
  ScatterValue world_value_and_pdf(const Vector3&, const Vector3&, ScatterContext) const override { return {}; }
  std::optional<ScatterSample> world_sample(const Vector3& out, float, Point2, ScatterContext context) const override {
    return whole_.sample(out, 0, {}, {context.transport, null_scattering});  // requested alone, the lobe has probability 1
  }
  Spectrum world_albedo(const Vector3& out, Lobes) const override { return whole_.albedo(out, null_scattering); }

 private:
  const Scatter& whole_;
};

/// The BSDF at a point of a surface that is seen from `out`; null: nothing is scattered.
inline const Scatter* scattering_at(const SurfacePoint& point, const Vector3& out, const Wavelengths& wavelengths,
                                    Arena& arena) {
  const SceneObject& object = *point.object;
  if (!object.shader) return nullptr;
  const bool black = object.sides != Sides::both && (dot(point.normal, out) > 0) != (object.sides == Sides::front);
  if (!black) return bound(*object.shader, point, wavelengths, arena);
  if (!(object.shader->possible_lobes() & null_scattering)) return nullptr;
  const Scatter* whole = bound(*object.shader, point, wavelengths, arena);
  if (!whole || !whole->has(null_scattering)) return nullptr;
  return whole->lobes() == null_scattering ? whole : arena.make<StraightScatter>(point, *whole);
}

/// Whether a sampled direction enters an object with subsurface scattering. The algorithm must then sample an exit point
/// (Walk::subsurface_exit_found) or end the path.
inline bool enters_subsurface(const SurfacePoint& point, const ScatterSample& next) {
  return next.transmitted() && next.lobe != null_scattering && point.object->shader->has_subsurface_exit();
}

}  // namespace etendue
