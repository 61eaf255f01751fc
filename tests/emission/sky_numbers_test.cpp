// The sky and its sun in numbers: the sun's irradiance and its sampling probability, against integrals computed here.

#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "etendue/emission_shader.h"
#include "etendue/infinite_object.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using test::Setting;

constexpr double degree = M_PI / 180;

Vector3 towards_sun(double elevation) { return {float(std::cos(elevation * degree)), float(std::sin(elevation * degree)), 0}; }

Ref<EmissionShader> sky(double elevation, bool sun, std::vector<Setting> settings = {}) {
  settings.emplace_back("sun_direction", std::vector<double>{std::cos(elevation * degree), std::sin(elevation * degree), 0});
  const Ref<EmissionShader> e = create<EmissionShader>("SkyEmission", settings);
  set(*e, "sun", Value(sun));
  prepare_tree(*e);
  return e;
}
Spectrum seen(const EmissionShader& e, const Vector3& direction, const Wavelengths& w) {
  SurfacePoint p;
  p.object_position = Point3{} + direction;
  return e.radiance(p, -direction, w);
}
Wavelengths one(float lambda) {
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) w.place(i, lambda, 1);
  return w;
}

/// The integral over a disc around the sun of f, by rings.
template <class F>
double over_disc(double elevation, double radius, F&& f) {
  const Frame frame{Normal3(towards_sun(elevation))};
  double sum = 0;
  constexpr int rings = 400, sectors = 16;
  const double h_end = 1 - std::cos(radius * degree);
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double h = h_end * (i + 0.5) / rings, r = std::sqrt(h * (2 - h)), phi = 2 * M_PI * (k + 0.5) / sectors;
      sum += f(frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(1 - h)})) * 2 * M_PI * h_end /
             (rings * sectors);
    }
  return sum;
}

// The irradiance perpendicular to the sunlight at each wavelength: the disc's mean radiance [W m^-2 sr^-1 nm^-1] of the
// published model (see sky_projector_test) times the solid angle of a disc of radius 959.63 arc seconds, whatever diameter the
// disc is drawn with.
TEST(SkyNumbers, IrradianceOfTheSun) {
  const struct {
    double elevation, turbidity, wavelength, radiance;
  } rows[] = {{60, 3, 400, 12008.3},   {60, 3, 520, 22332.1},   {60, 3, 680, 19649.0},  {10, 6.5, 400, 891.398},
              {10, 6.5, 520, 5567.06}, {10, 6.5, 680, 8642.97}, {35, 2.2, 520, 20461.1}};
  const double solid_angle = M_PI * std::pow(959.63 / 3600 * degree, 2);
  for (const auto& r : rows)
    for (const double diameter : {0.53313, 1.0, 3.0}) {
      const std::vector<Setting> settings = {{"turbidity", r.turbidity}, {"sun_diameter", diameter}};
      const Ref<EmissionShader> with = sky(r.elevation, true, settings), without = sky(r.elevation, false, settings);
      const Wavelengths w = one(float(r.wavelength));
      const auto of_sun = [&](const Vector3& d) { return double(seen(*with, d, w)[0] - seen(*without, d, w)[0]); };
      const double irradiance = over_disc(r.elevation, diameter / 2, of_sun), expected = r.radiance * solid_angle;
      // A large disc close to the horizon differs in brightness between top and bottom.
      EXPECT_NEAR(irradiance, expected, (diameter > 2 && r.elevation < 20 ? 0.008 : 0.001) * expected)
          << r.elevation << " " << r.wavelength << " " << diameter;
      // The sun's light ends at the disc's edge.
      const Frame around{Normal3(towards_sun(r.elevation))};
      for (const auto& [part, there] : {std::pair(0.997, true), {1.003, false}}) {
        const double angle = part * diameter / 2 * degree;
        EXPECT_EQ(of_sun(around.to_world({float(std::sin(angle)), 0, float(std::cos(angle))})) > 0, there) << part;
      }
    }
  EXPECT_NEAR(get(*sky(50, true), "sun_diameter").as<Number>()->value / degree, 2 * 959.63 / 3600, 2e-5);
}

