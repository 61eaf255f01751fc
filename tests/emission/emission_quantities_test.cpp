// Emission given in watts, lumens, candelas and lux; lobes and beams.

#include "etendue/describe/color.h"
#include "etendue/emission_shader.h"
#include "etendue/infinite_object.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;
using List = std::vector<double>;

/// The integral of f over wavelengths by the trapezoidal rule in steps of 1 nm, with the weight K_m V if `to_the_eye`.
double integrate(const std::function<Spectrum(const Wavelengths&)>& f, bool to_the_eye) {
  double sum = 0;
  for (int lambda = 360; lambda <= 830; lambda += spectrum_size) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, std::min(float(lambda + i), 830.0f), 1 / 470.0f);
    const Spectrum s = f(w);
    for (int i = 0; i < spectrum_size && lambda + i <= 830; ++i) {
      const double end = lambda + i == 360 || lambda + i == 830 ? 0.5 : 1;
      sum += end * double(s[i]) * (to_the_eye ? 683.002 * observer(w[i]).y : 1);
    }
  }
  return sum;
}
double lumens(const EmissionShader& e, const SceneObject& o) {
  return integrate([&](const Wavelengths& w) { return e.power(o, w); }, true);
}
double watts(const EmissionShader& e, const SceneObject& o) {
  return integrate([&](const Wavelengths& w) { return e.power(o, w); }, false);
}
/// Luminance [cd/m^2]; for a point light, intensity [cd].
double luminance(const EmissionShader& e, const SurfacePoint& p, const Vector3& direction) {
  return integrate([&](const Wavelengths& w) { return e.radiance(p, normalize(direction), w); }, true);
}
SurfacePoint point_of(const SceneObject& o) { return o.sample_area({0.3f, 0.6f}, 0).point; }

const Color lamp = blackbody_spectrum(2856);

struct Objects {
  Ref<SceneObject> point = create<SceneObject>("Point"), sphere = create<SceneObject>("Sphere", {{"radius", 0.5}}),
                   disc = create<SceneObject>("Disc", {{"radius", 0.3}}),
                   rectangle = create<SceneObject>("Rectangle", {{"edge_u", List{2, 0, 0}}, {"edge_v", List{0, 1.5, 0}}}),
                   distant = create<SceneObject>("Distant", {{"direction", List{0.6, -0.8, 0}}}),
                   environment = create<SceneObject>("Environment");
};

TEST(EmissionQuantities, LumensOfACosineLobe) {
  const Objects o;
  for (const double n : {0.0, 1.0, 7.5, 2000.0}) {
    const auto e =
        create<EmissionShader>("CosineLobeEmission", {{"exponent", n}, {"luminous_flux", 800.0}, {"radiance", lamp}});
    EXPECT_NEAR(lumens(*e, *o.point), 800, 0.5) << n;
    EXPECT_NEAR(lumens(*e, *o.rectangle), 800, 0.5) << n;
    // I_0 = Phi (n + 1) / (2 pi) and L_0 = Phi (n + 2) / (2 pi A).
    const double intensity = 800 * (n + 1) / (2 * M_PI), radiance = 800 * (n + 2) / (2 * M_PI * 3);
    EXPECT_NEAR(luminance(*e, point_of(*o.point), {0, 0, 1}), intensity, 1e-3 * intensity) << n;
    EXPECT_NEAR(luminance(*e, point_of(*o.rectangle), {0, 0, 1}), radiance, 1e-3 * radiance) << n;
    const double fallen = radiance * std::pow(0.8, n);
    EXPECT_NEAR(luminance(*e, point_of(*o.rectangle), {0.6f, 0, 0.8f}), fallen, 1e-3 * fallen + 1e-9) << n;
    EXPECT_EQ(luminance(*e, point_of(*o.rectangle), {0.6f, 0, -0.8f}), 0);
  }
}

