// Luminaires in nested scenes and instances: the objects that represent them in the outermost scene, and whether their samples
// follow the reported pdfs.

#include <set>

#include "components/emission/per_object.h"
#include "components/lightsamplers/luminaire_power.h"
#include "etendue/render/job.h"
#include "support/component_test_support.h"
#include "support/geometry_support.h"
#include "support/luminaire_test_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

using geometry_test::Mean;
using geometry_test::Random;
using geometry_test::ray;

Ref<Scene> scene_of(const std::string& objects, const std::string& structure = "EmbreeScene") {
  return test::prepared_as<Scene>(structure + " { objects: [ " + objects + " ] }");
}

const char* const ball = "Sphere { centre: [0.3, 0, 0] m, radius: 0.5 m, emission: DiffuseEmission { radiance: 1 } }";
const char* const plate =
    "Rectangle { corner: [-0.5, -0.3, 0.2] m, edge_u: [1, 0, 0] m, edge_v: [0, 0.7, 0.2] m, "
    "emission: DiffuseEmission { radiance: 1, sides: both } }";
const char* const prism =
    "TriangleMesh { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.6] m, triangles: [0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3], "
    "emission: DiffuseEmission { radiance: 1 } }";
const char* const drum =
    "Cylinder { radius: 0.4 m, height: 0.9 m, transform: rotate(40, \"y\"), emission: DiffuseEmission { radiance: 1 } }";

/// Three scenes around an object.
std::string in_scenes(const std::string& object, const std::string& inner, const std::string& outer) {
  return "Instance { transform: " + outer + ", scene: BvhScene { objects: [ BvhScene { transform: " + inner +
         ", objects: [ EmbreeScene { transform: " + inner + ", objects: [ " + object + " ] } ] } ] } }";
}

struct Chain {
  const char *inner, *outer;
};
const Chain chains[] = {
    {"rotate(20, \"x\")", "translate(1, 2, -1) * scale(0.5)"},
    {"scale(1, 0.6, 1.3)", "translate(0.4, 0, 0) * rotate(70, \"y\") * scale(1.5, 1, 0.8)"},
    {"scale(-1, 1, 0.8)", "rotate(30, \"z\") * scale(1, 1.4, 1)"},
    {"rotate(50, \"y\")",
     "keyframes(0 s, scale(0.7, 1, 1), 1 s, translate(0.3, 0, 0) * rotate(90, \"z\") * scale(1, 1.5, 0.5))"},
};

// The pdfs per area and per solid angle are those of the sampled points: areas and solid angles estimated from samples equal
// those found by other means.
TEST(NestedLuminaires, DensitiesAreThoseOfTheSamples) {
  Random random(5);
  for (const char* shape : {ball, plate, prism, drum})
    for (const Chain& chain : chains) {
      const Ref<Scene> scene = scene_of(in_scenes(shape, chain.inner, chain.outer));
      const std::string what = std::string(shape).substr(0, 12) + " in " + chain.outer;
      ASSERT_EQ(scene->luminaires().size(), 1u);
      const SceneObject& light = *scene->luminaires()[0];
      EXPECT_EQ(light.luminaire_index(), 0);
      const float time = 0.37f;
      Mean area, seen, met;
      const Point3 from = scene->centre() + 1.3f * scene->radius() * random.direction();
      int wrong = 0, others = 0;
      for (int i = 0; i < 8000; ++i) {
        const SurfaceSample a = light.sample_area(random.pair(), time);
        ASSERT_GT(a.pdf, 0);
        area.add(1 / double(a.pdf));
        wrong += std::abs(light.area_pdf(a.point) / a.pdf - 1) > 1e-3f || a.point.object != &light;
        const SurfaceSample s = light.sample_visible(from, random.pair(), time);
        if (!(s.pdf > 0)) {
          seen.add(0);
          continue;
        }
        const float said = light.visible_pdf(from, s.direction, s.point);
        wrong += std::abs(said / s.pdf - 1) > 2e-2f && std::abs(dot(s.point.normal, s.direction)) > 0.02f;
        // Only the nearest point in that direction counts, not the far side of a body.
        const Ray line = ray(from, s.direction, time);
        Hit hit;
        SurfacePoint p;
        if (!scene->nearest(line, hit)) {
          seen.add(0);
          continue;
        }
        scene->locate(line, hit, p);
        others += p.object != &light;
        const bool first = std::abs(hit.distance - s.distance) <= 1e-3f * s.distance;
        seen.add(first ? 1 / double(s.pdf) : 0);
      }
      for (int i = 0; i < 40000; ++i) {
        // Uniform directions within the cone around the scene's bounding sphere.
        const float size = scene->radius(), far = distance(from, scene->centre());
        const float low = std::sqrt(1 - square(size / far)), z = low + (1 - low) * random.number(),
                    phi = 2 * pi * random.number();
        const Vector3 local{safe_sqrt(1 - z * z) * std::cos(phi), safe_sqrt(1 - z * z) * std::sin(phi), z};
        const Vector3 d = Frame(Normal3(normalize(scene->centre() - from))).to_world(local);
        met.add(scene->any(ray(from, d, time)) ? 2 * M_PI * double(1 - low) : 0);
      }
      EXPECT_LT(wrong, 12) << what;
      EXPECT_EQ(others, 0) << what;
      const double said = double(light.area(time));
      EXPECT_NEAR(area.value() / said, 1, 4.5 * area.error() / said + 1e-3) << what;
      EXPECT_NEAR(seen.value() / met.value(), 1, 4.5 * std::hypot(seen.error(), met.error()) / met.value() + 2e-3) << what;
      EXPECT_TRUE(light.luminaire_bounds().box.contains(light.sample_area({0.3f, 0.6f}, time).point.position));
    }
}

