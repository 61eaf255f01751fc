// NurbsSurface: a tensor-product surface of rational B-splines, optionally trimmed.

#include "bezier_object.h"
#include "geometry/inner_origin.h"
#include "nurbs_basis.h"
#include "trimming_curve.h"

namespace etendue {
namespace {

enum class Keep { inside, outside };

class NurbsSurface final : public BezierObject {
 public:
  static void describe(Description<NurbsSurface>& d) {
    d.summary(
         "A non-uniform rational B-spline surface of degrees up to 9, converted exactly to Bézier patches. It faces where "
         "dp/du x "
         "dp/dv points, or outwards when its borders meet so that it encloses a volume. Surface coordinates go from 0 to 1 "
         "over "
         "the knots. Closed curves may trim it; loops must not cross.",
         "Piegl & Tiller 1997, \"The NURBS book\"")
        .group("Shape")
        .member<&NurbsSurface::degree_u>("degree_u", "1", "the degree along u", range(1, bezier::highest_degree),
                                         Effect::rebuild)
        .member<&NurbsSurface::degree_v>("degree_v", "1", "the degree along v", range(1, bezier::highest_degree),
                                         Effect::rebuild)
        .member<&NurbsSurface::knots_u>("knots_u", "1", "as many as points along u + degree_u + 1, not decreasing",
                                        Effect::rebuild)
        .member<&NurbsSurface::knots_v>("knots_v", "1", "the same along v", Effect::rebuild)
        .member<&NurbsSurface::points>("points", "m", "the control points, along u first", Effect::rebuild)
        .member<&NurbsSurface::weights>("weights", "1", "a weight for each control point, or none", more_than(0),
                                        Effect::rebuild)
        .group("Trimming")
        .member<&NurbsSurface::trimming>(
            "trimming", "",
            "curves in u and v, in the units of the knots, each of which begins where the last one "
            "ends until a loop is closed",
            Effect::rebuild)
        .member<&NurbsSurface::keep>("keep", "", "which part trimming leaves: what the loops wind around, or the rest",
                                     choices("inside", "outside"), Effect::rebuild, when("trimming"));
  }

  void prepare() override {
    const size_t columns = knots_u.size() - std::min(knots_u.size(), size_t(degree_u) + 1);
    const size_t rows = knots_v.size() - std::min(knots_v.size(), size_t(degree_v) + 1);
    if (const std::string fault = nurbs::knots_fault(knots_u, degree_u, columns); !fault.empty()) fail("knots_u", fault);
    if (const std::string fault = nurbs::knots_fault(knots_v, degree_v, rows); !fault.empty()) fail("knots_v", fault);
    if (points.size() != columns * rows)
      fail("points", "the knots are for " + std::to_string(columns) + " x " + std::to_string(rows) + " points, but " +
                         std::to_string(points.size()) + " are given");
    if (!weights.empty() && weights.size() != points.size())
      fail("weights", std::to_string(weights.size()) + " weights for " + std::to_string(points.size()) + " points");
    for (const float w : weights)
      if (!(w > 0 && w < infinity)) fail("weights", "weights must be positive and finite");
    for (const DoublePoint3& p : points)
      if (!is_finite(p)) fail("points", "a control point is not finite");
    transform.set_inner_origin(inner_origin_for(points));
    std::vector<bezier::Patch> patches = take_apart(columns, rows);
    if (patches.empty()) fail("points", "the surface has no area");
    bezier::Region region(patches.size(), trimming.empty() ? grid_for(patches.size()) : std::max(8, grid_for(patches.size())));
    trim(patches, region);
    if (!adopt(std::move(patches), std::move(region)))
      fail(trimming.empty() ? "points" : "trimming", "nothing is left of the surface");
  }