TEST(EmissionQuantities, TheShapeOfTheSpectrumIsThatOfTheRadiance) {
  const Objects o;
  const auto e = create<EmissionShader>("DiffuseEmission", {{"luminous_flux", 1000.0}, {"radiance", lamp}});
  const Wavelengths w = test::wavelengths();
  const Spectrum p = e->power(*o.disc, w);
  for (int i = 1; i < spectrum_size; ++i)
    EXPECT_NEAR(p[i] / p[0], lamp->at(w[i], ColorUse::radiance) / lamp->at(w[0], ColorUse::radiance), 1e-3 * p[i] / p[0]);
  // Green light at 555 nm gives 683 lm/W, by definition.
  const Color green = table_spectrum({554, 555, 556}, {0, 1, 0});
  const auto line = create<EmissionShader>("DiffuseEmission", {{"power", 1.0}, {"radiance", green}});
  EXPECT_NEAR(lumens(*line, *o.disc), 683.002, 0.01);
}

TEST(EmissionQuantities, Candelas) {
  const Objects o;
  const auto diffuse = create<EmissionShader>("DiffuseEmission", {{"luminous_intensity", 120.0}, {"radiance", lamp}});
  EXPECT_NEAR(luminance(*diffuse, point_of(*o.point), {0, 1, 0}), 120, 0.05);
  EXPECT_NEAR(luminance(*diffuse, point_of(*o.rectangle), {0, 0, 1}), 40, 0.02);  // over its 3 m^2
  EXPECT_NEAR(luminance(*diffuse, point_of(*o.sphere), Vector3(point_of(*o.sphere).normal)), 120 / (M_PI * 0.25), 0.1);
  const auto spot = create<EmissionShader>("SpotEmission", {{"luminous_intensity", 120.0}, {"axis", List{1, 2, 2}}});
  EXPECT_NEAR(luminance(*spot, point_of(*o.point), {1, 2, 2}), 120, 0.05);
  // On a surface, at 60 degrees to its normal: 120 = L A cos.
  const auto lobe = create<EmissionShader>(
      "CosineLobeEmission",
      {{"luminous_intensity", 120.0}, {"exponent", 5.0}, {"about", "axis"}, {"axis", List{0, std::sqrt(0.75), 0.5}}});
  EXPECT_NEAR(luminance(*lobe, point_of(*o.rectangle), {0, std::sqrt(0.75f), 0.5f}), 120 / (3 * 0.5), 0.05);
  EXPECT_THROW(diffuse->power(*o.environment, test::wavelengths()), Error);
}

TEST(EmissionQuantities, LuxAtADistance) {
  const Objects o;
  for (const double d : {0.2, 1.0, 5.0}) {
    const auto e = create<EmissionShader>("DiffuseEmission", {{"illuminance", 500.0}, {"distance", d}, {"radiance", lamp}});
    EXPECT_NEAR(luminance(*e, point_of(*o.point), {1, 0, 0}), 500 * d * d, 0.5 * d * d);
    // E = pi L R^2 / (R^2 + d^2) on the axis of a disc, pi L R^2 / d^2 for a sphere.
    const double of_disc = 500 / M_PI * (0.09 + d * d) / 0.09, of_sphere = 500 / M_PI * d * d / 0.25;
    EXPECT_NEAR(luminance(*e, point_of(*o.disc), {0, 0, 1}), of_disc, 2e-3 * of_disc) << d;
    EXPECT_NEAR(luminance(*e, point_of(*o.sphere), Vector3(point_of(*o.sphere).normal)), of_sphere, 1e-3 * of_sphere) << d;
  }
}

