// Scenes: all structures find the same hits; nesting, luminaires, errors.

#include "support/geometry_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

class TestEmission final : public EmissionShader {
 public:
  Spectrum radiance(const SurfacePoint&, const Vector3&, const Wavelengths&) const override { return Spectrum(1.0f); }
  DirectionSample sample(const SurfacePoint&, Point2) const override { return {}; }
  float pdf(const SurfacePoint&, const Vector3&) const override { return 0; }
  Spectrum power(const SceneObject&, const Wavelengths&) const override { return Spectrum(1.0f); }
};

Ref<SceneObject> soup(Random& random, int triangles, const AnimatedTransform& place) {
  std::vector<double> corners, indices;
  for (int i = 0; i < triangles; ++i) {
    const Point3 at = random.in_box(2);
    for (int k = 0; k < 3; ++k) {
      const Point3 p = at + 0.4f * random.direction();
      corners.insert(corners.end(), {double(p.x), double(p.y), double(p.z)});
      indices.push_back(double(indices.size()));
    }
  }
  return object("TriangleMesh", {{"positions", corners}, {"triangles", indices}}, place);
}

/// Some objects of every class, still, stretched and moving, without the nested scenes.
std::vector<Ref<SceneObject>> mixture(Random& random) {
  std::vector<Ref<SceneObject>> list;
  const auto place = [&] { return random.placement(4, 0.3f, 1.2f); };
  const auto moving = [&] { return AnimatedTransform({{0, place()}, {1, place()}}); };
  for (int i = 0; i < 3; ++i) {
    list.push_back(object("Sphere", {{"radius", 0.7}}, place()));
    list.push_back(object("Sphere", {}, place() * Transform::scale({0.5f, 1, -0.7f})));
    list.push_back(object("Disc", {{"radius", 0.9}}, place()));
    list.push_back(object("Rectangle", {{"edge_v", {0.3, 1, 0}}}, place() * Transform::scale({1, -1, 1})));
    list.push_back(object("Polygon", l_shape_settings(), place()));
    list.push_back(object("TriangleMesh", cube_settings(), place()));
  }
  list.push_back(object("Sphere", {}, moving()));
  list.push_back(object("Disc", {}, moving()));
  list.push_back(object("Rectangle", {}, moving()));
  list.push_back(object("TriangleMesh", cube_settings(), moving()));
  list.push_back(soup(random, 40, place()));
  list.push_back(soup(random, 40, moving()));
  return list;
}

/// The same objects and nested scenes with each structure; the objects are shared.
Ref<Scene> world(const std::string& name, const std::vector<Ref<SceneObject>>& objects,
                 const std::vector<Ref<SceneObject>>& inner, const std::vector<AnimatedTransform>& places) {
  std::vector<Ref<SceneObject>> all = objects;
  const Ref<Scene> deepest = scene(name, {inner.begin(), inner.begin() + 4}, places[0]);
  const std::vector<Ref<SceneObject>> rest(inner.begin() + 4, inner.end());
  for (size_t i = 1; i < places.size(); ++i) {
    std::vector<Ref<SceneObject>> parts = rest;
    if (i == 1) parts.push_back(deepest);
    all.push_back(scene(name, parts, places[i]));
  }
  return scene(name, all);
}

Ray random_ray(Random& random, float half) {
  const Point3 origin = random.in_box(half);
  Ray r = ray(origin, normalize(random.in_box(half / 2) - origin), random.number());
  if (random.number() < 0.3f) {  // along an axis: rays within flat boxes, parallel to planes
    const int axis = int(random.number() * 3);
    r.direction = {axis == 0 ? 1.0f : 0, axis == 1 ? -1.0f : 0, axis == 2 ? 1.0f : 0};
  }
  if (random.number() < 0.3f) r.maximum = random.between(0.1f, 10);
  return r;
}