TEST(NestedLuminaires, BoundsOfNormalsHoldThemAll) {
  Random random(11);
  for (const char* shape : {plate, prism, drum})
    for (const Chain& chain : chains) {
      const Ref<Scene> scene = scene_of(in_scenes(shape, chain.inner, chain.outer));
      const SceneObject& light = *scene->luminaires()[0];
      const NormalCone cone = light.luminaire_bounds().normals;
      if (shape == plate && std::string(chain.outer).find("keyframes") == std::string::npos) {
        EXPECT_GT(cone.cosine, 0.999f);
      }
      for (int i = 0; i < 300; ++i)
        EXPECT_GE(dot(light.sample_area(random.pair(), 0.5f).point.normal, cone.axis), cone.cosine - 1e-5f) << chain.outer;
    }
}

// One lamp in 3 x 3 places by nested scenes, the same lamps placed by hand, and with replaced shaders.
TEST(NestedLuminaires, EachPlaceHasItsOwn) {
  const std::string three = "lamps = BvhScene { objects: [ " + std::string(ball) + ", " + plate + R"( ] }
    row = EmbreeScene { objects: [ Instance { scene: lamps }, Instance { scene: lamps, transform: translate(3, 0, 0) },
      Instance { scene: lamps, transform: translate(6, 0, 0), shader: Lambertian {} } ] }
    Job { camera: PerspectiveCamera {}, scene: EmbreeScene { objects: [
      Instance { scene: row }, Instance { scene: row, transform: translate(0, 3, 0), shader: Lambertian { color: 0.2 } },
      Instance { scene: row, transform: translate(0, 6, 0) }, Sphere { centre: [0, 0, 9], radius: 0.1, emission: DiffuseEmission {} } ] } })";
  const Ref<Job> job = load_job_text(three, "test.etd");
  prepare_tree(*job);
  const Scene& scene = *job->scene;
  ASSERT_EQ(scene.luminaires().size(), 19u);
  std::set<const SceneObject*> met;
  for (int x = 0; x < 3; ++x)
    for (int y = 0; y < 3; ++y)
      for (const float u : {0.3f, -0.3f}) {
        const Ray down = ray({3.0f * float(x) + u, 3.0f * float(y) + 0.05f, 5}, {0, 0, -1});
        Hit hit;
        ASSERT_TRUE(scene.nearest(down, hit));
        SurfacePoint p;
        scene.locate(down, hit, p);
        ASSERT_GE(p.object->luminaire_index(), 0);
        EXPECT_EQ(scene.luminaires()[size_t(p.object->luminaire_index())], p.object);
        EXPECT_EQ(&p.object->original(), &hit.object->original());
        EXPECT_EQ(bool(p.object->shader), x == 2 || y == 1);
        EXPECT_TRUE(p.object->luminaire_bounds().box.contains(p.position));
        met.insert(p.object);
      }
  EXPECT_EQ(met.size(), 18u);
  EXPECT_EQ(luminaire_powers(scene.luminaires()).size(), 19u);
}

