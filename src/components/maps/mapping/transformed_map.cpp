// TransformedMap: evaluates a map as if the surface were transformed.

#include "components/volumes/bounded_map.h"
#include "geometry/geometry.h"
#include "mapping.h"

namespace etendue {
namespace {

// All members of the surface point are transformed, in object space and in rendering space: positions, tangents and the axes of
// the footprint by the transform, normals by its inverse transpose. So the map returns what it would return on an object of the
// transformed shape and position. The surface coordinates (u, v) are not changed.
class TransformedMap final : public ObjectMap, public BoundedMap {
 public:
  static void describe(Description<TransformedMap>& d) {
    d.summary("Looks another map up as if the surface were moved: its textures through space move the other way.")
        .member<&TransformedMap::map>("map", "1", "the map")
        .member<&TransformedMap::transform>("transform", "", "moves the surface before the map is looked up")
        .member<&TransformedMap::world>("world", "",
                                        "whether it moves in the coordinates of the whole scene; else in the object's own");
  }

  void prepare() override {
    if (!map) fail("map", "a map is needed");
    if (!transform.valid()) fail("transform", "must be invertible");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    return map->color(moved(p), w, use);
  }
  float scalar(const SurfacePoint& p) const override { return map->scalar(moved(p)); }
  float bound() const override { return bound_of(*map); }

  Ref<ObjectMap> map = etendue::constant(0.5f);
  AnimatedTransform transform;
  bool world = false;

 private:
  /// A transform of world space, expressed in rendering space with the given origin.
  Transform in_rendering_space(const DoublePoint3& rendering_origin, float time) const {
    AnimatedTransform shifted = transform.written(time);
    shifted.set_origins(rendering_origin, rendering_origin);
    return shifted.still();
  }

  SurfacePoint moved(const SurfacePoint& point) const {
    SurfacePoint p = point;
    with_tangents(p);
    const Footprint seen = footprint_of(p);
    Transform scratch, place_scratch;
    const bool far = world && p.object && p.object->rendering_origin() != DoublePoint3{};
    if (far) scratch = in_rendering_space(p.object->rendering_origin(), p.time);
    const Transform& t = far ? scratch : placed(transform, p.time, scratch);
    const Transform& place = placement(point, place_scratch);
    // Transform a vector, a normal or a position: `outside` one in rendering space, `inside` one in object space.
    const auto outside = [&](const auto& x) { return world ? t(x) : place(t(place.back(x))); };
    const auto inside = [&](const auto& x) { return world ? place.back(t(place(x))) : t(x); };
    const auto normal_outside = [&](const Normal3& n) { return normalize(world ? t(n) : place(t(normal_into(place, n)))); };
    p.position = outside(p.position);
    p.object_position = inside(p.object_position);
    p.normal = normal_outside(p.normal);
    p.shading_normal = normal_outside(p.shading_normal);
    p.object_normal = normalize(world ? normal_into(place, t(place(p.object_normal))) : t(p.object_normal));
    const float area = length(cross(p.dpdu, p.dpdv));
    p.dpdu = outside(p.dpdu);
    p.dpdv = outside(p.dpdv);
    if (area > 0) p.error *= std::sqrt(length(cross(p.dpdu, p.dpdv)) / area);
    if (p.footprint > 0)
      set_footprint(p, {outside(seen.longer), outside(seen.shorter)});
    else if (p.ray_direction != Vector3{})
      p.ray_direction = normalize(outside(p.ray_direction));
    return p;
  }
};

const Register<TransformedMap> registered;

}  // namespace
}  // namespace etendue
