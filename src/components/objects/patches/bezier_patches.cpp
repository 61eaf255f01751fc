// BezierPatches: tensor-product Bézier patches, such as the Utah teapot's.

#include "bezier_object.h"
#include "geometry/inner_origin.h"

namespace etendue {
namespace {

class BezierPatches final : public BezierObject {
 public:
  static void describe(Description<BezierPatches>& d) {
    d.summary(
         "Bézier patches of any degree up to 9, polynomial or rational. Each has its own surface coordinates from 0 to 1 and "
         "faces where dp/du x dp/dv points; patches whose borders all meet enclose a volume and face outwards.",
         "Bézier patches: Farin 2002, \"Curves and surfaces for CAGD\"; roots: Toth 1985; Nishita, Sederberg & Kakimoto 1990")
        .group("Shape")
        .member<&BezierPatches::degree_u>("degree_u", "1", "the degree along u", range(1, bezier::highest_degree),
                                          Effect::rebuild)
        .member<&BezierPatches::degree_v>("degree_v", "1", "the degree along v", range(1, bezier::highest_degree),
                                          Effect::rebuild)
        .member<&BezierPatches::points>("points", "m", "the control points", Effect::rebuild)
        .member<&BezierPatches::weights>("weights", "1", "a weight for each control point, or none", more_than(0),
                                         Effect::rebuild)
        .member<&BezierPatches::patches>(
            "patches", "1",
            "(degree_u + 1) (degree_v + 1) points, counting from 0, for each patch, along u first; "
            "none: the points in order",
            Effect::rebuild);
  }

  void prepare() override {
    const size_t each = size_t(degree_u + 1) * size_t(degree_v + 1);
    const auto number = [](size_t n) { return std::to_string(n); };
    for (const DoublePoint3& p : points)
      if (!is_finite(p)) fail("points", "a control point is not finite");
    if (!weights.empty() && weights.size() != points.size())
      fail("weights", number(weights.size()) + " weights for " + number(points.size()) + " points");
    for (const float w : weights)
      if (!(w > 0 && w < infinity)) fail("weights", "weights must be positive and finite");
    const size_t count = patches.empty() ? points.size() : patches.size();
    if (count == 0 || count % each != 0)
      fail(patches.empty() ? "points" : "patches", number(each) + " points make a patch of degrees " +
                                                       std::to_string(degree_u) + " and " + std::to_string(degree_v) +
                                                       ", but " + number(count) + " are given");
    transform.set_inner_origin(inner_origin_for(points));
    std::vector<bezier::Patch> made;
    size_t dropped = 0;
    for (size_t first = 0; first < count; first += each) {
      bezier::Patch patch;
      patch.m = degree_u;
      patch.n = degree_v;
      patch.rational = !weights.empty();
      for (size_t k = first; k < first + each; ++k) {
        const size_t i = patches.empty() ? k : patches[k];
        if (i >= points.size())
          fail("patches", "patch " + number(first / each) + " refers to point " + number(i) + " of " + number(points.size()) +
                              " (counting from 0)");
        const DoubleVector3 p = points[i] - transform.inner_origin();
        patch.points.push_back(bezier::control({p.x, p.y, p.z}, weights.empty() ? 1 : double(weights[i])));
      }
      if (bezier::measure(patch))
        made.push_back(std::move(patch));
      else
        ++dropped;
    }
    if (dropped > 0) warn(number(dropped) + " of " + number(count / each) + " patches have no area and are left out");
    const size_t left = made.size();
    if (left == 0 || !adopt(std::move(made), bezier::Region(left, grid_for(left)))) fail("points", "the patches have no area");
  }

  int degree_u = 3, degree_v = 3;
  // Approximately half a cylinder, slightly twisted.
  std::vector<DoublePoint3> points{{-0.5, -0.5, 0},  {-0.5, -0.38, 0.67}, {0.5, -0.62, 0.67}, {0.5, -0.5, 0},
                                   {-0.5, -0.17, 0}, {-0.5, -0.05, 0.67}, {0.5, -0.29, 0.67}, {0.5, -0.17, 0},
                                   {-0.5, 0.17, 0},  {-0.5, 0.29, 0.67},  {0.5, 0.05, 0.67},  {0.5, 0.17, 0},
                                   {-0.5, 0.5, 0},   {-0.5, 0.62, 0.67},  {0.5, 0.38, 0.67},  {0.5, 0.5, 0}};
  std::vector<float> weights;
  std::vector<std::uint32_t> patches;
};

const Register<BezierPatches> registered;

}  // namespace
}  // namespace etendue
