// The sky with its sun, and projected images.

#include "components/emission/sun_position.h"
#include "etendue/core/transform.h"
#include "etendue/describe/color.h"
#include "etendue/emission_shader.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using test::create;
using test::ImageFile;
using List = std::vector<double>;
constexpr double degree = M_PI / 180;

// ---- sky ------------------------------------------------------------------------------------------------------------

/// A sky whose sun stands at an elevation [deg] above +x.
Ref<EmissionShader> sky(double elevation, bool sun, std::vector<test::Setting> settings = {}) {
  settings.emplace_back("sun_direction", List{std::cos(elevation * degree), std::sin(elevation * degree), 0});
  const Ref<EmissionShader> e = create<EmissionShader>("SkyEmission", settings);
  set(*e, "sun", Value(sun));
  e->prepare();
  return e;
}
Wavelengths at(const std::array<float, 4>& lambda) {
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) w.place(i, lambda[size_t(i % 4)], 1 / 470.0f);
  return w;
}
/// The direction at angles [deg] from the zenith and, around it, from the sun's azimuth.
Vector3 towards(double theta, double phi) {
  return {float(std::sin(theta * degree) * std::cos(phi * degree)), float(std::cos(theta * degree)),
          float(-std::sin(theta * degree) * std::sin(phi * degree))};
}
Spectrum seen(const EmissionShader& e, const Vector3& d, const Wavelengths& w) {
  SurfacePoint p;
  p.object_position = Point3{} + d;
  return e.radiance(p, -d, w);
}

TEST(SkyEmission, RadianceIsThatOfMitsuba) {
  struct Row {
    double elevation, turbidity, albedo, theta, phi;
    std::array<float, 4> radiance;  // at 360, 440, 555 and 700 nm
  };
  // The sunsky plugin of Mitsuba 3.9.1 (scalar_spectral, sun_scale 0).
  const Row rows[] = {{60, 3, 0.3, 0, 0, {0.0876848f, 0.113161f, 0.0537105f, 0.0235216f}},
                      {60, 3, 0.3, 60, 0, {0.132013f, 0.212215f, 0.12123f, 0.0556308f}},
                      {60, 3, 0.3, 60, 180, {0.100095f, 0.144712f, 0.065447f, 0.0227842f}},
                      {60, 3, 0.3, 85, 90, {0.115619f, 0.263185f, 0.171065f, 0.0781449f}},
                      {10, 6.5, 0, 0, 0, {0.0164122f, 0.0314861f, 0.0189398f, 0.00793568f}},
                      {10, 6.5, 0, 60, 0, {0.0313811f, 0.12196f, 0.180314f, 0.155235f}},
                      {10, 6.5, 0, 85, 90, {0.0128214f, 0.0549148f, 0.0618231f, 0.0413349f}},
                      {10, 6.5, 0, 45, 30, {0.0236497f, 0.0564103f, 0.049018f, 0.0299439f}},
                      {35, 2.2, 0.8, 0, 0, {0.0649241f, 0.0901019f, 0.0387625f, 0.0126376f}},
                      {35, 2.2, 0.8, 60, 180, {0.0913204f, 0.156579f, 0.0792877f, 0.0282783f}},
                      {35, 2.2, 0.8, 45, 30, {0.0924556f, 0.152212f, 0.0828986f, 0.0339132f}}};
  for (const Row& row : rows) {
    const auto e = sky(row.elevation, false, {{"turbidity", row.turbidity}, {"ground_albedo", row.albedo}});
    const Spectrum s = seen(*e, towards(row.theta, row.phi), at({360, 440, 555, 700}));
    for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(s[i], row.radiance[size_t(i % 4)], 1e-4f * row.radiance[size_t(i % 4)]);
  }
}

