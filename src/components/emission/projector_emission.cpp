// ProjectorEmission: an image or a map, projected through a pinhole.

#include "direction_table.h"
#include "etendue/describe/color.h"
#include "etendue/describe/registry.h"
#include "images/linear_image.h"
#include "shaped_emission.h"

namespace etendue {
namespace {

// The image lies on a plane perpendicular to the axis at distance 1, w wide and h high. A direction at the angle theta to the
// axis intersects the plane at (x, y), with dA = dw / cos^3(theta). A screen perpendicular to the axis at distance d receives
// the irradiance I cos^3(theta) / d^2, so a projector that shows a white image as evenly white has the intensity
//     I(x, y) = scale rgb(x, y) / cos^3(theta)                                 [W sr^-1 nm^-1]
// as good projectors do. The profile (ShapedEmission; M is the colour space's white) is f = 1 / cos^3 within the image, and
// Omega = integral of f dw = w h, the image's area. A projector that is even over directions (pbrt's) has f = 1, and
// Omega = 4 atan(a b / sqrt(1 + a^2 + b^2)), with a and b half of w and h, the solid angle of the image.
//
// Importance sampling: a pdf that is constant over each pixel, in proportion to the mean over the pixel of the importance
// (luminance) of the bilinear image. The mean of a hat function over its own pixel is 3/4, over each neighbour 1/8, in both
// dimensions, so the mean is a 3 x 3 filter, positive wherever the image is. With the pdf p(x, y) per plane area the pdf per
// solid angle is p / cos^3 [1/sr], and I over this pdf is nearly constant.
class ProjectorEmission final : public ShapedEmission {
 public:
  static void describe(Description<ProjectorEmission>& d) {
    d.summary(
         "An image, projected through a pinhole: for a Point, whose transform turns it. In the object's own coordinates light "
         "leaves along +z, with the image's top towards +y and its right towards -x, as seen from behind; look_at() points it. "
         "On a screen across its axis a white image is evenly white. Outside of the image is no light.")
        .group("Image")
        .member<&ProjectorEmission::file>("file", "", "the image; none: `picture` is projected")
        .member<&ProjectorEmission::picture>(
            "picture", "1", "a map instead of an image file: its unit square is projected, (0, 0) at the lower left",
            Meaning::radiance, unless("file"))
        .member<&ProjectorEmission::aspect>("aspect", "1", "width over height of that picture", more_than(0), soft(0.5, 2),
                                            unless("file"))
        .member<&ProjectorEmission::fov>("fov", "deg", "angle across the image", Range{0, 170, true})
        .member<&ProjectorEmission::fov_axis>("fov_axis", "", "the side of the image the angle is measured across",
                                              choices("smaller", "larger", "width", "height"))
        .member<&ProjectorEmission::image_scale>(
            "scale", "1", "multiplies the image; 1: white is an intensity of 1 in the axis", at_least(0), soft(0.01, 1000),
            logarithmic, unless("power"), unless("luminous_flux"), unless("luminous_intensity"), unless("illuminance"))
        .member<&ProjectorEmission::even>(
            "even", "",
            "where a white image is evenly bright; screen: on a screen across the axis; directions: "
            "in all directions, so that a screen is darker towards the edges",
            choices("screen", "directions"))
        .member<&ProjectorEmission::color_space>("color_space", "", "primaries and white of the image's RGB", rgb_space_names(),
                                                 when("file"))
        .member<&ProjectorEmission::transfer>("transfer", "",
                                              "how its numbers are encoded; auto: srgb for integers, linear for floats",
                                              image_transfer_names(), when("file"));
    describe_amounts(d);
  }

