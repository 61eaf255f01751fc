// GoniometricEmission: a point light whose intensity in every direction is given by an image.

#include "etendue/core/warp.h"
#include "geometry/equal_area_square.h"
#include "images/linear_image.h"
#include "shaped_emission.h"
#include "texel_distribution.h"

namespace etendue {
namespace {

constexpr double exact_pi = 3.14159265358979323846;

// The profile f (ShapedEmission) is the image's value in a direction, times `scale`: a point's intensity is M f * 1 m^2, and
// Omega = integral of f dw is the sum of all texels' values times their weights (weight_of).
//
// Directions are sampled with a pdf that is constant over each texel. With nearest interpolation the pdf is proportional to the
// texel's value, so that f / pdf is the same everywhere. With bilinear interpolation it is proportional to the mean of the
// value over the texel, computed as if the texel's neighbours had its size: a hat function's mean over its own texel is 3/4,
// over each neighbour 1/8, in both dimensions; the mean is positive wherever the value is. Within a texel of the equal-area
// layout the position in the square is uniform, which is uniform in solid angle; within a texel of the lat_long layout,
// longitude and cos(theta) are uniform.
class GoniometricEmission final : public ShapedEmission {
 public:
  static void describe(Description<GoniometricEmission>& d) {
    d.summary(
         "The light of a Point whose intensity depends on the direction as an image says, as a goniophotometer measures it: "
         "grey, or "
         "the mean of its channels.",
         "Pharr, Jakob & Humphreys, Physically Based Rendering, section 12.2.3 (fourth edition)")
        .group("Light")
        .member<&GoniometricEmission::file>(
            "file", "", "the image of all directions that light leaves in, in the object's own coordinates", required)
        .member<&GoniometricEmission::map>(
            "radiance", "W m^-2 sr^-1 nm^-1",
            "what the image multiplies; of a Point, its intensity [W sr^-1 nm^-1] where the image "
            "is 1",
            Meaning::radiance, soft(0.01, 1000), logarithmic)
        .member<&GoniometricEmission::image_scale>("scale", "1", "multiplies the image", at_least(0), soft(0.01, 100),
                                                   logarithmic, unless("power"), unless("luminous_flux"),
                                                   unless("luminous_intensity"), unless("illuminance"));
    describe_amounts(d);
    d.group("Image")
        .member<&GoniometricEmission::layout>("layout", "",
                                              "how directions lie in the image; lat_long: in longitude and latitude, with its "
                                              "middle towards +z, its top towards +y, "
                                              "the middle of its left half towards +x; equal_area: in a square whose pixels "
                                              "all have the same solid angle, with +y "
                                              "in the middle, -y in the corners, +x at the right and -z below",
                                              choices("lat_long", "equal_area"))
        .member<&GoniometricEmission::interpolation>(
            "interpolation", "",
            "what is between the middles of texels: nearest: texels as squares; bilinear: mixtures of four",
            choices("nearest", "bilinear"))
        .member<&GoniometricEmission::transfer>(
            "transfer", "", "how its numbers are encoded; auto: srgb for integers, linear for floats", image_transfer_names());
  }

  void prepare() override {
    read();
    build();
    prepare_amounts("radiance");
    if (!(omega_ > 0) && amount_asked()) fail("file", "'" + file.resolved() + "' is black");
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    if (!emits(p, direction)) return {};
    const float f = profile(p, direction);
    return f > 0 ? scaled(p, w, f) : Spectrum();
  }

