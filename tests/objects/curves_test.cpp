// Tori, heightfields, curves and polygons with holes: closed forms of areas, volumes and hit distances.

#include <numeric>

#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

const Transform odd_place = Transform::translate({3, -2, 5}) * Transform::rotate(0.8f, {1, 2, -1});

/// Follows a ray through an object and calls a function with each point.
template <class F>
int for_all_hits(const SceneObject& object, Ray r, const F& call) {
  int n = 0;
  for (Hit hit; n < 1000 && object.intersect(r, hit); ++n, hit = {}) {
    SurfacePoint p;
    object.surface_point(r, hit, p);
    call(p);
    const float time = r.time;
    r = p.leave(r.direction);
    r.time = time;
  }
  return n;
}

/// The volume inside, with its standard error, by parallel rays through the bounds: signed chords. `odd` counts rays with an
/// odd number of crossings.
Mean volume(const SceneObject& object, int rays, unsigned seed, int& odd) {
  Random random(seed);
  const Bounds3 box = object.bounds();
  const float radius = length(box.diagonal()) / 2;
  Mean mean;
  for (int i = 0; i < rays; ++i) {
    const Vector3 d = random.direction();
    const float across = radius * std::sqrt(random.number()), phi = 2 * pi * random.number();
    const Ray r =
        ray(box.centre() + Frame(Normal3(d)).to_world({across * std::cos(phi), across * std::sin(phi), -1.1f * radius}), d);
    double inside = 0;
    odd += for_all_hits(object, r,
                        [&](const SurfacePoint& p) {
                          inside += std::copysign(double(dot(p.position - r.origin, d)), double(dot(p.normal, d)));
                        }) %
           2;
    mean.add(M_PI * double(radius) * double(radius) * inside);
  }
  return mean;
}

TEST(Torus, ClosedForms) {
  for (const float scale : {1e-3f, 1.0f, 1e4f}) {
    const Ref<SceneObject> torus = object("Torus", {{"radius", 2.0 * double(scale)}, {"tube_radius", 0.5 * double(scale)}});
    EXPECT_NEAR(double(torus->area()) / (4 * M_PI * M_PI * double(scale) * double(scale)), 1, 1e-6);
    // Through the middle: -2.5, -1.5, 1.5, 2.5; up through the tube: 0.5 sin.
    std::vector<float> found;
    for_all_hits(*torus, ray({-10 * scale, 0, 0}, {1, 0, 0}), [&](const SurfacePoint& p) { found.push_back(p.position.x); });
    ASSERT_EQ(found.size(), 4u);
    for (const size_t i : {0u, 1u, 2u, 3u})
      EXPECT_NEAR(found[i] / scale, std::vector<float>({-2.5f, -1.5f, 1.5f, 2.5f})[i], 1e-6f);
    int odd = 0;
    const Mean v = volume(*torus, 20000, 1, odd);
    EXPECT_EQ(odd, 0);
    EXPECT_NEAR(v.value(), 2 * M_PI * M_PI * 2 * 0.25 * std::pow(double(scale), 3), 4.5 * v.error());
  }
  EXPECT_THROW(object("Torus", {{"radius", 1}, {"tube_radius", 1.5}}), Error);
}

// Rays that graze the tube's top: just below it they go in and out, just above it they miss. Thin tubes as well.
TEST(Torus, GrazingRays) {
  for (const double tube : {0.25, 1e-3}) {
    const Ref<SceneObject> torus = object("Torus", {{"tube_radius", tube}});
    for (const double h : {1e-2, 1e-4}) {
      const float y = float(tube * (1 - h));
      // Over the top, along the circle's tangent, where both ends of the chord are nearly double roots.
      EXPECT_EQ(for_all_hits(*torus, ray({1, -5, y}, {0, 1, 0}), [](const auto&) {}), 2) << tube << " " << h;
      Hit hit;
      ASSERT_TRUE(torus->intersect(ray({1, 0, y}, {0, 1, 0}), hit));
      // (sqrt(1 + t^2) - 1)^2 = r^2 - z^2
      const double z = double(y), reach = std::sqrt(double(float(tube)) * double(float(tube)) - z * z);
      EXPECT_NEAR(double(hit.distance) / std::sqrt((1 + reach) * (1 + reach) - 1), 1, 1e-6) << tube << " " << h;
      EXPECT_FALSE(torus->occludes(ray({1, -5, float(tube * (1 + h))}, {0, 1, 0})));
    }
  }
}

