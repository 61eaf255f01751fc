// RgbProductMap: the product of two maps in RGB, before it is converted to a spectrum.

#include <algorithm>

#include "components/maps/rgb_source.h"
#include "etendue/describe/color.h"

namespace etendue {
namespace {

// In formats that compute in RGB (glTF, MTL, UsdPreviewSurface) "a factor times a texture" means r = f_r * a_r * b_r + g_r. A
// spectrum made from this product has the product's colour. The product of the three spectra has this colour only if they are
// grey, since the RGB of a product of spectra is not the product of their RGB.
class RgbProductMap final : public ObjectMap, public RgbSource {
 public:
  static void describe(Description<RgbProductMap>& d) {
    d.summary(
         "A product of maps that hold red, green and blue, number by number, of which the spectrum is made then: what other "
         "programs mean by a colour times a texture. MultiplyMap multiplies the spectra instead.")
        .group("Factors")
        .member<&RgbProductMap::first>("first", "1",
                                       "a map of red, green and blue: an image, colours of vertices, one of these moved, a "
                                       "product of them, or one colour; any other map counts as a grey, by its number")
        .member<&RgbProductMap::second>("second", "1", "another in the same way")
        .member<&RgbProductMap::factor>("factor", "1", "what red, green and blue are multiplied by")
        .member<&RgbProductMap::offset>("offset", "1", "what is added to red, green and blue then; nothing gets below 0")
        .group("Meaning")
        .member<&RgbProductMap::color_space>("color_space", "", "primaries and white of the product", rgb_space_names());
  }

  void prepare() override {
    space_ = &rgb_space(color_space);
    if (!first) fail("first", "a map is needed");
    if (!second) fail("second", "a map is needed");
    first_.take(*first, *space_);
    second_.take(*second, *space_);
    for (const auto& [values, name] : {std::pair{factor, "factor"}, {offset, "offset"}})
      if (!(std::isfinite(values.x) && std::isfinite(values.y) && std::isfinite(values.z)))
        fail(name, "must be finite numbers");
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    float c[3];
    rgb(p, c);
    return rgb_spectrum(*space_, c[0], c[1], c[2], use, w);
  }
  float scalar(const SurfacePoint& p) const override {
    float c[3];
    rgb(p, c);
    return (c[0] + c[1] + c[2]) / 3;
  }
  std::string rgb_space_name() const override { return color_space; }
  void rgb(const SurfacePoint& p, float out[3]) const override {
    float other[3];
    first_.look_up(p, out);
    second_.look_up(p, other);
    for (int i = 0; i < 3; ++i) {
      const float x = out[i] * other[i] * factor[i] + offset[i];
      out[i] = x > 0 ? x : 0;
    }
  }
  /// 0 (not known) if the largest number of one of the two maps is not known.
  float largest() const override {
    const float most = first_.largest() * second_.largest() * std::max({factor.x, factor.y, factor.z, 0.0f});
    return most > 0 && std::isfinite(most) ? most + std::max({offset.x, offset.y, offset.z, 0.0f}) : 0;
  }

  Ref<ObjectMap> first = etendue::constant(1), second = etendue::constant(1);
  Vector3 factor{1, 1, 1}, offset{0, 0, 0};
  std::string color_space = "srgb";

 private:
  /// One of the two maps, evaluated as RGB: from its RgbSource, its constant colour, or its number as a grey.
  class Part {
   public:
    void take(const ObjectMap& map, const RgbSpace& space) {
      map_ = &map;
      source_ = rgb_source(map);
      const Color same = source_ ? nullptr : map.constant();
      is_constant_ = same != nullptr;
      if (!same) return;
      if (!same->varies()) {
        std::fill_n(constant_, 3, same->at(550, ColorUse::coefficient));
        return;
      }
      // The RGB of a colour in this space: that of the colour as a reflectance under the space's white.
      const Xyz xyz = to_xyz(*same, ColorUse::reflectance, space.illuminant.get());
      for (size_t i = 0; i < 3; ++i)
        constant_[i] = float(space.from_xyz[3 * i] * double(xyz.x) + space.from_xyz[3 * i + 1] * double(xyz.y) +
                             space.from_xyz[3 * i + 2] * double(xyz.z));
    }
    void look_up(const SurfacePoint& p, float out[3]) const {
      if (source_)
        source_->rgb(p, out);
      else if (is_constant_)
        std::copy_n(constant_, 3, out);
      else
        out[0] = out[1] = out[2] = map_->scalar(p);
    }
    float largest() const {
      if (is_constant_) return std::max({constant_[0], constant_[1], constant_[2], 0.0f});
      return map_->largest();
    }

   private:
    const ObjectMap* map_ = nullptr;
    const RgbSource* source_ = nullptr;
    bool is_constant_ = false;
    float constant_[3] = {};
  };

  const RgbSpace* space_ = nullptr;
  Part first_, second_;
};

const Register<RgbProductMap> registered;

}  // namespace
}  // namespace etendue
