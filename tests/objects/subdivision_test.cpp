// Subdivision surfaces and displacement against closed forms.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "etendue/core/error.h"
#include "etendue/mesh_facts.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using geometry_test::Random;
using geometry_test::ray;

struct Setting : test::Setting {
  using test::Setting::Setting;
  Setting(std::string m, std::initializer_list<double> v) : test::Setting(std::move(m), std::vector<double>(v)) {}
};
using Settings = std::vector<Setting>;

Ref<SceneObject> object(const std::string& name, const Settings& settings = {}) {
  return test::create<SceneObject>(name, {settings.begin(), settings.end()});
}

const std::vector<double> cube_positions{-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
const std::vector<double> cube_faces{0, 3, 2, 1, 4, 5, 6, 7, 0, 1, 5, 4, 1, 2, 6, 5, 2, 3, 7, 6, 3, 0, 4, 7};

Settings cube(Settings more = {}) {
  more.emplace_back("positions", cube_positions);
  more.emplace_back("indices", cube_faces);
  return more;
}

/// A square grid of n x n unit faces whose height is a function of x.
template <class F>
Settings grid(int n, F height, Settings more = {}) {
  std::vector<double> positions, faces, uvs;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) {
      positions.insert(positions.end(), {double(x), double(y), height(double(x))});
      uvs.insert(uvs.end(), {double(x) / n, double(y) / n});
      const int at = y * (n + 1) + x;
      if (x < n && y < n) faces.insert(faces.end(), {double(at), double(at + 1), double(at + n + 2), double(at + n + 1)});
    }
  more.emplace_back("positions", positions);
  more.emplace_back("indices", faces);
  more.emplace_back("uvs", uvs);
  return more;
}

SurfacePoint first_hit(const SceneObject& o, const Point3& from, const Vector3& direction) {
  Hit hit;
  SurfacePoint p;
  const Ray r = ray(from, direction);
  if (o.intersect(r, hit))
    o.surface_point(r, hit, p);
  else
    ADD_FAILURE() << "nothing was hit from " << from.x << ' ' << from.y << ' ' << from.z;
  return p;
}

size_t count(const SceneObject& o) { return still_triangles(o)->triangles.size(); }

/// The vertex nearest to a place, as a point of an adjacent triangle.
SurfacePoint at_vertex(const SceneObject& o, const Point3& place) {
  const TriangleView view = *still_triangles(o);
  Hit nearest;
  float least = infinity;
  for (std::uint32_t i = 0; i < view.triangles.size(); ++i)
    for (size_t k = 0; k < 3; ++k)
      if (const float d = distance(view.positions[view.triangles[i][k]], place); d < least) {
        least = d;
        nearest.primitive = i;
        nearest.u = k == 1;
        nearest.v = k == 2;
      }
  SurfacePoint p;
  o.surface_point(Ray{}, nearest, p);
  return p;
}

std::string written(const std::string& name, const std::string& text) {
  const std::string path = (std::filesystem::temp_directory_path() / ("etendue_subdivision_" + name)).string();
  std::ofstream(path) << text;
  return path;
}

TEST(SubdivisionSurface, CornersOfACubeGoWhereTheLimitMaskSays) {
  // (n^2 v + 4 sum e + sum f) / (n (n + 5)) with n = 3 (Halstead, Kass & DeRose 1993): half way to the middle.
  const auto o = object("SubdivisionSurface", cube({{"levels", 2}}));
  const SurfacePoint p = at_vertex(*o, {0.5f, 0.5f, 0.5f});
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(p.position[k], 0.5, 1e-5);
    EXPECT_NEAR(p.shading_normal[k], std::sqrt(1 / 3.0), 1e-3);
  }
}

TEST(SubdivisionSurface, LoopMovesCornersOfAnOctahedronByItsMask) {
  // 3 / (8 beta) v + sum of neighbours, over 3 / (8 beta) + 4, with beta = 31 / 256: 24/55 (Loop 1987).
  const auto o =
      object("SubdivisionSurface", {{"positions", {1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1}},
                                    {"indices", {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5}},
                                    {"scheme", "loop"},
                                    {"levels", 3}});
  EXPECT_TRUE(o->closed());
  EXPECT_NEAR(at_vertex(*o, {0, 0, 1}).position.z, 24 / 55.0, 1e-5);
}

