// Fluorescence against closed forms, band by band, by every renderer that finds it.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <numeric>

#include "components/shaders/fluorescent/donaldson_matrix.h"
#include "etendue/dye.h"
#include "film/image_bands.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

constexpr double pi = 3.141592653589793;

/// Linear between its points, 0 outside.
struct Line {
  std::vector<double> at, values;
  double operator()(double x) const {
    for (size_t i = 0; i + 1 < at.size(); ++i)
      if (x >= at[i] && x <= at[i + 1]) return values[i] + (values[i + 1] - values[i]) * (x - at[i]) / (at[i + 1] - at[i]);
    return 0;
  }
  std::string text() const { return fmt::format("spectrum([{:g}], [{:g}])", fmt::join(at, ", "), fmt::join(values, ", ")); }
};

using Function = std::function<double(double)>;

double integral(const Function& f, double low = 360, double high = 830) {
  constexpr int steps = 470;
  double sum = 0;
  for (int i = 0; i < steps; ++i) sum += f(low + (high - low) * (i + 0.5) / steps);
  return sum * (high - low) / steps;
}

const Line absorbs{{400, 450, 500}, {0, 1, 0}}, emits{{480, 530, 600}, {0, 1, 0}}, lamp{{420, 430, 460, 470}, {0, 1, 1, 0}};
constexpr double quantum_yield = 0.8;

std::string dye() {
  return fmt::format("Dye {{ absorption: {}, emission: {}, quantum_yield: {} }}", absorbs.text(), emits.text(), quantum_yield);
}
/// y of etendue/dye.h, written down once more: photons, each of an energy in proportion to 1 / l.
double yield(double absorbed, double emitted) {
  static const double photons = integral([](double l) { return emits(l) * l; });
  const double photon_density = emits(emitted) * emitted / photons;
  return quantum_yield * photon_density * absorbed / emitted;
}

const std::vector<double> edges{400, 430, 460, 490, 520, 550, 600};

struct Bands {
  std::vector<double> mean, error;
};

/// The means of all bands over the picture, with standard errors from renders with different seeds.
Bands measured(const std::string& renderer, const std::string& camera, int size, const std::string& objects) {
  constexpr int renders = 16;
  const std::string text = fmt::format(
      "Job {{\n renderer: {}\n camera: {}\n wavelengths: HeroWavelengths {{ distribution: uniform }}\n"
      " image: SpectralFilm {{ width: {}, height: {}, filter: BoxFilter {{}}, edges: [{:g}] nm }}\n"
      " scene: EmbreeScene {{ objects: [\n{}\n] }} }}",
      renderer, camera, size, size, fmt::join(edges, ", "), objects);
  Render render(load_job_text(text, "test.etd"));
  std::vector<std::vector<double>> all(edges.size() - 1);
  for (int i = 0; i < renders; ++i) {
    test::render_again(render, std::uint64_t(i + 1));
    EXPECT_EQ(render.film().bad_samples(), 0u);
    const Image image = render.picture();
    const std::vector<ImageBand> bands = bands_of(image);
    for (size_t b = 0; b < bands.size(); ++b) {
      double sum = 0;
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) sum += image.at(x, y, bands[b].channel);
      all[b].push_back(sum / (double(image.width) * image.height));
    }
  }
  Bands result;
  for (const std::vector<double>& values : all) {
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / renders;
    double squares = 0;
    for (const double v : values) squares += (v - mean) * (v - mean);
    result.mean.push_back(mean);
    result.error.push_back(std::sqrt(squares / (renders * (renders - 1.0))));
  }
  return result;
}

/// Each band within five standard errors of the expected mean radiance (two-sided 2e-4 for each, Student's distribution with 15
/// degrees of freedom), and these errors small enough to tell.
void expect_bands(const Bands& found, const Function& radiance, double resolution) {
  double largest = 0;
  std::vector<double> expected;
  for (size_t b = 0; b + 1 < edges.size(); ++b) {
    expected.push_back(integral(radiance, edges[b], edges[b + 1]) / (edges[b + 1] - edges[b]));
    largest = std::max(largest, expected.back());
  }
  for (size_t b = 0; b < expected.size(); ++b) {
    EXPECT_NEAR(found.mean[b], expected[b], 5 * found.error[b] + 2e-4 * largest)
        << edges[b] << " nm, standard error " << found.error[b];
    EXPECT_LT(found.error[b], resolution * largest) << edges[b] << " nm";
  }
}

