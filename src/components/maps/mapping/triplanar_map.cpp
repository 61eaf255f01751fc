// Projections along three axes.

#include "geometry/geometry.h"
#include "mapping.h"

namespace etendue {
namespace {

// The three projections are weighted by |n_x|^s, |n_y|^s and |n_z|^s of the shading normal. A projection is flipped where the
// normal points along the negative axis, so that the map never appears mirrored from outside.
class TriplanarMap final : public ObjectMap {
 public:
  static void describe(Description<TriplanarMap>& d) {
    d.summary("Projects a map along the x, y and z axes, blended by the normal; u and v are in metres.")
        .member<&TriplanarMap::map>("map", "1", "the map over the surface coordinates that the projections give")
        .member<&TriplanarMap::size>("size", "m", "how long a unit of u and v is", more_than(0), soft(0.01, 100), logarithmic)
        .member<&TriplanarMap::sharpness>("sharpness", "1", "how quickly one projection takes over from another", range(1, 64),
                                          logarithmic)
        .member<&TriplanarMap::world>("world", "",
                                      "whether the projections stand still in the scene; else they are fixed to the object");
  }

  void prepare() override {
    if (!map) fail("map", "a map is needed");
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    Spectrum sum;
    blend(p, [&](const SurfacePoint& q, float weight) { sum += weight * map->color(q, w, use); });
    return sum;
  }
  float scalar(const SurfacePoint& p) const override {
    float sum = 0;
    blend(p, [&](const SurfacePoint& q, float weight) { sum += weight * map->scalar(q); });
    return sum;
  }

  Ref<ObjectMap> map = etendue::constant(0.5f);
  float size = 1, sharpness = 4;
  bool world = false;

 private:
  template <class Use>
  void blend(const SurfacePoint& p, Use use) const {
    Transform scratch;
    const Transform still, &t = world ? still : placement(p, scratch);
    const Vector3 n(normalize(normal_into(t, p.shading_normal)));
    const Point3 at = world ? Point3(world_position(p)) : p.object_position;
    const float s = 1 / size;
    float weights[3];
    for (int axis = 0; axis < 3; ++axis) weights[axis] = std::pow(std::abs(n[axis]), sharpness);
    const float total = weights[0] + weights[1] + weights[2];
    SurfacePoint q = p;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(weights[axis] > 1e-3f * total)) continue;
      const int i = axis == 0 ? 1 : 0, k = axis == 2 ? 1 : 2;  // upright: z is up on the sides
      const float sign = (n[axis] < 0) != (axis == 1) ? -s : s;
      Normal3 u, v;
      (i == 0 ? u.x : u.y) = sign;
      (k == 1 ? v.y : v.z) = s;
      set_uv(q, {{sign * at[i], s * at[k]}, Vector3(t(u)), Vector3(t(v))});
      use(q, weights[axis] / total);
    }
  }
};

const Register<TriplanarMap> registered;

}  // namespace
}  // namespace etendue
