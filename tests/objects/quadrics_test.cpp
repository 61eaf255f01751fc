// Ellipsoid, Annulus, InfinitePlane, Triangle, Cylinder, Tube, Cone, Paraboloid and Hyperboloid against closed forms.

#include <functional>

#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

struct Case {
  std::string name;
  std::vector<Setting> settings;
  double area = 0, volume = 0;                             ///< [m^2], [m^3]; no volume: open
  std::function<double(double, double, double)> off = {};  ///< distance of a point near the side from it [m]
  bool convex = true;
};

/// |Q| / |grad Q| of Q = x^2 + y^2 - (a z^2 + b z + c).
std::function<double(double, double, double)> off_revolved(double a, double b, double c) {
  return [=](double x, double y, double z) {
    const double slope = a * z + b / 2, q = x * x + y * y - ((a * z + b) * z + c);
    return std::abs(q) / (2 * std::sqrt(x * x + y * y + slope * slope) + 1e-300);
  };
}

std::vector<Case> solids() {
  const double rim = std::sqrt(5.0), p = std::sqrt(0.75 * 1.75) / 0.5;  // of the hyperboloid: s = 3/4, w = 1/2, z = 1
  return {{"Cylinder", {{"radius", 0.5}, {"height", 2}}, 2.5 * M_PI, M_PI / 2, off_revolved(0, 0, 0.25)},
          {"Cone", {{"radius", 1}, {"height", 2}}, M_PI * (1 + rim), 2 * M_PI / 3, off_revolved(0.25, -1, 1)},
          {"Cone",
           {{"radius", 0.5}, {"top_radius", 1}, {"height", 1}},
           M_PI * (1.25 + 1.5 * std::sqrt(1.25)),
           M_PI * 1.75 / 3,
           off_revolved(0.25, 0.5, 0.25)},
          {"Paraboloid", {{"radius", 1}, {"height", 1}}, M_PI * (1 + (5 * rim - 1) / 6), M_PI / 2, off_revolved(0, 1, 0)},
          {"Hyperboloid",
           {{"waist_radius", 0.5}, {"radius", 1}, {"height", 2}},
           M_PI * (2 + std::sqrt(1 + p * p) + std::asinh(p) / p),
           M_PI * (0.5 + 0.5),
           off_revolved(0.75, 0, 0.25),
           false},
          {"Tube",
           {{"inner_radius", 0.5}, {"radius", 1}, {"height", 1}},
           M_PI * (3 + 2 * 0.75),
           0.75 * M_PI,
           [](double x, double y, double) {
             const double r = std::sqrt(x * x + y * y);
             return std::min(std::abs(r - 1), std::abs(r - 0.5));
           },
           false},
          {"Ellipsoid",
           {{"radii", {1, 1, 2.5}}},
           2 * M_PI * (1 + 2.5 / std::sqrt(0.84) * std::asin(std::sqrt(0.84))),
           4 * M_PI / 3 * 2.5,
           [](double x, double y, double z) {
             const double q = x * x + y * y + z * z / 6.25 - 1;
             return std::abs(q) / (2 * std::sqrt(x * x + y * y + z * z / (6.25 * 6.25)));
           }}};
}