TEST(SkyEmission, TheSunIsThatOfMitsubaWithItsLimbKeptBright) {
  // sky_scale 0, complex_sun: at the centre of the disc and at 0.7 of its radius, at 400, 520 and 680 nm. In Mitsuba the limb
  // darkening reduces the irradiance; here the mean of the darkening over the disc is 1.
  struct Row {
    double elevation, turbidity;
    std::array<float, 3> middle, aside;
  };
  const Row rows[] = {{60, 3, {12008.3f, 22332.1f, 19649.0f}, {9319.99f, 18595.3f, 17144.6f}},
                      {10, 6.5, {891.398f, 5567.06f, 8642.97f}, {691.833f, 4635.5f, 7541.36f}},
                      {35, 2.2, {9208.94f, 20461.1f, 19144.5f}, {7147.33f, 17037.4f, 16704.5f}}};
  const float mean[] = {0.731014f, 0.792504f, 0.838388f};
  for (const Row& row : rows) {
    const auto e = sky(row.elevation, true, {{"turbidity", row.turbidity}, {"sun_diameter", 0.5358}});
    const Wavelengths w = at({400, 520, 680, 680});
    const double aside = 0.7 * 0.2679;
    const Vector3 sun = towards(90 - row.elevation, 0),
                  d = float(std::cos(aside * degree)) * sun + Vector3{0, 0, float(std::sin(aside * degree))};
    const float disc = float(std::pow(0.53313 / 0.5358, 2));
    const Spectrum middle = seen(*e, sun, w), beside = seen(*e, normalize(d), w);
    for (int i = 0; i < std::min(spectrum_size, 3); ++i) {
      const size_t k = size_t(i);
      EXPECT_NEAR(middle[i], row.middle[k] / mean[k] * disc, 1e-3f * middle[i]) << row.elevation << " " << i;
      EXPECT_NEAR(beside[i], row.aside[k] / mean[k] * disc, 1e-3f * beside[i]) << row.elevation << " " << i;
    }
    EXPECT_LT(seen(*e, towards(90 - row.elevation + 0.4, 0), w)[0], 0.01f * middle[0]);
    EXPECT_EQ(seen(*e, {1, -1e-3f, 0}, w)[0], 0);
  }
}

/// The irradiance on level ground [W/m^2] and the illuminance [lx], from the emission's own samples.
std::pair<double, double> level(const EmissionShader& e) {
  test::Random random(9);
  double watts = 0, lux = 0;
  constexpr int count = 20000;
  for (int i = 0; i < count; ++i) {
    const DirectionSample s = e.sample_incident(random.pair());
    Wavelengths w;
    const float shift = random();
    for (int k = 0; k < spectrum_size; ++k)
      w.place(k, 360 + 470 * std::fmod(shift + float(k) / float(spectrum_size), 1.0f), 1 / 470.0f);
    const Spectrum radiance = seen(e, s.direction, w);
    for (int k = 0; k < spectrum_size; ++k) {
      const double part = double(radiance[k] * std::max(s.direction.y, 0.0f) / s.pdf) * 470 / (spectrum_size * count);
      watts += part;
      lux += part * 683.002 * observer(w[k]).y;
    }
  }
  return {watts, lux};
}

TEST(SkyEmission, DaylightIsAsStrongAsDaylight) {
  // At 60 degrees: of some 900 W/m^2 (ASTM G-173 has 1000 for all wavelengths on a surface facing the sun) two thirds are
  // visible; 110 klx is typical of such days (15 to 20 klx from the sky alone).
  const auto [watts, lux] = level(*sky(60, true));
  EXPECT_NEAR(watts, 620, 60);
  EXPECT_NEAR(lux, 110e3, 10e3);
  EXPECT_NEAR(level(*sky(60, false)).second, 19e3, 2e3);
  EXPECT_LT(level(*sky(2, true)).second, 8e3);
  EXPECT_NEAR(level(*sky(60, true, {{"sun_diameter", 8.0}})).second, lux, 0.03 * lux);
  EXPECT_NEAR(level(*sky(40, true, {{"illuminance", 500.0}})).second, 500, 10);
  EXPECT_NEAR(level(*sky(60, true, {{"scale", 0.5}})).second, lux / 2, 0.03 * lux);
}