TEST(EmissionQuantities, LuxFromInfinity) {
  const Objects o;
  const auto diffuse = create<EmissionShader>("DiffuseEmission", {{"illuminance", 1000.0}, {"radiance", lamp}});
  const Ref<SceneObject> environment = o.environment, distant = o.distant;
  dynamic_cast<InfiniteObject&>(*environment).enclose({0, 0, 0}, 3);
  dynamic_cast<InfiniteObject&>(*distant).enclose({0, 0, 0}, 3);
  const auto seen = [](const EmissionShader& e, const SceneObject& from, const Vector3& towards) {
    Ray ray;
    ray.direction = normalize(towards);
    SurfacePoint p;
    from.surface_point(ray, {}, p);
    return luminance(e, p, -ray.direction);
  };
  EXPECT_NEAR(seen(*diffuse, *environment, {0.3f, 0.2f, 0.1f}), 1000 / M_PI, 0.3);
  EXPECT_NEAR(seen(*diffuse, *distant, {-0.6f, 0.8f, 0}), 1000, 0.5);  // L * 1 sr
  // A round sun of 5 degrees around its axis: E = pi L sin^2.
  const auto sun = create<EmissionShader>(
      "SpotEmission", {{"illuminance", 1000.0}, {"axis", List{1, -1, 0}}, {"inner_angle", 5.0}, {"outer_angle", 5.0}});
  EXPECT_NEAR(seen(*sun, *environment, {-1, 1, 0}), 1000 / (M_PI * std::pow(std::sin(5 * M_PI / 180), 2)), 50);
  const auto map = create<EmissionShader>("EnvironmentEmission", {{"illuminance", 1000.0}, {"radiance", lamp}, {"scale", 7.0}});
  EXPECT_NEAR(seen(*map, *environment, {1, 0, 0}), 1000 / M_PI, 0.3);
}

TEST(EmissionQuantities, OfATexture) {
  const Objects o;
  const Ref<ObjectMap> checker = create<ObjectMap>(
      "CheckerMap", {{"first", rgb_color("srgb", 1, 0, 0)}, {"second", rgb_color("srgb", 0, 0, 3)}, {"repeat", List{4, 4, 4}}});
  for (const char* kind : {"DiffuseEmission", "CosineLobeEmission", "SpotEmission"}) {
    const auto flux = create<EmissionShader>(kind, {{"radiance", checker}, {"luminous_flux", 250.0}});
    EXPECT_NEAR(lumens(*flux, *o.rectangle), 250, 1) << kind;  // 48 wavelengths represent a smooth spectrum
    const auto power = create<EmissionShader>(kind, {{"radiance", checker}, {"power", 5.0}});
    EXPECT_NEAR(watts(*power, *o.rectangle), 5, 0.02) << kind;
  }
}

TEST(EmissionQuantities, OnlyOneOfThem) {
  EXPECT_THROW(create<EmissionShader>("DiffuseEmission", {{"power", 1.0}, {"luminous_flux", 1.0}}), Error);
  EXPECT_THROW(create<EmissionShader>("SpotEmission", {{"luminous_intensity", 1.0}, {"illuminance", 1.0}}), Error);
  EXPECT_THROW(create<EmissionShader>("DiffuseEmission", {{"luminous_flux", 1.0}, {"radiance", 0.0}}), Error);
}

// ---- lobes and beams ------------------------------------------------------------------------------------------------

struct Case {
  const char* kind;
  std::vector<test::Setting> settings;
};
const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"CosineLobeEmission", {{"exponent", 0.0}}},
      {"CosineLobeEmission", {{"exponent", 12.5}}},
      {"CosineLobeEmission", {{"exponent", 3.0}, {"about", "axis"}, {"axis", List{1, 0.5, 1}}}},
      {"CollimatedEmission", {{"divergence", 10.0}}},
      {"CollimatedEmission", {{"divergence", 8.0}, {"about", "axis"}, {"axis", List{1, 0, -2}}}}};
  return all;
}

TEST(Lobes, PowerIsTheIntegralOverAreaAndDirections) {
  const Objects o;
  test::Random random(31);
  const Wavelengths w = test::wavelengths();
  for (const Case& c : cases())
    for (const char* sides : {"front", "back", "both"})
      for (const double flux : {0.0, 70.0}) {
        std::vector<test::Setting> settings = c.settings;
        settings.insert(settings.end(), {{"sides", sides}, {"luminous_flux", flux}, {"radiance", lamp}});
        const auto e = create<EmissionShader>(c.kind, settings);
        for (const SceneObject* object : {o.rectangle.get(), o.disc.get()}) {
          double sum = 0, squares = 0;
          constexpr int count = 4000;
          for (int i = 0; i < count; ++i) {
            const SurfaceSample s = object->sample_area(random.pair(), 0);
            const DirectionSample d = e->sample(s.point, random.pair());
            if (!(d.pdf > 0)) continue;
            const double value = double(e->radiance(s.point, d.direction, w)[0]) *
                                 std::abs(double(dot(s.point.normal, d.direction))) / double(d.pdf * s.pdf);
            sum += value;
            squares += value * value;
          }
          const double error = std::sqrt(std::max(squares / count - std::pow(sum / count, 2), 0.0) / count);
          // An emission whose lobe lies entirely on a dark side has no power to scale, so an amount throws Error.
          if (flux > 0 && sum == 0) {
            EXPECT_THROW(e->power(*object, w), Error);
          } else {
            const double power = double(e->power(*object, w)[0]);
            EXPECT_NEAR(sum / count, power, 4.5 * error + 2e-3 * power) << c.kind << " " << sides << " " << flux;
            if (flux > 0) {
              EXPECT_NEAR(lumens(*e, *object), flux, 0.1);
            }
          }
        }
      }
}