struct Way {
  std::string renderer;
  int samples;
  double resolution = 0.03;  ///< largest standard error of a band, relative to the brightest one
};
void PrintTo(const Way& w, std::ostream* out) { *out << w.renderer; }
std::string of(const Way& w, const std::string& depth) {
  std::string text = w.renderer;
  const bool plain = text.ends_with("{}");
  text.insert(text.find('{') + 1, fmt::format(" samples: {}, {}{}", w.samples, depth, plain ? " " : ","));
  return text;
}

class OnSurfaces : public testing::TestWithParam<Way> {};

const std::string above = "OrthographicCamera { from: [0.5, 0.5, 5], to: [0.5, 0.5, 0], up: [0, 1, 0], width: 1 }";
std::string plate(const std::string& shader) {
  return "Rectangle { corner: [0, 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0], shader: " + shader + " }\n";
}
std::string furnace(const Line& light) {
  return "Environment { emission: DiffuseEmission { radiance: " + light.text() + " } }";
}

// A plate under light that comes with the same radiance from everywhere: what lands in each band.
TEST_P(OnSurfaces, APlateInAFurnaceOfOneColour) {
  constexpr double rho = 0.5, c = 1.5;
  const auto fraction = [](double l) { return 1 - std::exp(-c * absorbs(l)); };
  const Bands found = measured(
      of(GetParam(), "max_depth: 3"), above, 8,
      plate(fmt::format("FluorescentShader {{ color: {}, concentration: {}, dye: {} }}", rho, c, dye())) + furnace(lamp));
  expect_bands(
      found,
      [&](double l) {
        return rho * (1 - fraction(l)) * lamp(l) +
               integral([&](double a) { return fraction(a) * yield(a, l) * lamp(a); }, 420, 470);
      },
      GetParam().resolution);
}

// Inside a sphere all light meets the dye again and again: L = L_e + rho (1 - a) L + int a y L, solved for all wavelengths at
// once.
TEST_P(OnSurfaces, ASphereLitFromWithin) {
  constexpr double rho = 0.5, c = 1;
  constexpr int n = 470;
  const auto wavelength = [](int i) { return 360.5 + i; };
  std::vector<double> a(n), L(n), next(n);
  for (int i = 0; i < n; ++i) a[size_t(i)] = 1 - std::exp(-c * absorbs(wavelength(i)));
  for (int round = 0; round < 80; ++round) {
    for (int i = 0; i < n; ++i) {
      double sum = lamp(wavelength(i)) + rho * (1 - a[size_t(i)]) * L[size_t(i)];
      for (int j = 0; j < n; ++j)
        if (a[size_t(j)] > 0) sum += a[size_t(j)] * yield(wavelength(j), wavelength(i)) * L[size_t(j)];
      next[size_t(i)] = sum;
    }
    L = next;
  }
  const Bands found = measured(
      of(GetParam(), "max_depth: 200"), "PerspectiveCamera { from: [0.3, 0.1, 0.2], to: [0, 0, 1], fov: 90 }", 8,
      fmt::format("Sphere {{ radius: 1, shader: FluorescentShader {{ color: {}, concentration: {}, dye: {} }}, emission: "
                  "DiffuseEmission {{ radiance: {}, sides: back }} }}",
                  rho, c, dye(), lamp.text()));
  expect_bands(found, [&](double l) { return L[size_t(std::clamp(int(l - 360), 0, n - 1))]; }, GetParam().resolution);
}

// A matrix with fluorescence in both directions of wavelength, under flat light.
const std::vector<double> matrix{0.2, 0.3, 0.4, 0.05, 0.3, 0.2, 0, 0, 0.5};
std::string donaldson() {
  return fmt::format("DonaldsonShader {{ wavelengths: [430, 490, 550], values: [{:g}] }}", fmt::join(matrix, ", "));
}
double bilinear(double absorbed, double emitted) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (i != j)
        sum += matrix[size_t(3 * i + j)] * std::max(0.0, 1 - std::abs(absorbed - 430 - 60 * i) / 60) *
               std::max(0.0, 1 - std::abs(emitted - 430 - 60 * j) / 60) / 60;
  return absorbed >= 430 && absorbed <= 550 && emitted >= 430 && emitted <= 550 ? sum : 0;
}