  // A part of the light may lie on a side that does not emit: samples of this part have pdf 0.
  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    if (!(texels_.total() > 0)) return {{0, 0, 1}, 0};
    const auto [x, y, within, drawn] = texels_.choose(u);
    const double u01 = (double(x) + double(within.x)) / double(width_), v01 = (double(y) + double(within.y)) / double(height_);
    Vector3 local;
    if (layout == Layout::equal_area) {
      const SquareDirection d = equal_area_direction({u01, v01});
      local = {float(d.x), float(d.z), float(-d.y)};
    } else {
      const double top = std::cos(exact_pi * double(y) / double(height_)),
                   bottom = std::cos(exact_pi * double(y + 1) / double(height_)),
                   cosine = std::lerp(top, bottom, double(within.y)), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine)),
                   phi = 2 * exact_pi * u01;
      local = {float(sine * std::sin(phi)), float(cosine), float(-sine * std::cos(phi))};
    }
    const Vector3 direction = frame(p).to_world(normalize(local));
    return {direction, pdf(p, direction)};  // evaluated anew: at a texel's border rounding may move it into the next texel
  }
  float pdf(const SurfacePoint& p, const Vector3& direction) const override {
    if (!(texels_.total() > 0) || !emits(p, direction)) return 0;
    const SquarePlace at = place(frame(p).to_local(direction));
    return texels_.pdf(column(at.x), row(at.y));
  }

  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    if (object.infinite()) fail("file", "such light belongs on a Point or on a surface, not at infinity");
    return ShapedEmission::power(object, w);
  }

  FilePath file;
  float image_scale = 1;
  enum class Layout : std::uint8_t { lat_long, equal_area };
  Layout layout = Layout::lat_long;
  enum class Interpolation : std::uint8_t { nearest, bilinear };
  Interpolation interpolation = Interpolation::bilinear;
  std::string transfer = automatic_transfer;

 protected:
  float profile(const SurfacePoint& p, const Vector3& direction) const override {
    const SquarePlace at = place(frame(p).to_local(direction));
    return factor() * (interpolation == Interpolation::nearest ? texel(int(column(at.x)), int(row(at.y))) : bilinear(at));
  }
  double solid_angle() const override { return double(factor()) * omega_; }
  /// K over the emitting sides, by quadrature with 64 x 64 directions.
  double surface_share(const SurfacePoint& p) const override {
    constexpr int steps = 64;
    double sum = 0;
    for (int i = 0; i < steps * steps; ++i) {
      const Vector3 d = warp::sphere({(float(i % steps) + 0.5f) / steps, (float(i / steps) + 0.5f) / steps});
      if (emits(p, d)) sum += double(profile(p, d) * std::abs(dot(p.normal, d)));
    }
    return sum * 4 * exact_pi / (steps * steps);
  }

 private:
  float factor() const { return amount_asked() ? 1 : image_scale; }

  void read() {
    LinearImage image;
    try {
      image = read_linear_image(file.resolved(), transfer);
    } catch (const Error& e) {
      fail("file", e.what());
    }
    width_ = size_t(image.width);
    height_ = size_t(image.height);
    if (layout == Layout::equal_area && width_ != height_)
      fail("file", fmt::format("an image of directions in equal areas is a square, not {} x {}", width_, height_));
    values_.resize(width_ * height_);
    size_t negative = 0;
    for (size_t i = 0; i < values_.size(); ++i) {
      const float value = (image.rgb[3 * i] + image.rgb[3 * i + 1] + image.rgb[3 * i + 2]) / 3;
      if (!std::isfinite(value)) fail("file", "'" + file.resolved() + "' holds values that are infinite or not a number");
      negative += value < 0;
      values_[i] = std::max(value, 0.0f);
    }
    if (negative)
      warn(fmt::format("'{}' holds {} negative values, which are taken as 0", file.resolved(), negative), location_of("file"));
  }

  void build() {
    std::vector<float> importance = values_;
    if (interpolation == Interpolation::bilinear)
      for (size_t y = 0; y < height_; ++y)
        for (size_t x = 0; x < width_; ++x) {
          float sum = 0;
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
              sum += (dx ? 0.125f : 0.75f) * (dy ? 0.125f : 0.75f) * texel(int(x) + dx, int(y) + dy);
          importance[y * width_ + x] = sum;
        }
    std::vector<double> solid_angles(height_, 4 * exact_pi / double(width_ * height_));
    if (layout == Layout::lat_long)
      for (size_t y = 0; y < height_; ++y)
        solid_angles[y] =
            2 * exact_pi / double(width_) *
            (std::cos(exact_pi * double(y) / double(height_)) - std::cos(exact_pi * double(y + 1) / double(height_)));
    omega_ = 0;
    for (size_t i = 0; i < values_.size(); ++i) omega_ += double(values_[i]) * weight_of(i / width_, solid_angles);
    texels_.build(importance, width_, solid_angles);
  }

  /// The weight of a texel's value in the integral over all directions [sr]. With nearest interpolation it is the texel's solid
  /// angle, and also with bilinear interpolation in the equal-area layout, where all texels have the same solid angle. Rows of
  /// the lat_long layout differ in solid angle. Between the centres of rows, delta apart, bilinear values are linear in theta:
  /// int hat(theta) sin(theta) dtheta = 2 sin(theta_y) (1 - cos(delta)) / delta about the centre theta_y of a row; for the
  /// outermost row, whose value is constant from its centre to the pole, 1 - (sin(3 delta / 2) - sin(delta / 2)) / delta.
  double weight_of(size_t row, const std::vector<double>& solid_angles) const {
    if (layout != Layout::lat_long || interpolation != Interpolation::bilinear) return solid_angles[row];
    const double delta = exact_pi / double(height_), across = 2 * exact_pi / double(width_);
    if (height_ == 1) return 2 * across;
    if (row == 0 || row + 1 == height_) return across * (1 - (std::sin(1.5 * delta) - std::sin(0.5 * delta)) / delta);
    return across * 2 * std::sin((double(row) + 0.5) * delta) * (1 - std::cos(delta)) / delta;
  }

  /// The object's axes in world space, orthonormalized. For a mirrored object the frame is left-handed.
  static Frame frame(const SurfacePoint& p) {
    const Vector3 y = turned(p, {0, 1, 0});
    Vector3 x = turned(p, {1, 0, 0});
    x = normalize(x - dot(x, y) * y);
    const Vector3 z = cross(x, y);
    return {x, y, Normal3(dot(z, turned(p, {0, 0, 1})) < 0 ? -z : z)};
  }

  SquarePlace place(const Vector3& d) const {
    if (layout == Layout::equal_area) return equal_area_place({double(d.x), -double(d.z), double(d.y)});
    const double u = std::atan2(double(d.x), -double(d.z)) / (2 * exact_pi);
    return {u < 0 ? u + 1 : u, std::atan2(std::hypot(double(d.x), double(d.z)), double(d.y)) / exact_pi};
  }
  size_t column(double u) const { return std::min(size_t(u * double(width_)), width_ - 1); }
  size_t row(double v) const { return std::min(size_t(v * double(height_)), height_ - 1); }

  /// The value of a texel. Beyond the image, longitudes wrap around, latitudes are clamped, and the equal-area square is
  /// folded.
  float texel(int x, int y) const {
    const int w = int(width_), h = int(height_);
    if (layout == Layout::equal_area) {
      fold_equal_area(x, y, w);
    } else {
      x = x < 0 ? x + w : x >= w ? x - w : x;
      y = std::clamp(y, 0, h - 1);
    }
    return values_[size_t(y) * width_ + size_t(x)];
  }
  float bilinear(const SquarePlace& at) const {
    const double x = at.x * double(width_) - 0.5, y = at.y * double(height_) - 0.5;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    const float fx = float(x - x0), fy = float(y - y0);
    return lerp(fy, lerp(fx, texel(x0, y0), texel(x0 + 1, y0)), lerp(fx, texel(x0, y0 + 1), texel(x0 + 1, y0 + 1)));
  }

  size_t width_ = 1, height_ = 1;
  std::vector<float> values_;
  TexelDistribution texels_;  // in proportion to the value, or its mean over the texel, times the solid angle
  double omega_ = 0;          // the integral of the image [sr]
};

const Register<GoniometricEmission> registered;

}  // namespace
}  // namespace etendue