TEST(SubdivisionSurface, HeightsOfAParabolaBecomeThatParabolaAndAThird) {
  // The uniform cubic B-spline of i^2 is x^2 + 1/3, away from the border.
  Random random(1);
  for (const double tolerance : {0.0, 1e-3}) {
    const auto o =
        object("SubdivisionSurface", grid(8, [](double x) { return x * x; }, {{"levels", 5}, {"tolerance", tolerance}}));
    EXPECT_LT(count(*o), tolerance > 0 ? 80000u : 131073u);
    float most = 0;
    for (int i = 0; i < 2000; ++i) {
      const float x = random.between(2, 6), y = random.between(2, 6);
      const SurfacePoint p = first_hit(*o, {x, y, 99}, {0, 0, -1});
      const float slope = std::sqrt(1 + 4 * x * x);
      most = std::max(most, std::abs(p.position.z - (x * x + 1 / 3.0f)) / slope);
      const Vector3 n = normalize(Vector3{-2 * x, 0, 1});
      EXPECT_LT(length(Vector3(p.shading_normal) - n), tolerance > 0 ? 2e-3 : 1e-3);
      EXPECT_NEAR(p.uv.x, x / 8, 1e-4);
    }
    EXPECT_LT(most, tolerance > 0 ? tolerance : 2.5e-4);
    EXPECT_GE(most, tolerance / 100);  // no finer than requested
  }
}

TEST(SubdivisionSurface, InfinitelySharpEdgesKeepTheCube) {
  std::vector<double> creases;
  for (const int e : {0, 1, 1, 2, 2, 3, 3, 0, 4, 5, 5, 6, 6, 7, 7, 4, 0, 4, 1, 5, 2, 6, 3, 7}) creases.push_back(e);
  const auto o = object("SubdivisionSurface", cube({{"creases", creases}, {"levels", 3}}));
  EXPECT_NEAR(o->area(), 24, 1e-4);
  EXPECT_TRUE(o->closed());
  const SurfacePoint p = first_hit(*o, {0.999f, 0.999f, 4}, {0, 0, -1});  // shaded flat up to the edge
  EXPECT_NEAR(p.shading_normal.z, 1, 1e-5);
  EXPECT_LT(object("SubdivisionSurface", cube({{"creases", creases}, {"crease_sharpness", std::vector<double>{1}}}))->area(),
            22);
}

TEST(SubdivisionSurface, AFlatGridStaysASquareAndEdgesRoundItsCorners) {
  const auto flat = [](double) { return 0.0; };
  EXPECT_NEAR(object("SubdivisionSurface", grid(3, flat, {{"levels", 3}}))->area(), 9, 1e-5);
  const float rounded = object("SubdivisionSurface", grid(3, flat, {{"levels", 5}, {"boundary", "edges"}}))->area();
  EXPECT_LT(rounded, 8.7f);
  EXPECT_GT(rounded, 7);
  EXPECT_NEAR(object("SubdivisionSurface", grid(3, flat, {{"levels", 3}, {"boundary", "none"}}))->area(), 1, 1e-5);
}

TEST(SubdivisionSurface, UnequalDivisionsSeamsAndPolygonsLeaveNoGap) {
  // A prism over a pentagon, whose surface coordinates have a seam along every edge; the numbers of subdivisions differ from
  // edge to edge.
  std::string obj = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\n";
  for (const double z : {0.0, 3.0})
    for (int i = 0; i < 5; ++i)
      obj += "v " + std::to_string(std::cos(i * 1.2566)) + " " + std::to_string(std::sin(i * 1.2566)) + " " +
             std::to_string(z) + "\n";
  obj += "f 5/1 4/2 3/3 2/4 1/5\nf 6/1 7/2 8/3 9/4 10/5\n";
  for (int i = 1; i <= 5; ++i) {
    const int j = i % 5 + 1;
    obj += "f " + std::to_string(i) + "/1 " + std::to_string(j) + "/2 " + std::to_string(j + 5) + "/3 " +
           std::to_string(i + 5) + "/4\n";
  }
  const std::string path = written("prism.obj", obj);
  for (const double tolerance : {0.0, 0.02, 0.002, 0.0007}) {
    const auto o = object("SubdivisionSurface", {{"file", path}, {"levels", 6}, {"tolerance", tolerance}});
    EXPECT_TRUE(o->closed()) << tolerance;
    EXPECT_GT(o->area(), 10) << tolerance;
  }
}

