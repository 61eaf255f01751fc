// Paths that split into reflection and refraction, and into wavelengths, have the expectation of paths that do not: compared
// with closed forms whose colours depend on each wavelength being refracted for itself.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "support/component_test_support.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

struct Statistics {
  Xyz mean, error;   ///< mean over renders with different seeds, and its standard error
  double noise = 0;  ///< colour noise: deviation of pixels' X and Z from those of the mean colour at their Y, over Y
};

Statistics rendered(const std::string& members, int samples, const std::string& camera, const std::string& objects) {
  Render render(load_job_text(
      job_text(fmt::format("PathTracer {{ samples: {}, {} }}", samples, members), camera, 8, objects, "EmbreeScene"),
      "split.etd"));
  constexpr int renders = 16;
  double sum[3] = {}, squares[3] = {}, chroma = 0;
  std::vector<std::array<double, 3>> pixels;
  for (int i = 0; i < renders; ++i) {
    render_again(render, std::uint64_t(i + 1));
    EXPECT_EQ(render.film().bad_samples(), 0u);
    const Image image = render.film().develop();
    double mean[3] = {};
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        pixels.push_back({image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)});
        for (size_t c = 0; c < 3; ++c) mean[c] += pixels.back()[c] / 64;
      }
    for (size_t c = 0; c < 3; ++c) {
      sum[c] += mean[c];
      squares[c] += mean[c] * mean[c];
    }
  }
  Statistics s;
  double* means[] = {&s.mean.x, &s.mean.y, &s.mean.z};
  double* errors[] = {&s.error.x, &s.error.y, &s.error.z};
  for (size_t c = 0; c < 3; ++c) {
    const double mean = sum[c] / renders;
    *means[c] = mean;
    *errors[c] = std::sqrt(std::max(0.0, squares[c] / renders - mean * mean) / (renders - 1));
  }
  for (const auto& p : pixels)
    chroma += std::pow(p[0] - p[1] * s.mean.x / s.mean.y, 2) + std::pow(p[2] - p[1] * s.mean.z / s.mean.y, 2);
  s.noise = std::sqrt(chroma / double(pixels.size())) / s.mean.y;
  return s;
}

Xyz color_of(const std::function<double(double)>& f) {
  Xyz sum;
  for (int i = 0; i < 4 * 470; ++i) {
    const double l = 360 + (i + 0.5) / 4;
    const Xyz c = observer(float(l));
    sum += (f(l) / 4) * c;
  }
  return (1 / observer_y_integral()) * sum;
}

void expect_color(const std::string& what, const Statistics& s, const Xyz& expected) {
  EXPECT_NEAR(s.mean.x, expected.x, 4.5 * s.error.x + 4e-4 * expected.y) << what << ", standard error " << s.error.x;
  EXPECT_NEAR(s.mean.y, expected.y, 4.5 * s.error.y + 4e-4 * expected.y) << what << ", standard error " << s.error.y;
  EXPECT_NEAR(s.mean.z, expected.z, 4.5 * s.error.z + 4e-4 * expected.y) << what << ", standard error " << s.error.z;
  EXPECT_LT(s.error.y, 0.02 * expected.y) << what;
}

/// Fresnel's reflectance of glass of index n for the sine s of the incident angle.
double fresnel(double n, double s) {
  const double c = std::sqrt(1 - s * s), i = std::sqrt(1 - s * s / (n * n));
  const double rs = (c - n * i) / (c + n * i), rp = (n * c - i) / (n * c + i);
  return (rs * rs + rp * rp) / 2;
}

const char* const index_text = "spectrum([360, 830], [1.9, 1.4])";
double index_at(double l) { return 1.9 - 0.5 * (l - 360) / 470; }

const std::vector<std::string> divisions = {"split_depth: 0, split_wavelengths: 1", "split_depth: 1, split_wavelengths: 1",
                                            "split_depth: 4, split_wavelengths: 1", "split_depth: 0, split_wavelengths: 8",
                                            "split_depth: 1, split_wavelengths: 4", "split_depth: 3, split_wavelengths: 3"};

