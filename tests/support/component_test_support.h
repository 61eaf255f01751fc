#pragma once
// Shared by tests of single components: their creation, surface points, and a chi-square test.

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "check/conform/statistics.h"
#include "etendue/describe/component.h"
#include "etendue/describe/registry.h"
#include "etendue/scene_object.h"
#include "etendue/shader.h"

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

/// A square in the xy plane of object space with an edge of given length, facing +z; only what tests of shaders and emission
/// use.
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
    s.pdf = 1 / area(time);
    return s;
  }

 private:
  float edge_;
};

using statistics::cell_of;
using statistics::chi_square;
using statistics::chi_square_tail;
using statistics::each_of;
using statistics::gauss;
using statistics::integrate_cells;

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
