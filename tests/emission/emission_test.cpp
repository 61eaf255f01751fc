// Emission: power against the integral of radiance, samples against their pdf, environments.

#include "etendue/emission_shader.h"

#include "components/emission/texel_distribution.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using test::create;
using test::ImageFile;

/// The integral over 360 to 830 nm of a function of wavelengths, at the middle of 235 * size equal steps.
double integrate_wavelengths(const std::function<Spectrum(const Wavelengths&)>& f) {
  constexpr int sets = 235;
  constexpr double step = 470.0 / (sets * spectrum_size);
  double sum = 0;
  for (int set = 0; set < sets; ++set) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, float(360 + (i * sets + set + 0.5) * step), 1 / 470.0f);
    sum += double(f(w).average()) * spectrum_size * step;
  }
  return sum;
}

/// Power per wavelength by quadrature over the square and over the sphere of directions.
Spectrum measured_power(const EmissionShader& emission, const test::TestSquare& square, const Wavelengths& w) {
  Spectrum sum;
  constexpr int points = 16;
  const Frame frame(Normal3{0, 0, 1});
  for (int i = 0; i < points * points; ++i) {
    const SurfaceSample s = square.sample_area({(float(i % points) + 0.5f) / points, (float(i / points) + 0.5f) / points}, 0);
    for (int k = 0; k < spectrum_size; ++k) {
      double emitted = 0;
      for (const double cell : test::integrate_cells(frame, 2, 2, [&](const Vector3& d) {
             return double(emission.radiance(s.point, d, w)[k]) * std::abs(double(d.z));
           }))
        emitted += cell;
      sum.set(k, sum[k] + float(emitted) / (s.pdf * points * points));
    }
  }
  return sum;
}

TEST(DiffuseEmission, PowerIsTheIntegralOfRadiance) {
  test::TestSquare square(2);
  square.reference();
  const Ref<ObjectMap> checker =
      create<ObjectMap>("CheckerMap", {{"first", 1.0}, {"second", 3.0}, {"repeat", std::vector<double>{4, 4, 4}}});
  for (const char* sides : {"front", "back", "both"})
    for (const double watts : {0.0, 60.0})
      for (const bool varied : {false, true}) {
        std::vector<test::Setting> settings{{"sides", sides}, {"power", watts}};
        if (varied) settings.emplace_back("radiance", checker);
        const Ref<EmissionShader> emission = create<EmissionShader>("DiffuseEmission", settings);
        const float exact = varied ? 5e-3f : 1e-4f;  // a textured power is a mean over points
        const Wavelengths w = test::wavelengths();
        const Spectrum wanted = measured_power(*emission, square, w), power = emission->power(square, w);
        for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(power[k], wanted[k], exact * wanted[k]) << sides << watts << varied;
        if (watts > 0) {
          EXPECT_NEAR(integrate_wavelengths([&](const Wavelengths& v) { return emission->power(square, v); }), watts, 1e-3);
        } else {
          const double mean = varied ? 2 : 1, count = std::string(sides) == "both" ? 2 : 1;
          EXPECT_NEAR(power[0], M_PI * 4 * mean * count, double(exact) * M_PI * 4 * mean * count);
        }
      }
}

TEST(DiffuseEmission, EachObjectHasThePower) {
  test::TestSquare small(1), large(3);
  small.reference();
  large.reference();
  const Ref<ObjectMap> checker = create<ObjectMap>("CheckerMap");
  const Ref<EmissionShader> constant_one = create<EmissionShader>("DiffuseEmission", {{"power", 5.0}});
  const Ref<EmissionShader> varied = create<EmissionShader>("DiffuseEmission", {{"power", 5.0}, {"radiance", checker}});
  for (const auto* square : {&small, &large})
    for (const EmissionShader* emission : {constant_one.get(), varied.get()})
      EXPECT_NEAR(integrate_wavelengths([&](const Wavelengths& w) { return emission->power(*square, w); }), 5, 1e-3);
}