TEST(Heightfield, AgreesWithItsFormula) {
  // z = x y at the grid's points is bilinear everywhere: the surface is z = 0.1 x y itself, whatever the cells.
  std::vector<double> heights;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 9; ++i) heights.push_back((i / 4.0 - 1) * (j / 2.5 - 1));
  const Ref<SceneObject> field =
      object("Heightfield", {{"heights", heights}, {"nx", 9}, {"ny", 6}, {"size", {2, 2}}, {"height", 0.1}});
  Random random(2);
  for (int i = 0; i < 3000; ++i) {
    const Point3 to = random.in_box(0.98f), from{random.between(-3, 3), random.between(-3, 3), random.between(0.5f, 4)};
    const Point3 aim{to.x, to.y, 0.1f * to.x * to.y};
    Hit hit;
    const Ray r = ray(from, normalize(aim - from));
    ASSERT_TRUE(field->intersect(r, hit));
    SurfacePoint p;
    field->surface_point(r, hit, p);
    EXPECT_NEAR(p.position.z, 0.1f * p.position.x * p.position.y, 1e-6f);
    EXPECT_LT(distance(p.position, r(hit.distance)), 1e-5f);
    EXPECT_NEAR(p.uv.x, p.position.x / 2 + 0.5f, 1e-6f);
    EXPECT_NEAR(dot(p.normal, normalize(Vector3{-0.1f * p.position.y, -0.1f * p.position.x, 1})), 1, 1e-6f);
  }
  // Straight down onto the grid lines, where cells meet.
  for (int i = 0; i <= 8; ++i)
    for (int j = 0; j <= 5; ++j) {
      Hit hit;
      EXPECT_TRUE(field->intersect(ray({-1 + float(i) * 0.25f, -1 + float(j) * 0.4f, 3}, {0, 0, -1}), hit)) << i << " " << j;
    }
  // Area of z = k x y over [-1, 1]^2 by Gauss's rule is the integral of sqrt(1 + k^2 (x^2 + y^2)).
  double area = 0;
  for (int i = 0; i < 400; ++i)
    for (int j = 0; j < 400; ++j) {
      const double x = (i + 0.5) / 200 - 1, y = (j + 0.5) / 200 - 1;
      area += std::sqrt(1 + 0.01 * (x * x + y * y)) / 40000;
    }
  EXPECT_NEAR(double(field->area()), area, 1e-5);
  EXPECT_THROW(object("Heightfield", {{"heights", {0, 1, 2}}, {"nx", 2}, {"ny", 2}}), Error);
  EXPECT_THROW(object("Heightfield", {{"size", {1, 0}}}), Error);
}

TEST(Heightfield, LargeFieldIsFoundQuickly) {
  constexpr int n = 1025;
  std::vector<double> heights(size_t(n) * n);
  for (size_t i = 0; i < heights.size(); ++i) heights[i] = double(mix_bits(i) >> 40) * 0x1p-24;
  const Ref<SceneObject> field =
      object("Heightfield", {{"heights", heights}, {"nx", n}, {"ny", n}, {"size", {1024, 1024}}, {"height", 1}});
  Random random(3);
  for (int i = 0; i < 20000; ++i) {  // against all cells the ray may cross: the first sign change of the height difference
    const float phi = 2 * pi * random.number();
    const Ray r = ray({random.between(-400, 400), random.between(-400, 400), 2},
                      normalize(Vector3{std::cos(phi), std::sin(phi), random.between(-2, -0.02f)}));
    Hit hit;
    ASSERT_TRUE(field->intersect(r, hit));
    EXPECT_NEAR(r(hit.distance).z, clamp(r(hit.distance).z, 0, 1), 1e-4f);
    Ray shorter = r;
    shorter.maximum = hit.distance * 0.9999f;
    EXPECT_FALSE(field->occludes(shorter));
  }
}

