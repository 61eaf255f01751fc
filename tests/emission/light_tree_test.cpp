// The tree of luminaires (TreeLightSampler): its probabilities, pictures rendered with it, and emissive meshes.

#include <fmt/format.h>

#include "etendue/language/language.h"
#include "etendue/light_sampler.h"
#include "etendue/render/job.h"
#include "support/component_test_support.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

/// Lamps that face many directions, a sphere, a point, a disc and an environment.
std::string lamps(int count) {
  Random random(5);
  std::string text;
  for (int i = 0; i < count; ++i) {
    const Vector3 d = 0.3f * random.direction(), e = 0.3f * random.direction();
    const auto v = [](const Vector3& a) { return fmt::format("[{}, {}, {}]", a.x, a.y, a.z); };
    const Vector3 corner{6 * random() - 3, 6 * random() - 3, 1 + 2 * random()};
    text += fmt::format("Polygon {{ points: [{}, {}, {}], emission: DiffuseEmission {{ radiance: {}, sides: {} }} }}\n",
                        v(corner), v(corner + d), v(corner + e), 1 + i % 3,
                        i % 4 == 0   ? "both"
                        : i % 4 == 1 ? "back"
                                     : "front");
  }
  return text + R"(Sphere { centre: [2, 2, 1], radius: 0.2, emission: DiffuseEmission { radiance: 3 } }
    Point { position: [-1, 2, 2], emission: DiffuseEmission { radiance: 0.5 } }
    Disc { radius: 0.5, transform: translate([0, -2, 2]), emission: DiffuseEmission { radiance: 2, sides: back } }
    Environment { emission: DiffuseEmission { radiance: 0.05, sides: both } }
    )";
}

const char* const floor_plane =
    "Rectangle { corner: [-3,-3,0], edge_u: [6,0,0], edge_v: [0,6,0], shader: Lambertian { color: 0.8 } }\n";

std::string scene_job(const std::string& sampler, const std::string& objects, int samples) {
  return job_text("PathTracer { max_depth: 3, samples: " + std::to_string(samples) + ", light_sampler: " + sampler + " {} }",
                  "OrthographicCamera { from: [0, -0.01, 9], to: [0, 0, 0], up: [0, 1, 0], width: 6 }", 32, objects,
                  "EmbreeScene");
}

TEST(LightTree, ProbabilitiesAreThoseOfTheChoices) {
  const Ref<Job> job = load_job_text(scene_job("TreeLightSampler", lamps(40) + floor_plane, 1), "test.etd");
  prepare_tree(*job->scene);  // the scene alone, so that coordinates stay relative to the origin
  const Scene& scene = *job->scene;
  const Ref<LightSampler> tree = create<LightSampler>("TreeLightSampler");
  tree->build(scene);
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const Point3 p{6 * random() - 3, 6 * random() - 3, k % 2 ? 0 : 3 * random()};
    const Normal3 n = k % 3 == 0 ? Normal3{} : Normal3(random.direction());
    double sum = 0;
    std::vector<double> expected, counts(scene.luminaires().size());
    constexpr int choices = 20000;
    for (const SceneObject* l : scene.luminaires()) {
      const double q = double(tree->probability(p, n, *l));
      sum += q;
      expected.push_back(q * choices);
    }
    EXPECT_LE(sum, 1 + 1e-4);
    EXPECT_GE(sum, 0.97);  // luminaires that face away are excluded at the leaves only
    for (int i = 0; i < choices; ++i) {
      const LightChoice c = tree->choose(p, n, (float(i) + random()) / choices);
      if (!c.luminaire) continue;
      EXPECT_NEAR(c.probability, tree->probability(p, n, *c.luminaire), 1e-4f * c.probability + 1e-7f);
      ++counts[size_t(c.luminaire->luminaire_index())];
    }
    for (size_t i = 0; i < counts.size(); ++i) EXPECT_NEAR(counts[i], expected[i], 5 * std::sqrt(expected[i]) + 3) << i;
  }
}