TEST(DiffuseEmission, PowerKeepsTheShapeOfTheSpectrum) {
  test::TestSquare square;
  square.reference();
  const Color lamp = blackbody_spectrum(2856);
  const Ref<EmissionShader> emission = create<EmissionShader>("DiffuseEmission", {{"power", 60.0}, {"radiance", lamp}});
  EXPECT_NEAR(integrate_wavelengths([&](const Wavelengths& w) { return emission->power(square, w); }), 60, 0.01);
  const Wavelengths w = test::wavelengths();
  const Spectrum p = emission->power(square, w);
  for (int i = 1; i < spectrum_size; ++i)
    EXPECT_NEAR(p[i] / p[0], lamp->at(w[i], ColorUse::radiance) / lamp->at(w[0], ColorUse::radiance), 1e-4 * p[i] / p[0]);
}

TEST(DiffuseEmission, SamplesFollowDensity) {
  constexpr int rows = 12, columns = 12, count = 40000;
  const SurfacePoint p = test::surface_point();
  const Frame frame(p.normal);
  std::uint32_t seed = 20;
  for (const char* sides : {"front", "back", "both"}) {
    const Ref<EmissionShader> emission = create<EmissionShader>("DiffuseEmission", {{"sides", sides}});
    std::vector<double> expected =
        test::integrate_cells(frame, rows, columns, [&](const Vector3& d) { return double(emission->pdf(p, d)); });
    double total = 0;
    for (double& e : expected) {
      total += e;
      e *= count;
    }
    EXPECT_NEAR(total, 1, 1e-4) << sides;
    std::vector<double> counts(expected.size());
    test::Random random(seed++);
    for (int i = 0; i < count; ++i) {
      const DirectionSample s = emission->sample(p, random.pair());
      EXPECT_NEAR(s.pdf, emission->pdf(p, s.direction), 1e-4f);
      EXPECT_TRUE(emission->emits(p, s.direction));
      ++counts[test::cell_of(frame, rows, columns, s.direction)];
    }
    EXPECT_GT(test::chi_square(counts, expected), test::each_of(3)) << sides;
  }
}

TEST(DiffuseEmission, RefusesAPowerOfBlack) {
  EXPECT_THROW(create<EmissionShader>("DiffuseEmission", {{"power", 1.0}, {"radiance", 0.0}}), Error);
  EXPECT_THROW(create<EmissionShader>("DiffuseEmission", {{"radiance", -1.0}}), Error);
}

// ---- environments ---------------------------------------------------------------------------------------------------

constexpr int width = 24, height = 12;

/// Random grey texels, a black part, and a few very bright ones (one in the corner, whose neighbours wrap around).
std::vector<float> sky() {
  std::vector<float> rgb;
  test::Random random(99);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      float value = y > 7 && x < 12 ? 0 : random();
      if ((x == 5 && y == 3) || (x == 0 && y == 10) || (x == 23 && y == 0)) value = 30;
      rgb.insert(rgb.end(), {value, value, value});
    }
  return rgb;
}

SurfacePoint towards(const Vector3& d) {
  SurfacePoint p;
  p.object_position = Point3{} + d;
  return p;
}

/// Radiance at the first wavelength.
float seen(const EmissionShader& e, const Vector3& d) { return e.radiance(towards(d), -d, test::wavelengths(550))[0]; }