// Beyond the model's last channel the radiance falls off like that of a black body of the sun's 5778 K.
TEST(SkyNumbers, BeyondRed) {
  const Ref<EmissionShader> e = sky(40, false);
  const auto at = [&](float lambda) { return double(seen(*e, Vector3{0, 1, 0}, one(lambda))[0]); };
  const auto planck = [](double nm) { return std::pow(nm, -5) / std::expm1(1.438777e7 / (nm * 5778)); };
  for (const float lambda : {740.0f, 780.0f, 830.0f})
    EXPECT_NEAR(at(lambda) / at(720), planck(double(lambda)) / planck(720), 1e-4) << lambda;
}

/// The integral of f(direction) over the upper hemisphere except a disc around the sun of a radius [deg].
template <class F>
double over_sky(double elevation, F&& f, double radius = 0) {
  double sum = 0;
  const Frame frame{Normal3(towards_sun(elevation))};
  // In rings about the sun, which are narrower near it.
  constexpr int rings = 700, sectors = 180;
  for (int i = 0; i < rings; ++i) {
    const auto ring = [&](int k) { return std::lerp(radius * degree, M_PI, std::pow(double(k) / rings, 2)); };
    const double a = ring(i), b = ring(i + 1), c = (a + b) / 2;
    for (int k = 0; k < sectors; ++k) {
      const double phi = 2 * M_PI * (k + 0.5) / sectors;
      const Vector3 d =
          frame.to_world({float(std::sin(c) * std::cos(phi)), float(std::sin(c) * std::sin(phi)), float(std::cos(c))});
      if (d.y > 0) sum += f(d) * (std::cos(a) - std::cos(b)) * 2 * M_PI / sectors;
    }
  }
  return sum;
}

double lux(const std::function<double(float)>& spectral) {
  double sum = 0;
  for (int l = 375; l <= 725; l += 10) sum += 10 * 683.002 * observer(float(l)).y * spectral(float(l));
  return sum;
}

// The requested illuminance arrives on level ground, from sky and sun weighted by their own cosines.
TEST(SkyNumbers, IlluminanceOnLevelGround) {
  for (const bool sun : {true, false})
    for (const double elevation : {20.0, 65.0}) {
      const Ref<EmissionShader> e = sky(elevation, sun, {{"illuminance", 1000.0}, {"sun_diameter", 2.0}, {"turbidity", 4.5}});
      // The model's channels are 40 nm apart, so a wavelength for every 20 nm is enough.
      const double level = lux([&](float l) {
        static thread_local std::map<std::tuple<bool, double, int>, double> known;
        const auto key = std::tuple(sun, elevation, int(l) / 20);
        const auto found = known.find(key);
        if (found != known.end()) return found->second;
        const Wavelengths middle = one(float(int(l) / 20 * 20 + 10));
        const auto on_level_ground = [&](const Vector3& d) { return double(seen(*e, d, middle)[0] * d.y); };
        return known[key] = over_sky(elevation, on_level_ground, 1) + over_disc(elevation, 1, on_level_ground);
      });
      EXPECT_NEAR(level, 1000, 3) << sun << " " << elevation;
    }
}