TEST(SkyEmission, SamplesFollowDensity) {
  constexpr int rows = 24, columns = 24, count = 100000, fine = 960;
  const Frame frame(Normal3{0, 1, 0});
  for (const bool sun : {false, true}) {
    const auto e = sky(35, sun, {{"sun_diameter", 20.0}});
    std::vector<double> counts(rows * columns), expected(rows * columns);
    test::Random random(sun ? 70 : 71);
    for (int i = 0; i < count; ++i) {
      const Point2 u = random.pair();
      const DirectionSample s = e->sample_incident(u);
      ASSERT_EQ(s.pdf, e->incident_pdf(s.direction));
      // One of the places that lead to the direction is where it came from. (Longitudes are inexact at the pole.)
      const IncidentPlaces places = e->incident_places(s.direction);
      float all = 0, nearest = 2;
      for (int k = 0; k < places.count; ++k) {
        all += places.pdf[k];
        nearest = std::min(nearest, std::hypot(places.at[k].x - u.x, places.at[k].y - u.y));
      }
      ASSERT_NEAR(all, s.pdf, 1e-5f * s.pdf);
      ASSERT_LT(nearest, 2e-3f);
      ++counts[test::cell_of(frame, rows, columns, s.direction)];
    }
    double total = 0;
    for (int i = 0; i < fine * fine; ++i) {
      const double z = -1 + 2 * (i % fine + 0.5) / fine, phi = 2 * M_PI * (i / fine + 0.5) / fine, r = std::sqrt(1 - z * z);
      const Vector3 d = frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
      const double part = double(e->incident_pdf(d)) * 4 * M_PI / (fine * fine);
      total += part;
      expected[test::cell_of(frame, rows, columns, d)] += part * count;
    }
    EXPECT_NEAR(total, 1, 2e-3) << sun;
    EXPECT_GT(test::chi_square(counts, expected), test::each_of(2)) << sun;
  }
}

TEST(SkyEmission, PowerIsTheIntegralOfRadiance) {
  test::TestSquare object(2);
  object.reference();
  const auto e = sky(50, true);
  const Wavelengths w = test::wavelengths();
  test::Random random(3);
  double sum = 0;
  constexpr int count = 40000;
  for (int i = 0; i < count; ++i) {
    const DirectionSample s = e->sample_incident(random.pair());
    sum += double(seen(*e, s.direction, w)[0] / s.pdf) / count;
  }
  // pi * area * mean over 4 pi.
  EXPECT_NEAR(double(e->power(object, w)[0]), sum * double(object.area(0)) / 4, 0.01 * sum);
}

TEST(SkyEmission, TheSunStandsWhereItDoes) {
  // Meeus 1998, example 25.a: 1992 October 13, 0 h.
  const SunCoordinates sun = sun_coordinates(parse_time("1992-10-13T00:00Z"));
  EXPECT_NEAR(std::fmod(sun.right_ascension / degree + 360, 360), 198.38083, 0.01);
  EXPECT_NEAR(sun.declination / degree, -7.78507, 0.01);
  // Reda & Andreas 2004, table A5.1: 39.742476 N 105.1786 W, without refraction.
  const Vector3 d = sun_direction(parse_time("2003-10-17T19:30:30Z"), 39.742476, -105.1786);
  EXPECT_NEAR(std::asin(double(d.y)) / degree, 39.872046, 0.01);
  EXPECT_NEAR(std::atan2(double(d.x), -double(d.z)) / degree + 360, 194.340241, 0.02);
  for (const char* bad :
       {"", "noon", "2024-13-01T00:00Z", "2024-02-30T00:00Z", "2023-02-29T00:00Z", "2024-01-01T24:00Z", "2024-01-01T00:00",
        "2024-01-01T00:00:00+01", "1900-01-01T00:00Z", "2024-01-01T-1:00Z", "2024-01-01T00:00:99Z"})
    EXPECT_THROW(parse_time(bad), Error) << bad;
  EXPECT_NO_THROW(parse_time("2024-02-29T23:59:59Z"));
  EXPECT_THROW(create<EmissionShader>("SkyEmission", {{"time", "2024-06-21T00:00Z"}}), Error);  // midnight at Greenwich
  EXPECT_NO_THROW(create<EmissionShader>("SkyEmission", {{"time", "2024-06-21T12:00Z"}}));
  EXPECT_THROW(create<EmissionShader>("SkyEmission", {{"sun_direction", List{1, -0.1, 0}}}), Error);
  EXPECT_THROW(create<EmissionShader>("SkyEmission", {{"ground_albedo", 1.5}}), Error);
}