TEST(EnvironmentEmission, DensityIsThatOfTheSamples) {
  const ImageFile file("sky.exr", width, height, sky());
  const Ref<EmissionShader> e = create<EmissionShader>("EnvironmentEmission", {{"file", file.path}});
  ASSERT_TRUE(e->knows_incident());
  // The bins are the texels, over each of which the pdf is constant. Longitude from -z over +x is that of a frame with s = -z,
  // t = x.
  const double solid_angle_steps = 2 * M_PI / width;
  std::vector<double> expected, counts(size_t(width * height));
  double total = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double top = std::cos(M_PI * y / height), bottom = std::cos(M_PI * (y + 1) / height);
      const double phi = 2 * M_PI * (x + 0.5) / width, c = (top + bottom) / 2, s = std::sqrt(1 - c * c);
      const Vector3 d{float(s * std::sin(phi)), float(c), float(-s * std::cos(phi))};
      expected.push_back(double(e->incident_pdf(d)) * solid_angle_steps * (top - bottom));
      total += expected.back();
    }
  EXPECT_NEAR(total, 1, 1e-5);
  constexpr int count = 200000;
  for (double& x : expected) x *= count;
  test::Random random(4);
  for (int i = 0; i < count; ++i) {
    const Point2 u = random.pair();
    const DirectionSample s = e->sample_incident(u);
    ASSERT_GT(s.pdf, 0);
    ASSERT_EQ(s.pdf, e->incident_pdf(s.direction));
    const IncidentPlaces places = e->incident_places(s.direction);
    ASSERT_EQ(places.count, 1);
    ASSERT_EQ(places.pdf[0], s.pdf);
    ASSERT_NEAR(places.at[0].x, u.x, 1e-5f);
    ASSERT_NEAR(places.at[0].y, u.y, 1e-5f);
    ASSERT_NEAR(length(s.direction), 1, 1e-5f);
    double phi = std::atan2(double(s.direction.x), -double(s.direction.z)) / (2 * M_PI);
    if (phi < 0) phi += 1;
    const int x = std::min(int(phi * width), width - 1),
              y = std::min(int(std::acos(double(clamp(s.direction.y, -1, 1))) / M_PI * height), height - 1);
    ++counts[size_t(y * width + x)];
  }
  EXPECT_GT(test::chi_square(counts, expected), 1e-3);
}

// Evenly spaced primary samples choose each texel in proportion to its weight, to within one sample: wide rows, whose search
// passes several nodes, with texels and whole rows of weight 0.
TEST(TexelDistribution, EvenNumbersFallByWeight) {
  constexpr size_t columns = 1500, rows = 3;
  std::vector<float> weights;
  test::Random random(12);
  for (size_t i = 0; i < columns * rows; ++i)
    weights.push_back(i / columns == 1 || (i % columns > 400 && i % columns < 700) ? 0 : random() < 0.01f ? 50 : random());
  TexelDistribution d;
  d.build(weights, columns, {1, 5, 2});
  std::array<double, rows> sums{};
  for (size_t i = 0; i < weights.size(); ++i) sums[i / columns] += double(weights[i]);
  EXPECT_NEAR(d.total(), sums[0] + 2 * sums[2], 1e-9 * d.total());
  constexpr size_t count = 100000;
  for (const size_t y : {size_t(0), size_t(2)}) {
    const double share = (y == 0 ? 1 : 2) * sums[y] / d.total();
    std::vector<size_t> met(columns);
    for (size_t k = 0; k < count; ++k) {
      const float u = (float(k) + 0.5f) / float(count);
      const TexelDistribution::Choice c = d.choose({u, y == 0 ? 0.01f : 0.99f});
      ASSERT_EQ(c.y, y);
      ASSERT_TRUE(c.within.x >= 0 && c.within.x < 1);
      ++met[c.x];
    }
    double worst = 0, worst_pdf = 0;
    for (size_t x = 0; x < columns; ++x) {
      const double part = double(weights[y * columns + x]) / sums[y], pdf = part * share / (y == 0 ? 1 : 2);
      worst = std::max(worst, std::abs(double(met[x]) - part * count));
      worst_pdf = std::max(worst_pdf, std::abs(double(d.pdf(x, y)) - pdf));
    }
    EXPECT_LE(worst, 1.1) << y;
    EXPECT_LE(worst_pdf, 1e-6) << y;
  }
}

