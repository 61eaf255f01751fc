// Emissions with all members away from their defaults: the light that leaves a lamp, over all directions and all of its area,
// adds up to the requested amount; profiles about slanted axes, back sides, textures on spheres, environments.

#include <gtest/gtest.h>

#include <fstream>

#include "components/emission/direction_table.h"
#include "etendue/describe/color.h"
#include "support/image_file.h"
#include "support/luminaire_test_support.h"

namespace etendue::test {
namespace {

constexpr double degree = M_PI / 180;

/// The integral of g over all directions by the midpoint rule, even in z and azimuth; with an even number of steps the
/// hemispheres about +z and -z consist of whole cells.
double over_sphere(const std::function<double(const Vector3&)>& g, int steps = 600, int sectors = 240) {
  double sum = 0;
  for (int i = 0; i < steps; ++i)
    for (int k = 0; k < sectors; ++k) {
      const double z = -1 + 2 * (i + 0.5) / steps, r = std::sqrt(1 - z * z), phi = 2 * M_PI * (k + 0.5) / sectors;
      sum += g({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)});
    }
  return sum * 4 * M_PI / (steps * sectors);
}

// A table of few, wide cells: samples are uniform within each of them, as bins that are much finer show.
TEST(EmissionFormulas, DirectionsAreEvenWithinTheCellsOfATable) {
  DirectionTable table;
  table.build({20, 60, 130}, {-30, 90, 250}, [](size_t row, size_t column) { return double(1 + row + 2 * column); });
  constexpr size_t rows = 22, columns = 28;
  constexpr int count = 200000;
  std::vector<double> counts(rows * columns), expected(rows * columns);
  Random random(71);
  for (int i = 0; i < count; ++i) {
    const DirectionSample s = table.sample(random.pair());
    const double theta = std::acos(double(s.direction.z)) / degree, phi = std::atan2(s.direction.y, s.direction.x) / degree;
    const double from_first = phi < -30 ? phi + 360 + 30 : phi + 30;
    ++counts[size_t((theta - 20) / 5) * columns + size_t(from_first / 10)];
  }
  double sum = 0;
  for (size_t row = 0; row < rows; ++row)
    for (size_t column = 0; column < columns; ++column) {
      const double band = std::cos((20 + 5 * double(row)) * degree) - std::cos((25 + 5 * double(row)) * degree);
      sum += expected[row * columns + column] = band * double(1 + (row >= 8) + 2 * (column >= 12));
    }
  for (double& e : expected) e *= count / sum;
  EXPECT_GT(chi_square(counts, expected), each_of(1));
}

/// Spectral power that leaves a lamp [W/nm] at the hero wavelength: integrated over points, by their pdf, and over all
/// directions.
double emitted(const SceneObject& lamp, int points = 4, int steps = 600, int sectors = 240) {
  const Wavelengths w = wavelengths(550);
  double sum = 0;
  for (int i = 0; i < points * points; ++i) {
    const SurfaceSample s =
        lamp.sample_area({(float(i % points) + 0.5f) / float(points), (float(i / points) + 0.5f) / float(points)}, 0);
    const bool point = s.point.normal == Normal3{};
    const double inner = over_sphere(
        [&](const Vector3& d) {
          return double(lamp.emission->radiance(s.point, d, w)[0]) * (point ? 1.0 : std::abs(double(dot(s.point.normal, d))));
        },
        steps, sectors);
    sum += inner / double(s.pdf) / (points * points);
  }
  return sum;
}

struct Profile {
  const char* name;
  const char* emission;
  std::function<double(double)> fall_off;  // of the cosine to the axis
  double borders[2];                       // angles where it is not smooth [deg]
};
const std::vector<Profile> profiles = {{"lobe",
                                        "CosineLobeEmission { radiance: 3, exponent: 4.5, axis: [1, 2, 2], about: axis",
                                        [](double c) { return c > 0 ? std::pow(c, 4.5) : 0; },
                                        {89.9, 90}},
                                       {"spot",
                                        "SpotEmission { radiance: 3, axis: [1, 2, 2], inner_angle: 25, outer_angle: 70",
                                        [](double c) {
                                          const double inner = std::cos(25 * M_PI / 180), outer = std::cos(70 * M_PI / 180);
                                          const double t = std::clamp((c - outer) / (inner - outer), 0.0, 1.0);
                                          return t * t * (3 - 2 * t);
                                        },
                                        {25, 70}},
                                       {"beam",
                                        "CollimatedEmission { radiance: 3, axis: [1, 2, 2], about: axis, divergence: 9",
                                        [](double c) { return c >= std::cos(9 * M_PI / 180) ? 1.0 : 0.0; },
                                        {9, 9.01}}};

// A profile about a slanted axis on a flat lamp: the radiance is f(angle to the axis) on the sides that emit, and power() is
// its integral.
TEST(EmissionFormulas, ProfilesAboutSlantedAxes) {
  const Vector3 axis = normalize(Vector3{1, 2, 2});
  const Wavelengths w = wavelengths(550);
  for (const Profile& p : profiles)
    for (const char* sides : {"front", "back", "both"})
      for (const char* normal : {"edge_u: [2, 0, 0], edge_v: [0, 1.5, 0]", "edge_u: [0, 0, 2], edge_v: [1, 0.5, 0]",
                                 "edge_u: [1, 0, 0], edge_v: [0, 0, 1]"}) {
        const Ref<SceneObject> lamp = prepared_as<SceneObject>(std::string("Rectangle { ") + normal +
                                                               ", emission: " + p.emission + ", sides: " + sides + " } }");
        const SurfacePoint point = lamp->sample_area({0.4f, 0.6f}, 0).point;
        const auto radiance = [&](const Vector3& d) {
          const bool front = dot(point.normal, d) > 0;
          if (std::string(sides) != "both" && front != (std::string(sides) == "front")) return 0.0;
          return 3 * p.fall_off(double(dot(d, axis)));
        };
        Random random(3);
        for (int i = 0; i < 300; ++i) {
          const Vector3 d = normalize(Vector3(axis) + (i % 2 ? 2.0f : 0.3f) * random.direction());
          if (std::abs(dot(d, axis) - std::cos(radians(9))) < 1e-4f) continue;
          EXPECT_NEAR(double(lamp->emission->radiance(point, d, w)[0]), radiance(d), 2e-4) << p.name << " " << sides;
        }
        // In spherical coordinates about the axis, with separate steps between the profile's borders.
        const auto flux = [&](const Vector3& d) { return radiance(d) * std::abs(double(dot(point.normal, d))); };
        const double power =
            double(lamp->area(0)) *
            integrate_around(axis, {0, one_minus_cosine(p.borders[0]), one_minus_cosine(p.borders[1]), 1}, flux, 500, 720);
        EXPECT_NEAR(double(lamp->emission->power(*lamp, w)[0]), power, 2e-3 * power + 1e-6)
            << p.name << " " << sides << " " << normal;
        // The pdf over directions integrates to the probability of samples on emitting sides; samples report that pdf.
        double covered = 0;
        for (int i = 0; i < 2000; ++i) {
          const DirectionSample s = lamp->emission->sample(point, random.pair());
          if (!(s.pdf > 0)) continue;
          covered += 1 / 2000.0;
          EXPECT_NEAR(lamp->emission->pdf(point, s.direction), s.pdf, 3e-3f * s.pdf) << p.name;
          EXPECT_GT(radiance(s.direction), -1e-9);
        }
        const double whole = integrate_around(
            axis, {0, one_minus_cosine(p.borders[0]), one_minus_cosine(p.borders[1]), 1},
            [&](const Vector3& d) { return double(lamp->emission->pdf(point, d)); }, 100, 144);
        EXPECT_NEAR(covered, whole, 0.05) << p.name << " " << sides;
      }
}

// The mean of radiance cos / pdf over the emission's own samples equals the estimate from uniform directions.
TEST(EmissionFormulas, DirectionsGiveThePower) {
  const Wavelengths w = wavelengths(550);
  for (const char* emission : {"DiffuseEmission { radiance: 2", "CosineLobeEmission { radiance: 2, exponent: 3",
                               "CosineLobeEmission { radiance: 2, exponent: 3, about: axis, axis: [0.2, 0.1, 1]",
                               "SpotEmission { radiance: 2, axis: [0.1, 0.3, 1], inner_angle: 30, outer_angle: 75",
                               "CollimatedEmission { radiance: 2, divergence: 8"})
    for (const char* sides : {"front", "back", "both"}) {
      const Ref<SceneObject> lamp =
          prepared_as<SceneObject>(std::string("Rectangle { edge_u: [2, 0, 0], edge_v: [0, 1.5, 0], transform: rotate(40, [1, "
                                               "1, 0]) * scale(1, 2, -1), emission: ") +
                                   emission + ", sides: " + sides + " } }");
      const SurfacePoint p = lamp->sample_area({0.4f, 0.6f}, 0).point;
      double sum = 0;
      constexpr int side = 200;
      for (int i = 0; i < side * side; ++i) {
        const DirectionSample s = lamp->emission->sample(p, {(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side});
        if (s.pdf > 0)
          sum += double(lamp->emission->radiance(p, s.direction, w)[0] * std::abs(dot(p.normal, s.direction)) / s.pdf) /
                 (side * side);
      }
      const double power = double(lamp->emission->power(*lamp, w)[0] / lamp->area(0));
      EXPECT_NEAR(sum, power, 4e-3 * power + 1e-4) << emission << " " << sides;
    }
}

// Amounts: the requested quantity is the one that leaves the lamp, or that arrives.
TEST(EmissionFormulas, AmountsAreWhatLeavesOrArrives) {
  // 1 W between 360 and 830 nm of a flat spectrum: 1 / 470 W/nm.
  for (const char* shape :
       {"Rectangle { edge_u: [2, 0, 0], edge_v: [0.4, 1.5, 0]", "Sphere { radius: 0.4",
        "Disc { radius: 2, transform: scale(1, 3, 1)", "Point { position: [1, 2, 3]", "Torus { radius: 1, tube_radius: 0.2"})
    for (const char* emission : {"DiffuseEmission { power: 1", "CosineLobeEmission { power: 1, exponent: 2",
                                 "SpotEmission { power: 1, axis: [0, 0.3, 1], inner_angle: 40, outer_angle: 80"}) {
      const Ref<SceneObject> lamp = prepared_as<SceneObject>(std::string(shape) + ", emission: " + emission + " } }");
      EXPECT_NEAR(emitted(*lamp, std::string(emission).starts_with("Spot") ? 12 : 6, 300, 120), 1 / 470.0, 0.012 / 470)
          << shape << emission;
    }
  const auto candelas = [](const SceneObject& lamp, const Vector3& direction) {  // intensity of the whole lamp in a direction
    const Wavelengths w = wavelengths(550);
    double sum = 0;
    constexpr int side = 40;
    for (int i = 0; i < side * side; ++i) {
      const SurfaceSample s = lamp.sample_area({(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side}, 0);
      const bool point = s.point.normal == Normal3{};
      sum += double(lamp.emission->radiance(s.point, direction, w)[0]) *
             (point ? 1 : std::abs(double(dot(s.point.normal, direction)))) / double(s.pdf) / (side * side);
    }
    return sum * 683.002 * observer_y_integral();
  };
  const Vector3 slanted = normalize(Vector3{0, 0.3f, 1});
  EXPECT_NEAR(
      candelas(*prepared_as<SceneObject>(
                   "Rectangle { edge_u: [2, 0, 0], edge_v: [0, 1, 0], emission: DiffuseEmission { luminous_intensity: 70 } }"),
               {0, 0, 1}),
      70, 0.1);
  EXPECT_NEAR(
      candelas(*prepared_as<SceneObject>("Sphere { radius: 0.3, emission: DiffuseEmission { luminous_intensity: 70 } }"),
               slanted),
      70, 0.3);
  EXPECT_NEAR(
      candelas(*prepared_as<SceneObject>("Point { emission: SpotEmission { luminous_intensity: 70, axis: [0, 0.3, 1] } }"),
               slanted),
      70, 0.1);
  EXPECT_NEAR(
      candelas(*prepared_as<SceneObject>("Point { emission: DiffuseEmission { illuminance: 50, distance: 3 } }"), slanted), 450,
      0.5);
  EXPECT_NEAR(candelas(*prepared_as<SceneObject>(
                           "Point { emission: SpotEmission { illuminance: 50, distance: 3, axis: [0, 0.3, 1] } }"),
                       slanted),
              450, 0.5);
  EXPECT_NEAR(candelas(*prepared_as<SceneObject>("Rectangle { edge_u: [0.02, 0, 0], edge_v: [0, 0.01, 0], emission: "
                                                 "CosineLobeEmission { illuminance: 50, distance: 3 } }"),
                       {0, 0, 1}),
              450, 0.5);
}

// An image around the scene: bilinear interpolation between texels; power and illuminance against integrals over its directions
// computed here.
TEST(EmissionFormulas, ImagesAroundTheScene) {
  const std::string path = testing::TempDir() + "emission_formulas.pfm";
  constexpr int width = 8, height = 4;
  const auto texel = [](int x, int y) {
    return 0.2f + 0.1f * float(((x % width) + width) % width) + 0.35f * float(y * y) + (x == 3 && y == 1 ? 2.0f : 0.0f);
  };
  {
    std::ofstream file(path, std::ios::binary);
    file << "PF\n" << width << " " << height << "\n-1.0\n";
    for (int y = height - 1; y >= 0; --y)
      for (int x = 0; x < width; ++x)
        for (int c = 0; c < 3; ++c) {
          const float v = texel(x, y);
          file.write(reinterpret_cast<const char*>(&v), 4);
        }
  }
  const Ref<SceneObject> sky =
      prepared_as<SceneObject>("Environment { emission: EnvironmentEmission { file: \"" + path + "\" } }");
  const auto seen = [&](const EmissionShader& e, const Vector3& d) {  // Y of a grey radiance; Y = 1 for 1 at all wavelengths
    SurfacePoint p;
    p.object_position = Point3{} + d;
    p.object = sky.get();
    double y = 0;
    for (int l = 370; l < 830; l += 20) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, float(l), 1);
      y += 20 * double(e.radiance(p, -d, w)[0]) * observer(float(l)).y / observer_y_integral();
    }
    return y;
  };
  const auto expected = [&](const Vector3& d) {
    double u = std::atan2(double(d.x), -double(d.z)) / (2 * M_PI), v = std::acos(std::clamp(double(d.y), -1.0, 1.0)) / M_PI;
    if (u < 0) u += 1;
    const double x = u * width - 0.5, y = std::clamp(v * height - 0.5, 0.0, height - 1.0);
    const int x0 = int(std::floor(x)), y0 = int(y), y1 = std::min(y0 + 1, height - 1);
    const double fx = x - x0, fy = y - y0;
    return (1 - fy) * ((1 - fx) * double(texel(x0, y0)) + fx * double(texel(x0 + 1, y0))) +
           fy * ((1 - fx) * double(texel(x0, y1)) + fx * double(texel(x0 + 1, y1)));
  };
  Random random(4);
  const double unit = seen(*sky->emission, {0, 0, -1}) / expected({0, 0, -1});
  EXPECT_NEAR(unit, 1, 0.01);
  for (int i = 0; i < 300; ++i) {
    const Vector3 d = random.direction();
    EXPECT_NEAR(seen(*sky->emission, d) / unit, expected(d), 4e-3 * expected(d)) << d.x << " " << d.y << " " << d.z;
  }
  // Directions are sampled with their pdf, which integrates to 1.
  EXPECT_NEAR(over_sphere([&](const Vector3& d) { return double(sky->emission->incident_pdf({d.y, d.z, d.x})); }), 1, 2e-3);
  double estimate = 0, exact = over_sphere([&](const Vector3& d) { return expected({d.y, d.z, d.x}); });
  constexpr int side = 60;
  for (int i = 0; i < side * side; ++i) {
    const DirectionSample s =
        sky->emission->sample_incident({(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side});
    estimate += expected(s.direction) / double(s.pdf) / (side * side);
  }
  EXPECT_NEAR(estimate, exact, 5e-3 * exact);
  // The requested illuminance on level ground is that of an image of constant texels, without interpolation.
  const Ref<SceneObject> asked =
      prepared_as<SceneObject>("Environment { emission: EnvironmentEmission { file: \"" + path + "\", illuminance: 1000 } }");
  double level = 0;
  for (int y = 0; y < height / 2; ++y)
    for (int x = 0; x < width; ++x) {
      const double top = std::cos(M_PI * y / height), bottom = std::cos(M_PI * (y + 1) / height);
      level += double(texel(x, y)) * M_PI / width * (top * top - bottom * bottom);
    }
  const double factor = 1000 / (683.002 * observer_y_integral() * level);
  EXPECT_NEAR(seen(*asked->emission, {0, 0, -1}) / seen(*sky->emission, {0, 0, -1}), factor, 1e-3 * factor);
  std::remove(path.c_str());
}

}  // namespace
}  // namespace etendue::test
