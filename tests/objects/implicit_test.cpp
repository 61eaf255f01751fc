// Quadrics, metaballs, grids of distances and formulas: against closed forms; and thin features are not missed.

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "etendue/language/language.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

SurfacePoint located(const SceneObject& o, const Ray& r, const Hit& hit) {
  SurfacePoint p;
  o.surface_point(r, hit, p);
  return p;
}

/// Distances of all crossings along a ray; each is found by a ray that leaves the point before.
std::vector<double> crossings(const SceneObject& o, Ray r) {
  std::vector<double> all;
  const Point3 start = r.origin;
  for (Hit hit; all.size() < 100 && o.intersect(r, hit); hit = {}) {
    const SurfacePoint p = located(o, r, hit);
    all.push_back(double(dot(p.position - start, r.direction)));
    p.leave(r.direction, r);
  }
  return all;
}

std::string error_of(const std::string& text) {
  try {
    prepare_tree(*parse_component(text, "text"));
  } catch (const Error& e) {
    return std::to_string(e.location.line) + ":" + std::to_string(e.location.column) + " " + e.what();
  } catch (const Errors& e) {
    return e.errors.front().what();
  }
  return "no error";
}

// ---- areas in closed form ---------------------------------------------------------------------------------------------

struct Form {
  std::string name;
  Ref<SceneObject> object;
  double area;
};

std::vector<Form> forms() {
  const double pi2 = M_PI * M_PI;
  const Setting open("capped", false), closed("capped", true);
  const std::vector<Setting> cylinder{{"squares", {1, 1, 0}}, {"constant", -0.25}},
      cone{{"squares", {1, 1, -1}}, {"constant", 0.0}};
  const auto also = [](std::vector<Setting> a, const Setting& b) {
    a.push_back(b);
    return a;
  };
  const double single = std::sqrt(1 - std::cbrt(0.2));  // for a single ball, in units of its radius
  return {{"sphere", object("Quadric"), 4 * M_PI},
          {"open cylinder", object("Quadric", also(cylinder, open)), 2 * M_PI},
          {"closed cylinder", object("Quadric", also(cylinder, closed)), 2.5 * M_PI},
          // Two cones of slope 1, clipped by a cube: both over the square [-1, 1]^2, each sqrt(2) times its area.
          {"double cone", object("Quadric", also(cone, open)), 2 * M_PI * std::sqrt(2.0)},
          {"half space", object("Quadric", {{"squares", {0, 0, 0}}, {"linear", {0, 0, 1}}, {"constant", 0.0}}), 16},
          {"one ball", object("Metaballs", {{"centres", {0, 0, 0}}}), 4 * M_PI * single * single},
          {"torus", object("ImplicitSurface"), 4 * pi2 * 0.65 * 0.3},
          {"ball of a formula", object("ImplicitSurface", {{"formula", std::string("sqrt(x*x + y*y + z*z) - 0.8")}}),
           4 * M_PI * 0.64}};
}

TEST(Implicit, AreasAreThoseOfClosedForms) {
  for (const Form& f : forms()) {
    SCOPED_TRACE(f.name);
    const double area = double(f.object->area(0));
    EXPECT_NEAR(area / f.area, 1, 1e-3);
    EXPECT_LE(std::abs(area / f.area - 1), double(f.object->area_error(0)) + 1e-5);
    EXPECT_LT(f.object->area_error(0), 0.01f);
  }
}

TEST(Implicit, StretchedSpheresHaveTheAreaOfASpheroid) {
  const double a = 1, c = 3, e = std::sqrt(1 - a * a / (c * c));  // prolate
  const double area = 2 * M_PI * a * a * (1 + c / (a * e) * std::asin(e));
  const Transform stretch = Transform::rotate(0.4f, {1, 2, 3}) * Transform::scale({1, 1, -3});
  EXPECT_NEAR(double(object("Quadric", {}, stretch)->area(0)) / area, 1, 1e-3);
}