TEST(EnvironmentEmission, NothingThatShinesIsMissed) {
  const ImageFile file("sky.exr", width, height, sky());
  const Ref<EmissionShader> e = create<EmissionShader>("EnvironmentEmission", {{"file", file.path}});
  test::Random random(8);
  int black = 0;
  double integral = 0, uniform_squares = 0, estimate = 0, squares = 0;
  constexpr int count = 100000;
  for (int i = 0; i < count; ++i) {
    const Vector3 d = random.direction();
    const float radiance = seen(*e, d);
    integral += double(radiance) * 4 * M_PI / count;
    uniform_squares += std::pow(double(radiance) * 4 * M_PI, 2) / count;
    if (radiance > 0) {
      EXPECT_GT(e->incident_pdf(d), 0);
    } else {
      ++black;
    }
    const DirectionSample s = e->sample_incident(random.pair());
    const double value = double(seen(*e, s.direction) / s.pdf);
    estimate += value / count;
    squares += value * value / count;
  }
  EXPECT_GT(black, count / 20);
  // The exact integral, by the midpoint rule on small parts of the pixels.
  double exact = 0;
  constexpr int parts = 24;
  for (int y = 0; y < height * parts; ++y)
    for (int x = 0; x < width * parts; ++x) {
      const double theta = M_PI * (y + 0.5) / (height * parts), phi = 2 * M_PI * (x + 0.5) / (width * parts);
      const Vector3 d{float(std::sin(theta) * std::sin(phi)), float(std::cos(theta)), float(-std::sin(theta) * std::cos(phi))};
      exact += double(seen(*e, d)) * std::sin(theta) * M_PI / (height * parts) * 2 * M_PI / (width * parts);
    }
  const double error = std::sqrt((squares - estimate * estimate) / count);
  EXPECT_LT(error, 3e-3 * exact);
  EXPECT_NEAR(estimate, exact, 4.5 * error + 1e-3 * exact);
  // Importance sampling by the emission's own radiance leaves little of the variance.
  EXPECT_LT(squares - estimate * estimate, 0.1 * (uniform_squares - integral * integral));
}

TEST(EnvironmentEmission, DirectionsAndTexels) {
  std::vector<float> rgb(size_t(width * height * 3), 0.1f);
  const auto paint = [&](int x, int y) {
    for (size_t c = 0; c < 3; ++c) rgb[size_t(y * width + x) * 3 + c] = 5;
  };
  for (int y = 5; y <= 6; ++y) {
    paint(0, y);  // left edge of the image: -z
    paint(width - 1, y);
    paint(width / 4 - 1, y);  // a quarter to the right: +x
    paint(width / 4, y);
  }
  for (int x = 0; x < width; ++x) paint(x, 0);  // the top: +y
  const ImageFile file("directions.exr", width, height, rgb);
  const Ref<EmissionShader> e = create<EmissionShader>("EnvironmentEmission", {{"file", file.path}, {"scale", 2.0}});
  const float bright = seen(*e, {0, 0, -1}), dark = seen(*e, {0, 0, 1});
  EXPECT_NEAR(bright / dark, 50, 0.1);
  EXPECT_NEAR(seen(*e, {1, 0, 0}), bright, 1e-3f * bright);
  EXPECT_NEAR(seen(*e, {0, 1, 0}), bright, 1e-3f * bright);
  EXPECT_NEAR(seen(*e, {-1, 0, 0}), dark, 1e-3f * dark);
  EXPECT_NEAR(seen(*e, {0, -1, 0}), dark, 1e-3f * dark);
}

