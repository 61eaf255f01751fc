// The shading language's noises: values that the language fixes (as the reference implementation prints them), derivatives,
// periods, ranges.

#include "call_library.h"

namespace etendue::osl::test {

namespace {

Value point(float x, float y, float z) { return {Base::point, Triple(x, y, z)}; }

void expect_near(const Triple& a, const Triple& b, float tolerance) {
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[k], b[k], tolerance) << k;
}

}  // namespace

TEST(OslNoise, HashesAreTheLanguages) {
  EXPECT_EQ(integer("int hash(float u)", {0.25f}), -1518044388);
  EXPECT_EQ(integer("int hash(float u, float v)", {0.75f, 0.25f}), -802388107);
  EXPECT_EQ(integer("int hash(point p)", {point(0.25f, 0.75f, 1)}), 451400267);
  EXPECT_EQ(integer("int hash(point p, float t)", {point(0.75f, 0.75f, 1), 0.75f}), -626565092);
}

TEST(OslNoise, PerlinsValues) {
  expect_near(triple("TYPE noise(point p)", {point(0.5f, 0.5f, 1)}), {0.5f, 0.193125f, 0.37725f}, 1e-6f);
  EXPECT_NEAR(number("TYPE cellnoise(float x, float y)", {0.5f, 0.5f}), 0.860313, 1e-6);
  // Of an implementation that does one corner after the other.
  expect_near(triple("TYPE snoise(float x)", {1.37f}), {0.404237f, 0.558718f, 0.332139f}, 1e-6f);
  expect_near(triple("TYPE snoise(float x, float y)", {1.37f, -2.21f}), {-0.123012f, 0.58238f, -0.722636f}, 1e-6f);
  expect_near(triple("TYPE snoise(point p, float t)", {point(1.37f, -2.21f, 0.64f), 3.13f}),
              {-0.0845915f, -0.342004f, 0.230586f}, 1e-6f);
  // Zero at lattice points, also negative and large ones.
  for (const float x : {0.0f, -7.0f, 123456.0f}) {
    EXPECT_EQ(number("TYPE snoise(float x)", {x}), 0);
    EXPECT_EQ(number("TYPE noise(point p, float t)", {point(x, 1, -2), x}), 0.5f);
  }
  EXPECT_EQ(number("TYPE cellnoise(float x)", {-0.5f}), number("TYPE cellnoise(float x)", {-1.0f}));
}

TEST(OslNoise, NamesMeanTheSameAsFunctions) {
  const Value p = point(0.3f, -1.7f, 2.2f);
  EXPECT_EQ(number("TYPE noise(string name, point p, ...)", {"perlin", p}), number("TYPE snoise(point p)", {p}));
  EXPECT_EQ(number("TYPE noise(string name, point p, ...)", {"uperlin", p}), number("TYPE noise(point p)", {p}));
  EXPECT_EQ(number("TYPE noise(string name, point p, ...)", {"cell", p}), number("TYPE cellnoise(point p)", {p}));
  EXPECT_EQ(number("TYPE noise(string name, point p, ...)", {"hash", p}), number("TYPE hashnoise(point p)", {p}));
  EXPECT_EQ(number("TYPE noise(string name, point p, ...)", {"null", p}), 0);
  World world;
  call(world, "TYPE noise(string name, point p, ...)", Base::float_, {"pearl", p});
  EXPECT_EQ(world.failed, "Unknown noise type \"pearl\"");
  call(world, "TYPE noise(string name, point p, ...)", Base::float_, {"gabor", p, "bandwith", 2.0f});
  EXPECT_NE(world.warned, "");
}

TEST(OslNoise, DerivativesAreThoseOfDifferences) {
  World world;
  const float x[4] = {1.37f, -2.21f, 0.64f, 3.13f}, vx[4] = {0.7f, -0.3f, 0.5f, 0.2f}, vy[4] = {-0.1f, 0.9f, 0.4f, -0.6f};
  // So small that Gabor noise is not filtered.
  constexpr float pixel = 1e-4f, h = 1e-3f;
  for (const char* name : {"perlin", "uperlin", "simplex", "usimplex", "gabor"})
    for (int dimensions = 1; dimensions <= 4; ++dimensions) {
      const auto run = [&](float a, float b, bool derivatives) {
        const auto at = [&](int d) { return Dual<float>(x[d] + a * vx[d] + b * vy[d], pixel * vx[d], pixel * vy[d]); };
        std::vector<Value> arguments{name};
        if (dimensions < 3)
          for (int d = 0; d < dimensions; ++d) arguments.emplace_back(at(d));
        else
          arguments.emplace_back(Base::point, make_triple(at(0), at(1), at(2)));
        if (dimensions == 4) arguments.emplace_back(at(3));
        static constexpr const char* signatures[] = {
            "TYPE noise(string name, float x, ...)", "TYPE noise(string name, float x, float y, ...)",
            "TYPE noise(string name, point p, ...)", "TYPE noise(string name, point p, float t, ...)"};
        return call(world, signatures[dimensions - 1], Base::color, derivatives, arguments);
      };
      SCOPED_TRACE(std::string(name) + " " + std::to_string(dimensions));
      const Value exact = run(0, 0, true);
      const Triple by_x = (run(h, 0, false).as<Triple>() - run(-h, 0, false).as<Triple>()) * (0.5f / h);
      const Triple by_y = (run(0, h, false).as<Triple>() - run(0, -h, false).as<Triple>()) * (0.5f / h);
      expect_near(exact.at<Triple>(1) * (1 / pixel), by_x, 2e-3f);
      expect_near(exact.at<Triple>(2) * (1 / pixel), by_y, 2e-3f);
      EXPECT_EQ(exact.as<Triple>(), run(0, 0, false).as<Triple>());
    }
}