// ---- projector ------------------------------------------------------------------------------------------------------

/// A projector at (0, 0, 5) that points along -z, with +y up: its right is +x.
Ref<SceneObject> projecting_point() {
  const Ref<SceneObject> point = create<SceneObject>("Point");
  point->transform = Transform::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0});
  point->prepare();
  return point;
}
std::vector<float> grey(const std::vector<float>& values) {
  std::vector<float> rgb;
  for (const float v : values) rgb.insert(rgb.end(), {v, v, v});
  return rgb;
}

TEST(ProjectorEmission, GeometryOfThePicture) {
  // Each of 4 x 2 pixels has its own grey, in blocks of 8 x 8 texels so that the blocks' centres are not blurred.
  std::vector<float> values(32 * 16);
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 32; ++x) values[size_t(y * 32 + x)] = float(1 + x / 8 + 4 * (y / 8));
  const ImageFile file("grid.exr", 32, 16, grey(values));
  const auto e = create<EmissionShader>("ProjectorEmission", {{"file", file.path}, {"fov", 90.0}});
  const Ref<SceneObject> point = projecting_point();
  const SurfacePoint p = point->sample_area({0.5f, 0.5f}, 0).point;
  const Wavelengths w = test::wavelengths();
  // 90 degrees at 5 m: the picture on the plane z = 0 is 10 m by 5 m. The irradiance there is I cos^3 / 25.
  const auto irradiance = [&](float x, float y) {
    const Vector3 d = normalize(Point3{x, y, 0} - p.position);
    return double(e->radiance(p, d, w)[0]) * std::pow(-double(d.z), 3) / 25;
  };
  const double unit = irradiance(-3.75f, 1.25f);  // the first block
  EXPECT_GT(unit, 0);
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_NEAR(irradiance(-3.75f + 2.5f * float(x), 1.25f - 2.5f * float(y)) / unit, 1 + x + 4 * y, 2e-3) << x << y;
  EXPECT_EQ(irradiance(5.01f, 0), 0);
  EXPECT_EQ(irradiance(0, 2.51f), 0);
  EXPECT_GT(irradiance(4.99f, 2.49f), 0);
  EXPECT_EQ(e->radiance(p, {0, 0, 1}, w)[0], 0);  // nothing behind
  const auto tall = create<EmissionShader>("ProjectorEmission", {{"file", file.path}, {"fov", 90.0}, {"fov_axis", "height"}});
  EXPECT_GT(tall->radiance(p, normalize(Point3{9.9f, 4.9f, 0} - p.position), w)[0], 0);
}

TEST(ProjectorEmission, AmountsAreThoseOfAWhiteImage) {
  const ImageFile white("white.exr", 3, 2, grey(std::vector<float>(6, 1))),
      dim("dim.exr", 3, 2, grey(std::vector<float>(6, 0.25f)));
  const Ref<SceneObject> point = projecting_point();
  const auto flux = [&](const EmissionShader& e) {
    double sum = 0;
    for (int lambda = 362; lambda < 830; lambda += 4) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, float(lambda), 1 / 470.0f);
      sum += 4 * 683.002 * observer(float(lambda)).y * double(e.power(*point, w)[0]);
    }
    return sum;
  };
  EXPECT_NEAR(flux(*create<EmissionShader>("ProjectorEmission", {{"file", white.path}, {"luminous_flux", 2000.0}})), 2000, 4);
  EXPECT_NEAR(flux(*create<EmissionShader>("ProjectorEmission", {{"file", dim.path}, {"luminous_flux", 2000.0}})), 500, 2);
  // 300 lx at 2 m over an area A, 2 * 2 m tan(20 deg) wide and two thirds of that high: 300 A lm.
  const double width = 4 * std::tan(20 * degree), area = width * width * 2 / 3;
  const auto lit =
      create<EmissionShader>("ProjectorEmission", {{"file", white.path}, {"illuminance", 300.0}, {"distance", 2.0}});
  EXPECT_NEAR(flux(*lit), 300 * area, 1e-3 * 300 * area);
}

