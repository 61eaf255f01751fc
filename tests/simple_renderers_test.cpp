// Renderers that follow rays from the camera: Whitted, distribution, direct light, ambient occlusion, features.
// Statistical tests use fixed seeds and hold at 4.5 standard errors (two-sided 7e-6 each), unless they say otherwise.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "component_test_support.h"
#include "etendue/color.h"
#include "render_support.h"

namespace etendue::test {
namespace {

void expect_value(const Measured& m, double expected, double tolerance = 0.01) {
  EXPECT_EQ(m.bad, 0u);
  EXPECT_NEAR(m.mean.y, expected, tolerance * expected) << "standard error " << m.error;
  // The error bound assumes independent samples and is generous for low-discrepancy ones.
  EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + 2e-4 * expected);
}

/// A job that is ready to compute single samples.
class Ready {
 public:
  explicit Ready(const std::string& text) : job_(load_job_text(text, "test.etd")) {
    prepare_tree(*job_);
    job_->renderer->begin(context());
  }
  RenderContext context() const { return {*job_->scene, *job_->camera, *job_->image, *job_->wavelengths, job_->seed}; }
  Renderer::CameraSample sample(int x, int y, std::uint32_t n, std::span<Spectrum> lengths = {}) {
    Renderer::Request request;
    request.lengths = lengths;
    return job_->renderer->camera_sample(context(), x, y, n, arena_, request);
  }
  /// The components of linear sRGB of a sample.
  Vector3 rgb(int x, int y, std::uint32_t n = 0) {
    const auto s = sample(x, y, n);
    const Xyz c = to_xyz(s.value, s.wavelengths);
    const auto& m = rgb_space("srgb").from_xyz;
    return {float(m[0] * c.x + m[1] * c.y + m[2] * c.z), float(m[3] * c.x + m[4] * c.y + m[5] * c.z),
            float(m[6] * c.x + m[7] * c.y + m[8] * c.z)};
  }
  const Job& job() const { return *job_; }