  void prepare() override {
    if (file.empty() && !picture) fail("file", "an image file is needed, or a map as the `picture`");
    of_map_ = file.empty();
    space_ = &rgb_space(of_map_ ? "srgb" : color_space);  // a map returns spectra; sRGB then only defines the white, D65
    if (of_map_ && !std::isfinite(aspect)) fail("aspect", "must be finite");
    of_map_ ? look_at_picture() : read_image();
    const float shape = of_map_ ? aspect : float(image_.width) / float(image_.height), half = std::tan(radians(fov) / 2);
    const bool across_width =
        fov_axis == Axis::width || (fov_axis == Axis::smaller && shape <= 1) || (fov_axis == Axis::larger && shape > 1);
    half_width_ = across_width ? half : half * shape;
    half_height_ = across_width ? half / shape : half;
    if (!(half_width_ > 0 && half_height_ > 0 && std::isfinite(half_width_) && std::isfinite(half_height_)))
      fail("fov", "is too small or too large to count with");
    build();
    // Amounts are those of a white image, as projectors are specified: the base class gets the colour space's white as its map.
    map = ref_cast<ObjectMap>(Registry::instance().create("ConstantMap"));
    set(*map, "value", Value(space_->illuminant));
    map->prepare();
    prepare_amounts("scale");
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    Point2 at;
    float cosine = 0;
    if (!find(p, direction, at, cosine) || !emits(p, direction)) return {};
    const Spectrum seen = of_map_ ? pictured(at, p.time, w) : colour(look_up(at), w);
    return seen * (factor(p.object, p.time) * brightness(cosine));
  }

  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    if (empty_) return {};
    const size_t width = size_t(image_.width), height = size_t(image_.height);
    const size_t y = choose_interval(rows_.data(), height, u.y), x = choose_interval(columns_.data() + y * width, width, u.x);
    const Point2 at{(float(x) + u.x) / float(width), (float(y) + u.y) / float(height)};
    const Vector3 local = normalize(Vector3{(2 * at.x - 1) * half_width_, (1 - 2 * at.y) * half_height_, 1});
    const Vector3 direction = picture_frame(p).to_world(local);
    return {direction, pdf(p, direction)};
  }
  float pdf(const SurfacePoint& p, const Vector3& direction) const override {
    Point2 at;
    float cosine = 0;
    if (empty_ || !find(p, direction, at, cosine) || !emits(p, direction)) return 0;
    const size_t x = size_t(std::min(int(at.x * float(image_.width)), image_.width - 1));
    const size_t y = size_t(std::min(int(at.y * float(image_.height)), image_.height - 1));
    return pdfs_[y * size_t(image_.width) + x] / (cosine * square(cosine));
  }

  /// The power of a white image times the image's mean colour [W/nm]: exact for a Point; for surfaces it is the power of an
  /// image that has the mean colour everywhere.
  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    if (object.infinite()) fail("file", "a projector belongs on a Point or on a surface, not at infinity");
    // The ratio of a white image's power to its radiance along the axis is the same at all wavelengths. It is evaluated at
    // 555 nm, as the white may be 0 at other wavelengths.
    Wavelengths middle;
    for (int i = 0; i < spectrum_size; ++i) middle.place(i, 555, 1 / (wavelength_high - wavelength_low));
    const float share = ShapedEmission::power(object, middle)[0] / map->color({}, middle, ColorUse::radiance)[0];
    return (of_map_ ? mean_of_picture(w) : colour(mean_, w)) * (amount_asked() ? share : share * image_scale);
  }

  enum class Axis : std::uint8_t { smaller, larger, width, height };
  FilePath file;
  Ref<ObjectMap> picture;
  float aspect = 1;
  float fov = 40, image_scale = 1;
  Axis fov_axis = Axis::width;
  enum class Even : std::uint8_t { screen, directions };
  Even even = Even::screen;
  std::string color_space = "srgb", transfer = automatic_transfer;

