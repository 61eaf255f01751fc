// Heightfield: terrain and other surfaces z = h(x, y), from an image or a list.

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <mutex>

#include "etendue/core/error.h"
#include "geometry/double_ray.h"
#include "geometry/visible_directions.h"
#include "heightfield_grid.h"
#include "images/linear_image.h"

namespace etendue {
namespace {

// A hit's primitive is the cell's number, u and v are the hit's position in the cell.
class Heightfield final : public PlacedObject {
 public:
  static void describe(Description<Heightfield>& d) {
    d.summary(
         "A surface above the xy plane, around the origin, with heights along z on a regular grid that are interpolated "
         "bilinearly between its points. u goes along x, v along y, from 0 to 1 over the whole field.",
         "traversal: Tevs, Ihrke & Seidel 2008, \"Maximum mipmaps for fast, accurate, and scalable dynamic height field "
         "rendering\"")
        .group("Shape")
        .member<&Heightfield::image>(
            "image", "",
            "an image of heights, in place of the list: the first channel of its pixels, which are the "
            "grid's points; its bottom row lies at the lowest y",
            Effect::rebuild)
        .member<&Heightfield::transfer>(
            "transfer", "", "the transfer function of the image's numbers: linear when they are heights as they are",
            Effect::rebuild, image_transfer_names(), when("image"))
        .member<&Heightfield::heights>("heights", "1", "row by row along x, beginning at the lowest y", Effect::rebuild,
                                       unless("image"))
        .member<&Heightfield::nx>("nx", "1", "how many of the heights are in a row", range(2, 65536), Effect::rebuild,
                                  unless("image"))
        .member<&Heightfield::ny>("ny", "1", "how many rows of heights there are", range(2, 65536), Effect::rebuild,
                                  unless("image"))
        .group("Size")
        .member<&Heightfield::size>("size", "m", "of the field along x and y", Effect::rebuild)
        .member<&Heightfield::height>("height", "m", "of a 1 in the list or the image", Effect::rebuild, soft(-10, 10))
        .member<&Heightfield::smooth>("smooth", "", "shading normals hide that the surface is made of cells", Effect::rebuild);
  }

  /// Only building the shape takes time, and changes of emission do not affect it.
  void prepare_again() override {}
  void prepare() override {
    if (!(size.x > 0 && size.y > 0 && size.x < infinity && size.y < infinity)) fail("size", "must be positive and finite");
    if (!std::isfinite(height)) fail("height", "must be finite");
    std::vector<float> list = heights;
    int wide = nx, high = ny;
    if (!image.empty()) {
      list = read(wide, high);
    } else if (list.size() != size_t(nx) * size_t(ny)) {
      fail("heights",
           "there are " + std::to_string(list.size()) + ", but nx * ny is " + std::to_string(size_t(nx) * size_t(ny)));
    }
    if (size_t(wide - 1) * size_t(high - 1) >= size_t(1) << 32) fail(image.empty() ? "nx" : "image", "more than 2^32 cells");
    for (size_t i = 0; i < list.size(); ++i) {
      list[i] *= height;
      if (!(std::abs(list[i]) < 1e15f))
        fail(image.empty() ? "heights" : "image", "height " + std::to_string(i) + " is not finite");
    }
    grid_ = HeightfieldGrid(std::move(list), wide, high);
    step_x_ = double(size.x) / grid_.cells_x();
    step_y_ = double(size.y) / grid_.cells_y();
    table_ = std::make_unique<Table>();
    measure();
    place();
  }

  // Near the surface half of the samples are by direction: samples by area would rarely hit the nearest cells.
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override {
    const auto sample = [&](Point2 v, SurfaceSample& s) {
      LocalPoint own;
      if (!(local_sample(v, own) > 0)) return false;
      carry(own, time, s.point);
      return true;
    };
    return sample_by_both(*this, direction_share(from, time), from, u, time, sample,
                          [this](const SurfacePoint& p) { return area_pdf(p); });
  }
  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const override {
    return pdf_by_both(direction_share(from, p.time), from, direction, p,
                       [this](const SurfacePoint& q) { return area_pdf(q); });
  }

  FilePath image;
  std::string transfer = "linear";
  std::vector<float> heights{0, 0, 0, 0, 1, 0, 0, 0, 0};
  int nx = 3, ny = 3;
  Vector2 size{1, 1};
  float height = 0.25f;
  bool smooth = false;

 protected:
  Bounds3 local_bounds() const override {
    const auto [low, high] = grid_.range();
    Bounds3 box;
    box.add(Point3{-size.x / 2, -size.y / 2, low});
    box.add(Point3{size.x / 2, size.y / 2, high});
    return box;
  }