TEST(LightTree, GivesTheSamePicture) {
  const std::string objects = lamps(40) + floor_plane;
  const Measured power = measure(scene_job("PowerLightSampler", objects, 512));
  const Measured tree = measure(scene_job("TreeLightSampler", objects, 256));
  EXPECT_NEAR(tree.mean.y, power.mean.y, 4.5 * std::hypot(power.error, tree.error)) << power.error << " " << tree.error;
  EXPECT_LT(tree.error, 0.01 * tree.mean.y);
}

/// A sphere of triangles, by longitude and latitude.
std::string ball(int rows, const std::string& members) {
  std::string points, triangles;
  const int columns = 2 * rows;
  for (int i = 0; i <= rows; ++i)
    for (int k = 0; k < columns; ++k) {
      const double t = M_PI * i / rows, f = 2 * M_PI * k / columns;
      points += fmt::format("[{}, {}, {}],", std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t));
    }
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < columns; ++k) {
      const int a = i * columns + k, b = i * columns + (k + 1) % columns;
      if (i > 0) triangles += fmt::format("[{}, {}, {}],", a, a + columns, b);
      if (i + 1 < rows) triangles += fmt::format("[{}, {}, {}],", b, a + columns, b + columns);
    }
  points.pop_back();
  triangles.pop_back();
  return "TriangleMesh { positions: [" + points + "], triangles: [" + triangles + "], " + members + " }\n";
}

// The mean of 1 / pdf over sampled points whose front faces `from` estimates the solid angle, which is 2 pi (1 - sqrt(1 - 1 /
// d^2)) for a sphere.
TEST(LightTree, MeshSeenFromOutside) {
  const Ref<SceneObject> mesh = ref_cast<SceneObject>(parse_component(ball(60, "emission: DiffuseEmission { radiance: 1 }")));
  prepare_tree(*mesh);
  Random random(9);
  for (const double distance : {1.5, 4.0}) {
    const Point3 from{float(0.6 * distance), 0, float(0.8 * distance)};
    double sum = 0, squares = 0;
    constexpr int count = 20000;
    int none = 0;
    for (int i = 0; i < count; ++i) {
      const SurfaceSample s = mesh->sample_visible(from, random.pair(), 0);
      if (!(s.pdf > 0)) {
        ++none;
        continue;
      }
      EXPECT_NEAR(s.pdf, mesh->visible_pdf(from, s.direction, s.point), 2e-3f * s.pdf);
      const double value = dot(s.point.normal, s.direction) < 0 ? 1 / double(s.pdf) : 0;
      sum += value / count;
      squares += value * value / count;
    }
    EXPECT_LT(none, count / 4);
    const double expected = 2 * M_PI * (1 - std::sqrt(1 - 1 / (distance * distance)));
    EXPECT_NEAR(sum, expected, 4.5 * std::sqrt((squares - sum * sum) / count) + 3e-3 * expected) << distance;
    EXPECT_LT(std::sqrt(squares - sum * sum), 0.95 * expected) << distance;  // by area over the whole mesh: 1.3 and more
  }
}

TEST(LightTree, MeshAsALampGivesThePictureOfTheSphere) {
  const std::string emission = "transform: translate([0, 0, 1.5]), emission: DiffuseEmission { radiance: 1 }";
  const Measured sphere = measure(scene_job("TreeLightSampler", "Sphere { radius: 1, " + emission + " }\n" + floor_plane, 64));
  const Measured mesh = measure(scene_job("TreeLightSampler", ball(100, emission) + floor_plane, 64));
  EXPECT_NEAR(mesh.mean.y, sphere.mean.y, 4.5 * std::hypot(mesh.error, sphere.error) + 2e-3 * sphere.mean.y);
}

}  // namespace
}  // namespace etendue::test
