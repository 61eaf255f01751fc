// Objects and scenes in a space that is relative to a point far from the origin give the same results as at the origin, in
// every way of nesting; and walks within closed objects stay inside. No renderer takes part: see far_away_test.cpp for
// pictures.

#include <gtest/gtest.h>

#include <cstdlib>

#include "geometry/rendering_space.h"
#include "support/geometry_support.h"

namespace etendue {
namespace {

using geometry_test::Random;

/// A place in the world, and the scale of the objects there.
struct Where {
  double x = 0, y = 0, z = 0, scale = 1;
  DoublePoint3 at(double a, double b, double c) const { return {x + scale * a, y + scale * b, z + scale * c}; }
  Transform placed() const { return Transform::translate({x, y, z}) * Transform::scale({scale, scale, scale}); }
};
Where away(double distance, double scale = 1) { return {0.3713 * distance, 0.5571 * distance, -0.7428 * distance, scale}; }

Value value(const DoublePoint3& p) { return Value(Numbers{{p.x, p.y, p.z}, 1, Dimension::none}); }
Value value(double x) { return Value(Number{x}); }
Value value(const std::vector<DoublePoint3>& points) {
  Numbers n;
  n.width = 3;
  for (const DoublePoint3& p : points) n.values.insert(n.values.end(), {p.x, p.y, p.z});
  return Value(n);
}

using Members = std::vector<std::pair<std::string, Value>>;
Ref<SceneObject> make_object(const std::string& name, const Members& members, const AnimatedTransform& transform = {}) {
  Ref<SceneObject> made = ref_cast<SceneObject>(Registry::instance().create(name));
  for (const auto& [member, v] : members) set(*made, member, v);
  made->transform = transform;
  return made;
}

Ref<Scene> make_scene(const std::string& name, std::vector<Ref<SceneObject>> objects, const AnimatedTransform& transform = {}) {
  Ref<Scene> made = ref_cast<Scene>(Registry::instance().create(name));
  made->objects = std::move(objects);
  made->transform = transform;
  return made;
}

Ref<SceneObject> instance(const Ref<Scene>& scene, const AnimatedTransform& transform) {
  return make_object("Instance", {{"scene", Value(Ref<Component>(scene))}}, transform);
}

AnimatedTransform moving(const Transform& from, const Transform& to) {
  return AnimatedTransform(std::vector<AnimatedTransform::Key>{{0, from}, {1, to}});
}

// ---- the same as at the origin --------------------------------------------------------------------------------------------

/// Traces rays from the camera in both scenes: hits, points, normals and world positions agree except for rounding.
void expect_same(const Ref<Scene>& there, const Where& w, const Ref<Scene>& here, const std::string& what) {
  const Where home;
  set_rendering_origin(*there, w.at(0.1, -1.6, 0.1), 0);
  set_rendering_origin(*here, home.at(0.1, -1.6, 0.1), 0);
  prepare_tree(*there);
  prepare_tree(*here);
  Random random(3);
  int hits = 0, others = 0, again = 0;
  double off = 0, turned = 0, in_world = 0;
  for (int i = 0; i < 5000; ++i) {
    Ray ray;
    ray.direction = normalize(Vector3{random.between(-0.5f, 0.5f), 1, random.between(-0.5f, 0.5f)});
    ray.time = random.number();
    Hit a, b;
    const bool hit = there->nearest(ray, a);
    if (hit != here->nearest(ray, b)) ++others;
    if (!a || !b) continue;
    ++hits;
    SurfacePoint p, q;
    there->locate(ray, a, p);
    here->locate(ray, b, q);
    const double distance =
        length(DoubleVector3(p.position - Point3{}) - w.scale * DoubleVector3(q.position - Point3{})) / w.scale;
    if (distance > 1e-3) {
      ++others;
      continue;
    }
    off = std::max(off, distance);
    turned = std::max(turned, double(length(Vector3(p.normal) - Vector3(q.normal))));
    in_world =
        std::max(in_world, length(1 / w.scale * (world_position(p) - w.at(0, 0, 0)) - (world_position(q) - DoublePoint3{})));
    // A ray that leaves the surface does not hit it again.
    const Vector3 out = dot(p.normal, ray.direction) > 0 ? -Vector3(p.normal) : Vector3(p.normal);
    const Ray leaving = p.leave(normalize(out + 0.3f * random.direction()));
    Hit next;
    again += there->nearest(leaving, next) && double(next.distance) < 1e-3 * w.scale && next.object == a.object;
  }
  EXPECT_GT(hits, 300) << what;
  EXPECT_LE(others, 1) << what << " of " << hits;
  EXPECT_EQ(again, 0) << what;
  EXPECT_LT(off, 3e-5) << what;
  EXPECT_LT(turned, 1e-4) << what;
  EXPECT_LT(in_world, 3e-5) << what;
}

std::vector<Ref<SceneObject>> each_object(const Where& w) {
  const AnimatedTransform placed = w.placed() * Transform::rotate(0.4, {1, 2, 3});
  const double s = w.scale;
  std::vector<DoublePoint3> net;
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) net.push_back(w.at(-0.8 + 0.5 * i, 0.2 * ((i + j) % 3), -0.8 + 0.5 * j));
  const Transform to = Transform::translate({w.x, w.y, w.z}), on = Transform::translate({0.3 * s, 0, 0.2 * s});
  const Members ellipsoid{{"radii", value(DoublePoint3{0.9 * s, 0.5 * s, 0.4 * s})}};
  const Members outline{{"points", value({w.at(-0.7, 0, -0.6), w.at(0.8, 0, -0.6), w.at(0.8, 0, 0.7), w.at(-0.2, 0, 0.1)})}};
  std::vector<Ref<SceneObject>> all;
  for (const char* name : {"Cylinder", "Tube", "Torus", "Disc", "Annulus", "Cone", "Sphere", "Box", "Rectangle"})
    all.push_back(make_object(name, {}, placed));
  Members centred = ellipsoid;
  centred.emplace_back("centre", value(w.at(0.1, 0.2, 0)));
  all.push_back(make_object("Ellipsoid", centred));
  all.push_back(make_object("Ellipsoid", ellipsoid, moving(to, to * on * Transform::rotate(1, {0, 1, 1}))));
  all.push_back(
      make_object("Metaballs", {{"centres", value({w.at(-0.3, 0, 0), w.at(0.3, 0.1, 0)})}, {"radii", Value(Numbers{{s}})}}));
  all.push_back(make_object("Curve", {{"points", value({w.at(-0.9, 0, -0.5), w.at(0, 0.3, 0.2), w.at(0.6, 0, 0.7)})},
                                      {"radius", Value(Numbers{{0.2 * s}})}}));
  all.push_back(make_object("BezierPatches", {{"points", value(net)}}));
  all.push_back(make_object("Polygon", outline));
  all.push_back(make_object("Polygon", outline, moving(Transform(), on)));
  all.push_back(make_object(
      "Triangle", {{"a", value(w.at(-0.7, 0, -0.6))}, {"b", value(w.at(0.7, 0.1, -0.6))}, {"c", value(w.at(0, 0, 0.8))}}));
  all.push_back(make_object("InfinitePlane", {}, to * Transform::rotate(1.2, {1, 0, 0})));
  return all;
}

const Where places[] = {away(1e3), away(1e7), away(0, 1e-3), away(1e3, 1e-3), away(1e7, 1e6)};

TEST(FarAwayObjects, AreThoseAtTheOrigin) {
  for (const Where& w : places) {
    const std::vector<Ref<SceneObject>> there = each_object(w), here = each_object({});
    for (size_t i = 0; i < there.size(); ++i)
      expect_same(make_scene("BvhScene", {there[i]}), w, make_scene("BvhScene", {here[i]}),
                  fmt::format("{} {} at {}, scale {}", there[i]->class_info().name, i, w.x, w.scale));
  }
}

/// Objects with positions of all kinds: a point, a corner and edges, a list, a solid of two operands, a motion.
std::vector<Ref<SceneObject>> things(const Where& w, double shift = 0) {
  const double s = w.scale;
  const auto cube = [&](const DoublePoint3& at, double edge) {
    return make_object("Box", {{"centre", value(at)}, {"size", value(DoublePoint3{edge * s, edge * s, edge * s})}});
  };
  const auto ball = [&](const DoublePoint3& at, double radius) {
    return make_object("Sphere", {{"centre", value(at)}, {"radius", value(radius * s)}});
  };
  const auto to = [&](double a, double b, double c) { return Transform::translate(w.at(a, b, c) - DoublePoint3{}); };
  const Value operands(Value::List{Value(Ref<Component>(cube(w.at(shift + 0.6, 1.1, 0.5), 0.4))),
                                   Value(Ref<Component>(ball(w.at(shift + 0.6, 0.9, 0.5), 0.2)))});
  return {cube(w.at(shift, 1, 0), 0.5),
          ball(w.at(shift, 0.8, 0.6), 0.3),
          make_object("Rectangle", {{"corner", value(w.at(shift - 0.5, 1.2, -1))},
                                    {"edge_u", value(DoublePoint3{s, 0, 0})},
                                    {"edge_v", value(DoublePoint3{0, 0.2 * s, 2 * s})}}),
          make_object("TriangleMesh",
                      {{"positions", value({w.at(shift, 0.7, -0.3), w.at(shift + 0.4, 0.7, -0.3), w.at(shift, 0.7, -0.8)})},
                       {"triangles", Value(Numbers{{0, 1, 2}, 3, Dimension::none})}}),
          make_object("Difference", {{"operands", operands}}),
          make_object("Sphere", {{"radius", value(0.2 * s)}}, moving(to(shift - 0.6, 0.9, 0), to(shift - 0.6, 0.9, 1)))};
}

TEST(FarAwayObjects, NestedScenesBringThemBack) {
  for (const std::string structure : {"BvhScene", "EmbreeScene"})
    for (const Where& w : {away(1e4), away(1e7), away(1e4, 1e-3)}) {
      const auto scene = [&](std::vector<Ref<SceneObject>> objects, const AnimatedTransform& t = {}) {
        return make_scene(structure, std::move(objects), t);
      };
      const Where home{0, 0, 0, w.scale};
      const Transform back = Transform::translate({-w.x, -w.y, -w.z}), out = back.inverse();
      const Transform aside = Transform::translate({1.4 * w.scale, 0, 0}), up = Transform::translate({0, 5, 0});
      const std::string where = structure + " at " + std::to_string(w.x);
      const auto one = [&] { return scene(things({})); };
      const auto two = [&] {
        std::vector<Ref<SceneObject>> both = things({}, -0.7);
        for (const auto& other : things({}, 0.7)) both.push_back(other);
        return scene(both);
      };
      expect_same(scene({instance(scene(things(w)), back)}), home, one(), "an instance brought back, " + where);
      expect_same(scene({scene(things(w), back)}), home, one(), "a scene brought back, " + where);
      expect_same(scene({scene({instance(scene(things(w)), up)}, back * up.inverse())}), home, one(), "through two, " + where);
      const Ref<Scene> far = scene(things(w, -0.7)), near = scene(things(home, -0.7));
      expect_same(scene({instance(far, back), instance(far, back * aside)}), home, two(), "brought back twice, " + where);
      expect_same(scene({instance(near, out), instance(near, out * aside)}), w, two(), "brought there twice, " + where);
      std::vector<Ref<SceneObject>> shared = things(w, -0.7);
      shared.push_back(instance(scene(shared), aside));
      expect_same(scene(shared), w, two(), "shared by two scenes, " + where);
    }
}

// ---- closed objects -------------------------------------------------------------------------------------------------------

Ref<SceneObject> room(int kind, const Where& w) {
  const double s = w.scale;
  const AnimatedTransform turned = w.placed() * Transform::rotate(0.57, {1, 2, 3});
  const Value edges = value(DoublePoint3{4, 4, 4});
  if (kind == 0)
    return make_object("Box", {{"centre", value(w.at(0, 0, 0))}, {"size", value(DoublePoint3{4 * s, 4 * s, 4 * s})}});
  if (kind == 1) return make_object("Box", {{"size", edges}}, turned);
  if (kind == 2) return make_object("Sphere", {{"centre", value(w.at(0, 0, 0))}, {"radius", value(3 * s)}});
  const Where own = kind == 3 ? w : Where{};
  std::vector<DoublePoint3> corners;
  for (const int z : {-2, 2})
    for (const auto& [x, y] : {std::pair{-2, -2}, {2, -2}, {2, 2}, {-2, 2}}) corners.push_back(own.at(x, y, z));
  const Value triangles(
      Numbers{{0, 3, 2, 0, 2, 1, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7},
              3,
              Dimension::none});
  return make_object("TriangleMesh", {{"positions", value(corners)}, {"triangles", triangles}},
                     kind == 3 ? AnimatedTransform() : turned);
}

/// The number of rays that escape from a closed room in a space relative to `centre`; each ray leaves a point towards the
/// inside.
long leaks(const std::string& structure, const Where& w, const DoublePoint3& centre, int kind, long rays) {
  const Ref<Scene> scene = make_scene(structure, {room(kind, w)});
  set_rendering_origin(*scene, centre, 0);
  prepare_tree(*scene);
  Random random(7);
  Ray begin, ray;
  begin.origin = Point3(DoublePoint3{} + (w.at(0.31, -1.2, 0.23) - centre));
  long out = 0;
  bool again = true;
  for (long i = 0; i < rays; ++i) {
    const Vector3 d = random.direction();
    if (again) {
      ray = begin;
      ray.direction = d;
    }
    Hit hit;
    SurfacePoint p;
    const bool met = scene->nearest(ray, hit);
    if (met) scene->locate(ray, hit, p);
    const bool within = met && dot(p.normal, ray.direction) > 0;
    out += !within;
    // A direction within the surface's plane has no side; no light is scattered there.
    again = !within || i % 8 == 7 || dot(d, p.normal) == 0;
    if (!again) ray = p.leave(dot(d, p.normal) > 0 ? -d : d);
  }
  return out;
}

const char* const structures[] = {"BvhScene", "EmbreeScene", "OctreeScene", "GridScene", "BruteForceScene"};

/// The environment variable LEAK_RAYS replaces the usual number of rays.
long rays_asked(long usual) {
  const char* asked = std::getenv("LEAK_RAYS");
  return asked ? std::atol(asked) : usual;
}

TEST(FarAwayObjects, WalksStayInClosedOnes) {
  for (const char* structure : structures)
    for (const Where& w :
         {away(0), away(100), away(1e4), away(1e7), away(0, 1e-6), away(1e3, 1e-6), away(0, 1e7), away(1e7, 1e3)})
      for (int kind = 0; kind < 5; ++kind)
        EXPECT_EQ(leaks(structure, w, w.at(0.31, -1.2, 0.23), kind, rays_asked(20000)), 0)
            << structure << " at " << w.x << ", scale " << w.scale << ", room " << kind;
}

// Like a room far from the camera in a large scene: points within rounding of an edge must not be outside.
TEST(FarAwayObjects, WalksStayInClosedOnesFarFromTheCentre) {
  for (const char* structure : structures)
    for (const Where& w : {away(100), away(1e3), away(1e4)})
      for (int kind = 0; kind < 5; ++kind)
        EXPECT_EQ(leaks(structure, w, {}, kind, rays_asked(100000)), 0) << structure << " at " << w.x << ", room " << kind;
}

}  // namespace
}  // namespace etendue
