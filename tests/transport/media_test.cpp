// Participating media against closed forms, for every renderer that supports them. Each value is held to 0.5 % and to 4.5
// standard errors (7e-6 each), with fixed seeds. Rows are those of Chandrasekhar's half space and of plane slabs.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/render_support.h"

namespace etendue::test {
namespace {

struct Estimate {
  double mean = 0, error = 0;
};

/// The mean Y of an image and its standard error, from the differences between pixels.
Estimate estimate(const std::string& text) {
  const auto render = rendered(load_job_text(text, "test.etd"));
  const Image image = render->film().develop();
  double sum = 0, squares = 0;
  const double n = double(image.width) * image.height;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      sum += image.at(x, y, 1);
      squares += image.at(x, y, 1) * image.at(x, y, 1);
    }
  EXPECT_EQ(render->film().bad_samples(), 0u);
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n)) / (n - 1))};
}

/// A slab from z = 0 down to -depth, `half` wide to each side, with a null-scattering boundary.
std::string slab(double half, double depth, const std::string& medium) {
  const auto p = [&](int x, int y, double z) {
    return "[" + std::to_string(x * half) + "," + std::to_string(y * half) + "," + std::to_string(z) + "]";
  };
  std::string points;
  for (const double z : {-depth, 0.0})
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      points += (points.empty() ? "" : ",") + p(x, y, z);
  return "TriangleMesh { positions: [" + points +
         "], triangles: [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,5,4],[0,1,5],[1,6,5],[1,2,6],[2,7,6],[2,3,7],[3,4,7],[3,0,4]], "
         "shader: PassThrough {}, interior: HomogeneousVolume { " +
         medium + " } }\n";
}

const char* const beam = "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: 1 } }\n";

std::string view(bool from_above, double width) {
  return std::string("OrthographicCamera { from: [0, 0, ") + (from_above ? "1000" : "-2000") +
         "], to: [0, 0, 0], up: [0, 1, 0], width: " + std::to_string(width) + " }";
}

std::string job(const std::string& renderer, int depth, int samples, const std::string& camera, const std::string& objects) {
  return job_text(renderer + " { max_depth: " + std::to_string(depth) + ", samples: " + std::to_string(samples) + " }", camera,
                  16, objects, "EmbreeScene");
}

void expect(const std::string& text, double expected, const char* what) {
  const Estimate e = estimate(text);
  EXPECT_NEAR(e.mean, expected, 0.005 * expected) << what << ", standard error " << e.error;
  EXPECT_NEAR(e.mean, expected, 4.5 * e.error + 1e-4 * expected) << what;
}

const std::vector<const char*> renderers = {"PathTracer", "BidirectionalPathTracer"};

TEST(Media, BeerAndLambert) {  // exp(-2)
  const std::string plate =
      "Rectangle { corner: [-4,-4,-3], edge_u: [8,0,0], edge_v: [0,8,0], emission: DiffuseEmission { radiance: 1 } }\n";
  for (const char* r : renderers)
    expect(job(r, 5, 64, view(true, 0.1), slab(10, 1, "absorption: 2") + plate), std::exp(-2.0), r);
  expect(job("LightTracer", 5, 4096, view(true, 6), slab(10, 1, "absorption: 2") + plate), std::exp(-2.0), "LightTracer");
}

TEST(Media, EmissionOfAnAbsorber) {  // 1 - exp(-a)
  for (const char* r : renderers)
    for (const double a : {2.0, 0.25})
      expect(job(r, 5, 64, view(true, 0.1), slab(10, 1, fmt::format("absorption: {}, emission: {}", a, a))), 1 - std::exp(-a),
             r);
}

TEST(Media, SingleScattering) {
  const std::string medium = slab(1, 1, "scattering: 1");
  const double reflected = (1 - std::exp(-2.0)) / (8 * double(pi)), transmitted = std::exp(-1.0) / (4 * double(pi));
  for (const char* r : renderers) {
    expect(job(r, 2, 512, view(true, 1), medium + beam), reflected, r);
    expect(job(r, 2, 512, view(false, 1), medium + beam), transmitted, r);
  }
  expect(job("LightTracer", 2, 4096, view(true, 2), medium + beam), reflected, "LightTracer");
  expect(job("LightTracer", 2, 4096, view(false, 2), medium + beam), transmitted, "LightTracer");
}

// By H functions: omega H(1)^2 / (8 pi). With absorption, this slab is so deep that light from below would change the result by
// less than 1e-4. Without absorption the reflection of a slab would lack about 1 / depth of its flux, so this one absorbs a
// little.
TEST(Media, HalfSpace) {
  for (const char* r : renderers)
    expect(job(r, 100000, 1024, view(true, 1), slab(400, 40, "scattering: 0.9, absorption: 0.1") + beam), 0.122572, r);
}

TEST(Media, SlabOfAllOrders) {
  const std::string medium = slab(60, 1, "scattering: 1");
  for (const char* r : renderers) {
    expect(job(r, 100000, 1024, view(true, 1), medium + beam), 0.085749, r);
    expect(job(r, 100000, 1024, view(false, 1), medium + beam), 0.078473, r);
  }
  expect(job("LightTracer", 100000, 16384, view(true, 30), slab(30, 1, "scattering: 1") + beam), 0.085749, "LightTracer");
}

// A medium thin for short waves and thick for long ones: free flights are sampled for all wavelengths of a path at once, and
// must give the sum of short-waved light in a thin grey medium and long-waved light in a thick one.
TEST(Media, ChromaticSlabAgreesWithItsGreyParts) {
  const std::string low = "spectrum([360, 555, 555.01, 830], [1, 1, 0, 0])",
                    high = "spectrum([360, 555, 555.01, 830], [0, 0, 1, 1])";
  const auto at = [](const std::string& r, const std::string& light, const std::string& scattering) {
    return estimate(job(r, 12, 512, view(true, 1),
                        slab(60, 1, "scattering: " + scattering) +
                            "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: " + light + " } }\n"));
  };
  for (const char* r : renderers) {
    const Estimate both = at(r, "1", "spectrum([360, 555, 555.01, 830], [0.2, 0.2, 3, 3])");
    const Estimate thin = at(r, low, "0.2"), thick = at(r, high, "3");
    EXPECT_NEAR(both.mean, thin.mean + thick.mean, 4.5 * std::hypot(both.error, thin.error, thick.error)) << r;
    EXPECT_LT(both.error, 0.02 * both.mean) << r;
  }
}

// A camera inside a medium.
TEST(Media, TheCameraMayBeInside) {
  const std::string glow =
      "Sphere { radius: 2, shader: PassThrough {}, interior: HomogeneousVolume { absorption: 0.5, "
      "emission: 0.5 } }\n";
  for (const char* r : renderers) {
    const std::string camera = "PerspectiveCamera { from: [0, 0, 0], to: [0, 0, 1], fov: 60 }";
    expect(job(r, 5, 16, camera, glow), 1 - std::exp(-1.0), r);
  }
}

}  // namespace
}  // namespace etendue::test
