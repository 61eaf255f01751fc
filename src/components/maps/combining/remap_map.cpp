// RemapMap: maps one range of a map's values linearly to another range.

#include "combination.h"

namespace etendue {
namespace {

class RemapMap final : public ObjectMap, public BoundedMap {
 public:
  static void describe(Description<RemapMap>& d) {
    d.summary("A map of which one range of values is laid onto another, wavelength by wavelength.")
        .member<&RemapMap::input>("input", "1", "the map")
        .member<&RemapMap::from>("from", "1", "two values of the map …")
        .member<&RemapMap::to>("to", "1", "… and what they become; others in proportion")
        .member<&RemapMap::clamped>("clamped", "", "whether values outside of `from` become the nearer end of `to`");
  }

  void prepare() override {
    if (!input) fail("input", "a map is needed");
    if (!(std::isfinite(from.x) && std::isfinite(from.y) && from.x != from.y))
      fail("from", "two different, finite numbers are needed");
    if (!(std::isfinite(to.x) && std::isfinite(to.y))) fail("to", "must be finite numbers");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    return as_used(map(input->color(p, w, use), [this](float x) { return remapped(x); }), use);
  }
  float scalar(const SurfacePoint& p) const override { return remapped(input->scalar(p)); }
  float bound() const override { return clamped ? std::max(std::abs(to.x), std::abs(to.y)) : infinity; }

  Ref<ObjectMap> input = etendue::constant(0);
  Vector2 from{0, 1}, to{0, 1};
  bool clamped = true;

 private:
  float remapped(float x) const {
    float t = (x - from.x) / (from.y - from.x);
    if (clamped) t = clamp(t, 0, 1);
    const float y = lerp(t, to.x, to.y);
    return std::isfinite(y) ? y : 0;
  }
};

const Register<RemapMap> registered;

}  // namespace
}  // namespace etendue
