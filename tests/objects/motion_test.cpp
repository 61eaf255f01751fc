// Instances, deforming meshes, transforms and shutters over time.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "etendue/camera.h"
#include "etendue/mesh_facts.h"
#include "support/component_test_support.h"
#include "support/geometry_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using namespace geometry_test;

Ref<Instance> instance(const Ref<Scene>& scene, const AnimatedTransform& transform, const char* shader = nullptr) {
  const Ref<Instance> made = make<Instance>();
  made->scene = scene;
  made->transform = transform;
  if (shader) made->shader = ref_cast<Shader>(Registry::instance().create(shader));
  prepare_tree(*made);
  return made;
}

std::vector<Ref<SceneObject>> contents() {
  return {object("TriangleMesh", cube_settings()), object("Sphere", {{"radius", 0.7}}, Transform::translate({2.5f, 0, 0}))};
}

// The reference has the same objects placed one by one, in a structure without instances.
TEST(Motion, InstancesAreTheSceneInOtherPlaces) {
  Random random(1);
  const Ref<Scene> shared = scene("EmbreeScene", contents());
  std::vector<Ref<SceneObject>> instances, copies;
  for (const float scale : {1e-3f, 1.0f, 1e3f, 1e5f})
    for (int i = 0; i < 3; ++i) {
      Transform t = Transform::translate(random.in_box(1000 * scale) - Point3{}) * random.placement(0, scale, 2 * scale);
      if (i == 1) t = t * Transform::scale({-1, 1, 1});
      if (i == 2) t = t * Transform::scale({1, 0.3f, 2});
      instances.push_back(instance(shared, t));
      copies.push_back(scene("BruteForceScene", contents(), t));
    }
  const Ref<Scene> a = scene("EmbreeScene", instances), b = scene("BruteForceScene", copies);
  int hits = 0, differ = 0, stuck = 0, flipped = 0;
  for (int i = 0; i < 60000; ++i) {
    const Bounds3 box = instances[size_t(i) % instances.size()]->bounds();
    const float size = length(box.diagonal());
    const Point3 target = box.centre() + 0.4f * size * (random.in_box(1) - Point3{});
    const Vector3 d = random.direction();
    const Ray r = ray(target - random.between(0.5f, 3) * size * d, d);
    Hit h, g;
    const bool found = a->nearest(r, h);
    EXPECT_EQ(found, a->any(r));
    if (found != b->nearest(r, g)) {
      ++differ;
      continue;
    }
    if (!found) continue;
    ++hits;
    SurfacePoint p, q;
    a->locate(r, h, p);
    b->locate(r, g, q);
    const float slack = 4 * (p.error + q.error) + 2e-6f * h.distance;
    if (distance(p.position, q.position) > slack / std::max(0.02f, std::abs(dot(p.normal, d))) || h.depth != 1)
      ++differ;
    else if (dot(p.normal, Vector3(q.normal)) < 0.999f && h.primitive == g.primitive)
      ++flipped;
    // A ray that leaves a point to the outside does not hit the same place again.
    Hit again;
    const Vector3 away = normalize(Vector3(p.normal) + 0.7f * random.direction());
    if (dot(p.normal, away) > 0.05f && a->nearest(p.leave(away), again) && again.distance < 1e-3f * size) {
      SurfacePoint s;
      a->locate(p.leave(away), again, s);
      stuck += again.object == h.object && again.primitive == h.primitive && distance(s.position, p.position) < 4 * p.error;
    }
  }
  EXPECT_GT(hits, 14000);
  EXPECT_LT(differ, hits / 1000);  // grazing the edges
  EXPECT_EQ(stuck, 0);
  EXPECT_EQ(flipped, 0);
}