TEST(ProjectorEmission, SamplesFollowDensityAndTheImage) {
  std::vector<float> values;
  test::Random noise(12);
  for (int i = 0; i < 24 * 12; ++i) values.push_back(i % 24 < 8 ? 0 : i == 100 ? 20 : noise());
  const ImageFile file("noise.exr", 24, 12, grey(values));
  const auto e = create<EmissionShader>("ProjectorEmission", {{"file", file.path}, {"fov", 100.0}});
  const Ref<SceneObject> point = projecting_point();
  const SurfacePoint p = point->sample_area({0.5f, 0.5f}, 0).point;
  const double half = std::tan(50 * degree), pixel = 4 * half * half / 2 / (24 * 12);
  std::vector<double> counts(24 * 12), expected(24 * 12);
  const auto direction = [&](double x, double y) {  // of a point in pixels; the image's right is +x
    return normalize(Vector3{float((x / 12 - 1) * half), float((1 - y / 6) * half / 2), -1});
  };
  constexpr int count = 100000;
  for (int i = 0; i < 24 * 12; ++i) {
    const Vector3 d = direction(i % 24 + 0.5, i / 24 + 0.5);
    expected[size_t(i)] = count * double(e->pdf(p, d)) * std::pow(-double(d.z), 3) * pixel;  // dw = cos^3 dA
  }
  test::Random random(13);
  double sum = 0, squares = 0;
  const Wavelengths w = test::wavelengths();
  for (int i = 0; i < count; ++i) {
    const DirectionSample s = e->sample(p, random.pair());
    ASSERT_GT(s.pdf, 0);
    const double x = (double(s.direction.x / -s.direction.z) / half + 1) * 12,
                 y = (1 - 2 * double(s.direction.y / -s.direction.z) / half) * 6;
    ++counts[size_t(std::clamp(int(y), 0, 11) * 24 + std::clamp(int(x), 0, 23))];
    const double value = double(e->radiance(p, s.direction, w)[0] / s.pdf);
    sum += value / count;
    squares += value * value / count;
  }
  EXPECT_GT(test::chi_square(counts, expected), 1e-3);
  EXPECT_NEAR(sum, double(e->power(*point, w)[0]), 0.02 * sum);
  EXPECT_LT(squares - sum * sum, 0.5 * sum * sum);
}