TEST(OslNoise, PeriodsRepeat) {
  const Value a = point(0.3f, 1.6f, -2.2f), b = point(3.3f, 5.6f, 2.8f), period = point(3, 4, 5);
  expect_near(triple("TYPE psnoise(point p, point period)", {a, period}),
              triple("TYPE psnoise(point p, point period)", {b, period}), 1e-5f);
  for (const char* name : {"perlin", "cell", "gabor"})
    EXPECT_NEAR(number("TYPE pnoise(string name, float x, float y, float x_period, float y_period, ...)",
                       {name, 0.3f, -0.6f, 8.0f, 8.0f}),
                number("TYPE pnoise(string name, float x, float y, float x_period, float y_period, ...)",
                       {name, 8.3f, 7.4f, 8.0f, 8.0f}),
                std::string_view(name) == "gabor" ? 10 : 1e-5)  // Gabor's cells are not as wide as the periods
        << name;
  EXPECT_EQ(number("TYPE pnoise(float x, float x_period)", {2.5f, 0.0f}),
            number("TYPE pnoise(float x, float x_period)", {0.5f, 1.0f}));
}

TEST(OslNoise, RangesAndMeans) {
  World world;
  struct Expected {
    const char* name;
    float low, high, mean;
  };
  for (const Expected& e : {Expected{"perlin", -1, 1, 0},
                            {"uperlin", 0, 1, 0.5f},
                            {"simplex", -1, 1, 0},
                            {"usimplex", 0, 1, 0.5f},
                            {"cell", 0, 1, 0.5f},
                            {"hash", 0, 1, 0.5f},
                            {"gabor", -1, 1, 0}}) {
    double sum = 0;
    constexpr int count = 1000;
    for (int i = 0; i < count; ++i) {
      const float x = 97 * std::fmod(float(i) * 0.618034f, 1.0f), y = float(i) * 0.77f;
      const float v =
          call(world, "TYPE noise(string name, point p, ...)", Base::float_, {e.name, point(x, y, -3.3f)}).as<float>();
      EXPECT_GE(v, e.low) << e.name;
      EXPECT_LE(v, e.high) << e.name;
      sum += double(v);
    }
    // Five standard errors, of a deviation of at most 0.4.
    EXPECT_NEAR(sum / count, double(e.mean), 5 * 0.4 / std::sqrt(double(count))) << e.name;
  }
}

TEST(OslNoise, GaborIsFilteredOverThePixel) {
  World world;
  const auto deviation = [&](float pixel, int filter) {
    double squares = 0;
    for (int i = 0; i < 200; ++i) {
      const Dual<Triple> p({float(i) * 0.37f, float(i) * 0.11f, 0.5f}, {pixel, 0, 0}, {0, pixel, 0});
      std::vector<Value> arguments{"gabor", Value(Base::point, p), "do_filter", filter};
      const double v = double(call(world, "TYPE noise(string name, point p, ...)", Base::float_, false, arguments).as<float>());
      squares += v * v;
    }
    return std::sqrt(squares / 200);
  };
  const double sharp = deviation(0.05f, 1);
  EXPECT_NEAR(sharp, deviation(0.05f, 0), 0.05 * sharp);
  EXPECT_LT(deviation(1, 1), 0.4 * sharp);
  EXPECT_NEAR(deviation(1, 0), deviation(0.05f, 0), 1e-9);
}

TEST(OslNoise, IsDefinedEverywhere) {
  World world;
  const float all[] = {std::nanf(""), std::numeric_limits<float>::infinity(), -1e30f, 3e9f, 1e-40f};
  for (const char* name : {"perlin", "simplex", "cell", "hash", "gabor"})
    for (const float x : all)
      for (const float y : all)
        call(world, "TYPE pnoise(string name, float x, float y, float x_period, float y_period, ...)", Base::color,
             {name, x, y, y, x});
}

}  // namespace etendue::osl::test