TEST(Quadrics, Areas) {
  for (const Case& c : solids()) EXPECT_NEAR(object(c.name, c.settings)->area(0) / c.area, 1, 1e-6) << c.name;
  // Oblate: 2 pi a^2 + pi c^2 / e log((1 + e) / (1 - e)), e^2 = 1 - c^2 / a^2.
  const double e = std::sqrt(1 - 0.04);
  const double oblate = 2 * M_PI + M_PI * 0.04 / e * std::log((1 + e) / (1 - e));
  EXPECT_NEAR(object("Ellipsoid", {{"radii", {1, 0.2, 1}}})->area(0) / oblate, 1, 1e-6);
  EXPECT_NEAR(object("Ellipsoid", {{"radii", {3, 3, 3}}})->area(0) / (36 * M_PI), 1, 1e-6);
  // A flat one has twice the area of a disc; one with three different radii is compared with quadrature over the unit sphere.
  EXPECT_NEAR(object("Ellipsoid", {{"radii", {2, 3, 1e-5}}})->area(0) / (12 * M_PI), 1, 1e-6);
  double sum = 0;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < n; ++k) {
      const double theta = M_PI * (i + 0.5) / n, phi = 2 * M_PI * (k + 0.5) / n, s = std::sin(theta);
      sum += s * std::hypot(2 * 3 * s * std::cos(phi), 1 * 3 * s * std::sin(phi), 1 * 2 * std::cos(theta));
    }
  EXPECT_NEAR(object("Ellipsoid", {{"radii", {1, 2, 3}}})->area(0) / (sum * 2 * M_PI * M_PI / (n * n)), 1, 1e-4);
  const Transform stretch = Transform::rotate(1, {1, 2, 3}) * Transform::scale({-2, 1, 4}) * Transform::rotate(0.5f, {0, 1, 1});
  const Ref<SceneObject> sphere = object("Sphere", {}, stretch);
  EXPECT_NEAR(object("Ellipsoid", {}, stretch)->area(0) / sphere->area(0), 1, 1e-4);
  EXPECT_NEAR(object("Annulus", {{"inner_radius", 1}, {"radius", 2}, {"sweep", 90}})->area(0), 0.75 * M_PI, 1e-5);
  EXPECT_NEAR(object("Triangle", {{"a", {1, 0, 0}}, {"b", {1, 2, 0}}, {"c", {1, 0, 3}}})->area(0), 3, 1e-6);
  EXPECT_NEAR(object("Cylinder", {{"caps", false}, {"sweep", 90}, {"height", 3}})->area(0), 1.5 * M_PI, 1e-5);
  EXPECT_NEAR(object("Paraboloid", {{"radius", 1}, {"height", 1e-5}, {"cap", false}})->area(0), M_PI, 1e-5);
  EXPECT_NEAR(object("Hyperboloid", {{"waist_radius", 1}, {"radius", 1}, {"height", 2}, {"caps", false}})->area(0), 4 * M_PI,
              1e-5);
}

/// Calls a function with every surface point on a ray and its distance from the ray's origin; returns their number.
template <class F>
int for_all_hits(const SceneObject& o, Ray r, const F& call) {
  const Point3 start = r.origin;
  const Vector3 d = r.direction;
  for (int n = 0; n < 16; ++n) {
    Hit hit;
    if (!o.intersect(r, hit)) return n;
    SurfacePoint p;
    o.surface_point(r, hit, p);
    call(p, dot(p.position - start, d));
    p.leave(d, r);
  }
  return 16;
}

TEST(Quadrics, LinesEncloseTheVolumeAndCrossInPairs) {
  // Isotropic lines through a ball of radius R: the mean of the lengths inside, times pi R^2, is the volume, and the mean
  // number of crossings, times 2 pi R^2, the area (Crofton). 5 standard errors.
  Random random(1);
  const Transform place = Transform::translate({3, -1, 2}) * Transform::rotate(1, {1, 2, 3}) * Transform::scale({-2, 2, 2});
  for (const Case& c : solids())
    for (const float scale : {1.0f, 2.0f}) {
      SCOPED_TRACE(c.name);
      const Ref<SceneObject> o = object(c.name, c.settings, scale == 1 ? Transform() : place);
      EXPECT_TRUE(o->closed());
      const Point3 centre = o->bounds().centre();
      const float radius = length(o->bounds().diagonal()) / 2;
      Mean inside, crossings;
      int odd = 0;
      for (int i = 0; i < 20000; ++i) {
        const Vector3 d = random.direction();
        const float across = radius * std::sqrt(random.number()), phi = 2 * pi * random.number();
        const Vector3 start = Frame(Normal3(d)).to_world({across * std::cos(phi), across * std::sin(phi), -2 * radius});
        double chord = 0;
        const int n = for_all_hits(*o, ray(centre + start, d), [&](const SurfacePoint& p, float t) {
          chord += dot(p.normal, d) > 0 ? double(t) : -double(t);
        });
        odd += n % 2;
        if (n % 2 == 0) inside.add(chord);
        crossings.add(n);
      }
      EXPECT_LE(odd, 2);
      const double disc = M_PI * double(radius) * double(radius), s = double(scale);
      EXPECT_NEAR(inside.value() * disc, c.volume * s * s * s, 5 * inside.error() * disc);
      EXPECT_NEAR(crossings.value() * 2 * disc, c.area * s * s, 10 * crossings.error() * disc);
    }
}