 private:
  Ref<Job> job_;
  Arena arena_;
};

void expect_flat(const Spectrum& s, float expected, float tolerance = 1e-5f) {
  for (int i = 0; i < spectrum_size; ++i)
    EXPECT_NEAR(s[i], expected, tolerance * std::max(expected, 1e-3f)) << "wavelength " << i;
}

const std::string lit = "DiffuseEmission { radiance: 1, sides: both }";
const std::string matt = "shader: Lambertian { color: 1 }";

std::string pinhole(const std::string& from, const std::string& to) {
  return "PerspectiveCamera { from: " + from + ", to: " + to + ", up: [0, 1, 0], fov: 0.01 deg }";
}

struct Setup {
  const char* name;
  std::string camera, objects;
  double expected;
};

/// Rows of the table of closed forms: form factors of receivers of reflectance 1, and irradiance over pi.
std::vector<Setup> direct_light_setups() {
  const std::string from_above = "OrthographicCamera { from: [0.5,0.5,0.5], to: [0.5,0.5,0], up: [0,1,0], width: 1 }";
  const std::string square = "Rectangle { corner: [0,0,0], edge_u: [1,0,0], edge_v: [0,1,0], " + matt + " }\n";
  return {
      {"parallel squares", from_above,
       square + "Rectangle { corner: [0,0,1], edge_u: [1,0,0], edge_v: [0,1,0], emission: " + lit + " }", 0.199825},
      {"squares at right angles", from_above,
       square + "Rectangle { corner: [0,0,0], edge_u: [0,1,0], edge_v: [0,0,1], emission: " + lit + " }", 0.200044},
      {"discs", "OrthographicCamera { from: [0,0,0.5], to: [0,0,0], up: [0,1,0], width: 2 }",
       "Disc { radius: 1, " + matt + " }\nDisc { radius: 1, transform: translate(0, 0, 1), emission: " + lit + " }",
       0.381966 * double(pi) / 4},
      {"rectangle", pinhole("[0,0,0.5]", "[0,0,0]"),
       "Rectangle { corner: [-9,-9,0], edge_u: [18,0,0], edge_v: [0,18,0], " + matt +
           " }\nRectangle { corner: [-1,-1,1], edge_u: [2,0,0], edge_v: [0,2,0], emission: " + lit + " }",
       1.740840 / double(pi)},
      {"sphere", pinhole("[0,0.2,0.5]", "[0,0,0]"),
       "Disc { radius: 1, " + matt + " }\nSphere { center: [0,0,3], radius: 1, emission: " + lit + " }", 0.349066 / double(pi)},
      {"half a sphere", pinhole("[0,0.2,0.5]", "[0,0,0]"),
       "Disc { radius: 0.1, " + matt + " }\nSphere { center: [3,0,0], radius: 1, emission: " + lit + " }",
       0.025567 / double(pi)},
  };
}

void expect_direct_light(const std::string& renderer, int samples) {
  for (const Setup& setup : direct_light_setups()) {
    SCOPED_TRACE(std::string(setup.name) + ", " + renderer);
    const std::string with_samples = renderer.substr(0, renderer.size() - 1) + ", samples: " + std::to_string(samples) + " }";
    // The smallest lamp is met by one direction in 120 of the shader's: its error is larger.
    expect_value(measure(job_text(with_samples, setup.camera, 16, setup.objects)), setup.expected,
                 setup.expected < 0.01 ? 0.1 : 0.01);
  }
}

TEST(DirectRenderer, ClosedFormsByPointsOnLuminaires) {
  expect_direct_light("DirectRenderer { strategy: light, light_samples: 2 }", 256);
}
TEST(DirectRenderer, ClosedFormsByDirectionsOfTheShader) {
  expect_direct_light("DirectRenderer { strategy: shader, shader_samples: 2 }", 512);
}
TEST(DirectRenderer, ClosedFormsByBoth) {
  for (const char* heuristic : {"balance", "power"})
    expect_direct_light(
        fmt::format("DirectRenderer {{ strategy: both, heuristic: {}, light_samples: 2, shader_samples: 3 }}", heuristic), 128);
}
TEST(DistributionRenderer, ClosedForms) {
  expect_direct_light("DistributionRenderer { max_depth: 2, light_samples: 3, diffuse_samples: 2 }", 128);
  expect_direct_light("DistributionRenderer { max_depth: 2, light_samples: 2, split_depth: 0 }", 256);
  expect_direct_light("DistributionRenderer { max_depth: 2, light_samples: 2, diffuse_samples: 0 }", 128);
}

const std::string furnace_camera = "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }";
std::string furnace() { return "Sphere { radius: 1, shader: Lambertian { color: 0.8 }, emission: " + lit + " }"; }

TEST(DistributionRenderer, FurnaceOfLimitedDepth) {  // 5 (1 - 0.8^9)
  expect_value(measure(job_text("DistributionRenderer { max_depth: 9, diffuse_samples: 3, light_samples: 2, samples: 32 }",
                                furnace_camera, 32, furnace())),
               4.32891);
  // Splitting at several surfaces.
  expect_value(measure(job_text("DistributionRenderer { max_depth: 4, split_depth: 3, diffuse_samples: 2, samples: 32 }",
                                furnace_camera, 32, furnace())),
               5 * (1 - std::pow(0.8, 4)));
}

TEST(DistributionRenderer, WithoutDiffuseRaysIsDirectLight) {  // 1 + 0.8
  expect_value(measure(job_text("DistributionRenderer { max_depth: 9, diffuse_samples: 0, samples: 32 }", furnace_camera, 32,
                                furnace())),
               1.8, 0.002);
  expect_value(measure(job_text("DirectRenderer { samples: 32 }", furnace_camera, 32, furnace())), 1.8, 0.002);
}

/// A room with matt, glossy, mirroring and dispersing things, two lamps of different size and a window.
std::string room() {
  return R"(
    Rectangle { corner: [-2,-1,-2], edge_u: [0,0,4], edge_v: [4,0,0], shader: PhongShader { color: 0.4, specular: 0.5, exponent: 40 } }
    Rectangle { corner: [-2,-1,-2], edge_u: [4,0,0], edge_v: [0,3,0], shader: Lambertian { color: rgb(0.2, 0.5, 0.8) } }
    Rectangle { corner: [-2,-1,-2], edge_u: [0,3,0], edge_v: [0,0,4], shader: PhongShader { color: 0.3, specular: 0.3, exponent: 5 } }
    Rectangle { corner: [2,-1,-2], edge_u: [0,3,0], edge_v: [0,0,4], shader: PerfectSpecular { color: 0.9 } }
    Sphere { center: [-0.7,-0.4,-0.5], radius: 0.6, shader: Dielectric { ior: glass("N-SF11") } }
    Sphere { center: [0.8,-0.5,-0.6], radius: 0.5, shader: PhongShader { color: 0.1, specular: 0.8, exponent: 200 } }
    Rectangle { corner: [-0.5,1.9,-0.5], edge_u: [1,0,0], edge_v: [0,0,1], emission: DiffuseEmission { radiance: 4 } }
    Sphere { center: [1.2,0.8,-1], radius: 0.4, emission: DiffuseEmission { radiance: 4 } }
    Environment { emission: DiffuseEmission { radiance: 0.3, sides: both } })";
}
const std::string room_camera = "PerspectiveCamera { from: [0,0.3,4], to: [0,-0.2,0], up: [0,1,0], fov: 45 deg }";