 protected:
  // The profile and its integrals are those of a white image.
  float profile(const SurfacePoint& p, const Vector3& direction) const override {
    Point2 at;
    float cosine = 0;
    return find(p, direction, at, cosine) ? brightness(cosine) : 0;
  }
  double solid_angle() const override {
    if (even == Even::screen) return area();
    const double a = double(half_width_), b = double(half_height_);
    return 4 * std::atan(a * b / std::sqrt(1 + a * a + b * b));
  }
  /// K: the integral of |n . w| f dw over the part of the image on the emitting sides, by the midpoint rule with 64 x 64
  /// points.
  double surface_share(const SurfacePoint& p) const override {
    constexpr int steps = 64;
    const Frame f = picture_frame(p);
    double sum = 0;
    for (int i = 0; i < steps * steps; ++i) {
      const float x = 2 * (float(i % steps) + 0.5f) / steps - 1, y = 2 * (float(i / steps) + 0.5f) / steps - 1;
      const Vector3 local = normalize(Vector3{x * half_width_, y * half_height_, 1}), direction = f.to_world(local);
      if (emits(p, direction)) sum += std::abs(double(dot(p.normal, direction))) * per_area(local.z);
    }
    return sum * area() / (steps * steps);
  }
  Vector3 own_axis(const SurfacePoint& p) const override { return turned(p, {0, 0, 1}); }

 private:
  double area() const { return 4 * double(half_width_) * double(half_height_); }
  /// brightness: f. per_area: f dw / dA, with dA on the plane at distance 1.
  float brightness(float cosine) const { return even == Even::screen ? 1 / (cosine * square(cosine)) : 1; }
  double per_area(float cosine) const { return even == Even::screen ? 1 : double(cosine * square(cosine)); }
  double per_area(Point2 at) const {
    return per_area(1 / std::sqrt(1 + square((2 * at.x - 1) * half_width_) + square((1 - 2 * at.y) * half_height_)));
  }

  void read_image() {
    try {
      image_ = read_linear_image(file.resolved(), transfer);
    } catch (const Error& e) {
      fail("file", e.what());
    }
    for (float& value : image_.rgb) {
      if (!std::isfinite(value)) fail("file", "'" + file.resolved() + "' holds values that are infinite or not a number");
      value = std::max(value, 0.0f);
    }
  }