// A power of 60 W stays 60 W at half the size, and a radiance stays the same.
TEST(NestedLuminaires, AnAmountIsOfEachPlace) {
  for (const char* shape : {"Sphere { radius: 0.5 m", "Box { size: [1, 2, 0.5] m",
                            "TriangleMesh { positions: [0,0,0, 1,0,0, 0,1,0, 0,0,1], triangles: [0,2,1, 0,1,3, 1,2,3, 2,0,3]"})
    for (const Chain& chain : chains) {
      const auto power = [&](const std::string& emission, const std::string& outer) {
        const Ref<Scene> scene = scene_of(in_scenes(std::string(shape) + ", emission: " + emission + " }", chain.inner, outer));
        return luminaire_power(*scene->luminaires()[0]);
      };
      EXPECT_NEAR(power("DiffuseEmission { power: 60 W }", chain.outer), 60, 1e-2);
      EXPECT_NEAR(power("DiffuseEmission { power: 60 W }", std::string("scale(0.5)")), 60, 1e-2);
      const std::string plain = "DiffuseEmission { radiance: 1 }";
      EXPECT_NEAR(power(plain, "scale(0.5)") / power(plain, "scale(1)"), 0.25, 1e-4);
    }
}

// The power that arrives on a sphere around a stretched lamp of 60 W is 60 W: by lines through the sphere, uniform in the
// measure of lines.
TEST(NestedLuminaires, TheirPowerArrives) {
  const Ref<Scene> scene = scene_of(
      in_scenes("Sphere { radius: 0.5 m, emission: DiffuseEmission { power: 60 W } }", chains[1].inner, chains[1].outer));
  const Wavelengths w = test::wavelengths();
  const SceneObject& light = *scene->luminaires()[0];
  const double power = double(light.emission->power(light, w)[0]);
  Random random(3);
  Mean received;
  for (int i = 0; i < 100000; ++i) {
    const Vector3 d = random.direction();
    const Frame frame{Normal3(d)};
    const float r = scene->radius() * std::sqrt(random.number()), phi = 2 * pi * random.number();
    const Ray line =
        ray(scene->centre() + r * (std::cos(phi) * frame.s + std::sin(phi) * frame.t) - 2 * scene->radius() * d, d);
    Hit hit;
    SurfacePoint p;
    double radiance = 0;
    if (scene->nearest(line, hit)) {
      scene->locate(line, hit, p);
      radiance = double(p.object->emission->radiance(p, -d, w)[0]);
    }
    received.add(4 * M_PI * M_PI * double(square(scene->radius())) * radiance);
  }
  EXPECT_NEAR(received.value() / power, 1, 4 * received.error() / power);
}

TEST(NestedLuminaires, PointsAndDistantLightsGoWithTheirScenes) {
  const std::string spot =
      "Point { position: [1, 0, 0] m, emission: SpotEmission { axis: [1, 0, 0], inner_angle: 10, outer_angle: 20 } }";
  const Ref<Scene> scene =
      scene_of("Sphere { radius: 9 m }, " + in_scenes(spot, "rotate(90, \"z\")", "translate(0, 0, 3) * scale(2)"));
  ASSERT_EQ(scene->luminaires().size(), 1u);
  const SceneObject& light = *scene->luminaires()[0];
  EXPECT_TRUE(light.delta());
  EXPECT_EQ(light.area(0), 4);
  const Point3 from{-5, 0, 3}, there{-2, 0, 3};  // rotated twice by 90 degrees
  const SurfaceSample s = light.sample_visible(from, {0.5f, 0.5f}, 0);
  test::expect_near(s.point.position - there, {});
  EXPECT_NEAR(s.pdf, 9, 1e-4);
  EXPECT_EQ(s.point.normal, Normal3{});
  EXPECT_TRUE(light.luminaire_bounds().box.contains(s.point.position));
  const Wavelengths w = test::wavelengths();
  EXPECT_GT(light.emission->radiance(s.point, {-1, 0, 0}, w)[0], 0);
  EXPECT_EQ(light.emission->radiance(s.point, {1, 0, 0}, w)[0], 0);
  EXPECT_EQ(light.sample_area({}, 0).pdf, 1);

  const Ref<Scene> sunny =
      scene_of("Sphere { radius: 9 m }, " + in_scenes("Distant { direction: [1, 0, 0], emission: DiffuseEmission {} }",
                                                      "rotate(45, \"z\")", "translate(5, 0, 3)"));
  ASSERT_EQ(sunny->luminaires().size(), 1u);
  const SurfaceSample sun = sunny->luminaires()[0]->sample_visible(from, {}, 0);
  test::expect_near(sun.direction, {0, -1, 0});
  EXPECT_EQ(sun.pdf, 1);
  EXPECT_TRUE(sun.infinite && sun.delta);
  EXPECT_GT(distance(sun.point.position, from), 2 * sunny->radius());
  EXPECT_NEAR(sunny->luminaires()[0]->area(0), square(sunny->radius()), 1e-3);
}