TEST(ProjectorEmission, AMapIsAsGoodAsAnImage) {
  // The same checks as an image of 2 x 2 unblurred blocks, and as a map, whose v grows upwards.
  std::vector<float> values(64 * 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) values[size_t(y * 64 + x)] = (x < 32) == (y < 16) ? 3.0f : 1.0f;
  const ImageFile file("checks.exr", 64, 32, grey(values));
  const Ref<ObjectMap> image = create<ObjectMap>("ImageMap", {{"file", file.path}, {"wrap", "clamp"}});
  const auto of_file = create<EmissionShader>("ProjectorEmission", {{"file", file.path}, {"scale", 2.0}});
  const auto of_map = create<EmissionShader>("ProjectorEmission", {{"picture", image}, {"scale", 2.0}, {"aspect", 2.0}});
  const Ref<SceneObject> point = projecting_point();
  const SurfacePoint p = point->sample_area({0.5f, 0.5f}, 0).point;
  const Wavelengths w = test::wavelengths();
  for (int i = 0; i < 100; ++i) {
    const Vector3 d = normalize(Vector3{0.36f * (float(i % 10) / 4.5f - 1), 0.18f * (float(i / 10) / 4.5f - 1), -1});
    const float wanted = of_file->radiance(p, d, w)[0];
    EXPECT_NEAR(of_map->radiance(p, d, w)[0], wanted, 1e-4f * wanted + 1e-6f) << i;
  }
  EXPECT_NEAR(of_map->power(*point, w)[0], of_file->power(*point, w)[0], 2e-3f * of_file->power(*point, w)[0]);
  test::Random random(15);
  double sum = 0;
  for (int i = 0; i < 20000; ++i) {
    const DirectionSample s = of_map->sample(p, random.pair());
    ASSERT_GT(s.pdf, 0);
    sum += double(of_map->radiance(p, s.direction, w)[0] / s.pdf) / 20000;
  }
  EXPECT_NEAR(sum, double(of_file->power(*point, w)[0]), 0.01 * sum);
  EXPECT_THROW(create<EmissionShader>("ProjectorEmission"), Error);
}

// ---- RGB as light without a white --------------------------------------------------------------------------------------

TEST(ReadAsMap, EqualPartsOfLightAreTheSameAtEveryWavelength) {
  const ImageFile file("grey.exr", 2, 2, grey({3, 3, 3, 3}));
  const Ref<ObjectMap> image = create<ObjectMap>("ImageMap", {{"file", file.path}});
  const Ref<ObjectMap> flat = create<ObjectMap>("ReadAsMap", {{"map", image}}),
                       light = create<ObjectMap>("ReadAsMap", {{"map", image}, {"as", "radiance"}});
  const Color d65 = rgb_space("srgb").illuminant;
  for (const float hero : {400.0f, 500.0f, 640.0f}) {
    const Wavelengths w = test::wavelengths(hero);
    for (const ColorUse use : {ColorUse::radiance, ColorUse::coefficient})
      for (int i = 0; i < spectrum_size; ++i) {
        EXPECT_NEAR(flat->color({}, w, use)[i], 3, 3e-3f);
        EXPECT_NEAR(light->color({}, w, use)[i], 3 * d65->at(w[i], ColorUse::radiance), 1e-2f);
      }
    EXPECT_EQ(flat->color({}, w, ColorUse::reflectance).maximum(), 1);  // reflectances are clamped to 1
  }
}

TEST(EnvironmentEmission, WithoutItsWhiteAnImageOfGreyIsFlat) {
  const ImageFile file("flat-sky.exr", 4, 2, grey(std::vector<float>(8, 2)));
  const auto e = create<EmissionShader>("EnvironmentEmission", {{"file", file.path}});
  set(*e, "illuminant", Value(false));
  e->prepare();
  const Wavelengths w = test::wavelengths();
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(seen(*e, {0, 0.6f, 0.8f}, w)[i], 2, 2e-3f);
  set(*e, "illuminance", Value(Number{100}));
  EXPECT_THROW(e->prepare(), Error);
}