// The probability of sampling the sun is its fraction of all light, weighted by xbar + ybar + zbar.
TEST(SkyNumbers, ShareOfTheSun) {
  for (const auto& [elevation, turbidity] : {std::pair{12.0, 6.0}, {6.0, 4.0}}) {
    const Ref<EmissionShader> e = sky(elevation, true, {{"turbidity", turbidity}, {"sun_diameter", 1.0}}),
                              dark = sky(elevation, false, {{"turbidity", turbidity}});
    double sun_light = 0, sky_light = 0;
    for (int l = 360; l <= 720; l += 40) {  // the channels
      const Wavelengths w = one(float(l));
      const Xyz o = observer(float(l));
      const double weight = o.x + o.y + o.z;
      sky_light += weight * over_sky(elevation, [&](const Vector3& d) { return double(seen(*dark, d, w)[0]); });
      sun_light += weight * over_disc(elevation, 0.5,
                                      [&](const Vector3& d) { return double(seen(*e, d, w)[0] - seen(*dark, d, w)[0]); });
    }
    const double expected = sun_light / (sun_light + sky_light);
    ASSERT_TRUE(expected > 0.1 && expected < 0.9) << expected;
    const double inside = over_disc(elevation, 0.5, [&](const Vector3& d) { return double(e->incident_pdf(d)); });
    const double around = over_disc(elevation, 0.5, [&](const Vector3& d) { return double(dark->incident_pdf(d)); });
    EXPECT_NEAR((inside - around) / (1 - around), expected, 0.003 * expected) << elevation;
    // Samples fall within the disc with that probability.
    int count = 0;
    test::Random random(5);
    for (int i = 0; i < 20000; ++i)
      count += dot(e->sample_incident(random.pair()).direction, towards_sun(elevation)) > std::cos(0.5005 * degree);
    EXPECT_NEAR(count / 20000.0, inside, 0.012);
  }
}

// A wide sun of which half is below the horizon gives half of its light: its power, by which luminaires are chosen, and the
// requested illuminance are those of the visible part.
TEST(SkyNumbers, AWideSunOnTheHorizon) {
  for (const double elevation : {0.0, 2.0}) {
    const std::vector<Setting> settings = {{"sun_diameter", 12.0}, {"turbidity", 2.5}};
    const Ref<EmissionShader> e = sky(elevation, true, settings);
    const Ref<SceneObject> environment = create<SceneObject>("Environment");
    dynamic_cast<InfiniteObject&>(*environment).enclose({}, 1);
    for (const float l : {480.f, 600.f, 680.f}) {
      const Wavelengths w = one(l);
      const auto light = [&](const Vector3& d) { return d.y > 0 ? double(seen(*e, d, w)[0]) : 0; };
      const double all = over_sky(elevation, light, 6) + over_disc(elevation, 6, light);
      EXPECT_NEAR(double(e->power(*environment, w)[0]), all * double(environment->area(0)) / 4, 0.01 * all) << elevation << l;
    }
    std::vector<Setting> bright = settings;
    bright.emplace_back("illuminance", 1000.0);
    const Ref<EmissionShader> lit = sky(elevation, true, bright);
    const double level = lux([&](float l) {
      const Wavelengths w = one(l);
      const auto on_level_ground = [&](const Vector3& d) { return d.y > 0 ? double(seen(*lit, d, w)[0] * d.y) : 0; };
      return over_sky(elevation, on_level_ground, 6) + over_disc(elevation, 6, on_level_ground);
    });
    EXPECT_NEAR(level, 1000, 10) << elevation;
  }
}

// Right ascension and declination at noon, from almanacs (USNO): solstices, equinox and perihelion of 2024.
TEST(SkyNumbers, TheSunStandsWhereAlmanacsSay) {
  const struct {
    const char* time;
    double latitude, longitude, elevation;
  } rows[] = {{"2024-06-20T20:51:00Z", 23.44, -132.6, 89.2},  // solstice: the sun is above the tropic at noon there
              {"2024-12-21T12:00:00Z", 0, -0.4, 66.56},       // 90 - 23.44
              {"2024-03-20T03:06:00Z", 90, 0, 0.0},           // equinox: on the horizon of the pole
              {"2024-01-03T12:00:00Z", 0, 1.1, 67.2}};        // declination -22.8
  for (const auto& r : rows) {
    const Ref<EmissionShader> e = create<EmissionShader>(
        "SkyEmission", {{"time", r.time}, {"latitude", r.latitude}, {"longitude", r.longitude}, {"sun_diameter", 0.6}});
    // The sun is where the pdf is greatest.
    double best = 0;
    Vector3 sun{};
    test::Random random(7);
    for (int i = 0; i < 400; ++i) {
      const DirectionSample s = e->sample_incident(random.pair());
      if (double(s.pdf) > best) best = double(s.pdf), sun = s.direction;
    }
    EXPECT_NEAR(std::asin(double(sun.y)) / degree, r.elevation, 0.75) << r.time;
  }
}

}  // namespace
}  // namespace etendue
