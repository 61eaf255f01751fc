// Photons: their estimates, the choice of which are stored, and occlusion.

#include "etendue/transport/photons.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/render/renderer.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

Ref<Job> box(const std::string& renderer, int samples, int size = 24) {
  return load_job_text(job_text(fmt::format("{}, samples: {} }}", renderer, samples),
                                "PerspectiveCamera { from: [0, -0.9, 0], to: [0, 1, -0.3], fov: 90 }", size,
                                R"(Box { size: [2, 2, 2], shader: Lambertian { color: 0.6 } }
                                   Rectangle { corner: [-0.3, -0.3, 0.95], edge_u: [0, 0.6, 0], edge_v: [0.6, 0, 0]
                                               emission: DiffuseEmission { radiance: 3 } }
                                   Sphere { centre: [0.3, 0.3, -0.6], radius: 0.35, shader: PhongShader { color: 0.2, specular: 0.6, exponent: 20 } })"),
                       "box.etd");
}

TEST(VertexConnectionMerging, without_merging_is_bidirectional_path_tracing_to_the_bit) {
  const auto merging = rendered(box("VertexConnectionMerging { merging: false, max_depth: 6", 16));
  const auto connecting = rendered(box("BidirectionalPathTracer { max_depth: 6", 16));
  EXPECT_EQ(merging->film().develop().values, connecting->film().develop().values);
}

// Without connections it is progressive photon mapping whose photons include direct light. The camera subpaths differ, so the
// images agree only within their noise; both have the same photons, and so most of the noise is the same.
TEST(VertexConnectionMerging, without_connecting_is_progressive_photon_mapping) {
  const std::string members = "{ max_depth: 6, radius: 2, alpha: 0.7, photon_walks: 4000, ";
  const Image merged = rendered(box("VertexConnectionMerging " + members + "connecting: false", 64))->film().develop();
  const Image mapped = rendered(box("ProgressivePhotonMapper " + members + "next_event: false", 64))->film().develop();
  double sum = 0, difference = 0;
  for (size_t i = 0; i < merged.values.size(); ++i) {
    sum += double(mapped.values[i]);
    difference += std::abs(double(merged.values[i]) - double(mapped.values[i]));
  }
  EXPECT_LT(difference, 0.01 * sum);
}

// A dark room beside a lit one, on one floor: photons on the other side of the wall must not contribute.
TEST(Photons, do_not_shine_through_walls) {
  const std::string rooms = R"(
    Box { size: [4, 2, 2], shader: Lambertian { color: 0.8 } }
    Rectangle { corner: [0, -1, -1], edge_u: [0, 2, 0], edge_v: [0, 0, 2], shader: Lambertian { color: 0.8 } }
    Rectangle { corner: [0.5, -0.3, 0.95], edge_u: [0, 0.6, 0], edge_v: [0.6, 0, 0], emission: DiffuseEmission { radiance: 3 } })";
  for (const char* renderer :
       {"VertexConnectionMerging { radius: 4", "ProgressivePhotonMapper { radius: 4", "PhotonMapper { farthest: 4",
        "PhotonMapper { farthest: 4, irradiance: true", "PhotonMapper { farthest: 4, final_gather: false"}) {
    const Ref<Job> job =
        load_job_text(job_text(fmt::format("{}, max_depth: 5, samples: 4 }}", renderer),
                               "PerspectiveCamera { from: [-1.8, 0, 0.3], to: [0, 0, -0.8], fov: 80 }", 24, rooms),
                      "rooms.etd");
    for (const double value : rendered(job)->film().develop().values) ASSERT_EQ(value, 0) << renderer;
  }
}

