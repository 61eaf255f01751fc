// ReadAsMap: evaluates a map with a given ColorUse, whatever the ColorUse of the caller.

#include "components/maps/combining/combination.h"
#include "components/volumes/bounded_map.h"
#include "etendue/object_map.h"

namespace etendue {
namespace {

// RGB is converted to a spectrum according to the ColorUse that the caller passes (docs/decisions/003). Files of other programs
// sometimes mean another use: an image as light whose white is constant over wavelengths and not the white of its colour space.
class ReadAsMap final : public ObjectMap, public BoundedMap {
 public:
  static void describe(Description<ReadAsMap>& d) {
    d.summary(
         "A map whose RGB is read as something else than what it is asked for. As a coefficient, light has RGB without the "
         "white of its colour space: equal parts are the same at every wavelength.")
        .member<&ReadAsMap::map>("map", "1", "the map")
        .member<&ReadAsMap::use>("as", "",
                                 "what its RGB becomes; reflectance: a spectrum within [0, 1]; radiance: light of the colour "
                                 "space's white; coefficient: any number per wavelength",
                                 choices("reflectance", "radiance", "coefficient"));
  }

  void prepare() override {
    if (!map) fail("map", "a map is needed");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse asked) const override {
    return as_used(map->color(p, w, use), asked);
  }
  float scalar(const SurfacePoint& p) const override { return map->scalar(p); }
  float largest() const override { return map->largest(); }
  float bound() const override { return use == ColorUse::coefficient ? bound_of(*map) : infinity; }

  Ref<ObjectMap> map = etendue::constant(1);
  ColorUse use = ColorUse::coefficient;
};

const Register<ReadAsMap> registered;

}  // namespace
}  // namespace etendue