TEST(Curve, StraightTubesAreConesWithFlatEnds) {
  const double r0 = 0.3, r1 = 0.1, h = 2, slant = std::hypot(h, r0 - r1);
  // A cone tangent to both spheres, cut off perpendicularly at both ends: the radii there are r / sqrt(1 - k^2).
  const double c = std::sqrt(1 - square(float((r0 - r1) / h)) * 1.0), a = r0 / c, b = r1 / c;
  const double side = M_PI * (a + b) * std::hypot(h, a - b);
  EXPECT_GT(side, M_PI * (r0 + r1) * slant);
  for (const bool whole : {true, false}) {  // in one piece, or in two that must fit together
    std::vector<double> points{0, 0, 0, 0, 0, h}, radii{r0, r1};
    if (!whole) points = {0, 0, 0, 0, 0, h / 4, 0, 0, h}, radii = {r0, r0 + (r1 - r0) / 4, r1};
    const Ref<SceneObject> tube = object("Curve", {{"points", points}, {"radius", radii}}, odd_place);
    EXPECT_TRUE(tube->closed());
    EXPECT_NEAR(double(tube->area()), side + M_PI * (a * a + b * b), 1e-5);
    int odd = 0;
    const Mean v = volume(*tube, 20000, 4, odd);
    EXPECT_EQ(odd, 0);
    EXPECT_NEAR(v.value(), M_PI * h * (a * a + a * b + b * b) / 3, 4.5 * v.error());
  }
}

// Pappus: a bent tube has the volume pi r^2 times the length of its axis, however it is cut into pieces, because the wedges at
// bends cancel; at a bend too sharp for the tube, parts are counted twice.
TEST(Curve, BentTubesAreClosed) {
  struct Bent {
    const char* basis;
    std::vector<double> points;
  };
  const Bent bents[] = {{"linear", {0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1, 1, 2, 1, 2}},
                        {"catmull_rom", {0, 0, 0, 1, 0, 0, 1, 1, 0, 1, 1, 1, 2, 1, 2}},
                        {"b_spline", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 2}},
                        {"bezier", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 1}},
                        {"linear", {0, 0, 0, 1, 0, 0, 0.1, 0.2, 0, 0.1, 1, 0}},     // sharper than can be fitted
                        {"bezier", {0, 0, 0, 0.2, 0.2, 0, 0, 0.2, 0, 0.2, 0, 0}}};  // bends within its radius
  for (const Bent& bent : bents) {
    SCOPED_TRACE(bent.basis);
    int odd = 0;
    const Ref<SceneObject> tube = object("Curve", {{"points", bent.points}, {"radius", {0.1}}, {"basis", bent.basis}});
    const Mean v = volume(*tube, 15000, 5, odd);
    EXPECT_LE(odd, 1);
    if (std::string(bent.basis) == "linear" && bent.points.size() == 15) {
      EXPECT_NEAR(v.value(), M_PI * 0.01 * (3 + std::sqrt(2.0)), 4.5 * v.error());
      EXPECT_NEAR(double(tube->area()), M_PI * 0.2 * (3 + std::sqrt(2.0)) + 2 * M_PI * 0.01, 1e-5);
    }
    Random random(6);  // points by area lie on the surface; 1 / pdf averages to the area
    Mean area;
    for (int i = 0; i < 8000; ++i) {
      const SurfaceSample s = tube->sample_area(random.pair(), 0);
      area.add(1 / double(s.pdf));
      EXPECT_NEAR(tube->area_pdf(s.point) / s.pdf, 1, 1e-4f);
    }
    EXPECT_NEAR(area.value(), double(tube->area()), 4.5 * area.error() + 1e-5);
  }
}

