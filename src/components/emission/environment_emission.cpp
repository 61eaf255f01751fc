// EnvironmentEmission: light from all directions at infinity, given by an image or a map.

#include "at_infinity.h"
#include "core/huge_pages.h"
#include "equal_area.h"
#include "etendue/core/warp.h"
#include "etendue/describe/color.h"
#include "etendue/emission_shader.h"
#include "etendue/object_map.h"
#include "etendue/scene_object.h"
#include "images/linear_image.h"
#include "quantity.h"
#include "texel_distribution.h"

namespace etendue {
namespace {

// Directions are in object space; y is up. Longitude and latitude: u = atan2(x, -z) / (2 pi), wrapped to [0, 1), and
// v = acos(y) / pi from the top. Texels are squares of the (u, v) plane, row 0 at the top, and the radiance is bilinear between
// their centres (constant beyond the centres of the first and last row). With `rows: poles` the centre of the first row lies at
// the top and that of the last row at the bottom: row j of h lies at v = j / (h - 1).
//
// Importance sampling: a pdf that is constant over each cell's solid angle. A cell is a texel, or b x b texels:
//   Omega_row = (2 pi / columns) (cos(theta_top) - cos(theta_bottom)),
// in proportion to the mean of the bilinear radiance's importance f over the cell. The mean of a hat function over its own
// texel is 3/4, over each neighbour 1/8, in both dimensions, so the mean over a texel is a 3 x 3 filter, and it is positive
// wherever the radiance is. A cell is chosen with probability importance * Omega / sum, a point in it uniformly in longitude
// and in cos(theta), hence pdf = importance / sum [1/sr].
//
// Most of what a sample costs is that a large table is not in the cache: so cells are as large as costs nearly no variance.
// An estimate of the integral F of f by f / p has the second moment E = integral of f^2 / p. With texels as cells it is F^2,
// the least; with larger ones, over which p is constant,
//   E / F^2 = sum over cells of Omega (integral of f^2) / (integral of f), over F.
// The side b is the largest power of two for which this is at most 1.02: 8 or so for a sky with clouds, 1 where the sun is
// seen.
class EnvironmentEmission final : public EmissionShader {
 public:
  static void describe(Description<EnvironmentEmission>& d) {
    d.summary("Light that arrives from infinitely far away, from an image in longitude and latitude or of a map.")
        .group("Light")
        .member<&EnvironmentEmission::file>("file", "",
                                            "the image, in longitude and latitude: its middle is seen along +z of the object, "
                                            "its top along +y, its left and right "
                                            "edges along -z, the middle of its left half along +x. An OpenEXR file that says "
                                            "it is a cube (envmap = cube) is laid out so; none: `radiance` is used")
        .member<&EnvironmentEmission::map>("radiance", "W m^-2 sr^-1 nm^-1",
                                           "radiance when there is no image; maps see (u, v) of the direction, v upwards",
                                           Meaning::radiance, soft(0.01, 1000), logarithmic, unless("file"))
        .group("Amount")
        .member<&EnvironmentEmission::scale>("scale", "1", "multiplies the radiance", at_least(0), soft(0.01, 100), logarithmic,
                                             unless("illuminance"))
        .member<&EnvironmentEmission::lux>(
            "illuminance", "lx", "on a plane that faces +y of the object, instead of what the scale gives; 0: not asked for",
            at_least(0), soft(1, 100000), logarithmic)
        .group("Image")
        .member<&EnvironmentEmission::color_space>("color_space", "", "primaries and white of the image's RGB",
                                                   rgb_space_names(), when("file"))
        .member<&EnvironmentEmission::transfer>("transfer", "",
                                                "how its numbers are encoded; auto: srgb for integers, linear for floats",
                                                image_transfer_names(), when("file"))
        .member<&EnvironmentEmission::rows>("rows", "",
                                            "where the middles of the image's rows lie; centres: half a row below the top, and "
                                            "so on, as pixels do; poles: of the first at the top, of the last at the bottom",
                                            choices("centres", "poles"), when("file"))
        .member<&EnvironmentEmission::illuminant>(
            "illuminant", "",
            "whether RGB is light of the colour space's white, so that equal parts look white; off: it is a spectrum of that "
            "value, so that equal parts are the same at every wavelength",
            when("file"))
        .member<&EnvironmentEmission::layout>(
            "layout", "",
            "how directions lie in the image; lat_long: as `file` says; equal_area: in a square whose pixels all have the same "
            "solid angle, with +y in the middle, -y in the corners, +x at the right and -z below",
            choices("lat_long", "equal_area"), when("file"));
  }

