#pragma once
// Shared by tests of the simpler renderers: parts of scenes, single samples, and comparisons.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "component_test_support.h"
#include "etendue/describe/color.h"
#include "render_support.h"

namespace etendue::test {

inline void expect_value(const Measured& m, double expected, double tolerance = 0.01) {
  EXPECT_EQ(m.bad, 0u);
  EXPECT_NEAR(m.mean.y, expected, tolerance * expected) << "standard error " << m.error;
  // The error bound assumes independent samples and is generous for low-discrepancy ones.
  EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + 2e-4 * expected);
}

/// A started render of a job, from which single samples can be computed.
class Ready {
 public:
  explicit Ready(const std::string& text) : render_(load_job_text(text, "test.etd")), process_(render_.start_at(0)) {}
  CameraSample sample(int x, int y, std::uint32_t n, std::span<Spectrum> lengths = {}) {
    PathSink sink;
    sink.lengths = lengths;
    return process_->sample(x, y, n, arena_, sink);
  }
  /// A sample as linear sRGB.
  Vector3 rgb(int x, int y, std::uint32_t n = 0) {
    const auto s = sample(x, y, n);
    const Xyz c = to_xyz(s.value, s.wavelengths);
    const auto& m = rgb_space("srgb").from_xyz;
    return {float(m[0] * c.x + m[1] * c.y + m[2] * c.z), float(m[3] * c.x + m[4] * c.y + m[5] * c.z),
            float(m[6] * c.x + m[7] * c.y + m[8] * c.z)};
  }
  const Job& job() const { return render_.job(); }

 private:
  const Render render_;
  const std::unique_ptr<RenderProcess> process_;
  Arena arena_;
};

inline void expect_flat(const Spectrum& s, float expected, float tolerance = 1e-5f) {
  for (int i = 0; i < spectrum_size; ++i)
    EXPECT_NEAR(s[i], expected, tolerance * std::max(expected, 1e-3f)) << "wavelength " << i;
}

inline const std::string lit = "DiffuseEmission { radiance: 1, sides: both }";
inline const std::string diffuse = "shader: Lambertian { color: 1 }";

inline std::string pinhole(const std::string& from, const std::string& to) {
  return "PerspectiveCamera { from: " + from + ", to: " + to + ", up: [0, 1, 0], fov: 0.01 deg }";
}

inline const std::string furnace_camera = "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }";

/// A room with diffuse, glossy, mirroring and dispersive objects, two lamps of different size and an environment.
inline std::string room() {
  return R"(
    Rectangle { corner: [-2,-1,-2], edge_u: [0,0,4], edge_v: [4,0,0], shader: PhongShader { color: 0.4, specular: 0.5, exponent: 40 } }
    Rectangle { corner: [-2,-1,-2], edge_u: [4,0,0], edge_v: [0,3,0], shader: Lambertian { color: rgb(0.2, 0.5, 0.8) } }
    Rectangle { corner: [-2,-1,-2], edge_u: [0,3,0], edge_v: [0,0,4], shader: PhongShader { color: 0.3, specular: 0.3, exponent: 5 } }
    Rectangle { corner: [2,-1,-2], edge_u: [0,3,0], edge_v: [0,0,4], shader: PerfectSpecular { color: 0.9 } }
    Sphere { centre: [-0.7,-0.4,-0.5], radius: 0.6, shader: Dielectric { ior: glass("N-SF11") } }
    Sphere { centre: [0.8,-0.5,-0.6], radius: 0.5, shader: PhongShader { color: 0.1, specular: 0.8, exponent: 200 } }
    Rectangle { corner: [-0.5,1.9,-0.5], edge_u: [1,0,0], edge_v: [0,0,1], emission: DiffuseEmission { radiance: 4 } }
    Sphere { centre: [1.2,0.8,-1], radius: 0.4, emission: DiffuseEmission { radiance: 4 } }
    Environment { emission: DiffuseEmission { radiance: 0.3, sides: both } })";
}
inline const std::string room_camera = "PerspectiveCamera { from: [0,0.3,4], to: [0,-0.2,0], up: [0,1,0], fov: 45 deg }";

inline std::string whitted(int depth, int samples = 1) {
  return fmt::format("WhittedRenderer {{ max_depth: {}, samples: {} }}", depth, samples);
}
inline std::string distant(double x, double y, double z, double irradiance = 1) {
  return fmt::format("Distant {{ direction: [{}, {}, {}], emission: DiffuseEmission {{ radiance: {}, sides: both }} }}", x, y,
                     z, irradiance);
}
inline std::string floor_of(const std::string& shader) {
  return "Rectangle { corner: [-9,-9,0], edge_u: [18,0,0], edge_v: [0,18,0], shader: " + shader + " }\n";
}

inline const std::string slab = R"(
  TriangleMesh { positions: [[-9,-9,0],[9,-9,0],[9,9,0],[-9,9,0],[-9,-9,1],[9,-9,1],[9,9,1],[-9,9,1]]
    triangles: [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,1,5],[0,5,4],[1,2,6],[1,6,5],[2,3,7],[2,7,6],[3,0,4],[3,4,7]]
    shader: Dielectric { ior: 1.5 } }
)";

/// The p-value of a chi-square test over the pixels of two images: the difference of their Y, with the standard error of each
/// pixel. Means of few samples have heavy-tailed distributions, so there must be many samples.
inline double agreement(const std::string& a, const std::string& b, const std::string& camera, int size,
                        const std::string& objects) {
  double statistic = 0;
  const auto picture = [&](const std::string& renderer) {
    const Ref<Job> job = load_job_text(job_text(renderer, camera, size, objects), "test.etd");
    job->image->layers = {"variance"};
    const std::unique_ptr<Render> render = rendered(job);
    EXPECT_EQ(render->film().bad_samples(), 0u);
    return render->picture();
  };
  const Image first = picture(a), second = picture(b);
  const size_t variance =
      size_t(std::find(first.channels.begin(), first.channels.end(), "variance.Y") - first.channels.begin());
  double sum_a = 0, sum_b = 0, sum_variance = 0;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const double d = double(first.at(x, y, 1)) - double(second.at(x, y, 1));
      const double v = double(first.at(x, y, variance)) + double(second.at(x, y, variance));
      statistic += d * d / v;
      sum_a += double(first.at(x, y, 1));
      sum_b += double(second.at(x, y, 1));
      sum_variance += v;
    }
  EXPECT_NEAR(sum_a, sum_b, 4 * std::sqrt(sum_variance)) << "sums over the picture";
  EXPECT_LT(std::sqrt(sum_variance), 0.01 * sum_a) << "the test is too weak";
  return chi_square_tail(statistic, double(size) * size);
}

}  // namespace etendue::test