TEST(Implicit, PointsLieEvenlyOnTheSurface) {
  // A torus: the fraction of points outside its middle circle is (pi + 2 r / R) / (2 pi), because the area between the tube's
  // angles phi and phi + d phi is proportional to (1 + r / R cos phi) / (2 pi). 5 standard errors.
  const Ref<SceneObject> torus = object("ImplicitSurface");
  Random random(11);
  Mean outer, up;
  for (int i = 0; i < 8000; ++i) {
    const SurfaceSample s = torus->sample_area(random.pair(), 0);
    ASSERT_FLOAT_EQ(s.pdf, 1 / torus->area(0));
    const Point3& p = s.point.position;
    ASSERT_NEAR(std::hypot(std::hypot(p.x, p.y) - 0.65f, p.z), 0.3f, 1e-6f);
    outer.add(std::hypot(p.x, p.y) > 0.65f);
    up.add(double(p.z) > 0 && p.x > 0);
  }
  EXPECT_NEAR(outer.value(), 0.5 + 0.3 / 0.65 / M_PI, 5 * outer.error());
  EXPECT_NEAR(up.value(), 0.25, 5 * up.error());
}

// ---- rays ---------------------------------------------------------------------------------------------------------------

TEST(Implicit, ClosedSolidsAreCrossedInPairsWithinWhichTheirVolumeLies) {
  // The mean length inside over parallel rays, times the cross section, is the volume.
  struct Solid {
    Ref<SceneObject> object;
    double volume;
  };
  const double lone = std::sqrt(1 - std::cbrt(0.2));
  const Solid solids[] = {
      {object("Quadric", {{"squares", {1, 0, 1}}, {"constant", -0.25}}), M_PI / 2},
      {object("Quadric", {{"squares", {1, 1, -1}}, {"constant", 0.0}}), 2 * M_PI / 3},
      {object("Metaballs", {{"centres", {0, 0, 0}}}), 4 * M_PI / 3 * lone * lone * lone},
      {object("ImplicitSurface"), 2 * M_PI * M_PI * 0.65 * 0.09},
      {object("ImplicitSurface", {{"formula", std::string("max(abs(x), max(abs(y), abs(z))) - 0.7")}}), 2.744},
      {object("SignedDistanceGrid", {{"resolution", {2, 2, 2}}, {"distances", {-1, -1, -1, -1, 1, 1, 1, 1}}}), 4}};
  Random random(12);
  for (const Solid& s : solids) {
    ASSERT_TRUE(s.object->closed());
    Mean length;
    for (int i = 0; i < 6000; ++i) {
      const Frame frame(Normal3(random.direction()));
      const Vector3 across = random.between(-2, 2) * frame.s + random.between(-2, 2) * frame.t;
      const std::vector<double> t = crossings(*s.object, ray(Point3{} + across - 5 * Vector3(frame.n), Vector3(frame.n)));
      ASSERT_EQ(t.size() % 2, 0u);
      double inside = 0;
      for (size_t k = 0; k + 1 < t.size(); k += 2) inside += t[k + 1] - t[k];
      length.add(16 * inside);
    }
    EXPECT_NEAR(length.value(), s.volume, 5 * length.error());
  }
}

