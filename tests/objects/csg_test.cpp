// Solids made of others by union, intersection and difference, against closed forms and tests of points.

#include "components/objects/csg/csg.h"
#include "etendue/core/arena.h"
#include "etendue/language/language.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

Ref<SceneObject> solid(const std::string& text) {
  Ref<SceneObject> made = ref_cast<SceneObject>(parse_component(text, "solid"));
  prepare_tree(*made);
  return made;
}

/// The length of a ray inside a solid, from its crossings, which must enter and leave alternately.
double length_inside(const SceneObject& object, Ray r) {
  const Point3 begin = r.origin;
  double sum = 0;
  bool inside = false;
  for (int i = 0; i < 100; ++i) {
    Hit hit;
    if (!object.intersect(r, hit)) break;
    SurfacePoint p;
    object.surface_point(r, hit, p);
    const bool leaves = dot(p.normal, r.direction) > 0;
    EXPECT_EQ(leaves, inside);
    inside = !leaves;
    sum += (leaves ? 1 : -1) * double(distance(p.position, begin));
    p.leave(r.direction, r);
  }
  EXPECT_FALSE(inside);
  return sum;
}

/// The volume by parallel rays from a square of the given half width around the origin, with its standard error.
Mean volume(const SceneObject& object, double half, unsigned seed, int rays = 20000) {
  Random random(seed);
  Mean mean;
  const Vector3 d = random.direction();
  const Frame frame{Normal3(d)};
  const auto h = float(half);
  for (int i = 0; i < rays; ++i) {
    const Vector3 o = frame.to_world({random.between(-h, h), random.between(-h, h), -2 * h});
    mean.add(4 * half * half * length_inside(object, ray(Point3{} + o, d)));
  }
  return mean;
}

// Two unit balls whose centres are d apart share a lens of volume pi (4 + d) (2 - d)^2 / 12 and area 2 pi (2 - d).
TEST(Csg, BallsHaveTheVolumesAndAreasOfTheirLens) {
  const double d = 1.2, lens = M_PI * (4 + d) * (2 - d) * (2 - d) / 12, ball = 4 * M_PI / 3, cap = M_PI * (2 - d);
  struct Case {
    std::string name;
    double volume, area;
  };
  for (const Case& c : {Case{"Union", 2 * ball - lens, 8 * M_PI - 2 * cap}, Case{"Intersection", lens, 2 * cap},
                        Case{"Difference", ball - lens, 4 * M_PI}}) {
    SCOPED_TRACE(c.name);
    const auto object =
        solid(c.name + " { operands: [ Sphere { centre: [-0.6, 0, 0] m }, Sphere { centre: [0.6, 0, 0] m } ] }");
    const Mean found = volume(*object, 1.7, 1);
    EXPECT_NEAR(found.value(), c.volume, 5 * found.error());
    EXPECT_NEAR(double(object->area(0)), c.area, 2e-3 * c.area);
    EXPECT_LT(std::abs(double(object->area(0)) - c.area), double(object->area_error(0)) * c.area);
    EXPECT_TRUE(object->closed());
  }
}

// The middle of the hole, the wall and the remaining solid have known distances along a line.
TEST(Csg, ADrilledBoxHasWallsThatFaceTheHole) {
  const auto object = solid("Difference { operands: [ Box {}, Box { size: [0.5, 0.5, 1] m } ] }");  // ends flush with faces
  const auto first = [&](const Point3& o, const Vector3& d, SurfacePoint& p) {
    const Ray r = ray(o, d);
    Hit hit;
    if (!object->intersect(r, hit)) return infinity;
    object->surface_point(r, hit, p);
    return hit.distance;
  };
  SurfacePoint p;
  EXPECT_EQ(first({0.1f, 0.1f, 3}, {0, 0, -1}, p), infinity);  // through the hole: no surface remains at its ends
  EXPECT_EQ(first({0.1f, 0.1f, 0}, {0, 0, 1}, p), infinity);
  EXPECT_NEAR(first({0.1f, 0.1f, 0}, {1, 0, 0}, p), 0.15f, 1e-6f);
  EXPECT_NEAR(p.normal.x, -1, 1e-6f);
  EXPECT_NEAR(p.object_normal.x, -1, 1e-6f);
  EXPECT_GT(dot(cross(p.dpdu, p.dpdv), Vector3(p.normal)), 0);
  EXPECT_NEAR(first(p.exit({1, 0, 0}), {1, 0, 0}, p), 0.25f, 1e-5f);
  EXPECT_NEAR(p.normal.x, 1, 1e-6f);
  EXPECT_EQ(first(p.exit({1, 0, 0}), {1, 0, 0}, p), infinity);
  EXPECT_NEAR(double(object->area(0)), 4 + 2 * 0.75 + 4 * 0.5, 5e-3);
}