TEST(Curve, SplinesRunWhereTheyShould) {
  // The middle of a Bézier curve: (b0 + 3 b1 + 3 b2 + b3) / 8; of a B-spline's span (1, 23, 23, 1) / 48; a Catmull-Rom spline
  // passes through its points. A tube's point at u is its radius away from that point, perpendicular to the curve.
  const std::vector<double> points{0, 0, 0, 1, 0, 1, 2, 1, 1, 3, 1, 0};
  const auto at = [&](const char* basis, float u) {
    const Ref<SceneObject> tube =
        object("Curve", {{"points", points}, {"radius", {0.01}}, {"basis", std::string(basis)}, {"turn", 0.5}});
    Random random(7);
    SurfacePoint nearest;
    nearest.uv.x = 9;
    for (int i = 0; i < 40000; ++i)
      if (const SurfacePoint p = tube->sample_area(random.pair(), 0).point;
          p.primitive % 4 == 0 && std::abs(p.uv.x - u) < std::abs(nearest.uv.x - u))
        nearest = p;
    EXPECT_LT(std::abs(dot(nearest.normal, normalize(nearest.dpdu))), 1e-4f);
    return nearest.position - 0.01f * Vector3(nearest.normal);
  };
  EXPECT_LT(distance(at("bezier", 0.5f), {1.5f, 0.5f, 0.75f}), 2e-3f);
  EXPECT_LT(distance(at("b_spline", 0.5f), {1.5f, 0.5f, 46 / 48.0f}), 2e-3f);
  EXPECT_LT(distance(at("catmull_rom", 1 / 3.0f), {1, 0, 1}), 2e-3f);
  // Of four evenly spaced points on a parabola, here z = x (3 - x) / 2, the spline is that parabola between the inner two.
  EXPECT_LT(distance(at("catmull_rom", 0.5f), {1.5f, 0.5f, 1.125f}), 2e-3f);
}

TEST(Curve, RibbonsAreFlat) {
  const Ref<SceneObject> ribbon =
      object("Curve", {{"points", {0, 0, 0, 2, 0, 0}}, {"radius", {0.5, 0.25}}, {"form", "ribbon"}, {"normals", {0, 0, 1}}});
  EXPECT_FALSE(ribbon->closed());
  EXPECT_NEAR(ribbon->area(), 1.5f, 1e-5f);  // a trapezoid
  Hit hit;
  ASSERT_TRUE(ribbon->intersect(ray({1, 0.3f, 1}, {0, 0, -1}), hit));
  EXPECT_FALSE(ribbon->occludes(ray({1.9f, 0.3f, 1}, {0, 0, -1})));
  SurfacePoint p;
  ribbon->surface_point(ray({1, 0.3f, 1}, {0, 0, -1}), hit, p);
  EXPECT_NEAR(p.uv.x, 0.5f, 1e-6f);
  EXPECT_NEAR(p.uv.y, 0.9f, 1e-6f);  // y = (2 v - 1) 0.375
  EXPECT_EQ(p.normal, Normal3(0, 0, 1));
  EXPECT_THROW(object("Curve", {{"points", {0, 0, 0, 0, 0, 2}}, {"form", "ribbon"}, {"normals", {0, 0, 1}}}), Error);
  EXPECT_THROW(object("Curve", {{"points", {0, 0, 0, 0, 0, 1}}, {"radius", {0.1, 3}}}), Error);
  EXPECT_THROW(object("Curve", {{"points", {0, 0, 0, 0, 0, 1, 0, 1, 1}}, {"counts", {2}}}), Error);
  EXPECT_THROW(object("Curve", {{"points", {0, 0, 0, 0, 0, 1, 0, 1, 1}}, {"basis", "bezier"}}), Error);
}

