// Procedural maps: noise and maps made of it, patterns, and their means over the footprint.

#include "components/maps/noise.h"
#include "components/maps/periodic.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

using test::create;

Vector3 anywhere(test::Random& random, float range = 1000) {
  return {range * random() - range / 2, range * random() - range / 2, range * random() - range / 2};
}

TEST(Noise, IsZeroOnTheLatticeAndWhereThereIsNone) {
  for (int x = -3; x < 4; ++x)
    for (int y = -3; y < 4; ++y)
      for (int z = -3; z < 4; ++z) EXPECT_EQ(perlin_noise({float(x), float(y), float(z)}, 3), 0);
  EXPECT_EQ(perlin_noise({NAN, 0.5f, 0.5f}), 0);
  EXPECT_EQ(perlin_noise({0.5f, infinity, 0.5f}), 0);
  EXPECT_EQ(perlin_noise({0.5f, 0.5f, 3e20f}), 0);
  EXPECT_NE(perlin_noise({0.3f, 0.6f, 0.2f}, 1), perlin_noise({0.3f, 0.6f, 0.2f}, 2));
}

TEST(Noise, HasTheMeansItClaims) {
  // Points of different lattice cubes are independent; 4.4 standard errors are exceeded once in 10^5.
  test::Random random(1);
  constexpr int n = 300000;
  double sum = 0, squares = 0, absolute = 0;
  for (int i = 0; i < n; ++i) {
    const double x = double(perlin_noise(anywhere(random)));
    ASSERT_LE(std::abs(x), 1.04);
    sum += x;
    squares += x * x;
    absolute += std::abs(x);
  }
  const double deviation = std::sqrt(squares / n);
  EXPECT_NEAR(deviation, 0.27, 0.01);
  EXPECT_LT(std::abs(sum / n), 4.4 * deviation / std::sqrt(n));
  EXPECT_NEAR(absolute / n, double(Octaves::mean_absolute), 4.4 * 0.16 / std::sqrt(n));
}

TEST(Noise, HasTwoContinuousDerivatives) {
  test::Random random(2);
  const float h = 1e-2f;
  for (int i = 0; i < 2000; ++i) {
    // Across a lattice plane, and at other points.
    Vector3 p = anywhere(random, 16);
    if (i % 2) p.x = std::round(p.x);
    const auto at = [&](float dx) { return double(perlin_noise({p.x + dx, p.y, p.z})); };
    const double before = (at(0) - at(-h)) / double(h), after = (at(h) - at(0)) / double(h);
    EXPECT_LT(std::abs(before), 4);                            // no steps
    EXPECT_LT(std::abs(after - before), 20 * double(h)) << i;  // no creases: the second derivative stays below 20
    // Nor are there jumps of the second derivative, which a cubic fade has on the lattice planes.
    const double third = (at(2 * h) - 3 * at(h) + 3 * at(0) - at(-h)) / std::pow(double(h), 2);
    EXPECT_LT(std::abs(third), 3.0) << i;
  }
}

TEST(Noise, FadesAsAnAverageOverTheFootprintDoes) {
  // The best factor for the value at the middle of a square is E[mean * value] / E[value^2]. The formula, (1 - w^2 / 8)^4, may
  // differ from it by 0.012 and 0.006 for widths up to one feature, and by 0.1 where little is left.
  struct Row {
    float width;
    double formula, off;
  };
  test::Random random(3);
  for (const Row& row : {Row{0.5f, 0.880738, 0.012}, Row{1, 0.586182, 0.006}, Row{2, 0.0625, 0.1}}) {
    EXPECT_NEAR(double(noise_remains(row.width)), row.formula, 2e-6);
    double product = 0, squares = 0, residuals = 0;
    constexpr int n = 300000;
    for (int i = 0; i < n; ++i) {
      const Vector3 p = anywhere(random);
      const Frame frame{Normal3(random.direction())};
      double mean = 0;
      for (int k = 0; k < 36; ++k)
        mean +=
            double(perlin_noise(p + row.width * ((float(k % 6) - 2.5f) / 6 * frame.s + (float(k / 6) - 2.5f) / 6 * frame.t))) /
            36;
      const double value = double(perlin_noise(p));
      product += mean * value;
      squares += value * value;
      residuals += std::pow((mean - row.formula * value) * value, 2);
    }
    const double error = std::sqrt(residuals) / squares;
    EXPECT_NEAR(product / squares, row.formula, row.off + 4.4 * error) << row.width;
    EXPECT_LT(error, 0.002);
  }
  EXPECT_EQ(noise_remains(0), 1);
  EXPECT_EQ(noise_remains(3), 0);
}