TEST(SubdivisionSurface, VerticesThatAFileSplitsAtSeamsAreWelded) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 24\nproperty float x\nproperty float y\nproperty float z\n"
      "property float u\nproperty float v\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (size_t i = 0; i < 24; ++i) {
    for (size_t k = 0; k < 3; ++k) ply += std::to_string(cube_positions[3 * size_t(cube_faces[i]) + k]) + " ";
    ply += std::to_string((i + 1) / 2 % 2) + " " + std::to_string(i / 2 % 2) + "\n";
  }
  for (int f = 0; f < 24; f += 4)
    ply += "4 " + std::to_string(f) + " " + std::to_string(f + 1) + " " + std::to_string(f + 2) + " " + std::to_string(f + 3) +
           "\n";
  const std::string path = written("split.ply", ply);
  const auto whole = object("SubdivisionSurface", {{"file", path}, {"levels", 3}});
  EXPECT_TRUE(whole->closed());
  EXPECT_NEAR(whole->area(), object("SubdivisionSurface", cube({{"levels", 3}}))->area(), 1e-4);
  auto apart = ref_cast<SceneObject>(Registry::instance().create("SubdivisionSurface"));
  set(*apart, "file", Value(path));
  set(*apart, "weld", Value(false));
  prepare_tree(*apart);
  EXPECT_NEAR(apart->area(), 24, 1e-3);  // six squares, each with its own vertices
}

TEST(SubdivisionSurface, BadCagesAreRefused) {
  EXPECT_THROW(object("SubdivisionSurface", cube({{"scheme", "loop"}, {"face_sizes", {4, 4, 4, 4, 4, 4}}})), Error);
  EXPECT_THROW(object("SubdivisionSurface", cube({{"creases", {0, 6}}})), Error);
  EXPECT_THROW(object("SubdivisionSurface", cube({{"creases", {0, 1, 2}}})), Error);
  EXPECT_THROW(object("SubdivisionSurface", cube({{"corners", {8}}})), Error);
  EXPECT_THROW(object("SubdivisionSurface", cube({{"face_sizes", {4, 4}}})), Error);
  EXPECT_THROW(object("SubdivisionSurface", cube({{"uvs", {0, 0, 1, 1}}})), Error);
  EXPECT_THROW(
      object(
          "SubdivisionSurface",
          {{"positions", {0, 0, 0, 1, 0, 0, 1, 1, 0}}, {"indices", {0, 1, 1, 2}}, {"face_sizes", {4}}, {"boundary", "none"}}),
      Error);
}

Ref<ObjectMap> formula(const std::string& text) { return test::create<ObjectMap>("FormulaMap", {{"formula", text}}); }

TEST(DisplacedMesh, HeightsAreThoseOfTheMap) {
  // A unit square centred at the origin, displaced by sin(3 x) / 4 at its vertices.
  Random random(2);
  const auto o =
      object("DisplacedMesh", {{"levels", 7}, {"displacement", formula("sin(3 * x)")}, {"scale", 0.5}, {"midlevel", -0.5}});
  for (int i = 0; i < 1000; ++i) {
    const float x = random.between(-0.45f, 0.45f), y = random.between(-0.45f, 0.45f);
    const SurfacePoint p = first_hit(*o, {x, y, 4}, {0, 0, -1});
    EXPECT_NEAR(p.position.z, 0.5 * std::sin(3 * x) + 0.25, 1e-4);
    const Vector3 n = normalize(Vector3{-1.5f * std::cos(3 * x), 0, 1});
    EXPECT_LT(length(Vector3(p.shading_normal) - n), 5e-3);
    EXPECT_NEAR(p.uv.x, x + 0.5, 1e-5);
  }
}

TEST(DisplacedMesh, JumpsAndSeamsLeaveNoGapAndHardEdgesStay) {
  // Displaced on one half only: the jump becomes a wall. The faces of this cube have their own vertices.
  std::vector<double> positions, triangles, uvs;
  for (size_t i = 0; i < 24; ++i) {
    for (size_t k = 0; k < 3; ++k) positions.push_back(cube_positions[3 * size_t(cube_faces[i]) + k]);
    uvs.insert(uvs.end(), {double((i + 1) / 2 % 2), double(i / 2 % 2)});
  }
  for (int f = 0; f < 24; f += 4)
    for (const int k : {0, 1, 2, 0, 2, 3}) triangles.push_back(f + k);
  const auto mesh = object("TriangleMesh", {{"positions", positions}, {"triangles", triangles}, {"uvs", uvs}});
  const auto still = object("DisplacedMesh", {{"surface", mesh}, {"levels", 3}});
  EXPECT_TRUE(still->closed());
  EXPECT_NEAR(still->area(), 24, 1e-4);
  EXPECT_NEAR(first_hit(*still, {0.999f, 0.999f, 4}, {0, 0, -1}).shading_normal.z, 1, 1e-5);
  for (const char* text : {"step(0.3, u)", "0.3 * sin(40 * u) * sin(30 * v)"}) {
    const auto o =
        object("DisplacedMesh", {{"surface", mesh}, {"edge_length", 0.07}, {"displacement", formula(text)}, {"scale", 0.2}});
    EXPECT_TRUE(o->closed()) << text;
    EXPECT_GT(o->area(), 25) << text;
  }
}