  void prepare() override {
    image_ = {};
    texels_ = {};
    cells_.clear();
    if (!map && file.empty()) fail("radiance", "a map or a colour is needed");
    constant_map_ = map && map->constant();
    factor_ = scale;
    space_ = &rgb_space(color_space);
    if (file.empty()) {
      if (lux > 0) ask_for(map_illuminance());
      return;
    }
    try {
      image_ = read_linear_image(file.resolved(), transfer);
      if (layout == Layout::equal_area && !image_.from_cube) image_ = unfold_equal_area(image_);
    } catch (const Error& e) {
      fail("file", e.what());
    }
    if (image_.from_cube && (layout == Layout::equal_area || rows == Rows::poles))
      fail(layout == Layout::equal_area ? "layout" : "rows",
           "the image says of itself that it is a cube (envmap), which has a layout of its own");
    check_pixels();
    build();
    if (lux > 0 && !illuminant)
      fail("illuminance", "is known only of an image in its colour space's white; use a scale, or leave `illuminant` on");
    if (lux > 0) ask_for(image_illuminance());
    texels_.assign(image_.rgb.begin(), image_.rgb.end());
    image_.rgb = {};
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3&, const Wavelengths& w) const override {
    const Vector3 towards = p.object_position - Point3{};
    if (!texels_.empty()) {
      const Point2 at = place(towards);
      prefetch_pdf(at);  // a path whose BSDF sample escaped to infinity evaluates incident_pdf next, for its MIS weight
      const std::array<float, 3> rgb = look_up(at);
      return rgb_spectrum(*space_, factor_ * rgb[0], factor_ * rgb[1], factor_ * rgb[2], image_use(), w);
    }
    if (constant_map_) return map->color(p, w, ColorUse::radiance) * factor_;
    return map_radiance(p, towards, w);
  }

  DirectionSample sample(const SurfacePoint& p, Point2) const override { return sample_at_infinity(p); }
  float pdf(const SurfacePoint&, const Vector3&) const override { return 1; }

  /// The power that enters the scene through the object's area [W/nm]: pi * area * mean radiance. For an image the mean
  /// radiance is that of the mean RGB.
  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    const float sphere_times_disc = pi * object.area();
    if (!texels_.empty())
      return rgb_spectrum(*space_, factor_ * mean_[0], factor_ * mean_[1], factor_ * mean_[2], image_use(), w) *
             sphere_times_disc;
    if (constant_map_) return map->color({}, w, ColorUse::radiance) * (factor_ * sphere_times_disc);
    constexpr int side = 32;
    Spectrum sum;
    for (int i = 0; i < side; ++i)
      for (int k = 0; k < side; ++k) {
        // The points have all that maps may read: world-space normals and positions as well.
        const Point2 u{(float(i) + 0.5f) / side, (float(k) + 0.5f) / side};
        const SurfacePoint p = object.infinite() ? object.sample_visible({}, u, 0).point : facing(warp::sphere(u));
        sum += map_radiance(p, p.object_position - Point3{}, w);
      }
    return sum * (sphere_times_disc / (side * side));
  }

  bool only_at_infinity() const override { return true; }
  bool knows_incident() const override { return cells_.total() > 0; }