/// Chi-square over pixels of the difference of two pictures' Y, each pixel with its own standard errors; the p-value.
/// Sample means of few samples have long tails, so there must be many samples.
double agreement(const std::string& a, const std::string& b, const std::string& camera, int size, const std::string& objects) {
  double statistic = 0;
  const auto render = [&](const std::string& renderer) {
    const Ref<Job> job = load_job_text(job_text(renderer, camera, size, objects), "test.etd");
    job->image->layers = {"variance"};
    job->render();
    EXPECT_EQ(job->image->bad_samples(), 0u);
    return job->picture();
  };
  const Image first = render(a), second = render(b);
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

TEST(DistributionRenderer, AgreesWithThePathTracer) {
  const std::string path_tracer = "PathTracer { max_depth: 5, samples: 2000, sampler: IndependentSampler {} }";
  for (const char* members : {"light_samples: 3, diffuse_samples: 2, glossy_samples: 3",
                              "split_depth: 2, light_samples: 1, diffuse_samples: 3, glossy_samples: 2, "
                              "specular_samples: 2",
                              "split_depth: 0, roulette_depth: 2"}) {
    const std::string renderer =
        fmt::format("DistributionRenderer {{ max_depth: 5, samples: {}, sampler: IndependentSampler {{}}, {} }}",
                    std::string(members).starts_with("split_depth: 2") ? 400 : 600, members);
    EXPECT_GT(agreement(renderer, path_tracer, room_camera, 8, room()), 1e-4) << members;
  }
}

TEST(DirectRenderer, AgreesWithThePathTracer) {
  const std::string path_tracer = "PathTracer { max_depth: 2, samples: 2000, sampler: IndependentSampler {} }";
  for (const char* members : {"strategy: both, light_samples: 2, shader_samples: 2", "strategy: shader, shader_samples: 8"})
    EXPECT_GT(agreement(fmt::format("DirectRenderer {{ samples: 1000, sampler: IndependentSampler {{}}, {} }}", members),
                        path_tracer, room_camera, 8, room()),
              1e-4)
        << members;
}

// Half of the picture shows a glossy floor under a wide lamp, where luminaire points hardly ever fall into the lobe, the other
// a matt one under a small lamp, which the shader's directions hardly ever meet.
TEST(DirectRenderer, BothStrategiesTogetherVaryLessThanEach) {
  const std::string objects = R"(
    Rectangle { corner: [-2,-1,0], edge_u: [2,0,0], edge_v: [0,2,0], shader: PhongShader { color: 0, specular: 0.5, exponent: 2000 } }
    Rectangle { corner: [0,-1,0], edge_u: [2,0,0], edge_v: [0,2,0], shader: Lambertian { color: 0.5 } }
    Rectangle { corner: [-4,-4,2], edge_u: [0,8,0], edge_v: [3.99,0,0], emission: DiffuseEmission { radiance: 1 } }
    Sphere { center: [1,0,1.6], radius: 0.05, emission: DiffuseEmission { radiance: 1000 } })";
  const std::string camera = "OrthographicCamera { from: [0,0,1.5], to: [0,0,0], up: [0,1,0], width: 2 }";
  const auto error = [&](const std::string& strategy, int light, int shader) {
    return measure(job_text(fmt::format("DirectRenderer {{ strategy: {}, light_samples: {}, shader_samples: {}, samples: 64, "
                                        "sampler: IndependentSampler {{}} }}",
                                        strategy, light, shader),
                            camera, 16, objects))
        .error;
  };
  // The same number of rays for each.
  const double both = error("both", 1, 1), light = error("light", 2, 1), shader = error("shader", 1, 2);
  EXPECT_LT(both, 0.6 * light);
  EXPECT_LT(both, 0.6 * shader);
}

TEST(DirectRenderer, StrategiesFindWhatTheyCan) {
  const std::string floor = "Rectangle { corner: [-9,-9,0], edge_u: [18,0,0], edge_v: [0,18,0], shader: ";
  const std::string point = " }\nPoint { position: [0,0,2], emission: DiffuseEmission { radiance: 3 } }";
  const std::string camera = pinhole("[0,0,1]", "[0,0,0]");
  const auto value = [&](const char* strategy, const std::string& objects) {
    return Ready(job_text(fmt::format("DirectRenderer {{ strategy: {} }}", strategy), camera, 1, objects))
        .sample(0, 0, 0)
        .value;
  };
  // I / d^2 rho / pi = 3 / 4 / pi
  const std::string lit_floor = floor + "Lambertian { color: 1 }" + point;
  expect_flat(value("light", lit_floor), 0.75f * inverse_pi);
  expect_flat(value("both", lit_floor), 0.75f * inverse_pi);
  expect_flat(value("shader", lit_floor), 0);
  // A lamp in a mirror.
  const std::string mirror = floor +
                             "PerfectSpecular { color: 0.7 } }\nRectangle { corner: [-9,-9,3], edge_u: [18,0,0], "
                             "edge_v: [0,18,0], emission: DiffuseEmission { radiance: 2, sides: both } }";
  expect_flat(value("light", mirror), 0);
  expect_flat(value("both", mirror), 1.4f);
  expect_flat(value("shader", mirror), 1.4f);
}

