// MapVolume, and emission of heterogeneous media. Monte Carlo means have fixed seeds.

#include <fmt/format.h>

#include "color/planck.h"
#include "etendue/describe/color.h"
#include "etendue/transport/medium.h"
#include "support/luminaire_test_support.h"

namespace etendue::test {
namespace {

struct Estimate {
  double mean[spectrum_size] = {}, error[spectrum_size] = {};
};

/// The mean of a spectrum over Monte Carlo samples, each with its own stream of primary samples.
template <class Draw>
Estimate average(const Draw& draw, int n = 60000) {
  const Ref<Sampler> sampler = create<Sampler>("IndependentSampler");
  Estimate e;
  double squares[spectrum_size] = {};
  for (int i = 0; i < n; ++i) {
    NumberStream stream(*sampler, SampleKey(11, 0, 0, std::uint32_t(i)));
    const Spectrum s = draw(stream);
    for (int k = 0; k < spectrum_size; ++k) {
      e.mean[k] += double(s[k]) / n;
      squares[k] += double(s[k]) * double(s[k]) / n;
    }
  }
  for (int k = 0; k < spectrum_size; ++k) e.error[k] = std::sqrt(std::max(squares[k] - e.mean[k] * e.mean[k], 0.0) / n);
  return e;
}

struct Slab {
  Ref<VolumeShader> volume;
  Ref<SceneObject> inside = create<SceneObject>("Sphere");
  Medium medium{volume.get(), inside.get()};
  Ray ray;
  explicit Slab(const std::string& text) : volume(prepared_as<VolumeShader>(text)) {
    ray.origin = {0, 0.3f, 0.4f};
    ray.direction = {1, 0, 0};
  }
  Estimate let_through(float distance, const Wavelengths& w) const {
    return average([&](NumberStream& s) { return transmittance(medium, ray, distance, w, s); });
  }
  Estimate shines(float distance, const Wavelengths& w) const {
    return average([&](NumberStream& s) { return sample_free_flight(medium, ray, distance, Spectrum(1.0f), w, s).emitted; });
  }
};

/// To four standard errors, and rounding.
#define EXPECT_ESTIMATE(estimate, k, expected) \
  EXPECT_NEAR((estimate).mean[k], expected, 4 * (estimate).error[k] + 1e-5 * (expected)) << "wavelength " << (k)

// Absorption and scattering on separate RGB grids. Between the centres of two cells along x both are linear in RGB, but the
// spectra in between are not linear in x: the expected optical depth is a midpoint sum over the spectra of the colours.
TEST(MapVolume, TwoGridsOfRgbLetThroughWhatTheirIntegralSays) {
  const Slab slab(
      "MapVolume { absorption: GridMap { resolution: [2, 1, 1], values: [0.2, 1, 2, 3, 0.5, 0.1] }, scattering: GridMap { "
      "resolution: [1, 1, 1], values: [0.5, 0.1, 0.9] } }");
  const Wavelengths w = wavelengths();
  const Estimate t = slab.let_through(1, w);
  const Color scattering = rgb_color("srgb", 0.5, 0.1, 0.9);
  for (int k = 0; k < spectrum_size; ++k) {
    constexpr int points = 200;
    double depth = double(scattering->at(w[k], ColorUse::coefficient));
    for (int i = 0; i < points; ++i) {
      const double x = (i + 0.5) / points, f = std::clamp(2 * x - 0.5, 0.0, 1.0);
      const auto mix = [f](double a, double b) { return a + f * (b - a); };
      depth += double(rgb_color("srgb", mix(0.2, 3), mix(1, 0.5), mix(2, 0.1))->at(w[k], ColorUse::coefficient)) / points;
    }
    EXPECT_NEAR(t.mean[k], std::exp(-depth), 4 * t.error[k] + 2e-3);
    EXPECT_LE(slab.volume->coefficients({0.5f, 0.5f, 0.5f}, 0, w).extinction()[k], slab.volume->majorant(w)[k]);
  }
}

// Three equivalent descriptions: the density of a grid, that of a map, and coefficients on grids.
TEST(MapVolume, SaysWhatGridVolumeSays) {
  const std::string cells = "resolution: [2, 2, 1], ", numbers = "[0, 1, 2, 4]";
  const Ref<VolumeShader>
      a = prepared_as<VolumeShader>(
          "GridVolume { " + cells + "density: " + numbers +
          ", absorption: rgb(1, 2, 3), scattering: 2, emission: 5, placement: translate([1, 0, 0]), outside: empty }"),
      b = prepared_as<VolumeShader>(
          "MapVolume { density: GridMap { " + cells + "values: " + numbers +
          ", outside: empty }, absorption: rgb(1, 2, 3), scattering: 2, emission: 5, placement: translate([1, 0, 0]) }"),
      c = prepared_as<VolumeShader>(
          "MapVolume { density: GridMap { " + cells + "values: " + numbers +
          ", outside: empty, placement: translate([1, 0, 0]) }, extinction: MultiplyMap { first: 3, second: 2 }, "
          "albedo: 0.5 }");
  const Wavelengths w = wavelengths();
  for (const Point3 p : {Point3{1.3f, 0.4f, 0.5f}, Point3{1.7f, 0.8f, 0.2f}, Point3{0.9f, 0.5f, 0.5f}, Point3{3, 0, 0}}) {
    const VolumeCoefficients x = a->coefficients(p, 0, w), y = b->coefficients(p, 0, w), z = c->coefficients(p, 0, w);
    for (int k = 0; k < spectrum_size; ++k) {
      EXPECT_NEAR(x.absorption[k], y.absorption[k], 1e-5f);
      EXPECT_NEAR(x.scattering[k], y.scattering[k], 1e-5f);
      EXPECT_NEAR(x.emission[k], y.emission[k], 1e-5f);
      EXPECT_NEAR(z.extinction()[k], 3 * x.scattering[k], 1e-5f);
      EXPECT_NEAR(z.scattering[k], z.absorption[k], 1e-5f);
      EXPECT_NEAR(a->majorant(w)[k], b->majorant(w)[k], 1e-4f);
      EXPECT_NEAR(c->majorant(w)[k], 24, 1e-2f);
    }
  }
}

// Hot gas that only absorbs: L = B(T) (1 - exp(-a d)), which is a black body of its temperature where it is optically thick. B
// is Planck's radiance, that of the colour `blackbody`.
TEST(MapVolume, HotGasIsABlackBodyWhereItIsThick) {
  const Wavelengths w = wavelengths();
  const Color black = blackbody_spectrum(1800);
  for (const double depth : {0.02, 1.0, 9.0}) {
    const Slab slab(
        fmt::format("MapVolume {{ density: GridMap {{ values: [2] }}, absorption: {}, glow: BlackbodyMap {{ temperature: "
                    "GridMap {{ values: [1800] }} }} }}",
                    depth / 2));
    const Estimate light = slab.shines(1, w);
    for (int k = 0; k < spectrum_size; ++k)
      EXPECT_ESTIMATE(light, k, double(black->at(w[k], ColorUse::radiance)) * -std::expm1(-depth));
  }
}

// The temperature rises linearly along the ray: L = int_0^1 a B(T(x)) exp(-a x) dx.
TEST(MapVolume, LightByTemperatureIsThatOfEachPlace) {
  const Wavelengths w = wavelengths();
  Slab slab(
      "MapVolume { density: 1, absorption: 1.5, bound: 100, glow: BlackbodyMap { temperature: RemapMap { clamped: false, from: "
      "[100, 101], to: [0, 10], input: GridMap { resolution: [2, 1, 1], values: [200, 250] } } } }");
  slab.ray.origin.x = 0.25f;
  const Estimate light = slab.shines(0.5f, w);
  for (int k = 0; k < spectrum_size; ++k) {
    constexpr int points = 1000;
    double expected = 0;
    for (int i = 0; i < points; ++i) {
      const double x = 0.5 * (i + 0.5) / points;
      expected += 0.5 / points * 1.5 * std::exp(-1.5 * x) * planck(double(w[k]), 1000 + 1000 * x);
    }
    EXPECT_ESTIMATE(light, k, expected);
  }
}

// Emission without absorption: e d, also where no majorant bounds the free-flight distance.
TEST(MapVolume, ShinesWhereItAbsorbsNothing) {
  const Wavelengths w = wavelengths();
  for (const char* text : {"MapVolume { emission: 3 }", "GridVolume { emission: 3 }",
                           "GridVolume { resolution: [2, 1, 1], density: [1, 3], emission: 1.5, extinction: 1e-6 }"}) {
    const Slab slab(text);
    EXPECT_ESTIMATE(slab.shines(1, w), 0, 3.0);
  }
}

TEST(MapVolume, IsThinnedToItsBound) {
  const Wavelengths w = wavelengths();
  const Ref<VolumeShader> v = prepared_as<VolumeShader>(
      "MapVolume { density: FormulaMap { formula: \"10 * x\" }, absorption: 1, scattering: 3, bound: 8 }");
  const VolumeCoefficients thin = v->coefficients({0.1f, 0, 0}, 0, w), dense = v->coefficients({5, 0, 0}, 0, w);
  EXPECT_NEAR(thin.extinction()[0], 4, 1e-4f);
  EXPECT_NEAR(dense.extinction()[0], 8, 1e-4f);
  EXPECT_NEAR(dense.absorption[0], 2, 1e-4f);
  EXPECT_GE(v->majorant(w)[0], dense.extinction()[0]);
  expect_refused("MapVolume { density: FormulaMap { formula: \"x\" }, absorption: 1 }", "density", "give the medium a `bound`");
  // For example from a damaged file: the majorant would be infinite, and free-flight distances 0.
  expect_refused("MapVolume { density: GridMap { values: [3e38] }, absorption: 1000 }", "density", "cannot be followed");
  expect_refused("GridVolume { density: [3e38], absorption: 1000 }", "density", "cannot be followed");
  expect_refused("MapVolume { absorption: -1 }", "absorption", "negative");
  expect_refused("MapVolume { extinction: 1, scattering: 1 }", "extinction", "only one way");
  expect_refused("MapVolume { extinction: 1, albedo: 2 }", "albedo", "between 0 and 1");
}

TEST(MapVolume, EndsWithItsBox) {
  const Wavelengths w = wavelengths();
  const Ref<VolumeShader> v = prepared_as<VolumeShader>(
      "MapVolume { absorption: 1, limited: true, low: [0, 0, 0], high: [1, 2, 3], placement: scale(2) }");
  EXPECT_EQ(v->coefficients({1.9f, 3.9f, 5.9f}, 0, w).absorption[0], 1);
  EXPECT_EQ(v->coefficients({1.9f, 3.9f, 6.1f}, 0, w).absorption[0], 0);
  EXPECT_EQ(v->coefficients({-0.1f, 1, 1}, 0, w).absorption[0], 0);
}

// Maps report valid upper bounds: at random points no coefficient is above the majorant.
TEST(MapVolume, MapsKeepTheirBounds) {
  const std::string grid =
      "GridMap { resolution: [2, 2, 2], values: [3, 0, 0, 0, 2, 0, 0, 0, 1, 1, 1, 1, 3, 0, 0, 0, 0, 2, 2, 0, 3, 0, 1, 0] }";
  for (const std::string& map : std::vector<std::string>{
           grid, "MultiplyMap { first: " + grid + ", second: " + grid + " }", "AddMap { first: " + grid + ", second: 2 }",
           "SubtractMap { first: 1, second: " + grid + " }", "MaxMap { first: rgb(0.1, 5, 0.1), second: " + grid + " }",
           "MixMap { first: 0.1, second: " + grid + ", amount: FbmMap { size: 0.3 } }",
           "RemapMap { input: " + grid + ", to: [4, 2] }",
           "TransformedMap { map: " + grid + ", transform: rotate(20 deg, \"x\") }", std::string("CloudMap { second: 4 }")}) {
    const Ref<VolumeShader> v = prepared_as<VolumeShader>("MapVolume { density: " + map + ", absorption: " + map + " }");
    const Wavelengths w = wavelengths();
    const Spectrum most = v->majorant(w);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> u(-0.5f, 1.5f);
    for (int i = 0; i < 2000; ++i) {
      const Spectrum here = v->coefficients({u(random), u(random), u(random)}, 0, w).absorption;
      for (int k = 0; k < spectrum_size; ++k) ASSERT_LE(here[k], most[k]) << map;
    }
  }
}

}  // namespace
}  // namespace etendue::test
