#pragma once
// Base class and helpers of maps that evaluate another map at changed surface coordinates.

#include "components/maps/footprint.h"
#include "etendue/object_map.h"

namespace etendue {

/// Surface coordinates computed from a point in space, and their gradients with respect to this point.
struct Projected {
  Point2 uv;
  Vector3 gradient_u, gradient_v;  ///< [1/m]
};

/// Sets a point's surface coordinates and the corresponding tangents: dpdu and dpdv are the steps in the surface that change
/// one coordinate by 1 and keep the other. Gradients are in rendering space.
void set_uv(SurfacePoint&, const Projected&);

/// u = atan2(y, x) / (2 pi) in [0, 1), and its gradient.
float turn_around_z(const Vector3&, Vector3& gradient);

/// Evaluates a map at surface coordinates that are computed by a projection from space.
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
  /// (u, v) and gradients at a point, all in the coordinates of the projection.
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