TEST(Octaves, AreBandLimited) {
  test::Random random(4);
  const Octaves many{8, 2, 0.5f, 5}, few{3, 2, 0.5f, 5};
  const auto total = [](int n) { return 2 - std::pow(0.5f, float(n - 1)); };
  // Octave i vanishes when 2^i times the width exceeds sqrt(8): here all from the fourth on.
  const float width = 0.36f;
  for (int i = 0; i < 200; ++i) {
    const Vector3 p = anywhere(random);
    EXPECT_NEAR(many.fbm(p, width) * total(8), few.fbm(p, width) * total(3), 1e-5f);
    EXPECT_EQ(many.fbm(p, 3), 0);
    EXPECT_NEAR(many.turbulence(p, 3), Octaves::mean_absolute, 1e-6f);
  }
}

TEST(Octaves, AreWavesTwiceAsFineAndHalfAsHigh) {
  // Two octaves: (noise(p) + gain noise(lacunarity p)) / (1 + gain), each with a seed of its own.
  test::Random random(10);
  for (int i = 0; i < 200; ++i) {
    const Vector3 p = anywhere(random, 16);
    EXPECT_NEAR((Octaves{2, 2, 0.5f, 5}.fbm(p, 0)), (perlin_noise(p, 5) + 0.5f * perlin_noise(2 * p, 6)) / 1.5f, 1e-5f);
    EXPECT_NEAR((Octaves{2, 3, 0.8f, 5}.turbulence(p, 0)),
                (std::abs(perlin_noise(p, 5)) + 0.8f * std::abs(perlin_noise(3 * p, 6))) / 1.8f, 1e-5f);
  }
}

TEST(Periodic, MeansAreIntegrals) {
  test::Random random(5);
  for (int i = 0; i < 200; ++i) {
    const float x = 20 * random() - 10, width = 4 * random() * random() + 1e-3f, begin = 0.4f * random(),
                end = 0.5f + 0.5f * random();
    double square = 0, pulse = 0;
    constexpr int n = 4000;
    for (int k = 0; k < n; ++k) {
      const float at = x + width * ((float(k) + 0.5f) / n - 0.5f), t = at - std::floor(at);
      square += int(std::floor(at)) % 2 == 0 ? 1 : -1;
      pulse += t >= begin && t <= end ? 1 : 0;
    }
    EXPECT_NEAR(square_wave_mean(x, width), square / n, 4e-3f) << x << " " << width;
    EXPECT_NEAR(pulse_mean(x, width, begin, end), pulse / n, 4e-3f) << x << " " << width;
  }
}

/// A point of a square of one metre, seen from above, so that its footprint is a square along u and v.
SurfacePoint square_point(const SceneObject& square, float u, float v, float footprint) {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.object = &square;
  p.uv = {u, v};
  p.position = p.object_position = {u, v, 0};
  p.footprint = footprint;
  return p;
}