// Boxes that touch form one solid: no surface lies between them, nor where their side faces coincide. Far away and rotated, so
// that rounding decides which of two coincident faces is nearer.
TEST(Csg, CoincidentFacesLeaveNoGapsAndStopNoRays) {
  const std::string place = "transform: translate(300, -200, 100) * rotate(33, [1, 2, 3])";
  const auto object = solid("Union { operands: [ Box { centre: [-0.5, 0, 0] m, " + place + " }, Box { centre: [0.7, 0, 0] m, " +
                            "size: [1.4, 1, 1] m, " + place + " }, Box { centre: [0.3, 0, 0] m, size: [0.5, 1, 1] m, " + place +
                            " * rotate(90, \"x\") } ] }");
  Random random(4);
  const Transform t = solid("Box { " + place + " }")->transform.still();
  for (int i = 0; i < 20000; ++i) {
    // From inside, the nearest wall is that of the long box; a ray that leaves it outwards hits nothing.
    const Point3 o = t(Point3{random.between(-0.9f, 1.3f), random.between(-0.4f, 0.4f), random.between(-0.4f, 0.4f)});
    const Vector3 d = random.direction(), own = t.back(d);
    float expected = infinity;
    const Point3 from = t.back(o);
    const Point3 low{-1, -0.5f, -0.5f}, high{1.4f, 0.5f, 0.5f};
    for (int k = 0; k < 3; ++k) expected = std::min(expected, ((own[k] > 0 ? high : low)[k] - from[k]) / own[k]);
    Ray r = ray(o, d);
    Hit hit;
    ASSERT_TRUE(object->intersect(r, hit));
    ASSERT_NEAR(hit.distance, expected, 2e-3f + 1e-3f * expected);
    SurfacePoint p;
    object->surface_point(r, hit, p);
    const Vector3 out = normalize(Vector3(p.normal) + 0.95f * random.direction());
    p.leave(out, r);
    EXPECT_FALSE(object->occludes(r));  // the solid is convex
  }
}

// Nested, rotated, mirrored and moving: whether a point is inside, by rays and by each operand's own formula.
TEST(Csg, NestedSolidsHoldThePointsOfTheirFormula) {
  const auto object = solid(
      "Difference { transform: translate(1, 2, 3) * scale([1.5, -1, 0.5]), operands: [\n"
      "  Union { operands: [ Sphere {}, Box { centre: [1, 0, 0] m } ] },\n"
      "  Intersection { operands: [ Sphere { centre: [0.5, 0.5, 0] m, radius: 0.7 m }, Box { size: [1, 4, 4] m } ] },\n"
      "  Difference { operands: [ Sphere { centre: [0, -0.8, 0] m, radius: 0.5 m }, Sphere { centre: [0, -0.8, 0] m, radius: "
      "0.3 m } ] } ] }");
  const auto ball = [](const Point3& p, const Point3& c, float r) { return distance(p, c) < r; };
  const auto box = [](const Point3& p, const Point3& c, const Vector3& size) {
    const Vector3 d = abs(p - c);
    return d.x < size.x / 2 && d.y < size.y / 2 && d.z < size.z / 2;
  };
  Random random(5);
  int wrong = 0, within = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point3 p = random.in_box(1.6f);
    const bool expected = (ball(p, {}, 1) || box(p, {1, 0, 0}, {1, 1, 1})) &&
                          !(ball(p, {0.5f, 0.5f, 0}, 0.7f) && box(p, {}, {1, 4, 4})) &&
                          !(ball(p, {0, -0.8f, 0}, 0.5f) && !ball(p, {0, -0.8f, 0}, 0.3f));
    const Ray r = ray(object->transform.still()(p), random.direction());
    Hit hit;
    bool inside = false;
    if (object->intersect(r, hit)) {
      SurfacePoint q;
      object->surface_point(r, hit, q);
      inside = dot(q.normal, r.direction) > 0;
    }
    within += expected;
    wrong += inside != expected;
  }
  EXPECT_GT(within, 2000);
  EXPECT_LE(wrong, 2);
}