  // For a map the pdf is made from the means of 2 x 2 points in each cell of a grid. Finer details may be missed, so a tenth of
  // the overall mean is added everywhere: the pdf is then never less than 1/11 of that for an even picture.
  static constexpr int picture_cells = 128;
  void look_at_picture() {
    image_ = {};
    image_.width = image_.height = picture_cells;
    image_.rgb.resize(size_t(picture_cells) * picture_cells * 3);
    double sum = 0;
    for (int i = 0; i < picture_cells * picture_cells; ++i) {
      float value = 0;
      for (int k = 0; k < 4; ++k) {
        const Point2 uv{(float(i % picture_cells) + 0.25f + 0.5f * float(k % 2)) / picture_cells,
                        1 - (float(i / picture_cells) + 0.25f + 0.5f * float(k / 2)) / picture_cells};
        const float here = picture->scalar(picture_point(uv, 0));
        if (!(here >= 0 && std::isfinite(here))) fail("picture", "must be neither negative nor infinite");
        value += here / 4;
      }
      for (size_t c = 0; c < 3; ++c) image_.rgb[3 * size_t(i) + c] = value;
      sum += double(value);
    }
    const float more = sum > 0 ? float(0.1 * sum / (picture_cells * picture_cells)) : 1;
    for (float& value : image_.rgb) value += more;
  }
  Spectrum pictured(Point2 at, float time, const Wavelengths& w) const {
    return picture->color(picture_point({at.x, 1 - at.y}, time), w, ColorUse::radiance);
  }
  Spectrum mean_of_picture(const Wavelengths& w) const {
    constexpr int side = 64;
    Spectrum sum;
    double weights = 0;
    for (int i = 0; i < side * side; ++i) {
      const Point2 at{(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side};
      sum += pictured(at, 0, w) * float(per_area(at));
      weights += per_area(at);
    }
    return sum / float(weights);
  }

  /// The position in the image, from its upper left corner, that a direction projects to; returns false outside the image.
  bool find(const SurfacePoint& p, const Vector3& direction, Point2& at, float& cosine) const {
    const Vector3 local = picture_frame(p).to_local(direction);
    cosine = local.z;
    if (!(cosine > 0)) return false;
    at = {(local.x / (cosine * half_width_) + 1) / 2, (1 - local.y / (cosine * half_height_)) / 2};
    return at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1;
  }

  std::array<float, 3> look_up(Point2 at) const {
    const float x = clamp(at.x * float(image_.width) - 0.5f, 0, float(image_.width - 1)),
                y = clamp(at.y * float(image_.height) - 0.5f, 0, float(image_.height - 1));
    const int x0 = int(x), x1 = std::min(x0 + 1, image_.width - 1), y0 = int(y), y1 = std::min(y0 + 1, image_.height - 1);
    const float fx = x - float(x0), fy = y - float(y0);
    const auto texel = [&](int i, int k) { return &image_.rgb[(size_t(k) * size_t(image_.width) + size_t(i)) * 3]; };
    const float *a = texel(x0, y0), *b = texel(x1, y0), *c = texel(x0, y1), *d = texel(x1, y1);
    std::array<float, 3> rgb;
    for (size_t i = 0; i < 3; ++i) rgb[i] = lerp(fy, lerp(fx, a[i], b[i]), lerp(fx, c[i], d[i]));
    return rgb;
  }

  Spectrum colour(const std::array<float, 3>& rgb, const Wavelengths& w) const {
    return rgb_spectrum(*space_, rgb[0], rgb[1], rgb[2], ColorUse::radiance, w);
  }
  /// The factor of the image: its scale, or the factor that gives the requested amount.
  float factor(const SceneObject* object, float time) const {
    return amount_asked() && object ? scale(*object, time) : image_scale;
  }

  void build() {
    const size_t width = size_t(image_.width), height = size_t(image_.height);
    std::vector<float> raw(width * height);
    std::array<double, 3> sums{};
    double weights = 0;
    for (size_t i = 0; i < raw.size(); ++i) {
      const double weight = per_area({(float(i % width) + 0.5f) / float(width), (float(i / width) + 0.5f) / float(height)});
      weights += weight;
      const float* rgb = &image_.rgb[3 * i];
      const auto& m = space_->to_xyz;
      const double luminance = m[3] * double(rgb[0]) + m[4] * double(rgb[1]) + m[5] * double(rgb[2]);
      raw[i] = std::max(float(luminance), 0.02f * (rgb[0] + rgb[1] + rgb[2]));
      for (size_t c = 0; c < 3; ++c) sums[c] += weight * double(rgb[c]);
    }
    for (size_t c = 0; c < 3; ++c) mean_[c] = float(sums[c] / weights);

    pdfs_.resize(raw.size());
    columns_.resize(raw.size());
    rows_.resize(height);
    double total = 0;
    std::vector<double> row_sums(height);
    for (size_t y = 0; y < height; ++y) {
      const size_t above = y > 0 ? y - 1 : 0, below = std::min(y + 1, height - 1);
      const auto column = [&](size_t x) {
        return 0.75f * raw[y * width + x] + 0.125f * (raw[above * width + x] + raw[below * width + x]);
      };
      std::vector<double> running(width);
      double row = 0;
      for (size_t x = 0; x < width; ++x) {
        const float value = 0.75f * column(x) + 0.125f * (column(x > 0 ? x - 1 : 0) + column(std::min(x + 1, width - 1)));
        pdfs_[y * width + x] = value;
        running[x] = row += double(value);
      }
      for (size_t x = 0; x < width; ++x) columns_[y * width + x] = row > 0 ? float(running[x] / row) : 1;
      row_sums[y] = total += row;
    }
    empty_ = !(total > 0);
    if (empty_) return;
    for (size_t y = 0; y < height; ++y) rows_[y] = float(row_sums[y] / total);
    const double pixel_area = area() / double(raw.size());
    for (float& d : pdfs_) d = float(double(d) / (total * pixel_area));
  }

  const RgbSpace* space_ = nullptr;
  bool of_map_ = false;
  LinearImage image_;
  float half_width_ = 1, half_height_ = 1;  // of the image at distance 1
  std::array<float, 3> mean_{};
  bool empty_ = true;
  std::vector<float> pdfs_;            // of each pixel, per area of the plane at distance 1
  std::vector<float> rows_, columns_;  // CDF of the rows, and in each row the CDF of its pixels
};

const Register<ProjectorEmission> registered;

}  // namespace
}  // namespace etendue
