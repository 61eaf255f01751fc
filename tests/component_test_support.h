#pragma once
// What tests of single components share: making them, points on surfaces, and a chi-square test.

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "etendue/component.h"
#include "etendue/registry.h"
#include "etendue/scene_object.h"
#include "etendue/shader.h"  // Ref<Shader> in SceneObject needs the whole class

namespace etendue::test {

/// A member and its value, in the member's unit.
struct Setting {
  std::string member;
  Value value;
  Setting(std::string m, double v) : member(std::move(m)), value(Number{v}) {}
  Setting(std::string m, const char* v) : member(std::move(m)), value(std::string(v)) {}
  Setting(std::string m, const std::string& v) : member(std::move(m)), value(v) {}
  Setting(std::string m, std::vector<double> v) : member(std::move(m)), value(Numbers{std::move(v), 1, Dimension::none}) {}
  Setting(std::string m, Color v) : member(std::move(m)), value(std::move(v)) {}
  template <class C>
    requires std::is_base_of_v<Component, C>
  Setting(std::string m, const Ref<C>& v) : member(std::move(m)), value(Ref<Component>(v)) {}
};

/// A component by its class's name, with members set, prepared with all it refers to.
template <class T>
Ref<T> create(const std::string& name, const std::vector<Setting>& settings = {}) {
  Ref<T> made = ref_cast<T>(Registry::instance().create(name));
  if (!made) throw std::logic_error(name + " is of another interface");
  for (const Setting& s : settings) set(*made, s.member, s.value);
  prepare_tree(*made);
  return made;
}

/// Wavelengths at equal steps through the visible range, the hero first.
inline Wavelengths wavelengths(float hero = 450) {
  constexpr float range = wavelength_high - wavelength_low;
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) {
    float lambda = hero + float(i) * range / spectrum_size;
    if (lambda > wavelength_high) lambda -= range;
    w.place(i, lambda, 1 / range);
  }
  return w;
}

inline SurfacePoint surface_point(const Normal3& normal, const Normal3& shading_normal) {
  SurfacePoint p;
  p.normal = normalize(normal);
  p.shading_normal = normalize(shading_normal);
  p.object_normal = p.normal;
  return p;
}
inline SurfacePoint surface_point(const Normal3& normal = {0.3f, -0.5f, 0.8f}) { return surface_point(normal, normal); }

/// A square in its own xy plane with an edge of given length, facing +z; just what tests of shaders and emission ask for.
class TestSquare final : public SceneObject {
 public:
  explicit TestSquare(float edge = 1) : edge_(edge) {}
  Bounds3 bounds() const override {
    Bounds3 b;
    b.add(Point3{0, 0, 0});
    b.add(Point3{edge_, edge_, 0});
    return b;
  }
  bool intersect(const Ray&, Hit&) const override { return false; }
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override {}
  void tangents(SurfacePoint& p) const override {
    p.dpdu = {edge_, 0, 0};
    p.dpdv = {0, edge_, 0};
  }
  float area(float) const override { return edge_ * edge_; }
  SurfaceSample sample_area(Point2 u, float time) const override {
    SurfaceSample s;
    s.point = test::surface_point({0, 0, 1});
    s.point.position = s.point.object_position = {u.x * edge_, u.y * edge_, 0};
    s.point.uv = u;
    s.point.time = time;
    s.point.object = this;
    s.density = 1 / area(time);
    return s;
  }

 private:
  float edge_;
};

/// Probability that a chi-square variable of some degrees of freedom exceeds a value: the regularised upper incomplete
/// gamma function Q(k/2, x/2), by series or continued fraction (Abramowitz & Stegun 6.5.29, 6.5.31).
inline double chi_square_tail(double value, double degrees) {
  const double a = degrees / 2, x = value / 2;
  if (x <= 0) return 1;
  const double front = std::exp(-x + a * std::log(x) - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (int n = 1; n < 10000 && term > sum * 1e-15; ++n) sum += term *= x / (a + n);
    return 1 - front * sum;
  }
  // Lentz's method.
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 10000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = an * d + b;
    if (std::abs(d) < 1e-300) d = 1e-300;
    c = b + an / c;
    if (std::abs(c) < 1e-300) c = 1e-300;
    d = 1 / d;
    const double delta = d * c;
    h *= delta;
    if (std::abs(delta - 1) < 1e-15) break;
  }
  return front * h;
}