// A ball that moves through a box from which it is subtracted: at each time the area is that of the box with a hollow.
TEST(Csg, OperandsMoveWithinTheSolid) {
  const auto object = solid(
      "Difference { operands: [ Box {}, Sphere { radius: 0.3 m, transform: keyframes(0, translate(0, 0, 0), 1, "
      "translate(4, 0, 0)) } ] }");
  EXPECT_NEAR(double(object->area(0)), 6 + 4 * M_PI * 0.09, 0.02);
  EXPECT_NEAR(double(object->area(1)), 6, 0.02);
  const auto from_middle = [&](float time) {
    Hit hit;
    return object->intersect(ray({0, 0, 0}, {0, 0, 1}, time), hit) ? hit.distance : infinity;
  };
  EXPECT_NEAR(from_middle(0), 0.3f, 1e-6f);
  EXPECT_NEAR(from_middle(1), 0.5f, 1e-6f);
}

// Points by area, weighted by 1 / pdf, give the area of each part: of the hollow's spherical surface, and of a wall.
TEST(Csg, DensitiesByAreaGiveTheAreaOfEachPart) {
  const auto object = solid("Difference { operands: [ Box {}, Sphere { centre: [0, 0, 0.5] m, radius: 0.4 m } ] }");
  Random random(6);
  Mean bowl, top;
  for (int i = 0; i < 20000; ++i) {
    const SurfaceSample s = object->sample_area(random.pair(), 0);
    ASSERT_GT(s.pdf, 0);
    const float z = s.point.position.z;
    const bool on_ball = std::abs(distance(s.point.position, Point3{0, 0, 0.5f}) - 0.4f) < 1e-5f && z < 0.4999f;
    bowl.add(on_ball ? 1 / double(s.pdf) : 0);
    top.add(z > 0.49999f ? 1 / double(s.pdf) : 0);
  }
  EXPECT_NEAR(bowl.value(), 2 * M_PI * 0.16, 5 * bowl.error());
  EXPECT_NEAR(top.value(), 1 - M_PI * 0.16, 5 * top.error());

  // Balls far apart, which lines parallel to the axes often miss.
  const auto balls = solid("Union { operands: [ Sphere {}, Sphere { centre: [3, 3, 3] m, radius: 0.5 m } ] }");
  Mean small;
  for (int i = 0; i < 20000; ++i) {
    const SurfaceSample s = balls->sample_area(random.pair(), 0);
    ASSERT_GT(s.pdf, 0);
    small.add(s.point.position.x > 2 ? 1 / double(s.pdf) : 0);
  }
  EXPECT_NEAR(small.value(), M_PI, 5 * small.error());
}

TEST(Csg, SurfacesHaveTheShaderOfTheirOperandUnlessTheSolidHasItsOwn) {
  const std::string operands =
      "operands: [ Intersection { operands: [ Box { shader: Lambertian { color: 0.2 } }, Sphere { radius: 0.6 m, shader: "
      "Lambertian { color: 0.4 } } ] }, Sphere { centre: [0, 0, 0.5] m, radius: 0.3 m, shader: Lambertian { color: 0.6 } } ] }";
  const auto albedo = [](const SceneObject& object, const Vector3& towards) {
    const Ray r = ray(Point3{} - 3 * towards, towards);
    Hit hit;
    SurfacePoint p;
    EXPECT_TRUE(object.intersect(r, hit));
    object.surface_point(r, hit, p);
    Arena arena;
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, 500, 1);
    const Scatter* scatter = object.shader->bind(p, w, arena);
    return scatter ? scatter->albedo(Vector3(p.normal))[0] : 0;
  };
  const auto each = solid("Difference { " + operands);
  EXPECT_NEAR(albedo(*each, {1, 0, 0}), 0.2f, 1e-3f);                    // a face of the box
  EXPECT_NEAR(albedo(*each, normalize(Vector3{1, 1, 0})), 0.4f, 1e-3f);  // where the ball cut its edge
  EXPECT_NEAR(albedo(*each, {0, 0, -1}), 0.6f, 1e-3f);                   // the hollow
  Hit hit;
  const Ray down = ray({0, 0, 3}, {0, 0, -1});
  ASSERT_TRUE(each->intersect(down, hit));
  EXPECT_NEAR(hit.distance, 2.8f, 1e-5f);  // the bottom of the hollow
  EXPECT_EQ(each->shader->possible_lobes(), diffuse_reflection);
  const auto whole = solid("Difference { shader: Lambertian { color: 0.8 }, " + operands);
  EXPECT_NEAR(albedo(*whole, {1, 0, 0}), 0.8f, 1e-3f);
}