TEST(Patterns, FilteredIsTheMeanOfSharp) {
  test::TestSquare square(1);
  square.reference();
  const std::vector<Ref<ObjectMap>> maps = {
      create<ObjectMap>("CheckerMap", {{"repeat", std::vector<double>{5, 7, 1}}}),
      create<ObjectMap>("CheckerMap", {{"repeat", std::vector<double>{5, 7, 3}}, {"space", "object"}}),
      create<ObjectMap>("BricksMap", {{"repeat", std::vector<double>{3, 9}}, {"joint", 0.3}, {"shift", 0.4}}),
      create<ObjectMap>("RampMap",
                        {{"positions", std::vector<double>{0.1, 0.4, 0.8}}, {"colors", std::vector<double>{0.3, 0.9, 0.1}}}),
      create<ObjectMap>("RampMap", {{"positions", std::vector<double>{0.1, 0.4, 0.8}},
                                    {"colors", std::vector<double>{0.3, 0.9, 0.1}},
                                    {"along", "v"},
                                    {"interpolation", "smooth"}}),
      create<ObjectMap>("RampMap", {{"positions", std::vector<double>{0.1, 0.4, 0.8}},
                                    {"colors", std::vector<double>{0.3, 0.9, 0.1}},
                                    {"interpolation", "step"}}),
  };
  test::Random random(6);
  for (size_t m = 0; m < maps.size(); ++m)
    for (int i = 0; i < 8; ++i) {
      const float u = random(), v = random(), width = i < 4 ? 0.3f * random() : 2 * random();
      double mean = 0;
      constexpr int n = 250;
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
          mean += double(maps[m]->scalar(
              square_point(square, u + width * ((float(x) + 0.5f) / n - 0.5f), v + width * ((float(y) + 0.5f) / n - 0.5f), 0)));
      EXPECT_NEAR(maps[m]->scalar(square_point(square, u, v, width)), mean / (n * n), 8e-3f)
          << m << " at " << u << " " << v << " over " << width;
    }
}

// The mean of 3 t^2 - 2 t^3 from 0 to b is b^2 - b^3 / 2.
TEST(Patterns, SmoothRampsAreIntegrated) {
  test::TestSquare square(1);
  square.reference();
  const Ref<ObjectMap> ramp = create<ObjectMap>("RampMap", {{"interpolation", "smooth"}});
  for (const float b : {0.2f, 0.5f, 0.75f, 1.0f})
    EXPECT_NEAR(ramp->scalar(square_point(square, b / 2, 0.5f, b)), b * b * (1 - b / 2), 1e-5f) << b;
}

// On a square of one metre rows are 1/9 m high and their joints 0.3 of that, 1/30 m: a tenth of the length of bricks of 1/3 m.
TEST(Patterns, BricksHaveJointsOfOneThickness) {
  test::TestSquare square(1);
  square.reference();
  const Ref<ObjectMap> wall =
      create<ObjectMap>("BricksMap", {{"repeat", std::vector<double>{3, 9}}, {"joint", 0.3}, {"brick", 1.0}, {"mortar", 0.0}});
  double along = 0, up = 0;
  constexpr int n = 9000;
  for (int i = 0; i < n; ++i) {
    const float t = (float(i) + 0.5f) / n;
    along += double(wall->scalar(square_point(square, t, 0.5f / 9, 0))) / n;  // through the lowest row
    if (i < n / 9) up += double(wall->scalar(square_point(square, 0.5f / 3, t, 0))) / (n / 9.0);
  }
  EXPECT_NEAR(along, 1 - 3.0 / 30, 2e-3);
  EXPECT_NEAR(up, 1 - 9.0 / 30, 2e-3);
}

TEST(Patterns, SolidTexturesFadeToTheirMeans) {
  test::TestSquare square(1);
  square.reference();
  test::Random random(7);
  for (const char* name : {"NoiseMap", "FbmMap", "TurbulenceMap", "MarbleMap", "WoodMap"}) {
    const Ref<ObjectMap> map = create<ObjectMap>(name, {{"first", 0.0}, {"second", 1.0}, {"size", 1.0}});
    double sum = 0, squares = 0;
    constexpr int n = 40000;
    SurfacePoint p = square_point(square, 0, 0, 0);
    for (int i = 0; i < n; ++i) {
      p.object_position = Point3{} + anywhere(random);
      const double x = double(map->scalar(p));
      sum += x;
      squares += x * x;
    }
    p.position = p.object_position;
    p.footprint = 500;  // coarser than any displacement of the pattern
    const double error = std::sqrt((squares / n - sum * sum / n / n) / n);
    EXPECT_NEAR(double(map->scalar(p)), sum / n, 4.4 * error + 1e-3) << name;
  }
}