/// Tests counts against expected numbers; cells that expect fewer than 5 are pooled. Returns the p-value.
inline double chi_square(const std::vector<double>& counts, const std::vector<double>& expected) {
  double statistic = 0, pooled_count = 0, pooled_expected = 0;
  int cells = 0;
  const auto add = [&](double count, double wanted) {
    statistic += (count - wanted) * (count - wanted) / wanted;
    ++cells;
  };
  for (size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] >= 5) {
      add(counts[i], expected[i]);
    } else {
      pooled_count += counts[i];
      pooled_expected += expected[i];
    }
  }
  if (pooled_expected >= 1)
    add(pooled_count, pooled_expected);
  else if (pooled_count > 5 + 10 * pooled_expected)
    return 0;  // samples where hardly any may be
  return cells > 1 ? chi_square_tail(statistic, cells - 1) : 1;
}

/// The significance of each of several tests so that all together have the given one (Šidák).
inline double each_of(int tests, double together = 1e-3) { return 1 - std::pow(1 - together, 1.0 / tests); }

/// The 6-point Gauss-Legendre rule on [0, 1].
inline const std::array<std::pair<double, double>, 6>& gauss() {
  static const std::array<std::pair<double, double>, 6> rule = [] {
    const double x[3] = {0.238619186083197, 0.661209386466265, 0.932469514203152};
    const double w[3] = {0.467913934572691, 0.360761573048139, 0.171324492379170};
    std::array<std::pair<double, double>, 6> r;
    for (size_t i = 0; i < 3; ++i) {
      r[2 * i] = {(1 - x[i]) / 2, w[i] / 2};
      r[2 * i + 1] = {(1 + x[i]) / 2, w[i] / 2};
    }
    return r;
  }();
  return rule;
}

/// Integrals over cells of the sphere of a function of direction: `rows` steps in z (a border at z = 0 when even) by
/// `columns` steps in longitude, around the frame's normal.
inline std::vector<double> integrate_cells(const Frame& frame, int rows, int columns,
                                           const std::function<double(const Vector3&)>& f) {
  std::vector<double> cells;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      double sum = 0;
      for (const auto& [x, wx] : gauss())
        for (const auto& [y, wy] : gauss()) {
          const double z = -1 + 2 * (row + x) / rows, phi = 2 * M_PI * (column + y) / columns, r = std::sqrt(1 - z * z);
          sum += wx * wy * f(frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(z)}));
        }
      cells.push_back(sum * 4 * M_PI / (rows * columns));
    }
  return cells;
}

inline size_t cell_of(const Frame& frame, int rows, int columns, const Vector3& direction) {
  const Vector3 v = frame.to_local(direction);
  double phi = std::atan2(double(v.y), double(v.x)) / (2 * M_PI);
  if (phi < 0) phi += 1;
  const int row = std::min(int((double(v.z) + 1) / 2 * rows), rows - 1), column = std::min(int(phi * columns), columns - 1);
  return size_t(row * columns + column);
}

class Random {
 public:
  explicit Random(std::uint32_t seed) : engine_(seed) {}
  float operator()() { return to_unit_float(std::uint32_t(engine_())); }
  Point2 pair() {
    const float x = (*this)();
    return {x, (*this)()};
  }
  Vector3 direction() {
    const float z = 1 - 2 * (*this)(), phi = 2 * pi * (*this)(), r = safe_sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
  }

 private:
  std::mt19937 engine_;
};

}  // namespace etendue::test
