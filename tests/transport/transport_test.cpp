// Cases in which connections of paths were once wrong: all strategies must agree. Fixed seeds; each comparison is held to 4.5
// standard errors of its difference, taken from renders with different seeds.

#include <gtest/gtest.h>

#include "support/render_support.h"

namespace etendue::test {
namespace {

struct Estimate {
  double mean = 0, error = 0;
};

Estimate estimate(const std::string& renderer, int samples, const std::string& camera, const std::string& objects) {
  constexpr int runs = 12;
  double sum = 0, squares = 0;
  Render render(load_job_text(
      job_text(renderer + ", samples: " + std::to_string(samples) + " }", camera, 12, objects, "EmbreeScene"), "test.etd"));
  for (int i = 0; i < runs; ++i) {
    render_again(render, std::uint64_t(i + 1));
    const Image image = render.film().develop();
    double mean = 0;
    for (int y = 0; y < 12; ++y)
      for (int x = 0; x < 12; ++x) mean += image.at(x, y, 1) / 144;
    EXPECT_EQ(render.film().bad_samples(), 0u);
    sum += mean / runs;
    squares += mean * mean / runs;
  }
  return {sum, std::sqrt(std::max(0.0, squares - sum * sum) / (runs - 1))};
}

/// Compares all renderers with the first; a relative difference of `notice` must be detectable.
void agree(const std::vector<std::string>& renderers, int samples, const std::string& camera, const std::string& objects,
           double notice = 0.03) {
  const Estimate a = estimate(renderers[0], samples, camera, objects);
  EXPECT_GT(a.mean, 0);
  for (size_t i = 1; i < renderers.size(); ++i) {
    const Estimate b = estimate(renderers[i], samples, camera, objects);
    const double error = std::hypot(a.error, b.error);
    EXPECT_NEAR(b.mean, a.mean, 4.5 * error + 1e-5 * a.mean) << renderers[0] << " and " << renderers[i];
    EXPECT_LT(4.5 * error, notice * a.mean) << "too few samples to tell";
  }
}

const char* const camera = "PerspectiveCamera { from: [0, 1, -5], to: [0, 0, 0], fov: 40 }";
const std::string floor_plate =
    "Rectangle { corner: [-4, -1, -4], edge_u: [0, 0, 8], edge_v: [8, 0, 0], shader: Lambertian { color: 0.5 } }\n";
const std::string path = "PathTracer { max_depth: 6", unlit = "PathTracer { max_depth: 6, next_event: false",
                  both = "BidirectionalPathTracer { max_depth: 6", light = "LightTracer { max_depth: 6";

// An opaque sheet a tenth of a millimetre below a lamp, at a height of three metres: shadow rays must not end before it.
TEST(Transport, ShadesCloseToLampsShade) {
  const std::string lamp =
      "Rectangle { corner: [-0.4, 3, -0.4], edge_u: [0.8, 0, 0], edge_v: [0, 0, 0.8], emission: DiffuseEmission { radiance: "
      "10, "
      "sides: both } }\n"
      "Rectangle { corner: [-0.5, 2.9999, -0.5], edge_u: [1, 0, 0], edge_v: [0, 0, 1], shader: Lambertian { color: 0 } }\n"
      "Rectangle { corner: [-4, 4, -4], edge_u: [8, 0, 0], edge_v: [0, 0, 8], shader: Lambertian { color: 0.5 } }\n";
  agree({path, both, light}, 512, camera, floor_plate + lamp, 0.06);
}

// A luminaire with a null-scattering surface, filled with a medium.
TEST(Transport, LuminairesThatLightPassesThrough) {
  const std::string ball =
      "Sphere { radius: 0.6, shader: PassThrough {}, emission: DiffuseEmission { radiance: 1, sides: both }, interior: "
      "HomogeneousVolume { absorption: 1 } }\n";
  agree({path, unlit, both, light}, 256, camera, floor_plate + ball, 0.04);
}

// A null-scattering sheet in fog bounds no medium.
TEST(Transport, OpenSheetsInFogChangeNothing) {
  const std::string fog =
      "Sphere { radius: 2, shader: PassThrough {}, interior: HomogeneousVolume { scattering: 0.5 } }\n"
      "Sphere { centre: [0, 1, 0], radius: 0.2, emission: DiffuseEmission { radiance: 10 } }\n";
  const std::string sheet =
      "Rectangle { corner: [-1, 0.3, -1], edge_u: [2, 0, 0], edge_v: [0, 0, 2], shader: PassThrough {} }\n";
  const Estimate without = estimate(path, 256, camera, fog);
  for (const std::string& renderer : {path, both, light}) {
    const Estimate with = estimate(renderer, 256, camera, fog + sheet);
    EXPECT_NEAR(with.mean, without.mean, 4.5 * std::hypot(with.error, without.error)) << renderer;
    EXPECT_LT(with.error, 0.01 * with.mean);
  }
}

// A lamp parallel to a medium's boundary, seen through it by shadow rays.
TEST(Transport, LampsParallelToABoundary) {
  const std::string slab =
      "TriangleMesh { positions: [[-9,-1,-9],[9,-1,-9],[9,0,-9],[-9,0,-9],[-9,-1,9],[9,-1,9],[9,0,9],[-9,0,9]], triangles: "
      "[[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,5,4],[0,1,5],[1,6,5],[1,2,6],[2,7,6],[2,3,7],[3,4,7],[3,0,4]], shader: PassThrough "
      "{}, "
      "interior: HomogeneousVolume { scattering: 1 } }\n"
      "Rectangle { corner: [-9, 1, -9], edge_u: [18, 0, 0], edge_v: [0, 0, 18], emission: DiffuseEmission { radiance: 1 } }\n";
  agree({unlit, path, both}, 512, "PerspectiveCamera { from: [0, 0.5, -5], to: [0, -0.5, 0], fov: 20 }", slab, 0.02);
}

TEST(Transport, DepthIsMeasuredFromTheCameraThroughBoundaries) {
  for (const std::string& renderer : {path, both}) {
    const Ref<Job> job =
        load_job_text(job_text(renderer + ", samples: 1 }", "PerspectiveCamera { from: [0, 0, -5], to: [0, 0, 0], fov: 1 }", 4,
                               "Sphere { radius: 2, shader: PassThrough {}, interior: HomogeneousVolume { absorption: 1 } }\n"
                               "Sphere { radius: 1, shader: Lambertian {}, emission: DiffuseEmission {} }"),
                      "test.etd");
    job->image->layers = {"depth"};
    EXPECT_NEAR(rendered(job)->picture().at(1, 1, 3), 4, 1e-3) << renderer;
  }
}

// Hair is not reciprocal, and light that crosses a round hair passes its wall in one direction only: light subpaths use the
// adjoint. One lamp is behind the hair, so that most of the seen light was transmitted, and one is inside a hair.
TEST(Transport, HairFromBothEnds) {
  const std::string behind = "Sphere { centre: [1.2, 1.6, 0.9], radius: 0.5, emission: DiffuseEmission { radiance: 10 } }\n";
  const std::string within = "Sphere { centre: [0.3, -0.4, 0], radius: 0.12, emission: DiffuseEmission { radiance: 10 } }\n";
  const std::string wall = "Rectangle { corner: [-3, -3, 2], edge_u: [6, 0, 0], edge_v: [0, 6, 0], shader: Lambertian {} }\n";
  const std::string hair =
      "radius: [0.25], shader: HairShader { pigment: absorption, absorption: 0.1, longitudinal_roughness: 0.5, "
      "azimuthal_roughness: 0.5, tilt: 8 } }\n";
  const std::string one = "Curve { points: [[-2, -0.3, 0], [1, -0.3, 0]], " + hair;
  const std::string two =
      "Curve { points: [[-2, -0.3, 0], [1, -0.3, 0], [-2, -0.3, 0.2], [1, -0.3, 0.2]], counts: [2, 2], " + hair;
  for (const std::string form : {"tube", "ribbon"}) {
    const std::string strands =
        "Curve { points: [[-2, -0.3, 0], [1, -0.3, 0], [-2, -0.3, 0.2], [1, -0.3, 0.2], [0.2, -2, -0.5], [0, 2, -0.5]], "
        "counts: [2, 2, 2], form: " +
        form + ", normals: [[0.3, 0.4, -1]], " + hair;
    agree({path, both, light}, 256, camera, behind + strands + wall, 0.02);
  }
  agree({path, both, light}, 256, camera, within + one, 0.05);
  agree({path, both}, 512, camera, within + two, 0.05);
}

TEST(Transport, WhatCannotBeFoundIsRefused) {
  const auto refused = [](const std::string& objects) {
    try {
      rendered(load_job_text(job_text("PathTracer { samples: 1 }", camera, 2, objects), "test.etd"));
      return std::string();
    } catch (const Error& e) {
      return std::string(e.what());
    }
  };
  EXPECT_NE(refused("Sphere { emission: EnvironmentEmission { radiance: 1 } }").find("belongs on an Environment"),
            std::string::npos);
  EXPECT_EQ(refused("BruteForceScene { objects: [ Point { emission: DiffuseEmission {} } ] }"),
            "");  // luminaires in nested scenes are found
}

}  // namespace
}  // namespace etendue::test