TEST(Scene, StructuresAgree) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    Random random(seed);
    const std::vector<Ref<SceneObject>> objects = mixture(random), inner = mixture(random);
    const std::vector<AnimatedTransform> places{
        random.placement(3), random.placement(5, 0.2f, 0.4f),
        AnimatedTransform({{0, random.placement(5, 0.2f, 0.4f)}, {1, random.placement(5, 0.2f, 0.4f)}}),
        random.placement(5, 0.2f, 0.4f) * Transform::scale({1, 2, -1})};
    const Ref<Scene> brute = world("BruteForceScene", objects, inner, places);
    std::vector<Ref<Scene>> others{world("EmbreeScene", objects, inner, places)};
    Ref<Scene> careful = ref_cast<Scene>(Registry::instance().create("EmbreeScene"));
    careful->objects = others[0]->objects;
    set(*careful, "quality", Value(std::string("high")));
    careful->prepare();  // its contents were prepared before
    others.push_back(careful);
    int hits = 0, nested = 0;
    std::vector<int> differ(others.size());
    for (int i = 0; i < 20000; ++i) {
      const Ray r = random_ray(random, 8);
      Hit expected;
      const bool hit = brute->nearest(r, expected);
      EXPECT_EQ(brute->any(r), hit);
      hits += hit;
      nested += hit && expected.depth > 0;
      for (size_t k = 0; k < others.size(); ++k) {
        Hit found;
        const bool hit2 = others[k]->nearest(r, found);
        differ[k] += others[k]->any(r) != hit2;
        if (hit2 != hit || (hit && (found.object != expected.object ||
                                    std::abs(found.distance - expected.distance) > 1e-5f * (1 + expected.distance)))) {
          ++differ[k];
          continue;
        }
        if (!hit) continue;
        EXPECT_EQ(found.depth, expected.depth);
        if (found.primitive != expected.primitive) continue;  // on a common edge
        EXPECT_NEAR(found.u, expected.u, 2e-3f);
        EXPECT_NEAR(found.v, expected.v, 2e-3f);
      }
    }
    EXPECT_GT(hits, 3000);
    EXPECT_GT(nested, 300);
    // For rays through edges rounding decides, differently in each structure.
    for (int d : differ) EXPECT_LE(d, 4) << "seed " << seed;
  }
}

TEST(Scene, NearestIsNearest) {
  // Against the intersection of every object on its own.
  Random random(21);
  const std::vector<Ref<SceneObject>> objects = mixture(random);
  const Ref<Scene> s = scene("BruteForceScene", objects);
  int differ = 0;
  for (int i = 0; i < 20000; ++i) {
    const Ray r = random_ray(random, 8);
    float nearest = r.maximum;
    for (const auto& o : objects) {
      Hit hit;
      if (o->intersect(r, hit)) nearest = std::min(nearest, hit.distance);
    }
    Hit hit;
    const float found = s->nearest(r, hit) ? hit.distance : r.maximum;
    if (std::isfinite(found) != std::isfinite(nearest) ||
        (std::isfinite(found) && std::abs(found - nearest) > 1e-5f * (1 + nearest)))
      ++differ;
  }
  EXPECT_LE(differ, 3);
}

TEST(Scene, NestedPointsAreInTheOuterCoordinates) {
  Random random(22);
  for (const char* structure : {"BruteForceScene", "EmbreeScene"}) {
    const Transform outer = random.placement(3, 2, 2) * Transform::scale({1, 1.5f, -1}),
                    middle = random.placement(1, 0.5f, 0.5f);
    const std::vector<Setting> sphere{{"centre", {0.5, 0, 0}}};
    const Ref<Scene> deep = scene(structure, {scene(structure, {scene(structure, {object("Sphere", sphere)}, middle)}, outer)});
    const Ref<Scene> flat = scene(structure, {object("Sphere", sphere, outer * middle)});
    int hits = 0;
    for (int i = 0; i < 5000; ++i) {
      const Point3 origin = random.in_box(8);
      const Ray r = ray(origin, normalize(deep->centre() + 2 * random.direction() - origin));
      Hit a, b;
      if (!deep->nearest(r, a) || !flat->nearest(r, b)) continue;
      ++hits;
      EXPECT_EQ(a.depth, 2);
      EXPECT_NEAR(a.distance, b.distance, 1e-4f * b.distance);
      SurfacePoint p, q;
      deep->locate(r, a, p);
      flat->locate(r, b, q);
      q.object->tangents(q);
      p.object->tangents(p);
      EXPECT_LT(distance(p.position, q.position), 1e-4f);
      EXPECT_LT(distance(p.position, r(a.distance)), 1e-4f);
      EXPECT_GT(dot(p.normal, q.normal), 0.9999f);
      EXPECT_NEAR(p.uv.y, q.uv.y, 1e-3f);
      EXPECT_LT(length(p.dpdv - q.dpdv), 1e-2f * (1 + length(q.dpdv)));
      EXPECT_LT(distance(p.object_position, q.object_position), 1e-4f);
      const Vector3 away = dot(random.direction(), p.normal) > 0 ? -r.direction : Vector3(p.normal);
      if (dot(p.normal, away) > 1e-5f) {
        EXPECT_FALSE(deep->any(p.leave(away)));
      }
    }
    EXPECT_GT(hits, 500);
  }
}