// ---- Whitted ------------------------------------------------------------------------------------------------------

std::string whitted(int depth, int samples = 1) {
  return fmt::format("WhittedRenderer {{ max_depth: {}, samples: {} }}", depth, samples);
}
std::string distant(double x, double y, double z, double irradiance = 1) {
  return fmt::format("Distant {{ direction: [{}, {}, {}], emission: DiffuseEmission {{ radiance: {}, sides: both }} }}", x, y,
                     z, irradiance);
}
std::string floor_of(const std::string& shader) {
  return "Rectangle { corner: [-9,-9,0], edge_u: [18,0,0], edge_v: [0,18,0], shader: " + shader + " }\n";
}

TEST(WhittedRenderer, PlaneUnderLightsWithoutExtent) {
  const std::string camera = pinhole("[0,0,1]", "[0,0,0]");
  const auto value = [&](const std::string& objects) {
    return Ready(job_text(whitted(2), camera, 1, floor_of("Lambertian { color: 0.5 }") + objects)).sample(0, 0, 0).value;
  };
  expect_flat(value(distant(0, 0, -1)), 0.159155f);
  expect_flat(value(distant(1, 0, -1)), 0.159155f * std::sqrt(0.5f));
  // Of both and of a point, each in full: nothing is chosen. E = I cos / d^2 = 6 (1/2^0.5) / 8.
  const std::string all =
      distant(0, 0, -1) + "\n" + distant(1, 0, -1) + "\nPoint { position: [2,0,2], emission: DiffuseEmission { radiance: 6 } }";
  const float root = std::sqrt(0.5f);
  expect_flat(value(all), 0.159155f * (1 + root + 6 * root / 8));
  // In the shadow of something, and of an area light, nothing.
  expect_flat(value(distant(1, 0, -1) + "\nSphere { center: [-1,0,1], radius: 0.1 }"), 0);
  expect_flat(value("Sphere { center: [0,3,3], radius: 1, emission: " + lit + " }"), 0);
}

TEST(WhittedRenderer, LambertSphereFromAfar) {  // the mean over its disc is (2/3) [sin a + (pi - a) cos a] / pi^2
  for (const double degrees : {0.0, 45.0, 90.0, 135.0}) {
    const double a = degrees * double(pi) / 180;
    const Measured m =
        measure(job_text(whitted(2, 64), "OrthographicCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], width: 2 }", 64,
                         "Sphere { radius: 1, " + matt + " }\n" + distant(std::sin(a), 0, -std::cos(a))));
    const double mean = 2.0 / 3 * (std::sin(a) + (double(pi) - a) * std::cos(a)) / double(pi * pi);
    EXPECT_EQ(m.bad, 0u);
    EXPECT_NEAR(m.mean.y, mean * double(pi) / 4, 0.003 * mean) << degrees;
  }
}

const std::string slab = R"(
  TriangleMesh { positions: [[-9,-9,0],[9,-9,0],[9,9,0],[-9,9,0],[-9,-9,1],[9,-9,1],[9,9,1],[-9,9,1]]
    triangles: [[0,2,1],[0,3,2],[4,5,6],[4,6,7],[0,1,5],[0,5,4],[1,2,6],[1,6,5],[2,3,7],[2,7,6],[3,0,4],[3,4,7]]
    shader: Dielectric { ior: 1.5 } }
)";

// At normal incidence R = 0.04. A lamp of radiance 1 below, one of radiance 10 above: what comes with n segments is
// (1-R)^2 R^(n-3) of the lower one for n = 3, 5, …, and of the upper one R for n = 2 and (1-R)^2 R^(n-3) for n = 4, 6, ….
TEST(WhittedRenderer, TreeOfAGlassSlab) {
  const std::string objects = slab + "Rectangle { corner: [-9,-9,-3], edge_u: [18,0,0], edge_v: [0,18,0], emission: " + lit +
                              " }\nRectangle { corner: [-9,-9,5], edge_u: [18,0,0], edge_v: [0,18,0], emission: "
                              "DiffuseEmission { radiance: 10, sides: both } }";
  Ready ready(job_text(whitted(7), pinhole("[0,0,3]", "[0,0,0]"), 1, objects));
  std::array<Spectrum, 10> lengths{};
  const auto s = ready.sample(0, 0, 0, lengths);
  const double r = 0.04, t = (1 - r) * (1 - r);
  const double expected[10] = {0, 10 * r, t, 10 * t * r, t * r * r, 10 * t * r * r * r, t * r * r * r * r, 0, 0, 0};
  double sum = 0;
  for (size_t n = 0; n < lengths.size(); ++n) {
    expect_flat(lengths[n], float(expected[n]), 2e-4f);
    sum += expected[n];
  }
  expect_flat(s.value, float(sum));
}