TEST(EnvironmentEmission, ConstantImageIsSampledUniformly) {
  const ImageFile file("flat.exr", width, height, std::vector<float>(size_t(width * height * 3), 0.5f));
  const Ref<EmissionShader> e = create<EmissionShader>("EnvironmentEmission", {{"file", file.path}});
  test::Random random(5);
  for (int i = 0; i < 1000; ++i) EXPECT_NEAR(e->sample_incident(random.pair()).pdf, 1 / (4 * M_PI), 1e-6);
  test::TestSquare object;
  object.reference();
  const Wavelengths w = test::wavelengths(550);
  EXPECT_NEAR(e->power(object, w)[0] / seen(*e, {0, 0, 1}), M_PI * double(object.area(0)), 1e-3);
}

TEST(EnvironmentEmission, OfAMap) {
  const Ref<EmissionShader> plain = create<EmissionShader>("EnvironmentEmission", {{"radiance", 3.0}, {"scale", 2.0}});
  EXPECT_FALSE(plain->knows_incident());
  EXPECT_EQ(plain->sample_incident({0.5f, 0.5f}).pdf, 0);
  EXPECT_NEAR(seen(*plain, {0, 1, 0}), 6, 1e-6f);
  test::TestSquare object;
  object.reference();
  EXPECT_NEAR(plain->power(object, test::wavelengths())[0], 6 * M_PI * double(object.area(0)), 1e-3);
  // Maps are evaluated with (u, v) of the direction, v upwards: upper half dark, lower half bright.
  const Ref<ObjectMap> halves =
      create<ObjectMap>("CheckerMap", {{"first", 4.0}, {"second", 1.0}, {"repeat", std::vector<double>{1, 2, 1}}});
  const Ref<EmissionShader> varied = create<EmissionShader>("EnvironmentEmission", {{"radiance", halves}});
  EXPECT_NEAR(seen(*varied, normalize(Vector3{1, 0.2f, 0.3f})), 1, 1e-6f);
  EXPECT_NEAR(seen(*varied, normalize(Vector3{1, -0.2f, 0.3f})), 4, 1e-6f);
  EXPECT_NEAR(varied->power(object, test::wavelengths())[0], 2.5 * M_PI * double(object.area(0)), 0.01);
}

TEST(EnvironmentEmission, PowerIsThatOfItsMapWhateverTheMapAsksFor) {
  // A map of normals on a rotated sky, whose object space differs from world space.
  const Ref<ObjectMap> normals = create<ObjectMap>("NormalDirectionMap"),
                       bright = create<ObjectMap>("PowerMap", {{"base", normals}, {"exponent", 4.0}});
  const Ref<EmissionShader> e = create<EmissionShader>("EnvironmentEmission", {{"radiance", bright}});
  const Ref<SceneObject> sky = create<SceneObject>("Environment", {{"emission", e}});
  set(*sky, "transform", Value(Transform::rotate(90, {1, 0, 0}) * Transform::rotate(30, {0, 1, 0})));
  prepare_tree(*sky);
  const Wavelengths w = test::wavelengths();
  Spectrum sum;
  test::Random random(5);
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i) {
    const SurfaceSample s = sky->sample_visible({}, random.pair(), 0);
    sum += e->radiance(s.point, -s.direction, w) / (s.pdf * float(4 * M_PI * n));
  }
  const Spectrum power = e->power(*sky, w);
  for (int i = 0; i < spectrum_size; ++i) {
    const double wanted = M_PI * double(sky->area(0)) * double(sum[i]);
    EXPECT_NEAR(double(power[i]), wanted, 0.02 * wanted);
  }
}

TEST(EnvironmentEmission, RefusesBadFiles) {
  EXPECT_THROW(create<EmissionShader>("EnvironmentEmission", {{"file", "/nowhere/sky.exr"}}), Error);
  std::vector<float> rgb = sky();
  rgb[7] = std::numeric_limits<float>::quiet_NaN();
  const ImageFile file("nan.exr", width, height, rgb);
  EXPECT_THROW(create<EmissionShader>("EnvironmentEmission", {{"file", file.path}}), Error);
}

}  // namespace
}  // namespace etendue