TEST(Scene, LuminairesAndInteriors) {
  const auto lit = [](Ref<SceneObject> o) {
    o->emission = make<TestEmission>();
    return o;
  };
  const Ref<SceneObject> lamp = lit(object("Sphere")), sky = lit(object("Environment")), inner_lamp = lit(object("Disc")),
                         wall = object("Rectangle");
  // Their emission class is not registered, so they are prepared one by one.
  const auto prepared = [](std::vector<Ref<SceneObject>> objects) {
    Ref<Scene> s = ref_cast<Scene>(Registry::instance().create("BruteForceScene"));
    s->objects = std::move(objects);
    s->prepare();
    return s;
  };
  const Ref<Scene> inner = prepared({inner_lamp});
  EXPECT_EQ(inner_lamp->luminaire_index(), 0);
  const Ref<Scene> outer = prepared({wall, lamp, inner, sky});
  ASSERT_EQ(outer->luminaires().size(), 3u);
  EXPECT_EQ(&outer->luminaires()[2]->original(), inner_lamp.get());
  EXPECT_EQ(outer->luminaires()[2]->luminaire_index(), 2);
  EXPECT_TRUE(inner->luminaires().empty());
  ASSERT_EQ(outer->infinite_luminaires({}).size(), 1u);
  EXPECT_EQ(outer->luminaires()[size_t(lamp->luminaire_index())], lamp.get());
  EXPECT_EQ(outer->luminaires()[size_t(sky->luminaire_index())], sky.get());
  EXPECT_EQ(inner_lamp->luminaire_index(), -1);
  EXPECT_EQ(wall->luminaire_index(), -1);
  EXPECT_FALSE(outer->has_interiors());
  EXPECT_NEAR(outer->radius(), std::sqrt(3.0f), 1e-4f);
  EXPECT_NEAR(sky->area(0), 4 * pi * square(outer->radius()), 1e-4f);
  inner_lamp->shader = ref_cast<Shader>(Registry::instance().create("Dielectric"));
  inner->prepare();
  outer->prepare();
  EXPECT_TRUE(outer->has_interiors());
  EXPECT_EQ(prepared({inner, inner_lamp})->luminaires().size(), 2u);  // once in each place
  EXPECT_THROW(prepared({prepared({sky})}), Error);
}

// A hidden ball, and a hidden cube of triangles in a scene that occurs twice, in front of a wall: camera rays hit only the
// wall, all other rays hit everything, with every structure.
TEST(Scene, RaysOfTheCameraPassByWhatItDoesNotSee) {
  for (const char* structure : {"BruteForceScene", "BvhScene", "EmbreeScene", "GridScene", "OctreeScene"}) {
    const Ref<SceneObject> ball = object("Sphere"), cube = object("TriangleMesh", cube_settings()),
                           wall = object("Rectangle",
                                         {{"corner", {-20, -20, -2}}, {"edge_u", {40, 0, 0}}, {"edge_v", {0, 40, 0}}});
    ball->visible_to_camera = cube->visible_to_camera = false;
    const Ref<Scene> nested = scene(structure, {cube}, Transform::translate({5, 0, 0}));
    EXPECT_TRUE(nested->has_unseen());
    const Ref<Instance> instance = ref_cast<Instance>(Registry::instance().create("Instance"));
    instance->scene = scene(structure, {cube, object("Sphere", {{"radius", 0.25}}, Transform::translate({0, 0, 3}))});
    instance->transform = Transform::translate({-5, 0, 0});
    instance->prepare();
    const Ref<Scene> all = scene(structure, {ball, wall, nested, instance});
    for (const float x : {0.1f, 5.1f, -5.1f}) {
      Ray r = ray({x, 0.2f, 1.5f}, {0, 0, -1});
      Hit hit;
      ASSERT_TRUE(all->nearest(r, hit));
      EXPECT_EQ(hit.object, x == 0.1f ? ball.get() : cube.get()) << structure;
      EXPECT_EQ(hit.depth, x == 0.1f ? 0 : 1);
      HitList list;
      all->all(r, list);
      EXPECT_GE(list.size, structure == std::string("BruteForceScene") ? 2 : 1);
      r.of_camera = true;
      ASSERT_TRUE(all->nearest(r, hit));
      EXPECT_EQ(hit.object, wall.get()) << structure;
      EXPECT_NEAR(hit.distance, 3.5f, 1e-5f);
      HitList seen;
      all->all(r, seen);
      for (int i = 0; i < seen.size; ++i) EXPECT_EQ(seen.hits[i].object, wall.get());
      r.maximum = 3;  // does not reach the wall
      EXPECT_FALSE(all->any(r)) << structure;
      r.of_camera = false;
      EXPECT_TRUE(all->any(r)) << structure;
    }
  }
}