// The caustics of small glass balls and a mirror are the same for light subpaths that start everywhere and for those that start
// towards specular objects alone.
TEST(ProjectionMap, bring_the_same_caustics) {
  const std::string things = R"(
    Rectangle { corner: [-5, -5, 0], edge_u: [10, 0, 0], edge_v: [0, 10, 0], shader: Lambertian { color: 0.5 } }
    Sphere { centre: [0, 0, 1], radius: 0.8, shader: Dielectric { ior: 1.5 } }
    Rectangle { corner: [2, -1, 0.2], edge_u: [0.4, 0, 1.5], edge_v: [0, 2, 0], shader: PerfectSpecular {} }
    Sphere { centre: [0, 1, 1.2], radius: 0.7, shader: Dielectric { ior: 1.5 } })";
  for (const char* lamp :
       {"Rectangle { corner: [-2, -2, 4], edge_u: [0, 4, 0], edge_v: [4, 0, 0], emission: DiffuseEmission { radiance: 1 } }",
        "Sphere { centre: [-2, 0, 3], radius: 0.5, emission: DiffuseEmission { radiance: 1 } }",
        "Point { position: [1, 0.5, 1.2], emission: DiffuseEmission { radiance: 1 } }",
        "Point { position: [0, -3, 2], emission: SpotEmission { axis: [0, 1, -0.4], inner_angle: 10 deg, outer_angle: 40 deg } "
        "}",
        "Distant { direction: [1, 0.2, -1], emission: DiffuseEmission { radiance: 1 } }",
        "Environment { emission: DiffuseEmission { radiance: 1 } }"}) {
    const Ref<Job> job =
        load_job_text(job_text("LightTracer { samples: 1 }", "PerspectiveCamera {}", 4, things + "\n" + lamp), "ball.etd");
    Render render(job);  // prepares the parts
    const RenderContext context{*job->scene, *job->camera, *job->image, *job->wavelengths};
    const std::unique_ptr<RenderProcess> process = job->renderer->start(context);  // prepares the light sampler, too
    const ProjectionMap targets(*job->scene);
    ASSERT_TRUE(targets.useful());
    // The mean and standard error over 20 sets of light subpaths, each with its own step number.
    const auto flux = [&](const ProjectionMap* towards, double& error) {
      constexpr int sets = 20;
      double sum = 0, squares = 0;
      for (int set = 0; set < sets; ++set) {
        PhotonWalks walks{.context = context,
                          .lights = *job->renderer->light_sampler,
                          .numbers = *job->renderer->sampler,
                          .step = std::uint32_t(set),
                          .wavelengths = job->wavelengths->sample(SampleKey(1, 0, 0, std::uint32_t(set)), 0.5f),
                          .walks = 20000,
                          .limits = {12, 1000},
                          .kinds = PhotonKinds::caustics,
                          .targets = towards};
        std::vector<Photon> photons;
        Arena arena;
        for (std::uint64_t item = 0; item < walks.items(); ++item) walks(item, photons, arena);
        double all = 0;
        for (const Photon& p : photons) {
          EXPECT_TRUE(p.caustic && p.vertices > 1);
          all += double(p.throughput.average()) / 20000;
        }
        sum += all;
        squares += all * all;
      }
      error = std::sqrt((squares / sets - (sum / sets) * (sum / sets)) / (sets - 1));
      return sum / sets;
    };
    double error = 0, error_towards = 0;
    const double everywhere = flux(nullptr, error), towards = flux(&targets, error_towards);
    EXPECT_GT(everywhere, 0) << lamp;
    // Four standard errors, by Student's distribution with 38 degrees of freedom: a probability of 3e-4 for each lamp.
    EXPECT_NEAR(everywhere, towards, 4 * std::hypot(error, error_towards)) << lamp;
    EXPECT_LT(std::hypot(error, error_towards), 0.02 * everywhere) << lamp;
  }
}

TEST(ProjectionMap, are_not_used_where_they_are_as_large_as_the_scene) {
  const Ref<Job> job = load_job_text(
      job_text("LightTracer { samples: 1 }", "PerspectiveCamera {}", 4,
               "Sphere { radius: 3, shader: Dielectric { ior: 1.5 } }\nPoint { emission: DiffuseEmission { radiance: 1 } }"),
      "ball.etd");
  Render render(job);
  EXPECT_FALSE(ProjectionMap(*job->scene).useful());
}

TEST(Photons, shrink_as_knaus_and_zwicker_say) {
  EXPECT_EQ(shrunk_area(0, 0.7), 1);
  EXPECT_DOUBLE_EQ(shrunk_area(1, 0.7), 1.7 / 2);
  EXPECT_DOUBLE_EQ(shrunk_area(2, 0.7), 1.7 / 2 * 2.7 / 3);
  // Asymptotically i^(a - 1) / Gamma(1 + a).
  EXPECT_NEAR(shrunk_area(99999, 0.7) * std::pow(100000.0, 0.3) * std::tgamma(1.7), 1, 1e-4);
}

// Camera subpaths end where photons are gathered, and photons do not represent the emission of media.
TEST(VertexConnectionMerging, AloneDoesNotFindTheLightOfMediaOnSurfaces) {
  const auto merging = ref_cast<Renderer>(Registry::instance().create("VertexConnectionMerging"));
  EXPECT_TRUE(merging->finds() & emitting_media);
  set(*merging, "connecting", Value(false));
  EXPECT_FALSE(merging->finds() & emitting_media);
}

}  // namespace
}  // namespace etendue::test