TEST(DisplacedMesh, LimitPointsMoveAlongLimitNormals) {
  const auto cage = object("SubdivisionSurface", cube({{"levels", 5}}));
  const auto o = object("DisplacedMesh", {{"surface", cage}, {"displacement", formula("1")}, {"scale", 0.25}});
  EXPECT_TRUE(o->closed());
  const SurfacePoint p = at_vertex(*o, {0.65f, 0.65f, 0.65f});
  EXPECT_NEAR(distance(p.position, {}), 0.5 * std::sqrt(3.0) + 0.25, 1e-4);
}

TEST(DisplacedMesh, OffsetsMoveAlongAxesAndTangents) {
  auto made = ref_cast<SceneObject>(Registry::instance().create("DisplacedMesh"));
  set(*made, "offset", Value(Value::List{Value(Number{1}), Value(Number{2}), Value(Number{3})}));
  set(*made, "midlevel", Value(Number{0.5}));
  set(*made, "scale", Value(Number{2}));
  prepare_tree(*made);
  // A displacement of 0 is below the midlevel too, and moves by -1 along z.
  EXPECT_LT(distance(made->bounds().centre(), {1, 3, 4}), 1e-5);
  made->transform = Transform::rotate(pi / 2, {0, 0, 1});
  set(*made, "offset_space", Value(std::string("tangent")));
  prepare_tree(*made);
  EXPECT_LT(distance(made->bounds().centre(), {-3, 1, 4}), 1e-5);
}

TEST(DisplacedMesh, EdgesAreNoLongerThanAskedForAndAttributesAreKept) {
  std::vector<double> colors;
  for (size_t i = 0; i < 8; ++i) colors.insert(colors.end(), {cube_positions[3 * i], cube_positions[3 * i + 1], 1});
  const auto mesh = geometry_test::object("TriangleMesh", [&] {
    auto settings = geometry_test::cube_settings();
    settings.emplace_back("colors", colors);
    return settings;
  }());
  const auto o = object("DisplacedMesh", {{"surface", mesh}, {"edge_length", 0.3}});
  const TriangleView view = *still_triangles(*o);
  for (const auto& t : view.triangles)
    for (size_t k = 0; k < 3; ++k) EXPECT_LE(distance(view.positions[t[k]], view.positions[t[(k + 1) % 3]]), 0.3f);
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const SurfacePoint p = first_hit(*o, {}, random.direction());
    float color[4];
    ASSERT_EQ(o->mesh_facts()->attribute(attribute_number("color"), p, color), 3);
    EXPECT_NEAR(color[0], p.position.x, 1e-5);
    EXPECT_NEAR(color[1], p.position.y, 1e-5);
  }
}

TEST(DisplacedMesh, WhatCannotBeMovedIsRefused) {
  EXPECT_THROW(object("DisplacedMesh", {{"surface", object("Sphere")}}), Error);
  EXPECT_THROW(object("DisplacedMesh", {{"scale", std::numeric_limits<double>::infinity()}}), Error);
  auto made = ref_cast<SceneObject>(Registry::instance().create("DisplacedMesh"));
  set(*made, "offset", Value(Value::List{Value(Number{1}), Value(Number{2})}));
  EXPECT_THROW(prepare_tree(*made), Error);
}

TEST(PolygonFiles, CornersInLineAreNotLost) {
  // A cube whose bottom is divided in two, so that its front and back faces have a vertex in the middle of an edge.
  const std::string path = written("line.obj",
                                   "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                                   "v 0 -1 -1\nv 0 1 -1\nf 1 4 10 9\nf 9 10 3 2\nf 5 6 7 8\nf 1 9 2 6 5\nf 2 3 7 6\n"
                                   "f 3 10 4 8 7\nf 4 1 5 8\n");
  const auto o = object("TriangleMesh", {{"file", path}});
  EXPECT_TRUE(o->closed());
  EXPECT_NEAR(o->area(), 24, 1e-5);
}

}  // namespace
}  // namespace etendue