TEST_P(OnSurfaces, ADonaldsonMatrix) {
  const Line flat{{360, 830}, {1, 1}}, elastic{{430, 490, 550}, {0.2, 0.3, 0.5}};
  const Bands found = measured(of(GetParam(), "max_depth: 3"), above, 8, plate(donaldson()) + furnace(flat));
  expect_bands(
      found, [&](double l) { return elastic(l) + integral([&](double a) { return bilinear(a, l); }, 430, 550); },
      GetParam().resolution);
}

// The exchange of lamp and meter exchanges their wavelengths, and the matrix is not symmetric: light of 430-460 nm is found at
// 520-550 nm, and not the other way round.
TEST_P(OnSurfaces, AbsorptionAndEmissionAreNotExchanged) {
  const Line low{{430, 430.01, 459.99, 460}, {0, 1, 1, 0}}, high{{520, 520.01, 549.99, 550}, {0, 1, 1, 0}};
  for (const Line& light : {low, high}) {
    const Line elastic{{430, 490, 550}, {0.2, 0.3, 0.5}};
    const Bands found = measured(of(GetParam(), "max_depth: 3"), above, 8, plate(donaldson()) + furnace(light));
    expect_bands(
        found,
        [&](double l) {
          return elastic(l) * light(l) +
                 integral([&](double a) { return bilinear(a, l) * light(a); }, light.at[0], light.at[3]);
        },
        GetParam().resolution);
  }
}

// From both ends the wavelengths of all levels are drawn uniformly, which a narrow lamp makes noisy.
INSTANTIATE_TEST_SUITE_P(
    Fluorescence, OnSurfaces,
    testing::Values(Way{"PathTracer {}", 64}, Way{"PathTracer { next_event: false }", 64}, Way{"GuidedPathTracer {}", 64},
                    Way{"SimplePathTracer {}", 64}, Way{"RandomWalk {}", 128}, Way{"LightTracer {}", 512, 0.1},
                    Way{"BidirectionalPathTracer {}", 64, 0.1}, Way{"BidirectionalPathTracer { heuristic: balance }", 64, 0.1},
                    Way{"VertexConnectionMerging { merging: false }", 64, 0.1}),
    [](const auto& info) {
      return fmt::format("{}_{}", info.param.renderer.substr(0, info.param.renderer.find(' ')), info.index);
    });

class InMedia : public testing::TestWithParam<Way> {};

// A ball of dyed water, as clear as air besides, under light of one colour from everywhere. Of the radiance L(l') a ball of the
// radius R lets the fraction T = (1 - (1 + 2 m R) exp(-2 m R)) / (2 m^2 R^2) pass, m being the absorption coefficient (the
// lengths of chords are distributed as s / (2 R^2)); so it absorbs pi 4 pi R^2 L (1 - T) and, its own light not being absorbed
// again, sends out the power 4 pi^2 R^2 int y L (1 - T) dl', alike in all directions: a mean radiance of int y L (1 - T) dl'
// over its disc. The light around is invisible to the camera.
void expect_ball(const Way& way, const std::string& volume) {
  const Line apart{{505, 530, 600}, {0, 1, 0}};
  const double photons = integral([&](double l) { return apart(l) * l; });
  const Bands found = measured(
      of(way, "max_depth: 4"), "OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 2 }", 8,
      fmt::format("Sphere {{ radius: 1, shader: PassThrough {{}}, interior: {}, dye_absorption: 2, dye: Dye {{ absorption: {}, "
                  "emission: {}, quantum_yield: {} }} }} }}\n"
                  "Environment {{ visible_to_camera: false, emission: DiffuseEmission {{ radiance: {} }} }}",
                  volume, absorbs.text(), apart.text(), quantum_yield, lamp.text()));
  const double sent = integral(
      [&](double l) {
        const double m = 2 * absorbs(l);
        const double passes = m > 0 ? (1 - (1 + 2 * m) * std::exp(-2 * m)) / (2 * m * m) : 1;
        return l * lamp(l) * (1 - passes);
      },
      420, 470);
  expect_bands(found, [&](double l) { return pi / 4 * quantum_yield * apart(l) / photons * sent; }, way.resolution);
}