TEST(Implicit, SmallLargeAndFarOnesAreFoundAndLeft) {
  // A unit sphere that its transform makes small or large and moves far off: rays that leave it outwards do not hit it again.
  Random random(13);
  for (const char* name : {"Quadric", "Metaballs", "ImplicitSurface", "SignedDistanceGrid"})
    for (const float scale : {1e-3f, 1.0f, 1e5f})
      for (const float off : {0.0f, 1e3f}) {
        SCOPED_TRACE(name + std::to_string(scale) + " " + std::to_string(off));
        std::vector<Setting> settings;
        if (name == std::string("ImplicitSurface")) settings = {{"formula", std::string("x*x + y*y + z*z - 0.8")}};
        if (name == std::string("Metaballs")) settings = {{"centres", {0, 0, 0}}};
        const Point3 middle = Point3{} + off * scale * Vector3{1, -0.7f, 0.4f};
        const Ref<SceneObject> o =
            object(name, settings, Transform::translate(middle - Point3{}) * Transform::scale({scale, scale, scale}));
        int again = 0, missed = 0;
        for (int i = 0; i < 1000; ++i) {
          Vector3 d = random.direction();
          const Ray in = ray(middle - 3 * scale * d, d);
          Hit hit;
          ASSERT_TRUE(o->intersect(in, hit));
          const SurfacePoint p = located(*o, in, hit);
          d = random.direction();
          if (dot(p.normal, d) < 0) d = -d;
          Ray r;
          p.leave(d, r);
          again += name != std::string("SignedDistanceGrid") && o->occludes(r);  // a trilinear surface is not convex
          p.leave(-d, r);
          missed += dot(p.normal, d) > 0.05f && !o->occludes(r);
        }
        EXPECT_EQ(again, 0);
        EXPECT_EQ(missed, 0);
      }
}

TEST(Implicit, NothingThinIsMissed) {
  // Sheets with the thickness of a thousandth of the box's edge, at positions that a coarse search would step over; and a
  // metaball that only just exceeds the threshold.
  Random random(14);
  const Ref<SceneObject> sheet =
      object("ImplicitSurface", {{"formula", std::string("abs(x - 0.31234 + 0.05*sin(3*y)) - 0.0005")}});
  const Ref<SceneObject> plate =
      object("Quadric", {{"squares", {1, 0, 0}}, {"linear", {-0.6, 0, 0}}, {"constant", 0.09 - 1e-6}});
  const Ref<SceneObject> seed = object("Metaballs", {{"centres", {0, 0, 0}}, {"threshold", 0.999}});
  for (int i = 0; i < 2000; ++i) {
    const Point3 to{random.between(-0.2f, 0.2f), random.between(-0.9f, 0.9f), random.between(-0.9f, 0.9f)};
    EXPECT_EQ(crossings(*sheet, ray(to - 3 * Vector3{1, 0, 0}, {1, 0, 0})).size(), 2u);
    EXPECT_EQ(crossings(*plate, ray(to - 3 * Vector3{1, 0, 0}, {1, 0, 0})).size(), 2u);
    const Vector3 d = random.direction();
    EXPECT_EQ(crossings(*seed, ray(Point3{} - 3 * d, d)).size(), 2u);
  }
}

TEST(Implicit, GridsAreInterpolatedExactly) {
  // A trilinear field in one cell: T = x y z - 1/8 on [0, 1]^3, by its corners. Along the diagonal x = y = z = 1/2.
  const Ref<SceneObject> o =
      object("SignedDistanceGrid", {{"resolution", {2, 2, 2}},
                                    {"low", {0, 0, 0}},
                                    {"high", {1, 1, 1}},
                                    {"capped", false},
                                    {"distances", {-.125, -.125, -.125, -.125, -.125, -.125, -.125, .875}}});
  Random random(15);
  for (int i = 0; i < 2000; ++i) {
    const float y = random.between(0.3f, 1), z = random.between(0.3f, 1), x = 0.125f / (y * z);
    const Ray r = ray({-1, y, z}, {1, 0, 0});
    Hit hit;
    ASSERT_EQ(o->intersect(r, hit), x < 1) << x;
    if (!hit) continue;
    const SurfacePoint p = located(*o, r, hit);
    EXPECT_NEAR(p.position.x, x, 1e-6f);
    EXPECT_NEAR(dot(p.normal, normalize(Vector3{y * z, x * z, x * y})), 1, 1e-6f);
  }
}