TEST(NestedLuminaires, WhatCannotBeIsRefused) {
  const auto refused = [](const std::string& objects) -> std::string {
    try {
      scene_of(objects);
    } catch (const Error& e) {
      return e.what();
    }
    return "";
  };
  EXPECT_NE(refused("BvhScene { objects: [ Environment { emission: DiffuseEmission {} } ] }").find("outermost"),
            std::string::npos);
  // 200^3 lamps: they are counted, but not created.
  std::string many = std::string("s0 = BvhScene { objects: [ ") + ball + " ] }\n";
  for (int i = 1; i <= 3; ++i) {
    many += fmt::format("s{} = BvhScene {{ objects: [", i);
    for (int k = 0; k < 200; ++k)
      many += fmt::format("\n Instance {{ scene: s{}, transform: translate({}, 0, 0) }}", i - 1, 2 * k * std::pow(400, i - 1));
    many += " ] }\n";
  }
  const Ref<Job> job = load_job_text(many + "Job { camera: PerspectiveCamera {}, scene: s3 }", "test.etd");
  try {
    prepare_tree(*job);
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("luminaires stand in nested scenes"), std::string::npos) << e.what();
    EXPECT_GT(e.location.line, 1);
  }
}

// Products of animated transforms.
TEST(NestedLuminaires, ProductsOfMotionsAreExact) {
  const auto turn = [](float angle, const Vector3& by) {
    return Transform::translate(by) * Transform::rotate(angle, {0, 1, 0}) * Transform::scale({1, 2, 0.5f});
  };
  const AnimatedTransform a = test::motion(turn(0, {1, 0, 0}), turn(2, {0, 3, 0})),
                          b = test::motion(turn(1, {0, 0, 4}), turn(-1, {2, 0, 0}));
  const AnimatedTransform product = a * AnimatedTransform(turn(0.4f, {1, 1, 1})) * b;
  EXPECT_TRUE(product.animated() && product.valid());
  Bounds3 box;
  box.add(Point3{-1, -1, -1});
  box.add(Point3{1, 2, 1});
  const Bounds3 swept = product.sweep(box, 0, 1);
  for (int i = 0; i <= 50; ++i) {
    const float time = float(i) / 50;
    const Point3 p = product.at(time)(Point3{1, 2, -1});
    EXPECT_LT(distance(p, a.at(time)(turn(0.4f, {1, 1, 1})(b.at(time)(Point3{1, 2, -1})))), 1e-4f);
    EXPECT_TRUE(swept.contains(p));
  }
  EXPECT_FALSE((AnimatedTransform(turn(1, {})) * AnimatedTransform(turn(2, {}))).animated());
}

// A value is computed once for each object, however many objects there are.
TEST(NestedLuminaires, NumbersOfManyObjectsAreRemembered) {
  std::vector<Ref<SceneObject>> objects;
  for (int i = 0; i < 5000; ++i) objects.push_back(ref_cast<SceneObject>(Registry::instance().create("Sphere")));
  PerObject numbers;
  numbers.expect();
  int found = 0;
  for (int round = 0; round < 3; ++round)
    for (size_t i = 0; i < objects.size(); ++i)
      EXPECT_EQ(numbers.get(*objects[i], [&] { return ++found, double(i); }), double(i));
  EXPECT_EQ(found, 5000);
  numbers.forget();
  EXPECT_EQ(numbers.get(*objects[0], [] { return 7.0; }), 7);
}

}  // namespace
}  // namespace etendue