TEST_P(InMedia, ABallOfDyedWater) { expect_ball(GetParam(), "HomogeneousVolume { absorption: 0"); }

// The same amount of dye on a grid: distances and transmittances are found by delta tracking.
TEST_P(InMedia, ABallOfDyeOnAGrid) {
  expect_ball(GetParam(), "GridVolume { absorption: 0, scattering: 0, resolution: [2, 1, 1], density: [1, 1]");
}

INSTANTIATE_TEST_SUITE_P(Fluorescence, InMedia,
                         testing::Values(Way{"PathTracer {}", 160}, Way{"GuidedPathTracer {}", 160},
                                         Way{"LightTracer {}", 3072}),
                         [](const auto& info) {
                           return fmt::format("{}_{}", info.param.renderer.substr(0, info.param.renderer.find(' ')),
                                              info.index);
                         });

/// A job with these objects; `before` stands before it.
Ref<Job> job_of(const std::string& objects, const std::string& before = {}) {
  return load_job_text(before + test::job_text("PathTracer {}", above, 4, objects), "test.etd");
}

// Photons are kept: of each photon absorbed, quantum_yield are emitted.
TEST(Fluorescence, ADyeKeepsTheNumberOfPhotons) {
  const Ref<Job> job = job_of("plate", "plate = " + plate("FluorescentShader { dye: " + dye() + " }"));
  prepare_tree(*job);
  const FluorescentSurface* const surface = fluorescent(job->scene->objects[0]->shader.get());
  ASSERT_TRUE(surface);
  Arena arena;
  SurfacePoint point;
  point.normal = point.shading_normal = {0, 0, 1};
  point.object = job->scene->objects[0].get();
  const Reradiation* const r = surface->bind_reradiation(point, arena);
  ASSERT_TRUE(r);
  for (const float absorbed : {410.0f, 450.0f, 490.0f}) {
    const double a = 1 - std::exp(-absorbs(double(absorbed)));
    const double photons = integral([&](double l) { return double(r->value(absorbed, float(l))) * l / double(absorbed); });
    EXPECT_NEAR(photons, a * quantum_yield, 1e-4) << absorbed;
    EXPECT_NEAR(double(r->given(absorbed)), integral([&](double l) { return double(r->value(absorbed, float(l))); }), 1e-4);
  }
  EXPECT_EQ(r->value(450, 400), 0);
}

// Sampled wavelengths have the pdf that is returned.
TEST(Fluorescence, SampledWavelengthsHaveTheirPdf) {
  std::array<float, SampledFunction::size> values{};
  for (int k = 0; k < 100; ++k) values[size_t(40 + k)] = float(k % 10);
  const SampledFunction f(values);
  constexpr int n = 100000;
  double sum = 0, first = 0;
  for (int i = 0; i < n; ++i) {
    float pdf = 0;
    const float l = f.sample((float(i) + 0.5f) / n, pdf);
    ASSERT_GT(pdf, 0);
    sum += double(f(l) / pdf) / n;
    first += double(l * f(l) / pdf) / n;
  }
  EXPECT_NEAR(sum, double(f.integral()), 1e-3 * double(f.integral()));
  EXPECT_NEAR(first, integral([&](double l) { return l * double(f(float(l))); }), 1e-3 * first);
}