  int degree_u = 2, degree_v = 1;
  // Approximately a quarter of a cylinder, with one inner knot.
  std::vector<float> knots_u{0, 0, 0, 1, 1, 1}, knots_v{0, 0, 0.5f, 1, 1};
  std::vector<DoublePoint3> points{{1, 0, 0},   {1, 1, 0}, {0, 1, 0}, {1, 0, 0.6}, {1, 1, 0.6},
                                   {0, 1, 0.6}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  std::vector<float> weights;
  std::vector<Ref<TrimmingCurve>> trimming;
  Keep keep = Keep::inside;

 private:
  double low_u() const { return double(knots_u[size_t(degree_u)]); }
  double low_v() const { return double(knots_v[size_t(degree_v)]); }
  double size_u() const { return double(knots_u[knots_u.size() - size_t(degree_u) - 1]) - low_u(); }
  double size_v() const { return double(knots_v[knots_v.size() - size_t(degree_v) - 1]) - low_v(); }

  std::vector<bezier::Patch> take_apart(size_t columns, size_t rows) {
    std::vector<bezier::Control> net;
    for (size_t i = 0; i < points.size(); ++i) {
      const DoubleVector3 p = points[i] - transform.inner_origin();
      net.push_back(bezier::control({p.x, p.y, p.z}, weights.empty() ? 1 : double(weights[i])));
    }
    const std::vector<nurbs::Span> along_u = nurbs::spans(knots_u, degree_u), along_v = nurbs::spans(knots_v, degree_v);
    const size_t m = size_t(degree_u) + 1, n = size_t(degree_v) + 1, width = along_u.size() * m;
    // Decomposes all rows along u, then the columns of the result along v.
    std::vector<bezier::Control> strip(width * rows), column(n);
    for (size_t j = 0; j < rows; ++j)
      for (size_t a = 0; a < along_u.size(); ++a) {
        bezier::Control* out = &strip[j * width + a * m];
        nurbs::bezier_values(knots_u, degree_u, along_u[a], &net[j * columns], 1, out);
        if (a > 0) out[0] = out[-1];  // equal up to rounding; copied so that neighbours share their borders exactly
      }
    std::vector<bezier::Patch> patches;
    std::vector<bezier::Control> last_row(width);
    size_t dropped = 0;
    for (size_t b = 0; b < along_v.size(); ++b) {
      std::vector<bezier::Patch> row(along_u.size());
      for (size_t a = 0; a < along_u.size(); ++a) {
        bezier::Patch& p = row[a];
        p.m = degree_u;
        p.n = degree_v;
        p.rational = !weights.empty();
        p.low[0] = (along_u[a].low - low_u()) / size_u();
        p.high[0] = (along_u[a].high - low_u()) / size_u();
        p.low[1] = (along_v[b].low - low_v()) / size_v();
        p.high[1] = (along_v[b].high - low_v()) / size_v();
        p.points.resize(m * n);
        for (size_t i = 0; i < m; ++i) {
          nurbs::bezier_values(knots_v, degree_v, along_v[b], &strip[a * m + i], width, column.data());
          if (b > 0) column[0] = last_row[a * m + i];
          last_row[a * m + i] = column[n - 1];
          for (size_t j = 0; j < n; ++j) p.points[i + j * m] = column[j];
        }
      }
      for (bezier::Patch& p : row)
        if (bezier::measure(p))
          patches.push_back(std::move(p));
        else
          ++dropped;
    }
    if (dropped > 0) warn(std::to_string(dropped) + " pieces of the surface have no area and are left out");
    return patches;
  }

  void trim(const std::vector<bezier::Patch>& patches, bezier::Region& region) const {
    if (trimming.empty()) return;
    const double extent = std::max(size_u(), size_v());
    std::vector<std::array<double, 2>> loop;
    std::vector<std::vector<std::array<double, 2>>> loops;
    const auto apart = [&](const std::array<double, 2>& a, const std::array<double, 2>& b) {
      return std::hypot(a[0] - b[0], a[1] - b[1]) > 1e-4 * extent;
    };
    for (size_t k = 0; k < trimming.size(); ++k) {
      if (!trimming[k]) fail("trimming", "curve " + std::to_string(k) + " is missing");
      const size_t joint = loop.size();
      trimming[k]->flatten(1e-6 * extent, loop);
      if (joint > 0 && apart(loop[joint - 1], loop[joint]))
        fail("trimming", "curve " + std::to_string(k) + " does not begin where the one before it ends (counting from 0)");
      if (apart(loop.front(), loop.back())) continue;
      loop.push_back(loop.front());
      loops.push_back(std::exchange(loop, {}));
    }
    if (!loop.empty()) fail("trimming", "the last loop is not closed");
    std::vector<bezier::Segment> segments;
    for (size_t k = 0; k < patches.size(); ++k) {
      const bezier::Patch& p = patches[k];
      const auto s = [&](double u) { return ((u - low_u()) / size_u() - p.low[0]) / (p.high[0] - p.low[0]); };
      const auto t = [&](double v) { return ((v - low_v()) / size_v() - p.low[1]) / (p.high[1] - p.low[1]); };
      segments.clear();
      for (const auto& closed_loop : loops)
        for (size_t i = 0; i + 1 < closed_loop.size(); ++i) {
          const auto &a = closed_loop[i], &b = closed_loop[i + 1];
          segments.push_back({s(a[0]), t(a[1]), s(b[0]), t(b[1])});
        }
      region.trim(std::uint32_t(k), segments, keep == Keep::inside);
    }
  }
};

const Register<NurbsSurface> registered;

}  // namespace
}  // namespace etendue