// A ray hits a block of glass with the sine s. In the glass, at the depth 1, lies a luminaire that ends at the line x:
// wavelengths that are refracted too little miss it. By Snell's law
//     L(l) = R F(l) + (1 - R) 1 / n^2 [s / sqrt(n^2 - s^2) < x],
// with R Fresnel's reflectance at l, F the sky's radiance and 1 that of the luminaire inside.
TEST(Splitting, EveryWavelengthIsRefractedForItself) {
  constexpr double s = 0.8, x = 0.585;
  const double cosine = std::sqrt(1 - s * s);
  const Xyz expected = color_of([&](double l) {
    const double n = index_at(l), R = fresnel(n, s);
    return 0.5 * R + (s / std::sqrt(n * n - s * s) < x ? (1 - R) / (n * n) : 0);
  });
  const std::string camera =
      fmt::format("OrthographicCamera {{ from: [{}, 0, {}], to: [0, 0, 0], up: [0, 1, 0], width: 1e-5 }}", -2 * s, 2 * cosine);
  const std::string objects = fmt::format(
      "Box {{ size: [20, 20, 4], transform: translate(0, 0, -2), shader: Dielectric {{ ior: {} }} }}\n"
      "Rectangle {{ corner: [-5, -5, -1], edge_u: [{}, 0, 0], edge_v: [0, 10, 0], emission: DiffuseEmission {{ radiance: 1 "
      "}} }}\n"
      "Rectangle {{ corner: [{}, -5, -1], edge_u: [5, 0, 0], edge_v: [0, 10, 0] }}\n"
      "Environment {{ emission: DiffuseEmission {{ radiance: 0.5 }} }}",
      index_text, 5 + x, x);
  double by_chance = 0;
  for (const std::string& members : divisions) {
    const Statistics seen = rendered(members, 64, camera, objects);
    expect_color(members, seen, expected);
    if (members == divisions.front()) by_chance = seen.noise;
    if (members.ends_with("split_wavelengths: 8")) EXPECT_LT(seen.noise, by_chance / 3);
  }
}

// A ball of dispersive, absorbing glass in the spherical room of absorbing_ball_test.cpp, whose wall has the radiance B. The
// ball returns the fraction T of light that arrives with the sine s: its radiance there is T B.
TEST(Splitting, AbsorbingGlassSeenAndLookedPast) {
  constexpr double b = 0.6, s = 0.5;
  const auto absorption = [](double l) { return 0.4 + 6 * (l - 360) / 470; };
  const auto T = [&](double l, double sine) {
    const double n = index_at(l), R = fresnel(n, sine);
    const double t = std::exp(-absorption(l) * 2 * b * std::sqrt(1 - sine * sine / (n * n)));
    return R + (1 - R) * (1 - R) * t / (1 - R * t);
  };
  const Xyz expected = color_of([&](double l) {
    constexpr int steps = 1000;
    double lost = 0;
    for (int i = 0; i < steps; ++i) lost += (1 - T(l, std::sqrt((i + 0.5) / steps))) / steps * b * b;
    return T(l, s) / (1 - 0.5 * (1 - lost));
  });
  const std::string objects = fmt::format(
      "Sphere {{ radius: 1, shader: Lambertian {{ color: 0.5 }}, emission: DiffuseEmission {{ radiance: 1, sides: back }} }}\n"
      "Sphere {{ radius: {}, shader: Dielectric {{ ior: {} }}, interior: HomogeneousVolume {{ absorption: spectrum([360, 830], "
      "[0.4, 6.4]) }} }}",
      b, index_text);
  const std::string camera =
      fmt::format("OrthographicCamera {{ from: [{0}, 0, 0.75], to: [{0}, 0, 0], up: [0, 1, 0], width: 1e-4 }}", b * s);
  for (const std::string& members : divisions)
    expect_color(members, rendered("max_depth: 1000, " + members, 32, camera, objects), expected);
}

}  // namespace
}  // namespace etendue::test