TEST(Motion, AnInstancesShaderReplacesAllInside) {
  const Ref<Scene> inner = scene("EmbreeScene", contents());
  const Ref<Scene> middle = scene("EmbreeScene", {instance(inner, Transform::translate({0, 0, 5}), "Lambertian")});
  const Ref<Instance> plain = instance(middle, {}), glass = instance(middle, Transform::translate({10, 0, 0}), "Dielectric"),
                      same = instance(inner, Transform::translate({20, 0, 0}));
  const Ref<Instance> twin = make<Instance>();
  twin->scene = middle;
  twin->shader = glass->shader;
  twin->transform = Transform::translate({30, 0, 0});
  prepare_tree(*twin);
  for (const char* structure : {"EmbreeScene", "BruteForceScene"}) {
    const Ref<Scene> all = scene(structure, {plain, glass, same, twin});
    EXPECT_EQ(twin->replacement(), glass->replacement());
    EXPECT_TRUE(all->has_interiors());
    EXPECT_TRUE(all->maybe_inside({10, 0, 5}));
    EXPECT_FALSE(all->maybe_inside({0, 0, 5}));
    const auto hit = [&](float x, float z) {
      Hit h;
      EXPECT_TRUE(all->nearest(ray({x, 0.2f, z - 9}, {0, 0, 1}), h));
      SurfacePoint p;
      all->locate(ray({x, 0.2f, z - 9}, {0, 0, 1}), h, p);
      EXPECT_EQ(p.object, h.object);
      EXPECT_NEAR(p.position.z, z - (h.object->closed() ? 1 : 0), 1.0f);
      HitList list;
      all->all(ray({x, 0.2f, z - 9}, {0, 0, 1}), list);
      EXPECT_GT(list.size, 0);
      for (int i = 0; i < list.size; ++i) EXPECT_EQ(list.hits[i].object, h.object);
      return h.object;
    };
    EXPECT_EQ(hit(0, 5)->shader->class_info().name, "Lambertian");
    EXPECT_EQ(hit(10, 5)->shader.get(), glass->shader.get());
    EXPECT_EQ(hit(12.5f, 5)->shader.get(), glass->shader.get());
    EXPECT_NE(hit(12.5f, 5), hit(10, 5));
    EXPECT_EQ(hit(20, 0), inner->objects[0].get());
    EXPECT_EQ(hit(30, 5), hit(10, 5));
    EXPECT_TRUE(hit(10, 5)->closed());
  }
  EXPECT_THROW(prepare_tree(*make<Instance>()), Error);
}

TEST(Motion, ManyInteriorsAreFoundByTheTree) {
  Random random(3);
  std::vector<Ref<SceneObject>> balls;
  for (int i = 0; i < 200; ++i) {
    balls.push_back(object("Sphere", {{"radius", 0.3}}, Transform::translate(random.in_box(5) - Point3{})));
    balls.back()->shader = ref_cast<Shader>(Registry::instance().create("Dielectric"));
  }
  const Ref<Scene> all = scene("BruteForceScene", balls);
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point3 p = random.in_box(5.5f);
    const bool expected = std::any_of(balls.begin(), balls.end(), [&](const auto& b) { return b->bounds().contains(p); });
    ASSERT_EQ(all->maybe_inside(p), expected);
    inside += expected;
  }
  EXPECT_GT(inside, 500);
}

/// The cube's corners, each moved by a random offset.
std::vector<double> shaken(unsigned seed, double by) {
  Random random(seed);
  std::vector<double> p;
  for (const double x : {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1})
    p.push_back(x + by * double(random.between(-1, 1)));
  return p;
}

std::vector<Setting> deforming(const std::vector<double>& times) {
  std::vector<Setting> settings = cube_settings();
  std::vector<double> later;
  for (size_t k = 1; k < times.size(); ++k)
    for (const double x : shaken(unsigned(k), 0.4)) later.push_back(x);
  settings.emplace_back("times", times);
  settings.emplace_back("motion_positions", later);
  return settings;
}