std::string message(const std::string& shader, const std::string& definitions = {}, const std::string& objects = {}) {
  try {
    prepare_tree(*job_of(objects + plate(shader), definitions));
  } catch (const Errors& e) {
    return e.errors.front().what();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(Fluorescence, WhatCannotBeIsRefusedWithItsReason) {
  const std::string fluorescent = "FluorescentShader { dye: " + dye() + " }";
  EXPECT_EQ(message(fluorescent), "");
  const auto has = [](const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << text << "\n does not hold: " << part;
  };
  has(message("MixShader { first: " + fluorescent + ", second: Lambertian {} }"), "fluoresces within a MixShader");
  has(message("MaskShader { shader: " + fluorescent + " }"), "fluoresces within a MaskShader");
  // Also where it was met before as the shader of another object.
  has(message("MaskShader { shader: paint }", "paint = " + fluorescent + "\n", "Sphere { shader: paint }\n"),
      "fluoresces within a MaskShader");
  has(message("FluorescentShader {}"), "dye");
  has(message("FluorescentShader { dye: Dye { absorption: 0, emission: 1 } }"), "is 0 at all wavelengths");
  has(message("FluorescentShader { dye: Dye { absorption: 1, emission: spectrum([400, 500], [-1, 1]) } }"), "negative");
  has(message("DonaldsonShader { wavelengths: [400, 500], values: [0.5, -0.1, 0, 0.5] }"), "negative");
  has(message("DonaldsonShader { file: \"no such file.csv\" }"), "no such file.csv");
  has(message("DonaldsonShader { wavelengths: [400, 500], values: [0.5, 0.6, 0, 0.5] }"), "1.1 times as much");
  has(message("DonaldsonShader { wavelengths: [400, 500], values: [0.5, 0.4, 0] }"), "need 4 values");
  has(message("DonaldsonShader { wavelengths: [400, 500, 550], values: [0, 0, 0, 0, 0, 0, 0, 0, 0] }"), "equal steps");
}

TEST(Fluorescence, MatricesAreReadFromFiles) {
  TemporaryFolder folder;
  const auto read = [&](const std::string& text) {
    std::ofstream(folder / "matrix.csv") << text;
    return read_donaldson_matrix(folder / "matrix.csv");
  };
  const DonaldsonMatrix m = read("# made up\nnm;400;500\n400; 0.2;0.3\n500;0;0.5\n");
  EXPECT_FLOAT_EQ(m.value(400, 500), 0.003f);
  EXPECT_FLOAT_EQ(m.value(450, 475), 0.5f * 0.75f * 0.003f);
  EXPECT_EQ(m.value(500, 400), 0);
  EXPECT_FLOAT_EQ(m.elastic(450), 0.35f);
  EXPECT_FLOAT_EQ(m.absorbed()(450), 0.15f);
  const auto fails = [&](const std::string& text, const std::string& part) {
    try {
      read(text);
      ADD_FAILURE() << text;
    } catch (const Error& e) {
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos) << e.what();
    }
  };
  fails("nm,400,500\n400,0.2,0.3\n510,0,0.5\n", "line 3: rows and columns must have the same wavelengths");
  fails("nm,400,500\n400,0.2\n", "line 2: it has 2 columns where 3 are needed");
  fails("nm,400,500\n400,0.2,much\n", "'much' is not a finite number");
  fails("nm,400,500\n400,0.2,0.3\n", "need 4 values");
  fails("", "it holds no numbers");
}

// A renderer that does not follow changes of wavelengths says that it loses them.
TEST(Fluorescence, TheOthersTellWhatTheyLose) {
  const Ref<Job> job = job_of("plate", "plate = " + plate("FluorescentShader { dye: " + dye() + " }"));
  prepare_tree(*job);
  const SceneTraits traits = scene_traits(*job->scene, *job->camera);
  for (const char* name :
       {"PhotonMapper", "ProgressivePhotonMapper", "VertexConnectionMerging", "WhittedRenderer", "ManyLights",
        "MultiplexedMetropolis", "ManifoldPathTracer", "DirectRenderer", "DistributionRenderer"}) {
    const auto renderer = ref_cast<Renderer>(Registry::instance().create(name));
    const std::vector<Advice> advice = renderer->misses(traits);
    const auto told = std::ranges::find(advice, fluorescent_surfaces, &Advice::kind);
    ASSERT_NE(told, advice.end()) << name;
    EXPECT_EQ(told->lost, "the fluorescence of 'plate'");
    EXPECT_NE(std::ranges::find(told->instead, "PathTracer"), told->instead.end());
  }
}

}  // namespace
}  // namespace etendue