TEST(EnvironmentEmission, RowsMayReachThePoles) {
  // Rows of 1, 4, 10 at v = 0, 1/2, 1, linear between them: radiance a + b v, whose mean over the sphere is known.
  const ImageFile file("rows.exr", 2, 3, grey({1, 1, 4, 4, 10, 10}));
  const auto e = create<EmissionShader>("EnvironmentEmission", {{"file", file.path}, {"rows", "poles"}}),
             one = create<EmissionShader>(
                 "EnvironmentEmission",
                 {{"radiance", create<ObjectMap>("ConstantMap", {{"value", rgb_color("srgb", 1, 1, 1)}})}});
  const Wavelengths w = test::wavelengths();
  const auto value = [&](double v) { return double(seen(*e, towards(180 * v, 20), w)[0] / seen(*one, {0, 1, 0}, w)[0]); };
  EXPECT_NEAR(value(0), 1, 1e-3);
  EXPECT_NEAR(value(0.25), 2.5, 1e-3);
  EXPECT_NEAR(value(0.5), 4, 1e-3);
  EXPECT_NEAR(value(0.75), 7, 1e-3);
  EXPECT_NEAR(value(1), 10, 1e-3);
  test::Random random(16);
  double sum = 0, total = 0;
  constexpr int n = 40000;
  for (int i = 0; i < n; ++i) {
    const DirectionSample s = e->sample_incident(random.pair());
    ASSERT_GT(s.pdf, 0);
    EXPECT_NEAR(e->incident_pdf(s.direction), s.pdf, 1e-3f * s.pdf);
    sum += double(seen(*e, s.direction, w)[0] / seen(*one, {0, 1, 0}, w)[0] / s.pdf) / n;
    total += double(e->incident_pdf(towards(std::acos(1 - 2 * double(random())) / degree, 33))) * 4 * M_PI / n;
  }
  // Integral over theta of (1 + 6 theta/pi | 4 + 12 (theta/pi - 1/2)) sin(theta) 2 pi, with v = theta / pi:
  // upper half: 1 + 6/pi (sin - theta cos) at pi/2 = 1 + 6/pi; lower: -2 * 1 + 12/pi (pi - 1) = 10 - 12/pi.
  EXPECT_NEAR(sum, 2 * M_PI * (11 - 6 / M_PI), 0.01 * sum);
  EXPECT_NEAR(total, 1, 0.01);
}

// A smooth sky is sampled in cells of some texels, one with a sun in single texels; either way samples have the pdf that is
// told of them, which integrates to one, and lead back to the numbers they came from.
TEST(EnvironmentEmission, CellsAreAsLargeAsCostsLittleVariance) {
  constexpr int width = 512, height = 256;
  std::vector<float> values(size_t(width * height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) values[size_t(y * width + x)] = 2 + std::sin(2 * float(M_PI) * float(x) / width);
  const ImageFile smooth("smooth.exr", width, height, grey(values));
  for (int y = 60; y < 62; ++y)
    for (int x = 100; x < 102; ++x) values[size_t(y * width + x)] = 1e5f;
  const ImageFile sunny("sunny.exr", width, height, grey(values));
  const auto emission = [](const ImageFile& file) {
    return create<EmissionShader>("EnvironmentEmission", {{"file", file.path}});
  };
  /// The directions of one row, half a texel apart, at which the pdf differs from that before.
  const auto steps = [](const EmissionShader& e) {
    int found = 0;
    float last = 0;
    for (int i = 0; i < 2 * width; ++i) {
      const float pdf = e.incident_pdf(towards(100.2, 360.0 * (i + 0.5) / (2 * width)));
      found += i > 0 && pdf != last;
      last = pdf;
    }
    return found;
  };
  const auto wide = emission(smooth), single = emission(sunny);
  EXPECT_LE(steps(*wide), 128);
  EXPECT_GE(steps(*single), 400);
  for (const EmissionShader* e : {wide.get(), single.get()}) {
    test::Random random(17);
    double total = 0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) {
      const Point2 u = random.pair();
      const DirectionSample s = e->sample_incident(u);
      ASSERT_GT(s.pdf, 0);
      const IncidentPlaces places = e->incident_places(s.direction);
      ASSERT_EQ(places.count, 1);
      // A direction at a border may be rounded into the neighbour, whose pdf is not far from its own.
      EXPECT_NEAR(e->incident_pdf(s.direction), s.pdf, 0.05f * s.pdf);
      EXPECT_NEAR(places.at[0].x, u.x, 2e-3f);
      EXPECT_NEAR(places.at[0].y, u.y, 2e-3f);
      if (e == wide.get())
        total += double(e->incident_pdf(towards(std::acos(1 - 2 * double(random())) / degree, 360 * double(random())))) * 4 *
                 M_PI / n;
    }
    if (e == wide.get()) EXPECT_NEAR(total, 1, 0.02);
  }
}

}  // namespace
}  // namespace etendue
