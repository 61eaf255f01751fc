#pragma once
// Shared by tests of shaders' formulas: vectors in double precision, colours that vary with the wavelength, and the comparison
// of a smooth model with its formula at random pairs of directions.

#include "component_test_support.h"
#include "etendue/describe/color.h"

namespace etendue::formulas_test {

using test::create;
using test::Setting;

struct V {
  double x, y, z;
};
inline double dot(const V& a, const V& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline V sum(const V& a, const V& b, double k = 1) { return {a.x + k * b.x, a.y + k * b.y, a.z + k * b.z}; }
inline V scaled(const V& a, double k) { return {k * a.x, k * a.y, k * a.z}; }
inline V unit(const V& a) { return scaled(a, 1 / std::sqrt(dot(a, a))); }
inline double pow2(double x) { return x * x; }
inline double pow5(double x) { return x * x * x * x * x; }

/// A colour that is linear in the wavelength, and its value at a wavelength.
struct Slope {
  double at360, at830;
  Color color() const { return table_spectrum({360, 830}, {float(at360), float(at830)}); }
  double operator()(double lambda) const { return at360 + (at830 - at360) * (lambda - 360) / 470; }
};

/// A point on a square with u along x and the normal along z, so that local directions are those of the world.
inline SurfacePoint flat_point() {
  static test::TestSquare* const square = [] {
    auto* made = new test::TestSquare;
    made->reference();
    return made;
  }();
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.object = square;
  return p;
}

/// f [1/sr] of a pair of directions in the frame of the brush strokes, both above the surface, at a wavelength [nm].
using Formula = std::function<double(const V& out, const V& in, double lambda)>;

inline V turned(const V& v, double turns) {  // into a frame that is rotated counter-clockwise
  const double c = std::cos(2 * M_PI * turns), s = std::sin(2 * M_PI * turns);
  return {c * v.x + s * v.y, c * v.y - s * v.x, v.z};
}

/// Compares f with a formula on both sides of the surface, and the weights of samples with f and the pdf.
inline void expect_formula(const std::string& name, const Ref<Shader>& shader, double rotation, const Formula& formula,
                           double tolerance = 2e-4, Lobes lobes = smooth_lobes) {
  const Wavelengths w = test::wavelengths(430);
  Arena arena;
  const Scatter* scatter = shader->bind(flat_point(), w, arena);
  ASSERT_NE(scatter, nullptr) << name;
  test::Random random(17);
  int compared = 0;
  for (int i = 0; i < 400; ++i) {
    Vector3 out = random.direction(), in = random.direction();
    in.z = std::copysign(in.z, out.z);
    if (i % 3 == 0) {  // near the mirror direction, where f is large
      in = normalize(Vector3{-out.x, -out.y, out.z} + 0.1f * random.direction());
      if (in.z * out.z < 0) in.z = -in.z;
    }
    if (std::abs(out.z) < 0.03f || std::abs(in.z) < 0.03f) continue;
    const Spectrum f = scatter->evaluate(out, in, {.lobes = lobes}) / scatter->cosine(in);
    const V o = turned({double(out.x), double(out.y), std::abs(double(out.z))}, rotation),
            t = turned({double(in.x), double(in.y), std::abs(double(in.z))}, rotation);
    for (int k = 0; k < spectrum_size; ++k) {
      const double expected = formula(o, t, double(w[k]));
      // For narrow lobes, rounding errors of directions are amplified by the squared narrowness; far tails are below the
      // tolerance.
      EXPECT_NEAR(double(f[k]), expected, tolerance * std::abs(expected) + 4e-6) << name << " at " << w[k] << " nm, pair " << i;
      ++compared;
    }
    if (testing::Test::HasFailure()) return;
    // The weight of a sample is value / pdf.
    const float choice = random();
    if (const auto s = scatter->sample(out, choice, random.pair(), {.lobes = lobes}); s && !s->specular()) {
      const ScatterValue both = scatter->value_and_pdf(out, s->direction, {.lobes = lobes});
      for (int k = 0; k < spectrum_size; ++k)
        EXPECT_NEAR(s->weight[k], both.value[k] / both.pdf, 3e-3f * s->weight[k] + 1e-5f) << name;
    }
  }
  EXPECT_GT(compared, 1000) << name;
}

/// The integral of 2 g(c) c dc over [0, 1].
template <class G>
double diffuse_mean(G&& g, int steps = 4000) {
  double total = 0;
  for (int i = 0; i < steps; ++i) {
    const double c = (i + 0.5) / steps;
    total += 2 * c * g(c) / steps;
  }
  return total;
}

}  // namespace etendue::formulas_test
