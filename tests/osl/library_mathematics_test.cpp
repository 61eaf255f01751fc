// The shading language's library: mathematics, geometry, transforms, steps and splines, against closed forms and differences.

#include "call_library.h"

namespace etendue::osl::test {

namespace {

Value point(float x, float y, float z) { return {Base::point, Triple(x, y, z)}; }
Value vector(float x, float y, float z) { return {Base::vector, Triple(x, y, z)}; }

/// Checks that the derivatives of a function of floats, or of triples' components, are those of differences. The arguments move
/// with velocity 1, 2, ... in x, and the negative half in y.
void expect_derivatives(std::string_view signature, const Type& result, const std::vector<float>& at, float tolerance = 3e-3f) {
  World world;
  const auto run = [&](float x, float y, bool derivatives) {
    std::vector<Value> arguments;
    float velocity = 1;
    for (const float a : at) {
      const float dx = velocity, dy = -0.5f * velocity;
      velocity += 1;
      arguments.emplace_back(Dual<float>(a + dx * x + dy * y, dx, dy));
    }
    return call(world, signature, result, derivatives, arguments);
  };
  const float h = 1e-3f;
  const Value exact = run(0, 0, true), right = run(h, 0, false), left = run(-h, 0, false), up = run(0, h, false),
              down = run(0, -h, false);
  const std::size_t size = std::size_t(result.floats());
  for (std::size_t k = 0; k < size; ++k) {
    const float by_x = (right.at<float>(k) - left.at<float>(k)) / (2 * h),
                by_y = (up.at<float>(k) - down.at<float>(k)) / (2 * h);
    EXPECT_NEAR(exact.at<float>(size + k), by_x, tolerance * std::max(1.0f, std::abs(by_x))) << signature;
    EXPECT_NEAR(exact.at<float>(2 * size + k), by_y, tolerance * std::max(1.0f, std::abs(by_y))) << signature;
  }
}

}  // namespace

TEST(OslMathematics, IsDefinedAtTheEdges) {
  EXPECT_EQ(number("TYPE sqrt(TYPE x)", {-1.0f}), 0);
  EXPECT_EQ(number("TYPE inversesqrt(TYPE x)", {0.0f}), 0);
  EXPECT_EQ(number("TYPE acos(TYPE x)", {-2.0f}), std::acos(-1.0f));
  EXPECT_EQ(number("TYPE pow(TYPE x, TYPE y)", {-2.0f, 1.5f}), 0);
  EXPECT_EQ(number("TYPE pow(TYPE x, TYPE y)", {-2.0f, 3.0f}), -8);
  EXPECT_EQ(number("TYPE pow(TYPE x, TYPE y)", {0.0f, 0.0f}), 1);
  EXPECT_EQ(number("TYPE pow(TYPE x, TYPE y)", {0.0f, -3.0f}), 0);
  EXPECT_EQ(number("TYPE pow(TYPE x, TYPE y)", {1e20f, 2.0f}), std::numeric_limits<float>::max());
  EXPECT_TRUE(std::isfinite(number("TYPE log(TYPE x)", {0.0f})));
  EXPECT_EQ(number("TYPE fmod(TYPE a, TYPE b)", {1.5f, 0.0f}), 0);
  EXPECT_EQ(number("TYPE mod(TYPE a, TYPE b)", {-0.25f, 1.0f}), 0.75f);
  EXPECT_EQ(number("TYPE fmod(TYPE a, TYPE b)", {-0.25f, 1.0f}), -0.25f);
  EXPECT_EQ(number("TYPE round(TYPE x)", {-2.5f}), -3);
  EXPECT_EQ(number("TYPE sign(TYPE x)", {-0.0f}), 0);
  EXPECT_EQ(integer("int abs(int x)", {std::numeric_limits<int>::min()}), std::numeric_limits<int>::min());
  EXPECT_EQ(integer("int isfinite(float x)", {std::numeric_limits<float>::infinity()}), 0);
  EXPECT_EQ(number("TYPE logb(TYPE x)", {27.1828f}), 4);
  EXPECT_NEAR(number("TYPE log(TYPE x, float base)", {27.1828f, 27.0f}), 1.00205, 1e-5);
  EXPECT_EQ(number("TYPE select(TYPE x, TYPE y, int condition)", {1.0f, 2.0f, 3}), 2);
  EXPECT_EQ(triple("TRIPLE mix(TRIPLE x, TRIPLE y, float a)", {vector(0, 1, 2), vector(1, 1, 4), 0.25f}),
            Triple(0.25f, 1, 2.5f));
}

TEST(OslMathematics, DerivativesAreThoseOfDifferences) {
  for (const char* name :
       {"radians", "degrees", "cos",  "sin",   "tan",  "acos",        "asin", "atan", "cosh", "sinh",  "tanh", "exp", "exp2",
        "expm1",   "log",     "log2", "log10", "sqrt", "inversesqrt", "cbrt", "abs",  "fabs", "floor", "ceil", "sign"})
    expect_derivatives(std::string("TYPE ") + name + "(TYPE x)", Base::float_, {0.4f});
  expect_derivatives("float erf(float x)", Base::float_, {0.4f});
  expect_derivatives("float erfc(float x)", Base::float_, {0.4f});
  expect_derivatives("TYPE atan2(TYPE y, TYPE x)", Base::float_, {-0.4f, 0.7f});
  expect_derivatives("TYPE pow(TYPE x, TYPE y)", Base::float_, {1.3f, 2.1f});
  expect_derivatives("TYPE log(TYPE x, float base)", Base::float_, {1.3f, 2.1f});
  expect_derivatives("float hypot(float x, float y, float z)", Base::float_, {1.3f, -2.1f, 0.5f});
  expect_derivatives("TYPE fmod(TYPE a, TYPE b)", Base::float_, {7.3f, 2.1f});
  expect_derivatives("TYPE mod(TYPE a, TYPE b)", Base::float_, {-7.3f, 2.1f});
  expect_derivatives("TYPE min(TYPE a, TYPE b)", Base::float_, {1.3f, 2.1f});
  expect_derivatives("TYPE clamp(TYPE x, TYPE low, TYPE high)", Base::float_, {1.3f, 2.1f, 3});
  expect_derivatives("TYPE mix(TYPE x, TYPE y, TYPE a)", Base::float_, {1.3f, 2.1f, 0.3f});
  expect_derivatives("TYPE linearstep(TYPE low, TYPE high, TYPE x)", Base::float_, {1, 2, 1.4f});
  expect_derivatives("TYPE smoothstep(TYPE low, TYPE high, TYPE x)", Base::float_, {1, 2, 1.4f});
  for (const float x : {0.98f, 1.5f, 2.02f})
    expect_derivatives("TYPE smooth_linearstep(TYPE low, TYPE high, TYPE x, TYPE eps)", Base::float_, {1, 2, x, 0.1f}, 0.02f);
  expect_derivatives("color color(float r, float g, float b)", Base::color, {1, 2, 3});
}

TEST(OslMathematics, OutputsGetDerivativesOfTheirOwn) {
  World world;
  std::vector<Value> arguments{Value(Dual<float>(0.4f, 1, 2)), Value(Type(Base::float_), true),
                               Value(Type(Base::float_), true)};
  call(world, "void sincos(TYPE x, output TYPE sine, output TYPE cosine)", Base::void_, false, arguments);
  EXPECT_FLOAT_EQ(arguments[1].at<float>(0), std::sin(0.4f));
  EXPECT_FLOAT_EQ(arguments[1].at<float>(2), 2 * std::cos(0.4f));
  EXPECT_FLOAT_EQ(arguments[2].at<float>(1), -std::sin(0.4f));
}

TEST(OslGeometry, ClosedForms) {
  EXPECT_EQ(number("float dot(vector a, vector b)", {vector(1, 2, 3), vector(4, 5, 6)}), 32);
  EXPECT_EQ(triple("vector cross(vector a, vector b)", {vector(1, 0, 0), vector(0, 1, 0)}), Triple(0, 0, 1));
  EXPECT_EQ(triple("vector normalize(vector v)", {vector(0, 0, 0)}), Triple(0));
  EXPECT_FLOAT_EQ(number("float distance(point a, point b, point q)", {point(0, 0, 0), point(1, 0, 0), point(3, 0, 0)}), 2);
  EXPECT_FLOAT_EQ(number("float distance(point a, point b, point q)", {point(0, 0, 0), point(1, 0, 0), point(0.5f, 2, 0)}), 2);
  EXPECT_EQ(
      triple("vector faceforward(vector n, vector i, vector reference)", {vector(0, 0, 1), vector(0, 0, 1), vector(0, 0, 1)}),
      Triple(0, 0, -1));
  EXPECT_EQ(triple("vector refract(vector i, vector n, float eta)", {vector(0.8f, 0, -0.6f), vector(0, 0, 1), 1.5f}),
            Triple(0));
  const Triple turned =
      triple("point rotate(point p, float angle, vector axis)", {point(1, 0, 0), float(M_PI / 2), vector(0, 0, 2)});
  EXPECT_NEAR(turned.x, 0, 1e-6);
  EXPECT_NEAR(turned.y, 1, 1e-6);
  // Fresnel at normal incidence into glass: ((n - 1)/(n + 1))^2.
  World world;
  std::vector<Value> a{vector(0, 0, -1), Value(Base::normal, Triple(0, 0, 1)), 1 / 1.5f, Value(Type(Base::float_)),
                       Value(Type(Base::float_))};
  call(world, "void fresnel(vector i, normal n, float eta, output float kr, output float kt)", Base::void_, false, a);
  EXPECT_NEAR(a[3].as<float>(), 0.04, 1e-6);
  EXPECT_NEAR(a[4].as<float>(), 0.96 / 2.25, 1e-6);
}

TEST(OslGeometry, DerivativesOfUnitVectors) {
  World world;
  const Dual<Triple> v({1, 2, 2}, {1, 0, 0}, {0, 1, 1});
  std::vector<Value> arguments{Value(Base::vector, v)};
  const Value unit = call(world, "vector normalize(vector v)", Base::vector, true, arguments);
  const float h = 1e-3f;
  const Triple moved = (1 / length(v.value + h * v.dx)) * (v.value + h * v.dx);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(unit.at<Triple>(1)[k], (moved[k] - unit.as<Triple>()[k]) / h, 1e-3);
}

TEST(OslTransforms, ByNameAndByMatrix) {
  World world;
  // Turned by 45 degrees, and moved by one: what the reference's shading test harness calls "shader" space.
  const float r = std::sqrt(0.5f);
  world.shader.m[0][0] = world.shader.m[0][1] = world.shader.m[1][1] = r;
  world.shader.m[1][0] = -r;
  world.shader.m[3][0] = 1;
  const Triple p = call(world, "PTYPE transform(string to, PTYPE p)", Base::point, {"shader", point(2, 1, 0)}).as<Triple>();
  EXPECT_NEAR(p.x, 2 * r, 1e-6);
  EXPECT_NEAR(p.y, 0, 1e-6);
  const Matrix back = call(world, "matrix matrix(string from, string to)", Base::matrix, {"common", "shader"}).as<Matrix>();
  EXPECT_NEAR(back.m[0][1], -r, 1e-6);
  EXPECT_NEAR(back.m[3][0], -r, 1e-6);
  EXPECT_EQ(world.failed, "");
  std::vector<Value> arguments{"foobar", Value(Matrix::diagonal(7))};
  EXPECT_EQ(call(world, "int getmatrix(string from, output matrix m)", Base::int_, false, arguments).as<int>(), 0);
  EXPECT_EQ(arguments[1].as<Matrix>(), Matrix::diagonal(7));
  EXPECT_EQ(world.failed, "Unknown transformation \"foobar\"");
  EXPECT_FLOAT_EQ(number("float transformu(string from, string to, float x)", {"ft", "cm", 2.0f}), 60.96f);
  EXPECT_FLOAT_EQ(number("float transformu(string from, string to, float x)", {"frames", "s", 48.0f}), 2);
  world.failed.clear();
  call(world, "float transformu(string from, string to, float x)", Base::float_, {"s", "cm", 1.0f});
  EXPECT_NE(world.failed, "");
}

TEST(OslTransforms, PerspectiveHasDerivatives) {
  World world;
  Matrix m = Matrix::identity();
  m.m[2][3] = 1, m.m[3][3] = 0;  // divides by z
  const Dual<Triple> p({1, 2, 4}, {1, 0, 1}, {0, 1, 0});
  std::vector<Value> arguments{m, Value(Base::point, p)};
  const Value q = call(world, "PTYPE transform(matrix to, PTYPE p)", Base::point, true, arguments);
  EXPECT_EQ(q.as<Triple>(), Triple(0.25f, 0.5f, 1));
  EXPECT_FLOAT_EQ(q.at<Triple>(1).x, (1 - 0.25f) / 4);
  EXPECT_FLOAT_EQ(q.at<Triple>(2).y, 0.25f);
}

TEST(OslSteps, AntialiasedStepIsTheMeanOverThePixel) {
  World world;
  std::vector<Value> arguments{0.5f, Value(Dual<float>(0.55f, 0.2f, 0))};
  EXPECT_FLOAT_EQ(call(world, "float aastep(float edge, float s)", Base::float_, false, arguments).as<float>(), 0.75f);
  EXPECT_EQ(number("float aastep(float edge, float s, float ds)", {0.5f, 0.4f, 0.1f}), 0);
  EXPECT_EQ(number("TYPE linearstep(TYPE low, TYPE high, TYPE x)", {0.5f, 0.5f, 0.5f}), 1);
}

TEST(OslSplines, InterpolateAndInvert) {
  const auto knots = Value::array(Base::float_, std::vector<float>{0, 0, 1, 4, 9, 9});
  const auto at = [&](const char* basis, float x) {
    return number("TYPE spline(string basis, float x, TYPE y[])", {basis, x, knots});
  };
  EXPECT_FLOAT_EQ(at("linear", 0.5f), 2.5f);
  EXPECT_FLOAT_EQ(at("constant", 0.5f), 1);
  EXPECT_FLOAT_EQ(at("catmull-rom", 0), 0);
  EXPECT_FLOAT_EQ(at("catmull-rom", 1), 9);
  EXPECT_FLOAT_EQ(at("catmull-rom", 2), 9);
  EXPECT_FLOAT_EQ(at("catmull-rom", std::nanf("")), 0);
  // The middle of Catmull-Rom's segment: (-y0 + 9 y1 + 9 y2 - y3) / 16.
  EXPECT_FLOAT_EQ(at("catmull-rom", 0.5f), (-0 + 9 * 1 + 9 * 4 - 9) / 16.0f);
  EXPECT_FLOAT_EQ(number("TYPE spline(string basis, float x, TYPE y0, TYPE y1, TYPE y2, TYPE y3, ...)",
                         {"bezier", 0.5f, 0.0f, 1.0f, 1.0f, 0.0f}),
                  0.75f);
  EXPECT_FLOAT_EQ(number("TYPE spline(string basis, float x, TYPE y0, TYPE y1, TYPE y2, TYPE y3, ...)",
                         {"hermite", 0.5f, 1.0f, 2.0f, 3.0f, 0.0f}),
                  2 + 0.25f);
  EXPECT_FLOAT_EQ(number("TYPE spline(string basis, float x, TYPE y0, TYPE y1, TYPE y2, TYPE y3, ...)",
                         {"bspline", 0.0f, 0.0f, 6.0f, 0.0f, 0.0f}),
                  4);
  for (const char* basis : {"linear", "catmull-rom", "bspline"})
    for (const float x : {0.13f, 0.4f, 0.9f})
      EXPECT_NEAR(number("float splineinverse(string basis, float v, float y[])", {basis, at(basis, x), knots}), x, 1e-4)
          << basis;
  World world;
  call(world, "TYPE spline(string basis, float x, int knots, TYPE y[])", Base::float_, {"linear", 0.5f, 3, knots});
  EXPECT_NE(world.failed, "");
  // The derivative by x and by a knot.
  std::vector<Value> arguments{"catmull-rom", Value(Dual<float>(0.5f, 1, 0)), 0.0f, Value(Dual<float>(1, 0, 1)), 2.0f, 3.0f};
  const Value d =
      call(world, "TYPE spline(string basis, float x, TYPE y0, TYPE y1, TYPE y2, TYPE y3, ...)", Base::float_, true, arguments);
  EXPECT_FLOAT_EQ(d.at<float>(1), 1);
  EXPECT_FLOAT_EQ(d.at<float>(2), 9 / 16.0f);
}

TEST(OslDerivatives, AreTheArgumentsBlocks) {
  World world;
  const Dual<Triple> p({1, 2, 3}, {2, 0, 0}, {0, 3, 0});
  const auto run = [&](const char* signature, const Type& type, Value v) {
    std::vector<Value> arguments{std::move(v)};
    return call(world, signature, type, false, arguments);
  };
  EXPECT_EQ(run("vector Dx(point x)", Base::vector, Value(Base::point, p)).as<Triple>(), Triple(2, 0, 0));
  EXPECT_EQ(run("vector Dy(point x)", Base::vector, Value(Base::point, p)).as<Triple>(), Triple(0, 3, 0));
  EXPECT_EQ(run("vector Dy(point x)", Base::vector, point(1, 2, 3)).as<Triple>(), Triple(0));
  EXPECT_EQ(run("float area(point p)", Base::float_, Value(Base::point, p)).as<float>(), 6);
  EXPECT_EQ(run("vector calculatenormal(point p)", Base::vector, Value(Base::point, p)).as<Triple>(), Triple(0, 0, 6));
  EXPECT_EQ(run("float filterwidth(float x)", Base::float_, Value(Dual<float>(0, 3, 4))).as<float>(), 5);
}

}  // namespace etendue::osl::test
