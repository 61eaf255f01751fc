// NormalMapShader: normals from an image.

#include <cmath>

#include "components/maps/rgb_source.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/core/error.h"
#include "images/linear_image.h"
#include "perturbed_normal.h"

namespace etendue {
namespace {

// An image of normals in the surface's tangent frame: red, green and blue in [0, 1] are x, y and z in [-1, 1], x along the
// direction in which u grows, y perpendicular to it on the side to which v grows (or, by `green`, always to the left of it), z
// along the shading normal (Cohen et al. 1998, "Appearance-preserving simplification"). Its raw numbers are read: a map of
// colours would convert them to spectra, from which the three components cannot be recovered.
//
// Between texels the vectors are interpolated linearly. They are not filtered over the pixel's footprint: the mean of tilted
// normals is a flat surface, which does not look like a rough one. Instead, the radiance for each normal is averaged by the
// samples of a pixel.
class NormalMapShader final : public PerturbedNormalShader {
 public:
  static void describe(Description<NormalMapShader>& d) {
    d.summary(
         "Tilts the normal that shading uses by an image of normals in the surface's frame, laid over the surface coordinates "
         "like that of an ImageMap, or by a map.",
         "Cohen, Olano & Manocha 1998, Appearance-preserving simplification")
        .member<&NormalMapShader::shader>("shader", "", "the surface that gets the normals", required)
        .group("Image")
        .member<&NormalMapShader::file>(
            "file", "", "the image: red, green, blue in [0, 1] are x (along u), y (along v), z in [-1, 1]; none: `map`")
        .member<&NormalMapShader::map>(
            "map", "1",
            "instead, a map that holds such red, green and blue: an ImageMap (mostly with transfer linear), an AttributeMap, "
            "or one of these below a UvTransformMap",
            Meaning::number, unless("file"))
        .member<&NormalMapShader::transfer>("transfer", "",
                                            "how the image's numbers are encoded; nearly all images of normals are linear",
                                            image_transfer_names(), when("file"))
        .member<&NormalMapShader::repeat>("repeat", "1", "how many times the image is laid along u and along v", when("file"))
        .group("Tilt")
        .member<&NormalMapShader::strength>(
            "strength", "1", "multiplies the tilt: 0 is flat, 1 as in the image; negative, it tilts the other way", soft(0, 2))
        .member<&NormalMapShader::green>(
            "green", "",
            "along which axis green tilts; v: to the side on which v grows, as glTF and most programs have it; across: to the "
            "left of u, seen from the front (the cross product of the shading normal and the direction of u), as Mitsuba and "
            "pbrt have it. They differ where coordinates run mirrored over the surface",
            choices("v", "across"))
        .member<&NormalMapShader::flip_y>("flip_y", "", "whether green tilts the other way, as in images made for DirectX");
    describe_slopes(d);
  }

  void prepare() override {
    if (!shader) fail("shader", "a shader is needed");
    if (file.empty() && !map) fail("file", "an image file is needed, or a map");
    if (!std::isfinite(strength)) fail("strength", "must be a finite number");
    if (!(std::isfinite(repeat.x) && std::isfinite(repeat.y))) fail("repeat", "must be finite numbers");
    source_ = nullptr;
    if (file.empty()) {
      source_ = rgb_source(*map);
      if (!source_) fail("map", "a " + map->class_info().name + " cannot tell red, green and blue as they are");
      return;
    }
    try {
      const LinearImage image = read_linear_image(file.resolved(), transfer);
      width_ = image.width;
      height_ = image.height;
      texels_.resize(image.rgb.size());
      for (size_t i = 0; i < texels_.size(); ++i) {
        const float x = image.rgb[i];
        texels_[i] = std::uint16_t(std::lround(65535 * (x > 0 ? std::min(x, 1.0f) : 0)));
      }
    } catch (const Error& e) {
      fail("file", e.what());
    }
    if (width_ < 1 || height_ < 1) fail("file", "the image is empty");
  }

  FilePath file;
  Ref<ObjectMap> map;
  float strength = 1;
  enum class Green : std::uint8_t { v, across } green = Green::v;
  bool flip_y = false;
  std::string transfer = "linear";
  Vector2 repeat{1, 1};

 protected:
  Vector3 tilted(const SurfacePoint& p) const override {
    Vector3 v = source_ ? ask(p) : look_up(p.uv.x * repeat.x, p.uv.y * repeat.y);
    v.x *= strength;
    v.y *= flip_y ? -strength : strength;
    v.z = std::max(v.z, 1e-3f);
    Frame frame = tangent_frame(p);
    if (green == Green::v && dot(frame.t, p.dpdv) < 0) frame.t = -frame.t;  // mirrored coordinates: v grows to the other side
    return frame.to_world(v);
  }

 private:
  Vector3 ask(SurfacePoint p) const {
    p.footprint = 0;  // not filtered, see above
    float c[3];
    source_->rgb(p, c);
    const Vector3 v{2 * c[0] - 1, 2 * c[1] - 1, 2 * c[2] - 1};
    return is_finite(v) ? v : Vector3{0, 0, 1};
  }

  /// Bilinear between texel centres, repeated; row 0 of the image is at v = 1.
  Vector3 look_up(float u, float v) const {
    const float x = (u - std::floor(u)) * float(width_) - 0.5f, y = (1 - (v - std::floor(v))) * float(height_) - 0.5f;
    if (!(std::isfinite(x) && std::isfinite(y))) return {0, 0, 1};
    const float column = std::floor(x), row = std::floor(y), a = x - column, b = y - row;
    const int x0 = wrap(int(column), width_), x1 = wrap(int(column) + 1, width_);
    const int y0 = wrap(int(row), height_), y1 = wrap(int(row) + 1, height_);
    const Vector3 above = (1 - a) * texel(x0, y0) + a * texel(x1, y0), below = (1 - a) * texel(x0, y1) + a * texel(x1, y1);
    return (1 - b) * above + b * below;
  }
  static int wrap(int i, int count) { return i < 0 ? i + count : (i >= count ? i - count : i); }
  Vector3 texel(int x, int y) const {
    const std::uint16_t* t = texels_.data() + 3 * (size_t(y) * size_t(width_) + size_t(x));
    const auto decoded = [](std::uint16_t c) { return float(c) * (2.0f / 65535) - 1; };
    return {decoded(t[0]), decoded(t[1]), decoded(t[2])};
  }

  // Sixteen bits are enough for the precision of normal maps; floats would take twice the memory.
  std::vector<std::uint16_t> texels_;
  int width_ = 0, height_ = 0;
  const RgbSource* source_ = nullptr;  // of `map`, when there is no file
};

const Register<NormalMapShader> registered;

}  // namespace
}  // namespace etendue