// At every time the mesh equals the still mesh whose vertices are interpolated between the keys: with Embree's own motion, as
// user geometry (two time ranges in one scene, moving transforms), within an instance, and intersected directly.
TEST(Motion, AMeshThatChangesItsShapeIsTheStillOneOfThatTime) {
  Random random(5);
  for (const std::vector<double>& times : {std::vector<double>{2, 3}, {2, 2.5, 3}, {2, 2.1, 2.9, 3}}) {
    // One mesh for each scene: preparing a mesh again frees the arrays to which an older structure refers.
    const auto made = [&] { return object("TriangleMesh", deforming(times)); };
    const auto later = [] { return object("TriangleMesh", deforming({5, 9}), Transform::translate({10, 0, 0})); };
    const Ref<SceneObject> mesh = made();
    const Ref<Scene> direct = scene("EmbreeScene", {made(), later()});
    const Ref<Scene> swapped = scene("EmbreeScene", {later(), made()});
    const Ref<Scene> within = scene("EmbreeScene", {instance(scene("EmbreeScene", {made()}), {})});
    std::vector<double> first = shaken(0, 0);
    EXPECT_FALSE(still_triangles(*mesh));
    EXPECT_TRUE(mesh->closed());
    for (const double time : {1.0, 2.0, 2.05, 2.1, 2.4, 2.5, 2.77, 2.9, 3.0, 4.0}) {
      const double now = std::clamp(time, times.front(), times.back());
      const size_t k =
          std::clamp<size_t>(size_t(std::upper_bound(times.begin(), times.end(), now) - times.begin()), 1, times.size() - 1);
      const double part = (now - times[k - 1]) / (times[k] - times[k - 1]);
      const std::vector<double> a = k == 1 ? first : shaken(unsigned(k - 1), 0.4), b = shaken(unsigned(k), 0.4);
      std::vector<Setting> settings = cube_settings();
      std::vector<double> between;
      for (size_t i = 0; i < a.size(); ++i) between.push_back((1 - part) * a[i] + part * b[i]);
      settings[0] = {"positions", between};
      const Ref<SceneObject> still = object("TriangleMesh", settings);
      EXPECT_NEAR(mesh->area(float(time)), still->area(0), 1e-4f * still->area(0));
      int hits = 0, wrong = 0;
      for (int i = 0; i < 500; ++i) {
        const Ray r = ray(Point3{} + 4 * random.direction(), {}, float(time));
        Ray s = r;
        s.direction = normalize(random.in_box(1) - r.origin);
        Hit h;
        const bool expected = still->intersect(s, h);
        hits += expected;
        const float distance_there = h.distance;
        for (const Ref<Scene>& where : {direct, swapped, within}) {
          Hit g;
          if (where->nearest(s, g) != expected || where->any(s) != expected) {
            ++wrong;
            continue;
          }
          if (!expected) continue;
          SurfacePoint p, q;
          where->locate(s, g, p);
          still->surface_point(s, h, q);
          EXPECT_NEAR(g.distance, distance_there, 1e-4f);
          EXPECT_LT(distance(p.position, q.position), 1e-4f);
          Hit again;
          const Vector3 out = dot(p.normal, s.direction) < 0 ? -s.direction : s.direction;
          EXPECT_FALSE(where->nearest(p.leave(out), again) && again.distance < 1e-5f);
        }
      }
      EXPECT_GT(hits, 150);
      EXPECT_LE(wrong, 2) << "at " << time;
      Mean area;
      for (int i = 0; i < 4000; ++i) {
        const SurfaceSample s = mesh->sample_area(random.pair(), float(time));
        ASSERT_TRUE(mesh->bounds().contains(s.point.position));
        area.add(1 / double(s.pdf));
      }
      EXPECT_NEAR(area.value(), double(still->area(0)), 5 * area.error() + 1e-4);
    }
  }
}

TEST(Motion, MeshesOfOneFileShareIt) {
  const std::string name = testing::TempDir() + "motion_shared.ply";
  {
    std::ofstream file(name);
    file << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  }
  const Ref<SceneObject> a = object("TriangleMesh", {{"file", name}}), b = object("TriangleMesh", {{"file", name}}),
                         moved = object("TriangleMesh", {{"file", name}}, Transform::translate({1, 0, 0}));
  EXPECT_EQ(still_triangles(*a)->positions.data(), still_triangles(*b)->positions.data());
  EXPECT_EQ(still_triangles(*a)->triangles.data(), still_triangles(*moved)->triangles.data());
  EXPECT_NE(still_triangles(*a)->positions.data(), still_triangles(*moved)->positions.data());
  EXPECT_EQ(still_triangles(*moved)->positions[1].x, 2);
  std::filesystem::remove(name);
}

TEST(Motion, BoundsHoldWhatTurns) {
  Random random(7);
  for (int trial = 0; trial < 40; ++trial) {
    std::vector<AnimatedTransform::Key> keys;
    float time = 0;
    const Vector3 axis = random.direction();
    for (int k = 0; k < 4; ++k) {  // by up to 3 rad from key to key, at very unequal time steps
      keys.push_back({time, Transform::translate(random.in_box(2) - Point3{}) * Transform::rotate(2.9f * float(k), axis) *
                                Transform::scale({random.between(0.5f, 2), 1, 1})});
      time += trial % 2 ? random.between(0.1f, 1) : std::pow(10.0f, random.between(-4, 0));
    }
    const AnimatedTransform motion(keys);
    const Bounds3 box{{-1, -2, 0.5f}, {1, 1, 3}}, swept = motion.sweep(box, 0, keys.back().time);
    Bounds3 tight;
    for (int k = 0; k + 1 < 4; ++k)
      for (int i = 0; i <= 1000; ++i) {
        const float t = lerp(float(i) / 1000, keys[size_t(k)].time, keys[size_t(k) + 1].time);
        for (int c = 0; c < 8; ++c) {
          const Point3 p = motion.at(t)(box.corner(c));
          tight.add(p);
          ASSERT_TRUE(swept.contains(p));
        }
      }
    EXPECT_LT(length(swept.diagonal()), 1.05f * length(tight.diagonal()));
  }
}