TEST(Csg, WhatHasNoInsideIsRefusedWhereItStands) {
  const auto message = [](const std::string& text) {
    try {
      solid(text);
    } catch (const Error& e) {
      return std::to_string(e.location.line) + " " + e.what();
    }
    return std::string();
  };
  EXPECT_NE(message("Union { operands: [\n  Sphere {},\n  Disc {} ] }").find("3 Disc: it cannot be"), std::string::npos);
  EXPECT_NE(message("Union { operands: [] }").find("1 Union.operands"), std::string::npos);
  const auto nothing = solid("Difference { operands: [ Sphere {}, Box { size: [3, 3, 3] m } ] }");
  EXPECT_FALSE(nothing->bounds().empty());
}

// Operands whose surfaces are open, or whose faces are oriented inconsistently, are refused; closed and consistent ones are
// accepted.
TEST(Csg, OperandsThatAreOpenOrDisagreeAreRefusedWhereTheyStand) {
  const auto message = [](const std::string& operands) {
    try {
      solid("Difference { operands: [ Box {},\n" + operands + " ] }");
    } catch (const Error& e) {
      return std::to_string(e.location.line) + " " + e.what();
    }
    return std::string();
  };
  const auto tetrahedron = [](const std::string& faces, const std::string& more = "") {
    return "TriangleMesh { positions: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] m, triangles: [" + faces + "]" + more + " }";
  };
  const std::string whole = "[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]", moving = ", times: [0, 1], motion_positions: ";
  const std::string open = "2 TriangleMesh: it cannot be part of a solid: its surface is not closed";
  EXPECT_EQ(message(tetrahedron(whole)), "");
  EXPECT_EQ(message(tetrahedron("[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]")), "");  // inside out, but consistently
  EXPECT_EQ(message(tetrahedron("[0, 2, 1], [0, 1, 3], [0, 3, 2]")).find(open), 0u);
  EXPECT_EQ(message(tetrahedron("[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 3, 2]")).find(open), 0u);           // one face reversed
  EXPECT_EQ(message(tetrahedron(whole + ", [1, 2, 3]")).find(open), 0u);                                  // one twice
  EXPECT_EQ(message(tetrahedron(whole, moving + "[[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]] m")), "");  // it grows
  EXPECT_EQ(message("Curve { form: ribbon }").substr(0, 9), "2 Curve: ");
  EXPECT_EQ(message("Union { operands: [ Sphere {},\nUnion { operands: [ Sphere {},\nDisc {} ] } ] }").substr(0, 8),
            "4 Disc: ");
}

TEST(Csg, WhereNothingIsLeftThereIsAWarning) {
  testing::internal::CaptureStderr();
  solid("\nDifference {\n operands: [ Sphere {}, Box { size: [3, 3, 3] m } ] }");
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find(":3:"), std::string::npos) << said;
  EXPECT_NE(said.find("nothing seems to be left"), std::string::npos) << said;
}

// A part's number has 32 bits: 16 of them distinguish 2^16 objects, and 16 remain for the triangles of a mesh, whether it is
// still or moves.
TEST(Csg, PartsThatAreTooManyAreRefused) {
  const auto solid_of = [](const std::string& later) {
    std::string positions, triangles, keys;
    const int n = 182;  // squares along each side of a closed sheet: 2 n^2 = 66248 triangles
    for (int i = 0; i < n * n; ++i) {
      // A torus, of n by n vertices.
      const double u = 2 * M_PI * (i % n) / n, v = 2 * M_PI * (i / n) / n;
      const auto corner = [&](double r) {
        return "[" + std::to_string((2 + r * std::cos(v)) * std::cos(u)) + "," +
               std::to_string((2 + r * std::cos(v)) * std::sin(u)) + "," + std::to_string(r * std::sin(v)) + "],";
      };
      positions += corner(1);
      keys += corner(0.9);
      const int x = (i % n + 1) % n + i / n * n, y = (i + n) % (n * n), z = (x + n) % (n * n);
      for (const int k : {i, x, z, i, z, y}) triangles += std::to_string(k) + ",";
    }
    return "TriangleMesh { positions: [" + positions + "] m, triangles: [" + triangles + "]" +
           (later.empty() ? "" : ", times: [0, 1], motion_positions: [" + keys + "] m") + " }";
  };
  for (const std::string later : {"", "moving"}) {
    std::vector<Ref<SceneObject>> operands{ref_cast<SceneObject>(parse_component(solid_of(later), "mesh"))};
    for (int i = 0; i < (1 << 15); ++i) operands.push_back(ref_cast<SceneObject>(Registry::instance().create("Sphere")));
    const Ref<Csg> all = ref_cast<Csg>(Registry::instance().create("Union"));
    all->operands = std::move(operands);
    EXPECT_THROW(prepare_tree(*all), Error) << later;
  }
}

}  // namespace
}  // namespace etendue