TEST(Patterns, TexturesStayWithTheirObject) {
  // The same object ten times as large, seen with a footprint ten times as wide, has the same texture.
  const Ref<SceneObject> small = create<SceneObject>("Sphere");
  const Ref<SceneObject> large = create<SceneObject>("Sphere");
  set(*large, "transform",
      Value(Transform::translate({3, -2, 5}) * Transform::rotate(0.7f, {1, 2, 3}) * Transform::scale({10, 10, 10})));
  prepare_tree(*large);
  const Ref<ObjectMap> map = create<ObjectMap>("FbmMap", {{"size", 0.3}});
  test::Random random(8);
  for (int i = 0; i < 50; ++i) {
    SurfacePoint a = small->sample_area(random.pair(), 0).point, b = a;
    b.object = large.get();
    b.position = large->transform.still()(a.object_position);
    b.normal = normalize(large->transform.still()(a.object_normal));
    a.footprint = 0.02f;
    b.footprint = 0.2f;
    EXPECT_NEAR(map->scalar(a), map->scalar(b), 1e-4f);
  }
}

TEST(CellularMap, DistancesAreDistances) {
  const auto map = [](const char* measure) { return create<ObjectMap>("CellularMap", {{"measure", measure}, {"size", 0.5}}); };
  const Ref<ObjectMap> nearest = map("nearest"), second = map("second_nearest"), difference = map("difference"),
                       cell = map("cell");
  test::Random random(9);
  SurfacePoint p = test::surface_point();
  const float large = 1000;  // a footprint for which the map returns its mean
  for (int i = 0; i < 20000; ++i) {
    p.object_position = Point3{} + anywhere(random);
    p.footprint = 0;
    const float f1 = nearest->scalar(p), f2 = second->scalar(p), d = difference->scalar(p), c = cell->scalar(p);
    EXPECT_LE(f1, f2);
    if (f2 < 1) {
      EXPECT_NEAR(d, f2 - f1, 1e-6f);
    }
    // The distance to a set changes by no more than the distance moved; an overlooked feature point would make it jump.
    const Vector3 step = 0.05f * random.direction();
    p.object_position = p.object_position + step;
    const float moved = length(step) / 0.5f + 2e-4f;
    EXPECT_LE(std::abs(nearest->scalar(p) - f1), moved);
    EXPECT_LE(std::abs(second->scalar(p) - f2), moved);
    if (d > 2 * moved) {
      EXPECT_EQ(cell->scalar(p), c);  // still the same cell
    }
  }
  p.footprint = large;
  EXPECT_NEAR(nearest->scalar(p), 0.5202f, 1e-4f);
}

TEST(HypertextureMap, IsABallWithASoftBorder) {
  const auto map = [](double bias, double contrast, double disturbance) {
    return create<ObjectMap>("HypertextureMap",
                             {{"bias", bias}, {"contrast", contrast}, {"disturbance", disturbance}, {"softness", 0.4}});
  };
  SurfacePoint p = test::surface_point();
  const auto at = [&](const Ref<ObjectMap>& m, float x) {
    p.object_position = {x, 0, 0};
    return m->scalar(p);
  };
  const Ref<ObjectMap> plain = map(0.5, 0.5, 0);
  EXPECT_EQ(at(plain, 0), 1);
  EXPECT_EQ(at(plain, 2), 0);
  EXPECT_NEAR(at(plain, 0.9f), 0.75f, 1e-5f);
  EXPECT_NEAR(at(map(0.8, 0.5, 0), 1), 0.8f, 1e-5f);
  EXPECT_NEAR(at(map(0.5, 0.9, 0), 1), 0.5f, 1e-5f);
  EXPECT_GT(at(map(0.5, 0.9, 0), 0.9f), 0.9f);
  EXPECT_LT(at(map(0.5, 0.5, 2), 0.93f), at(plain, 0.93f));  // turbulence can only remove density
}

}  // namespace
}  // namespace etendue