// Refraction that differs between wavelengths is followed for the hero alone, which then counts for all; the reflected
// branch of the same surface keeps all wavelengths.
TEST(SimpleRenderers, DispersionDropsSecondaryWavelengthsInItsBranchAlone) {
  const std::string lamps = "Rectangle { corner: [-9,-9,-3], edge_u: [18,0,0], edge_v: [0,18,0], emission: " + lit +
                            " }\nRectangle { corner: [-9,-9,5], edge_u: [18,0,0], edge_v: [0,18,0], emission: " + lit + " }";
  const Color glass = glass_index("N-SF11");
  const auto reflectance = [&](float wavelength) {
    const float n = glass->at(wavelength, ColorUse::coefficient);
    return square((n - 1) / (n + 1));
  };
  std::string prism = slab;
  prism.replace(prism.find("1.5"), 3, "glass(\"N-SF11\")");
  for (const char* renderer : {"WhittedRenderer { max_depth: 3 }", "DistributionRenderer { max_depth: 3, split_depth: 3 }",
                               "DistributionRenderer { max_depth: 3, split_depth: 3, specular_samples: 3 }"}) {
    SCOPED_TRACE(renderer);
    Ready ready(job_text(renderer, pinhole("[0,0,3]", "[0,0,0]"), 1, prism + lamps));
    std::array<Spectrum, 3> lengths{};
    const Wavelengths w = ready.sample(0, 0, 0, lengths).wavelengths;
    for (int i = 0; i < spectrum_size; ++i) {
      EXPECT_NEAR(lengths[1][i], reflectance(w[i]), 1e-5f);
      EXPECT_NEAR(lengths[2][i], i == 0 ? float(spectrum_size) * square(1 - reflectance(w[0])) : 0, 1e-4f);
    }
  }
  // A single boundary: radiance above is that below over the squared index.
  Ready ready(job_text("DirectRenderer { shader_samples: 4096 }", pinhole("[0,0,3]", "[0,0,0]"), 1,
                       floor_of("Dielectric { ior: glass(\"N-SF11\") }") +
                           "Rectangle { corner: [-9,-9,-3], edge_u: [18,0,0], edge_v: [0,18,0], emission: " + lit + " }"));
  const auto s = ready.sample(0, 0, 0);
  const float n = glass->at(s.wavelengths[0], ColorUse::coefficient);
  // Refraction is chosen in strata of a fixed choice, so the share of directions is exact to one of them.
  EXPECT_NEAR(s.value[0], float(spectrum_size) * (1 - reflectance(s.wavelengths[0])) / square(n), 2e-3f);
  for (int i = 1; i < spectrum_size; ++i) EXPECT_EQ(s.value[i], 0);
}

TEST(WhittedRenderer, MirrorsShowLitSurfaces) {
  // Up to a mirror, down to the floor: 0.7 * 0.8 / pi * E.
  const std::string objects = floor_of("Lambertian { color: 0.8 }") +
                              "Rectangle { corner: [-1,-1,2], edge_u: [2,0,0], edge_v: [0,2,0], shader: PerfectSpecular { "
                              "color: 0.7 } }\n" +
                              distant(0, 1, -1, 5);
  // The camera looks up at 45 degrees; the ray comes down to (2, 0, 0), where the mirror casts no shadow.
  Ready ready(job_text(whitted(3), pinhole("[-1,0,1]", "[0,0,2]"), 1, objects));
  std::array<Spectrum, 4> lengths{};
  expect_flat(ready.sample(0, 0, 0, lengths).value, 0.7f * 0.8f * inverse_pi * 5 * std::sqrt(0.5f), 1e-4f);
  expect_flat(lengths[1], 0);
  expect_flat(Ready(job_text(whitted(2), pinhole("[-1,0,1]", "[0,0,2]"), 1, objects)).sample(0, 0, 0).value, 0);
}

// Where there are only mirrors and glass it finds what a path tracer does, dispersion included; branches that are not
// refracted keep their wavelengths.
TEST(WhittedRenderer, AgreesWithThePathTracerAmongMirrorsAndGlass) {
  const std::string objects = R"(
    Sphere { center: [0,0,0], radius: 1, shader: Dielectric { ior: glass("N-SF11") } }
    Sphere { center: [0.2,0.1,0.1], radius: 0.4, priority: 1, shader: Dielectric { ior: glass("N-BK7") } }
    Sphere { center: [1.5,0,-1], radius: 0.7, shader: PerfectSpecular { color: rgb(0.9, 0.6, 0.3) } }
    Rectangle { corner: [-3,-3,-3], edge_u: [6,0,0], edge_v: [0,6,0], emission: DiffuseEmission { radiance: rgb(1, 0.2, 2) } }
    Environment { emission: DiffuseEmission { radiance: 0.5, sides: both } })";
  const std::string camera = "PerspectiveCamera { from: [0,0,4], to: [0,0,0], up: [0,1,0], fov: 40 deg }";
  EXPECT_GT(agreement("WhittedRenderer { max_depth: 6, samples: 1000, sampler: IndependentSampler {} }",
                      "PathTracer { max_depth: 6, samples: 4000, sampler: IndependentSampler {} }", camera, 8, objects),
            1e-4);
}

