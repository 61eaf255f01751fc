// Maps with one fault each, which `etendue conform` must find.

#include "etendue/object_map.h"
#include "etendue/scene_object.h"

namespace etendue {
namespace {

class UnboundedMap final : public ObjectMap {
 public:
  static void describe(Description<UnboundedMap>& d) {
    d.summary("Stripes whose reflectance leaves [0, 1], and is not a number along a line.")
        .member<&UnboundedMap::scale>("scale", "1", "how strong", range(1, 10));
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths&, ColorUse) const override { return scalar(p); }
  float scalar(const SurfacePoint& p) const override { return scale * std::sqrt(p.uv.x - 0.05f); }

  float scale = 4;
};
const Register<UnboundedMap> map;

/// Stripes of a period of 1 m along x and y, from 0 to 1.
float stripes(float x, float y) { return 0.5f + 0.5f * std::sin(2 * pi * (x + y)); }

class CameraSpaceMap final : public ObjectMap {
 public:
  static void describe(Description<CameraSpaceMap>& d) {
    d.summary("Stripes through rendering space, whose origin is near the camera.");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths&, ColorUse) const override { return scalar(p); }
  float scalar(const SurfacePoint& p) const override { return stripes(p.position.x, p.position.y); }
};
const Register<CameraSpaceMap> camera_space;

class OneSpaceMap final : public ObjectMap {
 public:
  enum class Space { object, world };
  static void describe(Description<OneSpaceMap>& d) {
    d.summary("Stripes that stay in the world even if they should follow the object.")
        .member<&OneSpaceMap::space>("space", "", "where the stripes are", choices("object", "world"));
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths&, ColorUse) const override { return scalar(p); }
  float scalar(const SurfacePoint& p) const override {
    const DoublePoint3 at = world_position(p);
    return stripes(float(at.x), float(at.y));
  }

  Space space = Space::object;
};
const Register<OneSpaceMap> one_space;

class OtherSpaceMap final : public ObjectMap {
 public:
  static void describe(Description<OtherSpaceMap>& d) {
    d.summary("Stripes that follow the object though they should stay in the world.")
        .member<&OtherSpaceMap::world>("world", "", "whether the stripes are in the world");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths&, ColorUse) const override { return scalar(p); }
  float scalar(const SurfacePoint& p) const override { return stripes(p.object_position.x, p.object_position.y); }

  bool world = true;
};
const Register<OtherSpaceMap> other_space;

class WithoutTangentsMap final : public ObjectMap {
 public:
  static void describe(Description<WithoutTangentsMap>& d) {
    d.summary("Stripes that fade with the footprint's width in u, of a point whose tangents are expected to be set.");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths&, ColorUse) const override { return scalar(p); }
  float scalar(const SurfacePoint& p) const override {
    const float wide = length(p.dpdu), width = p.footprint > 0 && wide > 0 ? p.footprint / wide : 0;
    return lerp(std::min(width, 1.0f), stripes(p.uv.x, 0), 0.5f);
  }
};
const Register<WithoutTangentsMap> without_tangents;

}  // namespace
}  // namespace etendue