  DirectionSample sample_incident(Point2 u) const override {
    if (!(cells_.total() > 0)) return {};
    const auto [x, y, within, pdf] = cells_.choose(u);
    const float side = float(size_t(1) << cell_bits_), column = side * (float(x) + within.x),
                row = side * (float(y) + within.y);
    prefetch_texels(column, row);
    const float phi = 2 * pi * column / float(image_.width);
    const float cosine = float(lerp(double(within.y), row_cosines_[y], row_cosines_[y + 1]));
    const float sine = safe_sqrt((1 - cosine) * (1 + cosine));
    return {{sine * std::sin(phi), cosine, -sine * std::cos(phi)}, pdf};
  }
  float incident_pdf(const Vector3& towards) const override {
    if (!(cells_.total() > 0)) return 0;
    const auto [x, y] = cell_at(place(towards));
    return cells_.pdf(x, y);
  }
  int most_incident_places() const override { return cells_.total() > 0; }
  IncidentPlaces incident_places(const Vector3& towards) const override {
    IncidentPlaces places;
    if (!(cells_.total() > 0)) return places;
    const Point2 at = place(towards);
    const auto [x, y] = cell_at(at);
    const double down = (double(towards.y) - row_cosines_[y]) / (row_cosines_[y + 1] - row_cosines_[y]);
    const Point2 within{clamp(at.x * float(image_.width >> cell_bits_) - float(x), 0, 1), clamp(float(down), 0, 1)};
    places.add(cells_.place(x, y, within), cells_.pdf(x, y));
    return places;
  }

  FilePath file;
  Ref<ObjectMap> map = constant(1.0f);
  float scale = 1;
  double lux = 0;
  std::string color_space = "srgb", transfer = automatic_transfer;
  enum class Rows : std::uint8_t { centres, poles };
  Rows rows = Rows::centres;
  enum class Layout : std::uint8_t { lat_long, equal_area };
  Layout layout = Layout::lat_long;
  bool illuminant = true;

 private:
  ColorUse image_use() const { return illuminant ? ColorUse::radiance : ColorUse::coefficient; }

  bool rows_at_poles() const { return rows == Rows::poles && image_.height > 1; }
  /// The row whose centre lies at v, as a fractional index.
  float row_at(float v) const { return rows_at_poles() ? v * float(image_.height - 1) : v * float(image_.height) - 0.5f; }
  int clamp_row(int y) const { return std::clamp(y, 0, image_.height - 1); }
  /// v of the upper border of row y: half-way between the rows' centres.
  double border(size_t y, size_t h) const {
    if (!rows_at_poles()) return double(y) / double(h);
    return std::clamp((double(y) - 0.5) / double(h - 1), 0.0, 1.0);
  }

  /// cos(theta) of the upper border of row y.
  double row_cosine(size_t y) const { return std::cos(3.14159265358979323846 * border(y, size_t(image_.height))); }

  static double lerp(double t, double a, double b) { return (1 - t) * a + t * b; }

  /// (u, v) of a direction, v from the top.
  static Point2 place(const Vector3& d) {
    float u = std::atan2(d.x, -d.z) / (2 * pi);
    if (u < 0) u += 1;
    return {std::min(u, one_minus_epsilon), safe_acos(d.y) / pi};
  }

  /// The environment's point in a direction, for an object whose transform is the identity.
  static SurfacePoint facing(const Vector3& towards) {
    SurfacePoint p;
    p.position = p.object_position = Point3{} + towards;
    p.normal = p.shading_normal = p.object_normal = Normal3(-towards);
    return p;
  }

  Spectrum map_radiance(SurfacePoint p, const Vector3& towards, const Wavelengths& w) const {
    const Point2 at = place(towards);
    p.uv = {at.x, 1 - at.y};
    p.footprint = 0;
    p.object_normal = Normal3(-towards);
    return map->color(p, w, ColorUse::radiance) * factor_;
  }

  std::array<float, 3> look_up(Point2 at) const {
    const float x = at.x * float(image_.width) - 0.5f, y = clamp(row_at(at.y), 0, float(image_.height - 1));
    const float left = std::floor(x);
    const int x0 = left < 0 ? image_.width - 1 : int(left), x1 = x0 + 1 == image_.width ? 0 : x0 + 1;
    const int y0 = int(y), y1 = std::min(y0 + 1, image_.height - 1);
    const float fx = x - left, fy = y - float(y0);
    const float *a = texel(x0, y0), *b = texel(x1, y0), *c = texel(x0, y1), *d = texel(x1, y1);
    std::array<float, 3> rgb;
    for (size_t i = 0; i < 3; ++i) rgb[i] = etendue::lerp(fy, etendue::lerp(fx, a[i], b[i]), etendue::lerp(fx, c[i], d[i]));
    return rgb;
  }
  /// Column and row of the cell that contains (u, v).
  std::pair<size_t, size_t> cell_at(Point2 p) const {
    return {size_t(std::min(int(p.x * float(image_.width)), image_.width - 1)) >> cell_bits_,
            size_t(clamp_row(int(row_at(p.y) + 0.5f))) >> cell_bits_};
  }