// ---- surfaces that light passes straight on ----------------------------------------------------------------------------

TEST(SimpleRenderers, AreNotDisturbedBySurfacesThatAreNotThere) {
  const std::string sheets = R"(
    Rectangle { corner: [-20,-20,0.4], edge_u: [40,0,0], edge_v: [0,40,0], shader: PassThrough {} }
    Sphere { center: [0,0,0.3], radius: 4, shader: PassThrough {} }
    )";
  const std::string area = "Rectangle { corner: [-1,-1,1], edge_u: [2,0,0], edge_v: [0,2,0], emission: " + lit + " }";
  const std::string point = "Point { position: [0,0,2], emission: DiffuseEmission { radiance: 4 } }";
  const std::string camera = pinhole("[0,0,0.9]", "[0,0,0]"), objects = floor_of("Lambertian { color: 1 }") + sheets;
  for (const char* renderer :
       {"DirectRenderer { strategy: light, samples: 512 }", "DirectRenderer { strategy: shader, samples: 4096 }",
        "DirectRenderer { samples: 1024 }", "DistributionRenderer { max_depth: 2, samples: 256 }",
        "DistributionRenderer { max_depth: 2, split_depth: 0, samples: 1024 }"}) {
    SCOPED_TRACE(renderer);
    expect_value(measure(job_text(renderer, camera, 8, objects + area)), 1.740840 / double(pi));
  }
  for (const char* renderer :
       {"DirectRenderer {}", "WhittedRenderer { max_depth: 2 }", "DistributionRenderer { max_depth: 2 }"}) {
    SCOPED_TRACE(renderer);
    expect_flat(Ready(job_text(renderer, camera, 1, objects + point)).sample(0, 0, 0).value, inverse_pi);
  }
  expect_flat(Ready(job_text("WhittedRenderer { max_depth: 1 }", pinhole("[0,0,0.9]", "[0,0,2]"), 1, objects + area))
                  .sample(0, 0, 0)
                  .value,
              1);
}

// ---- ambient occlusion ----------------------------------------------------------------------------------------------

TEST(AmbientOcclusionRenderer, InsideASphere) {
  // A direction at angle t from the normal meets the sphere again after 2 R cos(t): with rays of length d the open
  // fraction is 1 - (d / 2R)^2.
  for (const double d : {0.0, 0.5, 1.0, 1.9}) {
    const Measured m = measure(job_text(fmt::format("AmbientOcclusionRenderer {{ distance: {}, rays: 8, samples: 32 }}", d),
                                        furnace_camera, 16, "Sphere { radius: 1, " + matt + " }"));
    const double expected = d > 0 ? 1 - d * d / 4 : 0;
    EXPECT_EQ(m.bad, 0u);
    EXPECT_NEAR(m.mean.y, expected, 4.5 * m.error + 1e-6) << d;
    EXPECT_LE(m.error, 0.005);
  }
}

TEST(AmbientOcclusionRenderer, BesideAWall) {
  // A wall of height h at distance a, endlessly wide, takes (1 - 1 / sqrt(1 + h^2 / a^2)) / 2 of the hemisphere.
  const std::string wall = "Rectangle { corner: [1,-5000,0], edge_u: [0,10000,0], edge_v: [0,0,1] }";
  for (const char* from : {"[0,0,0.5]", "[0.01,0,3]"}) {
    const Measured m = measure(job_text("AmbientOcclusionRenderer { rays: 16, samples: 256 }", pinhole(from, "[0,0,0]"), 8,
                                        floor_of("Lambertian {}") + wall));
    EXPECT_NEAR(m.mean.y, 1 - (1 - std::sqrt(0.5)) / 2, 4.5 * m.error + 1e-5);
    EXPECT_LE(m.error, 0.001);
  }
}

TEST(AmbientOcclusionRenderer, IsWhiteInEverySampleWhereAllIsOpen) {
  for (const char* objects : {"Disc { radius: 0.1 }", "Disc { radius: 9 }"}) {
    Ready ready(job_text("AmbientOcclusionRenderer { samples: 4 }",
                         "PerspectiveCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], fov: 40 }", 2, objects));
    for (std::uint32_t n = 0; n < 4; ++n) {
      const Vector3 c = ready.rgb(1, 0, n);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(c[i], 1, 2e-6f);
    }
  }
}

// ---- features -------------------------------------------------------------------------------------------------------