  bool local_intersect(const Ray& ray, Hit& hit) const override {
    const DoubleRay r(ray);
    const double from[3] = {(r.origin[0] + 0.5 * double(size.x)) / step_x_, (r.origin[1] + 0.5 * double(size.y)) / step_y_,
                            r.origin[2]};
    const double direction[3] = {r.direction[0] / step_x_, r.direction[1] / step_y_, r.direction[2]};
    HeightfieldGrid::Found found{};
    if (!grid_.nearest(from, direction, ray.maximum, found)) return false;
    hit.distance = found.t;
    hit.primitive = std::uint32_t(found.j) * std::uint32_t(grid_.cells_x()) + std::uint32_t(found.i);
    hit.u = float(found.u);
    hit.v = float(found.v);
    return true;
  }

  void local_point(const Ray&, const Hit& hit, LocalPoint& p) const override {
    point_at(int(hit.primitive % std::uint32_t(grid_.cells_x())), int(hit.primitive / std::uint32_t(grid_.cells_x())), hit.u,
             hit.v, p);
  }

  double local_area() const override { return area_; }
  float local_area_error() const override { return area_error_; }

  // Chooses a row in proportion to its area, then a cell of the row likewise, then a position uniform in the cell's x and y.
  float local_sample(Point2 u, LocalPoint& p) const override {
    const Table& table = this->table();
    const size_t wide = size_t(grid_.cells_x());
    const auto choose = [](const float* begin, size_t count, float& x) {
      const size_t k = std::min(size_t(std::upper_bound(begin, begin + count, x) - begin), count - 1);
      const float below = k > 0 ? begin[k - 1] : 0, width = begin[k] - below;
      x = width > 0 ? clamp((x - below) / width, 0, one_minus_epsilon) : 0;
      return k;
    };
    const size_t j = choose(table.rows.data(), table.rows.size(), u.y);
    const size_t i = choose(table.cells.data() + j * wide, wide, u.x);
    point_at(int(i), int(j), u.x, u.y, p);
    return pdf(i, j, u.x, u.y);
  }

  float local_pdf(const SurfacePoint& p) const override {
    return pdf(p.primitive % std::uint32_t(grid_.cells_x()), p.primitive / std::uint32_t(grid_.cells_x()), p.u, p.v);
  }

 private:
  /// Computed at the first call: the cumulative area distribution of the rows, and of the cells in each row.
  struct Table {
    std::once_flag made;
    std::vector<float> rows, cells;
  };

  std::vector<float> read(int& wide, int& high) const {
    LinearImage picture;
    try {
      picture = read_linear_image(image.resolved(), transfer);
    } catch (const Error& error) {
      fail("image", error.what());
    }
    wide = picture.width;
    high = picture.height;
    if (wide < 2 || high < 2 || wide > 65536 || high > 65536)
      fail("image",
           "it has " + std::to_string(wide) + " x " + std::to_string(high) + " pixels: 2 to 65536 each way are allowed");
    std::vector<float> list(size_t(wide) * size_t(high));
    for (size_t y = 0; y < size_t(high); ++y)
      for (size_t x = 0; x < size_t(wide); ++x)
        list[(size_t(high) - 1 - y) * size_t(wide) + x] = picture.rgb[3 * (y * size_t(wide) + x)];
    return list;
  }

  void point_at(int i, int j, float u, float v, LocalPoint& p) const {
    const HeightfieldGrid::Cell c = grid_.cell(i, j);
    const double x = (i + double(u)) * step_x_ - 0.5 * double(size.x), y = (j + double(v)) * step_y_ - 0.5 * double(size.y);
    const double slope_x = c.slope_u(double(v)) / step_x_, slope_y = c.slope_v(double(u)) / step_y_;
    p.position = {float(x), float(y), float(c.height(double(u), double(v)))};
    p.normal = normal_of(slope_x, slope_y);
    if (smooth) p.shading_normal = smooth_normal(i, j, double(u), double(v));
    p.uv = {float((i + double(u)) / grid_.cells_x()), float((j + double(v)) / grid_.cells_y())};
    p.dpdu = {size.x, 0, float(double(size.x) * slope_x)};
    p.dpdv = {0, size.y, float(double(size.y) * slope_y)};
    p.primitive = std::uint32_t(j) * std::uint32_t(grid_.cells_x()) + std::uint32_t(i);
    p.u = u;
    p.v = v;
    // Rounding of the position in any direction, since it may fall into the next cell; of u and v times the cell size; and of
    // the offset ray origin. Intersection itself is in double.
    p.error = rounding_bound(3) * (length(p.position - Point3{}) + float(step_x_ + step_y_));
  }

  DirectionShare direction_share(const Point3& from, float time) const {
    Transform scratch;
    const Point3 own = placed(transform, time, scratch).back(from);
    const auto [low, high] = grid_.range();
    const Vector3 off{std::max(std::abs(own.x) - size.x / 2, 0.0f), std::max(std::abs(own.y) - size.y / 2, 0.0f),
                      std::max({low - own.z, own.z - high, 0.0f})};
    return {max_component(off) < 0.25f * std::min(size.x, size.y) ? 0.5f : 0.0f, false};
  }