  // The image is rarely in the cache, and the addresses of a lookup are known well before the values are needed: after a
  // direction is sampled the BSDF is evaluated first.
  void prefetch_pdf(Point2 at) const {
    const auto [x, y] = cell_at(at);
    cells_.prefetch(x, y);
  }
  /// Prefetches the texels that `look_up` will read at a place, given in texels from the upper left corner.
  void prefetch_texels(float column, float row) const {
    const int left = std::clamp(int(column - 0.5f), 0, image_.width - 1), above = clamp_row(int(row - 0.5f));
    __builtin_prefetch(texel(left, above));
    __builtin_prefetch(texel(left, clamp_row(above + 1)));
  }

  const float* texel(int x, int y) const { return texels_.data() + (size_t(y) * size_t(image_.width) + size_t(x)) * 3; }

  /// Sets the factor for the requested illuminance. `given`: the illuminance with a factor of 1 [lx].
  void ask_for(double given) {
    if (!(given > 0)) fail("illuminance", "nothing that the eye sees shines from above");
    factor_ = float(lux / given);
  }
  /// E = 683.002 integral of V L cos dw over the upper hemisphere. For an image the integral of V L over wavelengths is Y times
  /// the integral of ybar, 106.857 nm.
  double image_illuminance() const {
    const size_t width = size_t(image_.width);
    double sum = 0;
    for (size_t y = 0; y < size_t(image_.height); ++y) {
      const double top = std::max(row_cosine(y), 0.0), bottom = std::max(row_cosine(y + 1), 0.0);
      const double projected = 3.14159265358979323846 / double(width) * (top * top - bottom * bottom);  // integral of cos dw
      for (size_t x = 0; x < width && projected > 0; ++x) {
        const float* rgb = &image_.rgb[(y * width + x) * 3];
        for (size_t c = 0; c < 3; ++c) sum += projected * space_->to_xyz[3 + c] * double(rgb[c]);
      }
    }
    return luminous_efficacy * observer_y_integral() * sum;
  }
  double map_illuminance() {
    factor_ = 1;
    return integrate_wavelengths(Quantity::illuminance, [&](const Wavelengths& w) {
      if (constant_map_) return map->color({}, w, ColorUse::radiance) * pi;
      constexpr int side = 32;
      Spectrum sum;
      for (int i = 0; i < side * side; ++i) {
        const Vector3 local = warp::cosine_hemisphere({(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side});
        const Vector3 d{local.y, local.z, local.x};
        sum += map_radiance(facing(d), d, w);
      }
      return sum * (pi / (side * side));
    });
  }

  void check_pixels() {
    size_t bad = 0, negative = 0;
    for (float& value : image_.rgb) {
      if (!std::isfinite(value)) ++bad;
      if (value < 0) {
        value = 0;
        ++negative;
      }
    }
    if (bad)
      fail("file", "'" + file.resolved() + "' holds " + std::to_string(bad) + " values that are infinite or not a number");
    if (negative)
      warn("'" + file.resolved() + "' holds " + std::to_string(negative) + " negative values, which are taken as 0",
           location_of("file"));
  }

  /// The importance of a texel: its luminance, but at least 0.02 times the sum of its channels, as with wide-gamut primaries a
  /// colour without luminance may emit all the same.
  float texel_importance(const float* rgb) const {
    const auto& m = space_->to_xyz;
    const double y = m[3] * double(rgb[0]) + m[4] * double(rgb[1]) + m[5] * double(rgb[2]);
    return std::max(float(y), 0.02f * (rgb[0] + rgb[1] + rgb[2]));
  }

  void build() {
    const int width = image_.width, height = image_.height;
    const size_t w = size_t(width), h = size_t(height);
    std::vector<float> raw(w * h);
    for (size_t i = 0; i < raw.size(); ++i) raw[i] = texel_importance(image_.rgb.data() + 3 * i);

    std::vector<float> importance(w * h);
    for (int y = 0; y < height; ++y) {
      const size_t above = size_t(std::max(y - 1, 0)), below = size_t(std::min(y + 1, height - 1));
      const auto column = [&](size_t x) {
        return 0.75f * raw[size_t(y) * w + x] + 0.125f * (raw[above * w + x] + raw[below * w + x]);
      };
      for (size_t x = 0; x < w; ++x)
        importance[size_t(y) * w + x] =
            0.75f * column(x) + 0.125f * (column(x == 0 ? w - 1 : x - 1) + column(x + 1 == w ? 0 : x + 1));
    }

    std::vector<double> cosines(h + 1), solid_angles(h);
    for (size_t y = 0; y <= h; ++y) cosines[y] = row_cosine(y);
    std::array<double, 3> sums{};
    for (size_t y = 0; y < h; ++y) {
      solid_angles[y] = 2 * 3.14159265358979323846 / double(w) * (cosines[y] - cosines[y + 1]);
      for (size_t x = 0; x < w; ++x)
        for (size_t c = 0; c < 3; ++c) sums[c] += double(image_.rgb[(y * w + x) * 3 + c]) * solid_angles[y];
    }
    cell_bits_ = 0;
    while (Cells(importance, solid_angles, cell_bits_ + 1).good()) ++cell_bits_;
    const Cells cells(importance, solid_angles, cell_bits_);
    cells_.build(cells.importance, cells.columns, cells.solid_angles);
    row_cosines_.clear();
    for (size_t y = 0; y < h; y += size_t(1) << cell_bits_) row_cosines_.push_back(cosines[y]);
    row_cosines_.push_back(cosines[h]);
    for (size_t c = 0; c < 3; ++c) mean_[c] = float(sums[c] / (4 * 3.14159265358979323846));
  }

  /// Texels put together to cells of 2^bits in each dimension, and what they do to the variance.
  struct Cells {
    size_t columns = 0;
    std::vector<float> importance;     ///< means over the cells
    std::vector<double> solid_angles;  ///< of the cells of each row [sr]
    double second_moment = infinity;   ///< E / F^2

    Cells(const std::vector<float>& texels, const std::vector<double>& rows, int bits) {
      const size_t side = size_t(1) << bits, width = texels.size() / rows.size();
      if (bits > 0 && (width % side != 0 || width / side < fewest)) return;
      columns = width / side;
      double whole = 0, sum = 0;
      for (size_t top = 0; top < rows.size(); top += side) {
        const size_t bottom = std::min(top + side, rows.size());
        double angle = 0;
        for (size_t y = top; y < bottom; ++y) angle += rows[y] * double(side);
        solid_angles.push_back(angle);
        for (size_t left = 0; left < width; left += side) {
          double f = 0, f2 = 0;
          for (size_t y = top; y < bottom; ++y)
            for (size_t x = left; x < left + side; ++x) {
              const double value = double(texels[y * width + x]);
              f += value * rows[y];
              f2 += value * value * rows[y];
            }
          importance.push_back(float(f / angle));
          whole += f;
          if (f > 0) sum += angle * f2 / f;
        }
      }
      second_moment = whole > 0 ? sum / whole : infinity;
    }
    bool good() const { return second_moment <= 1.02; }

    static constexpr size_t fewest = 128;  ///< columns: such a table is in the nearest cache
  };

  const RgbSpace* space_ = nullptr;
  bool constant_map_ = true;
  float factor_ = 1;                 // multiplies all radiance
  LinearImage image_;                // once it is read, its size only
  HugeVector<float> texels_;         // its RGB; empty: there is no image
  std::array<float, 3> mean_{};      // mean RGB over the sphere
  int cell_bits_ = 0;                // a cell has 2^bits texels in each dimension
  TexelDistribution cells_;          // by importance times solid angle
  std::vector<double> row_cosines_;  // cos(theta) at the borders of rows of cells
};

const Register<EnvironmentEmission> registered;

}  // namespace
}  // namespace etendue