TEST(Motion, TheShutterLetsInLightAsFarAsItIsOpen) {
  const Ref<Camera> camera = ref_cast<Camera>(Registry::instance().create("PerspectiveCamera"));
  set(*camera, "shutter_open", Value(Number{1}));
  set(*camera, "shutter_close", Value(Number{3}));
  prepare_tree(*camera);
  EXPECT_FLOAT_EQ(camera->shutter_time(0.25f), 1.5f);
  camera->shutter_opening = 0.8f;
  camera->shutter_closing = 0.4f;
  prepare_tree(*camera);
  // The quantiles follow from the trapezoid's area, 2 - 0.6 = 1.4: half its first ramp is 0.4, and so on.
  EXPECT_FLOAT_EQ(camera->shutter_time(0), 1);
  EXPECT_NEAR(camera->shutter_time(0.4f / 1.4f), 1.8f, 1e-5f);
  EXPECT_NEAR(camera->shutter_time(0.1f / 1.4f), 1.4f, 1e-5f);
  EXPECT_NEAR(camera->shutter_time(1.2f / 1.4f), 2.6f, 1e-5f);
  EXPECT_NEAR(camera->shutter_time(1.35f / 1.4f), 2.8f, 1e-5f);
  for (int i = 1; i < 1000; ++i) {  // dt/du = area / efficiency
    const float u = (float(i) + 0.5f) / 1001, h = 1e-3f;
    if (u < 0.03f || u > 0.97f) continue;  // where the slope is steep
    const float slope = (camera->shutter_time(u + h) - camera->shutter_time(u - h)) / (2 * h);
    EXPECT_NEAR(slope * camera->shutter_efficiency(camera->shutter_time(u)) / 1.4f, 1, 0.02f) << u;
  }
  camera->shutter_closing = 1.5f;
  EXPECT_THROW(prepare_tree(*camera), Error);
}

std::string moving_scene(double open, double close, int samples) {
  const std::string shutter = "shutter_open: " + std::to_string(open) + " s, shutter_close: " + std::to_string(close) + " s";
  return test::job_text("PathTracer { samples: " + std::to_string(samples) + ", max_depth: 3 }",
                        "PerspectiveCamera { from: [0, 0, -8] m, to: [0, 0, 0] m, " + shutter +
                            ", transform: keyframes(0 s, translate(0, 0, 0), 1 s, translate(0.3, 0, 0) * rotate(4, \"z\")) }",
                        16, R"(
  Box { transform: keyframes(0 s, translate(-2, 0, 0), 0.5 s, translate(-1.5, 0, 0) * rotate(80, "z"),
                             1 s, translate(0, 0, 0) * rotate(170, "z")), shader: Lambertian { color: 0.7 } }
  TriangleMesh { positions: [1, -1, 0, 2, -1, 0, 2, 0, 0, 1, 0, 0] m, triangles: [0, 2, 1, 0, 3, 2], times: [0, 0.3, 1] s,
                 motion_positions: [1, -1, 0, 2, -2, 0, 2, 0, 0, 1, 1, 0,  0, -1, 0, 3, -2, 1, 2, 0, 0, 1, 1, 0] m,
                 shader: Lambertian { color: 0.4 } }
  Instance { scene: EmbreeScene { objects: [ Sphere { radius: 0.5 m, shader: Lambertian { color: 0.8 } } ] },
             transform: keyframes(0 s, translate(0, 2, 0), 1 s, translate(2, 2, 0) * scale(1.5)) }
  Environment { emission: DiffuseEmission { radiance: 1 } })",
                        "EmbreeScene");
}

TEST(Motion, ABlurredPictureIsTheMeanOfStillOnes) {
  const auto tiles = [](const std::string& text, int seed) {
    const Ref<Job> job = load_job_text(text, "test.etd");
    job->seed = decltype(job->seed)(seed);
    const Image image = test::rendered(job)->picture();
    std::vector<double> sums(16);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) sums[size_t(y / 4 * 4 + x / 4)] += image.at(x, y, 1) / 16;
    return sums;
  };
  const std::vector<double> blurred = tiles(moving_scene(0, 1, 1024), 1000);
  std::vector<double> mean(16);
  constexpr int stills = 256;
  for (int i = 0; i < stills; ++i) {
    const double time = (i + 0.5) / stills;
    const std::vector<double> still = tiles(moving_scene(time, time, 4), i);
    for (size_t k = 0; k < 16; ++k) mean[k] += still[k] / stills;
  }
  for (size_t k = 0; k < 16; ++k) EXPECT_NEAR(blurred[k] / mean[k], 1, 0.01) << "tile " << k;
}

// Transforms beyond the range of floats are refused before rays are traced.
TEST(Transforms, BeyondFloatsAreNotValid) {
  EXPECT_FALSE(Transform::scale({1, 1, 1e-30f}).valid());
  EXPECT_FALSE(Transform::scale({1e20f, 1, 1}).valid());
  EXPECT_TRUE(Transform::scale({1e-6f, 1e-6f, 1e-6f}).valid());
  EXPECT_TRUE((Transform::translate({1e20f, 0, 0}) * Transform::scale({1e6f, 1e6f, 1e6f})).valid());
}

}  // namespace
}  // namespace etendue