  static Normal3 normal_of(double slope_x, double slope_y) {
    const double s = 1 / std::sqrt(slope_x * slope_x + slope_y * slope_y + 1);
    return {float(-slope_x * s), float(-slope_y * s), float(s)};
  }

  /// The shading normal from slopes interpolated between the cell's corners.
  Normal3 smooth_normal(int i, int j, double u, double v) const {
    double x = 0, y = 0;
    for (int k = 0; k < 4; ++k) {
      const auto [slope_x, slope_y] = grid_.corner_slopes(i + (k & 1), j + (k >> 1));
      const double weight = ((k & 1) ? u : 1 - u) * ((k >> 1) ? v : 1 - v);
      x += weight * slope_x;
      y += weight * slope_y;
    }
    return normal_of(x / step_x_, y / step_y_);
  }

  /// Area of the surface per area of the ground.
  double stretch(const HeightfieldGrid::Cell& c, double u, double v) const {
    const double x = c.slope_u(v) / step_x_, y = c.slope_v(u) / step_y_;
    return std::sqrt(1 + x * x + y * y);
  }
  /// Mean stretch over a cell by Gauss-Legendre quadrature with 2 x 2 points.
  double mean_stretch(const HeightfieldGrid::Cell& c) const {
    constexpr double a = 0.21132486540518713, b = 1 - a;
    return 0.25 * (stretch(c, a, a) + stretch(c, a, b) + stretch(c, b, a) + stretch(c, b, b));
  }

  /// The area by Gauss-Legendre quadrature. The difference from Simpson's rule, whose error is larger and of opposite sign,
  /// bounds its error.
  void measure() {
    std::vector<double> gauss(size_t(grid_.cells_y())), simpson(size_t(grid_.cells_y()));
    tbb::parallel_for(0, grid_.cells_y(), [&](int j) {
      for (int i = 0; i < grid_.cells_x(); ++i) {
        const HeightfieldGrid::Cell c = grid_.cell(i, j);
        gauss[size_t(j)] += mean_stretch(c);
        const double edges = stretch(c, 0.5, 0) + stretch(c, 0.5, 1) + stretch(c, 0, 0.5) + stretch(c, 1, 0.5);
        const double corners = stretch(c, 0, 0) + stretch(c, 1, 0) + stretch(c, 0, 1) + stretch(c, 1, 1);
        simpson[size_t(j)] += (16 * stretch(c, 0.5, 0.5) + 4 * edges + corners) / 36;
      }
    });
    double sum = 0, other = 0;
    for (size_t j = 0; j < gauss.size(); ++j) {
      sum += gauss[j];
      other += simpson[j];
    }
    area_ = sum * step_x_ * step_y_;
    area_error_ = float(std::abs(other / sum - 1));
  }

  const Table& table() const {
    // Isolated: a thread that waits here within a parallel loop must not execute other iterations of that loop.
    std::call_once(table_->made, [this] { tbb::this_task_arena::isolate([this] { make_table(); }); });
    return *table_;
  }

  void make_table() const {
    const size_t wide = size_t(grid_.cells_x()), high = size_t(grid_.cells_y());
    table_->rows.resize(high);
    table_->cells.resize(wide * high);
    std::vector<double> sums(high);
    tbb::parallel_for(size_t(0), high, [&](size_t j) {
      std::vector<double> until(wide);
      for (size_t i = 0; i < wide; ++i) until[i] = sums[j] += mean_stretch(grid_.cell(int(i), int(j)));
      for (size_t i = 0; i < wide; ++i) table_->cells[j * wide + i] = float(until[i] / sums[j]);
    });
    double sum = 0, part = 0;
    for (const double row : sums) sum += row;
    for (size_t j = 0; j < high; ++j) table_->rows[j] = float((part += sums[j]) / sum);
  }

  /// The pdf [1/m^2] of local_sample, computed from the rounded distributions.
  float pdf(size_t i, size_t j, float u, float v) const {
    const Table& t = table();
    const float* row = t.cells.data() + j * size_t(grid_.cells_x());
    const double in_row = double(row[i]) - double(i > 0 ? row[i - 1] : 0),
                 of_row = double(t.rows[j]) - double(j > 0 ? t.rows[j - 1] : 0);
    return float(in_row * of_row / (step_x_ * step_y_ * stretch(grid_.cell(int(i), int(j)), double(u), double(v))));
  }

  HeightfieldGrid grid_;
  double step_x_ = 1, step_y_ = 1, area_ = 0;
  float area_error_ = 0;
  std::unique_ptr<Table> table_;
};

const Register<Heightfield> registered;

}  // namespace
}  // namespace etendue