TEST(Scene, WhatCannotBeHiddenFromTheCameraIsRefused) {
  const auto refused = [](const Ref<SceneObject>& o, const Ref<SceneObject>& outer) {
    o->visible_to_camera = false;
    EXPECT_THROW(scene("BruteForceScene", {outer}), Error);
    o->visible_to_camera = true;
    EXPECT_NO_THROW(scene("BruteForceScene", {outer}));
  };
  const Ref<SceneObject> nested = scene("BruteForceScene", {object("Sphere")});
  refused(nested, nested);
  const Ref<SceneObject> glass = object("Sphere");
  glass->shader = ref_cast<Shader>(Registry::instance().create("Dielectric"));
  refused(glass, glass);
  const Ref<SceneObject> surroundings = object("Surroundings");
  refused(surroundings, surroundings);
  // An object that becomes a dielectric body by the shader of its instance.
  const Ref<SceneObject> ball = object("Sphere");
  const Ref<Instance> instance = ref_cast<Instance>(Registry::instance().create("Instance"));
  instance->scene = ref_cast<Scene>(nested);
  instance->scene->objects = {ball};
  instance->shader = glass->shader;
  ball->visible_to_camera = false;
  instance->scene->prepare();
  instance->prepare();
  EXPECT_THROW(scene("BruteForceScene", {instance}), Error);
}

TEST(Scene, LuminairesAtInfinityThatTheCameraDoesNotSee) {
  const auto sky = [](bool seen) {
    const Ref<SceneObject> o = object("Environment");
    o->emission = make<TestEmission>();
    o->visible_to_camera = seen;
    return o;
  };
  Ref<Scene> s = ref_cast<Scene>(Registry::instance().create("BruteForceScene"));
  s->objects = {sky(false), sky(true), sky(false)};
  s->prepare();
  Ray r;
  EXPECT_EQ(s->infinite_luminaires(r).size(), 3u);
  r.of_camera = true;
  ASSERT_EQ(s->infinite_luminaires(r).size(), 1u);
  EXPECT_EQ(s->infinite_luminaires(r)[0], s->objects[1].get());
}

TEST(Scene, BadListsAreRefused) {
  const Ref<SceneObject> ball = object("Sphere");
  EXPECT_THROW(scene("EmbreeScene", {ball, nullptr}), Error);
  EXPECT_THROW(scene("EmbreeScene", {ball, ball}), Error);
  EXPECT_NO_THROW(scene("EmbreeScene",
                        {scene("BruteForceScene", {ball}), scene("BruteForceScene", {ball}, Transform::translate({3, 0, 0}))}));
  ball->transform = Transform::scale({1, 0, 1});
  EXPECT_THROW(scene("EmbreeScene", {ball}), Error);
  Ref<Scene> deep = scene("BruteForceScene", {object("Sphere")});
  for (int i = 0; i < Hit::deepest_nesting; ++i) deep = scene("BruteForceScene", {deep});
  Hit hit;
  EXPECT_TRUE(deep->nearest(ray({0, 0, 5}, {0, 0, -1}), hit));
  EXPECT_EQ(hit.depth, Hit::deepest_nesting);
  EXPECT_THROW(scene("BruteForceScene", {deep}), Error);
}

TEST(Scene, EmptyScenes) {
  for (const char* structure : {"BruteForceScene", "EmbreeScene"}) {
    const Ref<Scene> none = scene(structure, {}), around = scene(structure, {scene(structure, {})});
    Hit hit;
    EXPECT_FALSE(none->nearest(ray({0, 0, 5}, {0, 0, -1}), hit));
    EXPECT_FALSE(around->any(ray({0, 0, 5}, {0, 0, -1})));
    EXPECT_EQ(none->radius(), 1);
  }
}

}  // namespace
}  // namespace etendue
