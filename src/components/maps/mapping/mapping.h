#pragma once
// Maps that change where another map is looked up.

#include "components/maps/footprint.h"
#include "etendue/object_map.h"

namespace etendue {

/// Surface coordinates given by a point of space, and how they change with it.
struct Projected {
  Point2 uv;
  Vector3 gradient_u, gradient_v;  ///< [1/m]
};

/// Gives a point new surface coordinates, and the tangents that belong to them: dpdu and dpdv are the steps in the surface
/// that change one of them by 1 and leave the other. Gradients are in the renderer's coordinates.
void set_uv(SurfacePoint&, const Projected&);

/// u = atan2(y, x) / (2 pi) in [0, 1), and its gradient.
float turn_around_z(const Vector3&, Vector3& gradient);

/// A map over surface coordinates that a projection through space gives.
class ProjectionMap : public ObjectMap {
 public:
  void prepare() override;
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    return map->color(seen_at(p), w, use);
  }
  float scalar(const SurfacePoint& p) const override { return map->scalar(seen_at(p)); }

  Ref<ObjectMap> map = etendue::constant(0.5f);
  AnimatedTransform transform;
  bool world = false;

 protected:
  /// In the projector's own coordinates.
  virtual Projected project(const Vector3&) const = 0;

 private:
  SurfacePoint seen_at(const SurfacePoint&) const;
};

template <class Map>
Description<Map>& describe_projection(Description<Map>& d) {
  return d.template member<&Map::map>("map", "1", "the map over the surface coordinates that the projection gives")
      .template member<&Map::transform>(
          "transform", "", "from the projection's own coordinates to the object's, or to the whole scene's when `world`")
      .template member<&Map::world>("world", "",
                                    "whether the projection stands still in the scene; else it is fixed to the object");
}

}  // namespace etendue