TEST(Quadrics, HitsLieOnTheSurfaceWithinTheirError) {
  // Also for small and large objects, and for rays from far away.
  Random random(2);
  for (const Case& c : solids())
    for (const double size : {1e-3, 1.0, 1e5})
      for (const double away : {3.0, 1e5}) {
        SCOPED_TRACE(c.name + " of size " + std::to_string(size) + " from " + std::to_string(away));
        std::vector<Setting> settings = c.settings;
        for (Setting& s : settings) {
          if (auto* number = const_cast<Number*>(s.value.as<Number>())) number->value *= size;
          if (auto* list = const_cast<Numbers*>(s.value.as<Numbers>()))
            for (double& x : list->values) x *= size;
        }
        const Ref<SceneObject> o = object(c.name, settings);
        int hits = 0;
        for (int i = 0; i < 1500; ++i) {
          const Point3 to = random.in_box(0.8f * float(size)), from = to + float(away * size) * random.direction();
          const Ray r = ray(from, normalize(to - from));
          for_all_hits(*o, r, [&](const SurfacePoint& p, float) {
            const double x = double(p.position.x) / size, y = double(p.position.y) / size, z = double(p.position.z) / size;
            ++hits;
            if (std::abs(p.normal.z) < 1 || c.name == "Ellipsoid") {
              EXPECT_LE(c.off(x, y, z) * size, double(p.error));
            }
            EXPECT_LE(double(p.error), 2e-6 * size);
            // The point lies on the ray, within the rounding of the ray's direction and of the point.
            const Vector3 aside = cross(p.position - r.origin, r.direction);
            EXPECT_LE(double(length(aside)), 4e-7 * (away + 3) * size);
          });
        }
        EXPECT_GT(hits, 800);
      }
}

TEST(Quadrics, SpecialRays) {
  const Ref<SceneObject> cylinder = object("Cylinder", {{"radius", 1}, {"height", 2}}), cone = object("Cone"),
                         bowl = object("Paraboloid"), tube = object("Tube", {{"inner_radius", 0.5}, {"height", 2}}),
                         waist = object("Hyperboloid", {{"waist_radius", 0.5}, {"radius", 1}, {"height", 2}});
  Hit hit;
  const auto t = [&](const Ref<SceneObject>& o, const Point3& from, const Vector3& d) {
    hit = {};
    return o->intersect(ray(from, d), hit) ? hit.distance : -1.0f;
  };
  EXPECT_EQ(t(cylinder, {0.3f, 0.4f, 5}, {0, 0, -1}), 4);  // along the axis
  EXPECT_EQ(t(cylinder, {1.5f, 0, 5}, {0, 0, -1}), -1);
  EXPECT_EQ(t(cylinder, {0, 0, 0}, {0, 0, 1}), 1);  // from inside
  EXPECT_EQ(t(cylinder, {-3, 0, 0}, {1, 0, 0}), 2);
  EXPECT_EQ(t(cylinder, {-3, 1.0001f, 0}, {1, 0, 0}), -1);
  EXPECT_EQ(t(cylinder, {0, 0, 1.5f}, {1, 0, 0}), -1);  // outside of the slab
  EXPECT_NEAR(t(cone, {0.5f, 0, 3}, {0, 0, -1}), 2.5f, 1e-6f);
  EXPECT_EQ(t(cone, {0, 0, -1}, {0, 0, 1}), 1);
  EXPECT_EQ(t(cone, {-1, 0, 2}, normalize(Vector3{-1, 0, 1})), -1);  // the other nappe does not exist
  EXPECT_NEAR(t(cone, {0.5f, 0, 1}, {-std::sqrt(0.5f), 0, -std::sqrt(0.5f)}), std::sqrt(0.125f),
              1e-6f);  // parallel to the side
  EXPECT_NEAR(t(bowl, {0.5f, 0, -1}, {0, 0, 1}), 1.25f, 1e-6f);
  EXPECT_EQ(t(tube, {0.2f, 0, 5}, {0, 0, -1}), -1);  // through the bore
  EXPECT_EQ(t(tube, {0.75f, 0, 5}, {0, 0, -1}), 4);
  EXPECT_EQ(t(tube, {0, 0, 0}, {1, 0, 0}), 0.5f);
  EXPECT_NEAR(t(waist, {-3, 0, 0}, {1, 0, 0}), 2.5f, 1e-6f);
  EXPECT_NEAR(t(waist, {0.9f, 0, 3}, {0, 0, -1}), 2, 1e-6f);  // a cap, then the side between cap and waist, and again
  EXPECT_EQ(for_all_hits(*waist, ray({0.9f, 0, 3}, {0, 0, -1}), [](const SurfacePoint&, float) {}), 4);
  // A quarter of an open pipe: from the +x to the +y axis.
  const Ref<SceneObject> quarter = object("Cylinder", {{"caps", false}, {"sweep", 90}});
  EXPECT_FALSE(quarter->closed());
  EXPECT_NEAR(t(quarter, {2, 2, 0}, normalize(Vector3{-1, -1, 0})), std::sqrt(8.0f) - 1, 1e-6f);
  EXPECT_EQ(t(quarter, {-2, 2, 0}, normalize(Vector3{1, -1, 0})), -1);
}