TEST(Implicit, GridsComeFromFiles) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("etendue-grid-" + std::to_string(getpid()) + ".npy")).string();
  std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (3, 4, 5), }";
  header.resize(118, ' ');
  std::string bytes = std::string("\x93NUMPY\x01\x00", 8) + char(118) + char(0) + header;
  for (int i = 0; i < 60; ++i) {  // z - 0.25 with z from 0 to 2
    const float d = float(i / 20) - 0.25f;
    char raw[4];
    std::memcpy(raw, &d, 4);
    bytes.append(raw, 4);
  }
  std::ofstream(path, std::ios::binary) << bytes;
  const Ref<SceneObject> o =
      object("SignedDistanceGrid", {{"file", path}, {"low", {0, 0, 0}}, {"high", {4, 3, 2}}, {"capped", false}});
  EXPECT_NEAR(o->area(0), 12, 1e-3f);
  EXPECT_NEAR(crossings(*o, ray({1.3f, 2.7f, 9}, {0, 0, -1})).at(0), 8.75, 1e-5);
  std::filesystem::remove(path);
}

// ---- input ----------------------------------------------------------------------------------------------------------------

TEST(Implicit, ErrorsSayWhatAndWhere) {
  EXPECT_EQ(error_of("ImplicitSurface { formula: \"x + q\" }").substr(0, 4), "1:33");
  EXPECT_NE(error_of("ImplicitSurface { formula: \"2 + x*x\" }").find("no surface"), std::string::npos);
  EXPECT_NE(error_of("Quadric { squares: [0, 0, 0] }").find("squares"), std::string::npos);
  EXPECT_NE(error_of("Quadric { low: [2, 0, 0] m }").find("box is empty"), std::string::npos);
  EXPECT_NE(error_of("Metaballs { radii: [1, 2, 3] m }").find("radii"), std::string::npos);
  EXPECT_NE(error_of("Metaballs { threshold: 5 }").find("no surface"), std::string::npos);
  EXPECT_NE(error_of("SignedDistanceGrid { distances: [1, 2] m }").find("2 distances"), std::string::npos);
  EXPECT_FALSE(object("Quadric", {{"squares", {1, 1, 0}}, {"constant", -0.25}, {"capped", false}})->closed());
}

TEST(Implicit, FormulasKnowAllFunctions) {
  // The plane x = 1/4 or the like, written with each function; the gradient is along x.
  for (const char* formula : {"abs(x - 1) - 0.75",
                              "sqrt(x + 1) - sqrt(1.25)",
                              "exp(x) - exp(0.25)",
                              "log(x + 2) - log(2.25)",
                              "sin(x) - sin(0.25)",
                              "cos(x + 1) - cos(1.25)",
                              "tan(x) - tan(0.25)",
                              "atan2(x, 2) - atan2(0.25, 2)",
                              "pow(x + 2, 1.5) - pow(2.25, 1.5)",
                              "pow(x, 3) - 0.015625",
                              "min(x, 3) - 0.25",
                              "max(x, -3) - 0.25",
                              "step(0.25, x) - 0.5",
                              "clamp(x, -2, 2) - 0.25",
                              "mix(-1, 1, x) + 0.5",
                              "smoothstep(-2, 2, x) - 0.593261719",
                              "mean(x) - 0.25",
                              "1 / (x + 3) - 1 / 3.25",
                              "floor(x + 0.75) - 0.5 + 0*y",
                              "fract(x / 4) - 0.0625",
                              "mod(x, 8) - 0.25"}) {
    SCOPED_TRACE(formula);
    const Ref<SceneObject> o =
        object("ImplicitSurface",
               {{"formula", std::string(formula)}, {"low", {0.01, -1, -1}}, {"high", {1, 1, 1}}, {"capped", false}});
    const Ray r = ray({2, 0.2f, 0.3f}, {-1, 0, 0});
    Hit hit;
    ASSERT_TRUE(o->intersect(r, hit));
    const SurfacePoint p = located(*o, r, hit);
    EXPECT_NEAR(p.position.x, 0.25f, 1e-6f);
    EXPECT_NEAR(std::abs(p.normal.x), 1, 1e-6f);
  }
}

}  // namespace
}  // namespace etendue