TEST(Polygon, HolesAreLeftOut) {
  Random random(8);
  for (int round = 0; round < 40; ++round) {
    // A star with star-shaped holes on a grid, each at most 0.4 wide.
    const auto star = [&](double x, double y, double low, double high, int n, std::vector<double>& out) {
      double area = 0;
      std::vector<double> r(size_t(n), 0.0);
      for (double& radius : r) radius = double(random.between(float(low), float(high)));
      for (int i = 0; i < n; ++i) {
        const double phi = 2 * M_PI * i / n;
        out.insert(out.end(), {x + r[size_t(i)] * std::cos(phi), y + r[size_t(i)] * std::sin(phi), 0});
        area += 0.5 * r[size_t(i)] * r[size_t((i + 1) % n)] * std::sin(2 * M_PI / n);
      }
      return area;
    };
    std::vector<double> outer, holes, counts;
    double area = star(0, 0, 2.6, 4, 7 + round, outer);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y) {
        const int n = 3 + (round + x + 3 * y + 4) % 9;
        area -= star(x, y, 0.05, 0.45, n, holes);
        counts.push_back(n);
      }
    const Ref<SceneObject> polygon = object("Polygon", {{"points", outer}, {"holes", holes}, {"hole_counts", counts}});
    EXPECT_NEAR(polygon->area(), area, 1e-4 * area);
    EXPECT_FALSE(polygon->occludes(ray({1, -1, 1}, {0, 0, -1})));
    EXPECT_TRUE(polygon->occludes(ray({0.5f, -0.5f, 1}, {0, 0, -1})));
    const Vector3 down{0, 0, -1};
    for (int i = 0; i < 50; ++i)  // nothing is covered twice
      EXPECT_LE(for_all_hits(*polygon, ray({random.between(-3, 3), random.between(-3, 3), 1}, down), [](const auto&) {}), 1);
  }
}

TEST(Polygon, FaultyHolesAreErrors) {
  const std::vector<double> square{0, 0, 0, 4, 0, 0, 4, 4, 0, 0, 4, 0};
  const auto with = [&](const std::vector<double>& holes, const std::vector<double>& counts = {}) {
    return object("Polygon", {{"points", square}, {"holes", holes}, {"hole_counts", counts}});
  };
  EXPECT_NEAR(with({1, 1, 0, 2, 1, 0, 2, 2, 0, 1, 2, 0})->area(), 15, 1e-5f);
  EXPECT_NEAR(with({0, 0, 0, 2, 1, 0, 1, 2, 0})->area(), 14.5f, 1e-5f);                                  // touches a corner
  EXPECT_NEAR(with({1, 1, 0, 2, 1, 0, 2, 2, 0, 2, 2, 0, 3, 2, 0, 3, 3, 0}, {3, 3})->area(), 15, 1e-5f);  // touch each other
  EXPECT_THROW(with({3, 1, 0, 5, 1, 0, 5, 2, 0}), Error);                                                // crosses
  EXPECT_THROW(with({5, 1, 0, 6, 1, 0, 6, 2, 0}), Error);                                                // outside
  EXPECT_THROW(with({1, 1, 0, 3, 1, 0, 3, 3, 0, 2, 1.2, 0, 2.5, 1.2, 0, 2.5, 1.5, 0}, {3, 3}), Error);   // nested
  EXPECT_THROW(with({1, 1, 0, 2, 1, 0, 2, 2, 0.5}), Error);                                              // not in the plane
  EXPECT_THROW(with({1, 1, 0, 2, 1, 0}), Error);                                                         // two points
  EXPECT_THROW(with({1, 1, 0, 2, 1, 0, 2, 2, 0}, {4}), Error);                                           // count
}

}  // namespace
}  // namespace etendue