TEST(Quadrics, LeavingRaysDoNotReturn) {
  Random random(3);
  for (const Case& c : solids()) {
    if (!c.convex) continue;
    for (const float size : {1e-3f, 1.0f, 1e5f})
      for (const float away : {0.0f, 1000.0f}) {
        SCOPED_TRACE(c.name + " of size " + std::to_string(size) + ", away " + std::to_string(away));
        const Transform place = Transform::translate(away * size * random.direction()) *
                                Transform::rotate(random.between(0, 6), random.direction()) *
                                Transform::scale({size, size, size});
        const Ref<SceneObject> o = object(c.name, c.settings, place);
        int met = 0;
        for (int i = 0; i < 2000; ++i) {
          const SurfacePoint p = o->sample_area(random.pair(), 0).point;
          Vector3 d = random.direction();
          if (dot(p.normal, d) < 0) d = -d;
          if (i % 4 == 0) d = normalize(d - (1 - 1e-4f) * dot(p.normal, d) * Vector3(p.normal));  // grazing
          if (dot(p.normal, d) > 1e-5f) met += o->occludes(p.leave(d));
        }
        EXPECT_EQ(met, 0);
      }
  }
}

TEST(Quadrics, VisibleDensitiesIntegrateToOne) {
  // Over uniform directions, summed over the hits along each: the pdf of sample_visible() integrates to 1. From afar, close,
  // above and inside; stretched, so that pdfs are not simple multiples. 5 standard errors.
  Random random(4);
  const Transform stretched = Transform::rotate(0.7f, {1, 1, 0}) * Transform::scale({1.5f, 0.7f, 1});
  for (const Case& c : solids())
    for (const Point3 own : {Point3{2, -1, 0.3f}, {0.3f, 1.1f, 0.6f}, {0.2f, -0.1f, 3}, {0.3f, 0.1f, 0.4f}, {0.7f, 0, -2}}) {
      SCOPED_TRACE(c.name + " from z " + std::to_string(own.z));
      const Ref<SceneObject> o = object(c.name, c.settings, stretched);
      const Point3 from = stretched(own);
      Mean integral, sampled[3], expected[3];
      int found = 0;
      constexpr int rays = 8000;
      for (int i = 0; i < rays; ++i) {
        const Vector3 d = random.direction();
        double pdf = 0;
        for_all_hits(*o, ray(from, d),
                     [&](const SurfacePoint& p, float) { pdf += 4 * M_PI * double(o->visible_pdf(from, d, p)); });
        integral.add(pdf);
        for (int k = 0; k < 3; ++k) expected[k].add(pdf * double(d[k]));
        const SurfaceSample s = o->sample_visible(from, random.pair(), 0);
        for (int k = 0; k < 3; ++k) sampled[k].add(s.pdf > 0 ? double(s.direction[k]) : 0);
        if (s.pdf == 0) continue;
        ++found;
        if (std::abs(dot(s.point.normal, s.direction)) > 1e-3f) {
          EXPECT_NEAR(o->visible_pdf(from, s.direction, s.point) / s.pdf, 1, 1e-3f);
        }
      }
      // Samples that fail are missing from the integral.
      EXPECT_NEAR(integral.value(), double(found) / rays, 5 * integral.error() + 0.02);
      for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(sampled[k].value(), expected[k].value(), 5 * (sampled[k].error() + expected[k].error()) + 1e-3);
      EXPECT_GT(found, rays / 3);
    }
}