void expect_color(const Vector3& c, float r, float g, float b, const std::string& what) {
  EXPECT_NEAR(c.x, r, 2e-5f * std::max(1.0f, r)) << what;
  EXPECT_NEAR(c.y, g, 2e-5f * std::max(1.0f, g)) << what;
  EXPECT_NEAR(c.z, b, 2e-5f * std::max(1.0f, b)) << what;
}

TEST(FeatureRenderer, ShowsExactValues) {
  // Parallel rays along -z; a plane that rises along x by 45 degrees, and one below it.
  const std::string objects = R"(
    Rectangle { corner: [-1,-1,-1], edge_u: [2,0,2], edge_v: [0,2,0] }
    Rectangle { corner: [-1,-1,-3], edge_u: [2,0,0], edge_v: [0,2,0], shader: Lambertian { color: 0.25 } })";
  const auto color = [&](const char* feature, float x, float y, bool from_below = false) {
    const std::string camera = fmt::format("OrthographicCamera {{ from: [{},{},{}], to: [{},{},0], up: [0,1,0], width: 1e-5 }}",
                                           x, y, from_below ? -5 : 4, x, y);
    return Ready(job_text(fmt::format("FeatureRenderer {{ feature: {} }}", feature), camera, 1, objects)).rgb(0, 0);
  };
  const float half = std::sqrt(0.5f);
  for (const char* normal : {"normal", "shading_normal"})
    expect_color(color(normal, 0, 0), 0.5f - 0.5f * half, 0.5f, 0.5f + 0.5f * half, normal);
  expect_color(color("depth", 0.5f, 0), 3.5f, 3.5f, 3.5f, "depth");
  expect_color(color("uv", 0.5f, -0.5f), 0.75f, 0.25f, 0, "uv");
  expect_color(color("facing", 0, 0), half, half, half, "facing");
  expect_color(color("facing", 0, 0, true), 1, 0, 0, "the back of the lower plane");
  expect_color(color("hit_count", 0, 0), 2, 2, 2, "hit_count");
  // The scene's centre is (0, 0, -1), its radius sqrt(3 + ...) half the diagonal of a box of 2 x 2 x 4.
  const float radius = std::sqrt(6.0f);
  expect_color(color("position", 0.5f, -0.5f), 0.5f + 0.25f / radius, 0.5f - 0.25f / radius, 0.5f + 0.75f / radius, "position");
  for (const char* feature : {"normal", "depth", "albedo", "uv", "object", "primitive", "position", "hit_count", "facing"})
    expect_color(color(feature, 5, 5), 0, 0, 0, std::string("nothing met: ") + feature);
}

TEST(FeatureRenderer, TellsObjectsAndPrimitivesApart) {
  const std::string objects = R"(
    Sphere { center: [-1,1,0], radius: 0.4 }
    Rectangle { corner: [0.5,0.5,0], edge_u: [1,0,0], edge_v: [0,1,0] }
    BruteForceScene { objects: [ Sphere { center: [-1,-1,0], radius: 0.4 }, Sphere { center: [1,-1,0], radius: 0.4 } ] })";
  const std::string camera = "OrthographicCamera { from: [0,0,5], to: [0,0,0], up: [0,1,0], width: 4 }";
  Ready object(job_text("FeatureRenderer { feature: object }", camera, 2, objects));
  // Pixels show the objects' middles when the sample falls there: compare some samples that met something.
  std::vector<Vector3> colors;
  for (int pixel = 0; pixel < 4; ++pixel)
    for (std::uint32_t n = 0; n < 64; ++n) {
      const Vector3 c = object.rgb(pixel % 2, pixel / 2, n);
      if (c.x < 0.05f) continue;
      EXPECT_GE(std::min({c.x, c.y, c.z}), 0.0999f);
      EXPECT_LE(std::max({c.x, c.y, c.z}), 1.0001f);
      const auto same = [&](const Vector3& other) { return length(c - other) < 1e-4f; };
      if (std::ranges::none_of(colors, same)) colors.push_back(c);
    }
  EXPECT_EQ(colors.size(), 4u);

  Ready primitive(job_text("FeatureRenderer { feature: primitive }",
                           "OrthographicCamera { from: [1,1,5], to: [1,1,0], up: [0,1,0], width: 0.9 }", 1, objects));
  colors.clear();
  for (std::uint32_t n = 0; n < 64; ++n) {
    const Vector3 c = primitive.rgb(0, 0, n);
    if (std::ranges::none_of(colors, [&](const Vector3& other) { return length(c - other) < 1e-4f; })) colors.push_back(c);
  }
  EXPECT_EQ(colors.size(), 2u);  // the two triangles of the rectangle
}

