// A map over changed surface coordinates.

#include "components/maps/rgb_source.h"
#include "mapping.h"

namespace etendue {
namespace {

// (u', v') = A (u, v) + b. The tangents follow by the inverse: dp/du' = dp/du du/du' + dp/dv dv/du'.
class UvTransformMap final : public ObjectMap, public RgbSource {
 public:
  static void describe(Description<UvTransformMap>& d) {
    d.summary("Looks another map up at surface coordinates that are scaled, then turned, then shifted.")
        .member<&UvTransformMap::map>("map", "1", "the map")
        .member<&UvTransformMap::scale>("scale", "1", "factors of u and v")
        .member<&UvTransformMap::angle>("angle", "deg", "angle from u towards v by which coordinates are turned around (0, 0)")
        .member<&UvTransformMap::shift>("shift", "1", "what is added to u and v");
  }

  void prepare() override {
    if (!map) fail("map", "a map is needed");
    if (!(std::isfinite(scale.x) && std::isfinite(scale.y) && scale.x != 0 && scale.y != 0))
      fail("scale", "must be finite numbers other than 0");
    if (!std::isfinite(angle)) fail("angle", "must be finite");
    if (!(std::isfinite(shift.x) && std::isfinite(shift.y))) fail("shift", "must be finite numbers");
    cosine_ = std::cos(radians(angle));
    sine_ = std::sin(radians(angle));
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    return map->color(changed(p), w, use);
  }
  float scalar(const SurfacePoint& p) const override { return map->scalar(changed(p)); }
  bool has_rgb() const override { return map && rgb_source(*map); }
  std::string rgb_space_name() const override { return rgb_source(*map)->rgb_space_name(); }
  void rgb(const SurfacePoint& p, float out[3]) const override { rgb_source(*map)->rgb(changed(p), out); }

  Ref<ObjectMap> map = etendue::constant(0.5f);
  Vector2 scale{1, 1}, shift{0, 0};
  float angle = 0;

 private:
  SurfacePoint changed(const SurfacePoint& point) const {
    SurfacePoint p = point;
    with_tangents(p);
    const float u = scale.x * p.uv.x, v = scale.y * p.uv.y;
    p.uv = {cosine_ * u - sine_ * v + shift.x, sine_ * u + cosine_ * v + shift.y};
    const Vector3 a = p.dpdu / scale.x, b = p.dpdv / scale.y;
    p.dpdu = cosine_ * a - sine_ * b;
    p.dpdv = sine_ * a + cosine_ * b;
    return p;
  }

  float cosine_ = 1, sine_ = 0;
};

const Register<UvTransformMap> registered;

}  // namespace
}  // namespace etendue