TEST(Lobes, SamplesFollowDensity) {
  constexpr int rows = 40, columns = 8, count = 40000;
  const Objects o;
  std::uint32_t seed = 40;
  for (const Case& c : cases()) {
    if (c.kind == std::string("CollimatedEmission")) continue;  // see ABeamIsUniform
    for (const char* sides : {"front", "back", "both"})
      for (const bool on_point : {false, true}) {
        std::vector<test::Setting> settings = c.settings;
        settings.emplace_back("sides", sides);
        const auto e = create<EmissionShader>(c.kind, settings);
        const SurfacePoint p = on_point ? point_of(*o.point) : test::surface_point();
        test::Random random(seed++);
        double drawn = 0, total = 0;
        std::vector<double> counts(size_t(rows * columns));
        const Frame frame(Normal3{0.2f, 0.5f, 0.84f});
        for (int i = 0; i < count; ++i) {
          const DirectionSample s = e->sample(p, random.pair());
          if (!(s.pdf > 0)) continue;
          EXPECT_NEAR(s.pdf, e->pdf(p, s.direction), 2e-3f * s.pdf);
          EXPECT_TRUE(e->emits(p, s.direction));
          ++drawn;
          ++counts[test::cell_of(frame, rows, columns, s.direction)];
        }
        // The expected counts, from the pdf on a uniform grid of directions, which is fine enough for these smooth pdfs.
        std::vector<double> expected(counts.size());
        constexpr int grid = 360;
        for (int i = 0; i < grid * grid; ++i) {
          const double z = -1 + 2 * (i % grid + 0.5) / grid, phi = 2 * M_PI * (i / grid + 0.5) / grid, r = std::sqrt(1 - z * z);
          const Vector3 d = frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
          const double part = double(e->pdf(p, d)) * 4 * M_PI / (grid * grid);
          total += part;
          expected[test::cell_of(frame, rows, columns, d)] += part * count;
        }
        EXPECT_NEAR(drawn / count, total, 0.008) << c.kind << sides << on_point;
        EXPECT_GT(test::chi_square(counts, expected), test::each_of(18)) << c.kind << sides << on_point;
      }
  }
}

TEST(Lobes, ABeamIsUniform) {
  // Uniform in h = 1 - cos and in the angle around the axis.
  const auto e = create<EmissionShader>("CollimatedEmission", {{"divergence", 0.1}});
  const SurfacePoint p = test::surface_point();
  const Frame frame(p.normal);
  const double widest = 1 - std::cos(0.1 * M_PI / 180);
  constexpr int rows = 10, columns = 8, count = 40000;
  std::vector<double> counts(rows * columns);
  test::Random random(77);
  for (int i = 0; i < count; ++i) {
    const DirectionSample s = e->sample(p, random.pair());
    const Vector3 v = frame.to_local(s.direction);
    const double h = (double(v.x) * double(v.x) + double(v.y) * double(v.y)) / 2;
    double turn = std::atan2(double(v.y), double(v.x)) / (2 * M_PI);
    if (turn < 0) turn += 1;
    ++counts[size_t(std::min(int(h / widest * rows), rows - 1) * columns + std::min(int(turn * columns), columns - 1))];
    EXPECT_NEAR(s.pdf * 2 * M_PI * widest, 1, 1e-3);
  }
  EXPECT_GT(test::chi_square(counts, std::vector<double>(counts.size(), count / double(counts.size()))), 1e-3);
}

}  // namespace
}  // namespace etendue
