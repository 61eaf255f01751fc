#pragma once
// Configurations with a known answer, rendered by every renderer that can find all of their light: each strategy must give the
// same number. Each value is held to 0.5 % and to 4.5 standard errors of its own estimate, with fixed seeds. The standard error
// is taken from the differences of 32 renders with different seeds, which includes any correlation between splats of one path
// and between low-discrepancy samples (two-sided 9e-5 for each value: Student's distribution with 31 degrees of freedom).
//
// Left out, each because it cannot find the light: DirectRenderer where paths are longer than two segments; WhittedRenderer
// where luminaires have an area or diffuse surfaces light each other; LightTracer where the camera sees glass, a surface too
// small for light subpaths to hit (a point: there the mean over a square is rendered instead), or emissive media; PathTracer
// and DistributionRenderer where a delta luminaire shines through glass; media for all but PathTracer, BidirectionalPathTracer
// and LightTracer.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "render_support.h"

namespace etendue::closed_form {

using test::job_text;

inline constexpr double exact_pi = 3.141592653589793;

struct Way {
  std::string renderer, members;  ///< its class, and further members
  int samples;                    ///< per pixel and render
};

/// A number, or the function that computes it. All rows are made whenever the test program starts, which is once for every
/// test, so that integrals are left to the tests that compare with them.
class Expected {
 public:
  Expected(double value) : compute_([value] { return value; }) {}
  Expected(double (*compute)()) : compute_(compute) {}
  double value() const { return compute_(); }

 private:
  std::function<double()> compute_;
};

struct Row {
  std::string name, camera, objects;
  Expected expected;
  std::vector<Way> ways;
  int size = 16;  ///< width and height of the image [pixels]
};

struct Case {
  Row row;
  Way way;
};

inline std::vector<Case> cases(const std::vector<Row>& rows) {
  std::vector<Case> list;
  for (const Row& row : rows)
    for (const Way& way : row.ways) list.push_back({row, way});
  return list;
}

inline void PrintTo(const Case& c, std::ostream* out) { *out << c.way.renderer << " { " << c.way.members << " }"; }

/// Compares the mean Y of the image, over renders with different seeds, with the expected value.
inline void expect_row(const Case& c) {
  constexpr int renders = 32;
  Render render(load_job_text(job_text(fmt::format("{} {{ samples: {}{}{} }}", c.way.renderer, c.way.samples,
                                                   c.way.members.empty() ? "" : ", ", c.way.members),
                                       c.row.camera, c.row.size, c.row.objects, "EmbreeScene"),
                              "row.etd"));
  std::vector<double> means;
  std::uint64_t bad = 0;
  for (int i = 0; i < renders; ++i) {
    test::render_again(render, std::uint64_t(i + 1));
    const Image image = render.film().develop();
    double sum = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += image.at(x, y, 1);
    means.push_back(sum / (double(image.width) * image.height));
    bad += render.film().bad_samples();
  }
  const double mean = std::accumulate(means.begin(), means.end(), 0.0) / renders;
  double squares = 0;
  for (const double m : means) squares += (m - mean) * (m - mean);
  const double error = std::sqrt(squares / (renders * (renders - 1.0))), expected = c.row.expected.value();
  EXPECT_EQ(bad, 0u);
  EXPECT_NEAR(mean, expected, 0.005 * expected) << "standard error " << error;
  // Float arithmetic and expected values of six digits are exact to 1e-4, which matters only if the standard error is smaller.
  EXPECT_NEAR(mean, expected, 4.5 * error + 1e-4 * expected) << "standard error " << error;
}

inline std::string case_name(const testing::TestParamInfo<Case>& info) {
  return fmt::format("{}_{}_{}", info.param.row.name, info.param.way.renderer, info.index);
}

inline const std::string glow = "DiffuseEmission { radiance: 1, sides: both }";
inline const std::string diffuse = "shader: Lambertian { color: 1 }";

inline std::string pinhole(const std::string& from, const std::string& to) {
  return "PerspectiveCamera { from: " + from + ", to: " + to + ", up: [0, 1, 0], fov: 0.01 deg }";
}
/// An orthographic camera that sees the square of so many metres around `to`.
inline std::string square(const std::string& from, const std::string& to, double width) {
  return fmt::format("OrthographicCamera {{ from: {}, to: {}, up: [0, 1, 0], width: {} }}", from, to, width);
}
/// A horizontal rectangle at height z.
inline std::string plate(double half, double z, const std::string& more = "") {
  return fmt::format("Rectangle {{ corner: [{0}, {0}, {1}], edge_u: [{2}, 0, 0], edge_v: [0, {2}, 0]{3}{4} }}\n", -half, z,
                     2 * half, more.empty() ? "" : ", ", more);
}

}  // namespace etendue::closed_form