TEST(Quadrics, TangentsAreDerivatives) {
  Random random(5);
  std::vector<Case> cases = solids();
  cases.push_back({"Ellipsoid", {{"radii", {1, 2, 0.1}}}, {}});
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const Ref<SceneObject> o = object(c.name, c.settings);
    int wrong = 0, tested = 0;
    for (int i = 0; i < 500; ++i) {
      const SurfacePoint p = o->sample_area(random.pair(), 0).point;
      EXPECT_GT(dot(normalize(cross(p.dpdu, p.dpdv)), Vector3(p.normal)), 0.999f);
      const float h = 1e-3f;
      for (const Vector3& step : {h * p.dpdu, h * p.dpdv}) {
        Hit hit;
        const Ray down = ray(p.position + step + 0.02f * Vector3(p.normal), -Vector3(p.normal));
        if (!o->intersect(down, hit) || hit.primitive != p.primitive || hit.distance > 0.04f) continue;
        SurfacePoint q;
        o->surface_point(down, hit, q);
        const float du = q.uv.x - p.uv.x, dv = q.uv.y - p.uv.y;
        if (std::abs(du) > 0.5f || length(p.dpdu) < 0.3f) continue;  // at the seam or near a tip
        const Vector3 predicted = du * p.dpdu + dv * p.dpdv;
        ++tested;
        wrong += length(predicted - (q.position - p.position)) > 0.02f * length(step) + 1e-5f;
      }
    }
    EXPECT_GT(tested, 600);
    EXPECT_LE(wrong, 0.01 * tested);  // at a rim, where coordinates bend within a step
  }
}

TEST(Quadrics, InfinitePlane) {
  const Ref<SceneObject> plane = object("InfinitePlane", {}, Transform::translate({0, 0, 2}));
  EXPECT_TRUE(plane->unbounded());
  EXPECT_FALSE(plane->closed());
  Hit hit;
  ASSERT_TRUE(plane->intersect(ray({1, 2, 5}, {0.6f, 0, -0.8f}), hit));
  EXPECT_NEAR(hit.distance, 3.75f, 1e-6f);
  SurfacePoint p;
  plane->surface_point(ray({1, 2, 5}, {0.6f, 0, -0.8f}), hit, p);
  EXPECT_NEAR(p.uv.x, 3.25f, 1e-6f);
  EXPECT_NEAR(p.uv.y, 2, 1e-6f);
  EXPECT_FALSE(plane->occludes(p.leave(normalize(Vector3{1, 0, 1e-5f}))));
  EXPECT_FALSE(plane->occludes(p.leave({0, 0, -1})));
  EXPECT_TRUE(plane->occludes(ray({0, 0, 3}, normalize(Vector3{1, 0, -1e-6f}))));
  EXPECT_FALSE(plane->occludes(ray({0, 0, 3}, {1, 0, 0})));
  EXPECT_EQ(plane->sample_area({0.5f, 0.5f}, 0).pdf, 0);
  EXPECT_EQ(plane->sample_visible({0, 0, 3}, {0.5f, 0.5f}, 0).pdf, 0);
}

TEST(Quadrics, HostileMembersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(object("Annulus", {{"inner_radius", 1}}), Error);
  EXPECT_THROW(object("Tube", {{"inner_radius", 2}}), Error);
  EXPECT_THROW(object("Cone", {{"radius", 0}}), Error);
  EXPECT_THROW(object("Hyperboloid", {{"waist_radius", 2}}), Error);
  EXPECT_THROW(object("Ellipsoid", {{"radii", {1, 0, 1}}}), Error);
  EXPECT_THROW(object("Ellipsoid", {{"radii", {1e-30, 1e-30, 1e-30}}}), Error);
  EXPECT_THROW(object("Cylinder", {{"sweep", 0}}), Error);
  EXPECT_THROW(object("Cylinder", {{"height", nan}}), Error);
  EXPECT_THROW(object("Paraboloid", {{"radius", 1e30}}), Error);
  EXPECT_THROW(object("Triangle", {{"c", {2, 0, 0}}}), Error);
  EXPECT_NO_THROW(object("Cone", {{"radius", 0}, {"top_radius", 1}}));
}

}  // namespace
}  // namespace etendue