TEST(FeatureRenderer, AlbedoIsTheColourUnderWhiteLight) {
  const Ref<Job> job =
      load_job_text(job_text("FeatureRenderer { feature: albedo, samples: 1024 }", pinhole("[0,0,1]", "[0,0,0]"), 8,
                             floor_of("Lambertian { color: rgb(0.2, 0.5, 0.7) }")),
                    "test.etd");
  const Measured m = measure(job);
  const auto& f = rgb_space("srgb").from_xyz;
  const double wanted[3] = {0.2, 0.5, 0.7};
  for (size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(f[3 * i] * m.mean.x + f[3 * i + 1] * m.mean.y + f[3 * i + 2] * m.mean.z, wanted[i], 0.01);
}

// ---- all --------------------------------------------------------------------------------------------------------------

TEST(SimpleRenderers, LengthsAddUpToTheSample) {
  for (const char* renderer :
       {"WhittedRenderer { max_depth: 6 }", "DistributionRenderer { max_depth: 6 }", "DirectRenderer {}",
        "AmbientOcclusionRenderer {}", "FeatureRenderer { feature: depth }", "FeatureRenderer { feature: albedo }"}) {
    Ready ready(job_text(renderer, room_camera, 8, room()));
    double light = 0;
    for (int i = 0; i < 64; ++i) {
      std::array<Spectrum, 8> lengths{};
      const Spectrum value = ready.sample(i % 8, i / 8, 0, lengths).value;
      Spectrum sum;
      for (const Spectrum& part : lengths) sum += part;
      for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(sum[k], value[k], 1e-5f * (1 + std::abs(value[k]))) << renderer;
      light += double(value.average());
    }
    EXPECT_GT(light, 0) << renderer;
  }
}

TEST(SimpleRenderers, NoteFeaturesLikeThePathTracer) {
  const auto features = [](const char* renderer) {
    const Ref<Job> job = load_job_text(job_text(renderer, room_camera, 8, room()), "test.etd");
    job->image->layers = {"albedo", "normal", "depth", "object"};
    job->render();
    return job->picture();
  };
  const Image expected = features("PathTracer { samples: 2 }");
  for (const char* renderer :
       {"WhittedRenderer { samples: 2 }", "DistributionRenderer { samples: 2 }", "DirectRenderer { samples: 2 }",
        "AmbientOcclusionRenderer { samples: 2 }", "FeatureRenderer { samples: 2 }"}) {
    const Image image = features(renderer);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x)
        for (size_t channel = 3; channel < image.channels.size(); ++channel)
          ASSERT_EQ(image.at(x, y, channel), expected.at(x, y, channel)) << renderer << ' ' << image.channels[channel];
  }
}

TEST(SimpleRenderers, SayWhatTheyMiss) {
  const auto lost = [](const char* name, const std::vector<Setting>& settings, const SceneTraits& traits) {
    std::string text;
    for (const Advice& advice : create<Renderer>(name, settings)->misses(traits)) text += advice.lost + "; ";
    return text;
  };
  SceneTraits matt_room;
  matt_room.smooth = {"'wall'"};
  matt_room.areas = {"'lamp'"};
  EXPECT_NE(lost("WhittedRenderer", {}, matt_room).find("light of 'lamp' on 'wall'"), std::string::npos);
  EXPECT_NE(lost("DirectRenderer", {}, matt_room), "");
  EXPECT_EQ(lost("DistributionRenderer", {}, matt_room), "");
  EXPECT_NE(lost("DistributionRenderer", {{"diffuse_samples", 0.0}}, matt_room), "");
  EXPECT_NE(lost("AmbientOcclusionRenderer", {}, matt_room), "");
  EXPECT_NE(lost("FeatureRenderer", {}, matt_room), "");

  SceneTraits mirrors;
  mirrors.specular = {"'mirror'"};
  mirrors.areas = {"'lamp'"};
  EXPECT_EQ(lost("WhittedRenderer", {}, mirrors), "");
  EXPECT_EQ(lost("DistributionRenderer", {}, mirrors), "");
  EXPECT_NE(lost("DirectRenderer", {{"strategy", "light"}}, mirrors).find("seen in 'mirror'"), std::string::npos);

  SceneTraits bulb = matt_room;
  bulb.areas.clear();
  bulb.points = {"'bulb'"};
  EXPECT_EQ(lost("DistributionRenderer", {}, bulb), "");
  EXPECT_NE(lost("DirectRenderer", {{"strategy", "shader"}}, bulb).find("light of 'bulb'"), std::string::npos);
  bulb.specular = {"'glass'"};
  EXPECT_NE(lost("DistributionRenderer", {}, bulb).find("caustics"), std::string::npos);

  SceneTraits fog = mirrors;
  fog.media = {"'cloud'"};
  for (const char* name : {"WhittedRenderer", "DistributionRenderer", "DirectRenderer"})
    EXPECT_NE(lost(name, {}, fog).find("'cloud'"), std::string::npos) << name;
}

}  // namespace
}  // namespace etendue::test
