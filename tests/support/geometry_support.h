#pragma once
// Shared by tests of objects and scenes.

#include <gtest/gtest.h>

#include <random>

#include "etendue/describe/registry.h"
#include "etendue/scene.h"
#include "etendue/shader.h"

namespace etendue::geometry_test {

/// A member and its value, in the member's unit.
struct Setting {
  std::string member;
  Value value;
  Setting(std::string m, double v) : member(std::move(m)), value(Number{v}) {}
  template <std::same_as<bool> B>
  Setting(std::string m, B v) : member(std::move(m)), value(v) {}
  Setting(std::string m, const std::string& v) : member(std::move(m)), value(v) {}
  Setting(std::string m, std::initializer_list<double> v) : Setting(std::move(m), std::vector<double>(v)) {}
  Setting(std::string m, std::vector<double> v) : member(std::move(m)), value(Numbers{std::move(v), 1, Dimension::none}) {}
};

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  float number() { return std::min(uniform_(engine_), one_minus_epsilon); }
  float between(float low, float high) { return low + (high - low) * number(); }
  Point2 pair() {
    const float x = number(), y = number();
    return {x, y};
  }
  Vector3 direction() {
    const float z = 1 - 2 * number(), r = safe_sqrt(1 - z * z), phi = 2 * pi * number();
    return {r * std::cos(phi), r * std::sin(phi), z};
  }
  Point3 in_box(float half) {
    const float x = between(-half, half), y = between(-half, half), z = between(-half, half);
    return {x, y, z};
  }
  Transform placement(float half, float low_scale = 1, float high_scale = 1) {
    const float s = between(low_scale, high_scale);
    const Vector3 by = in_box(half) - Point3{};
    return Transform::translate(by) * Transform::rotate(between(0, 6), direction()) * Transform::scale({s, s, s});
  }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<float> uniform_{0, 1};
};

inline Ref<SceneObject> object(const std::string& name, const std::vector<Setting>& settings = {},
                               const AnimatedTransform& transform = {}) {
  Ref<SceneObject> made = ref_cast<SceneObject>(Registry::instance().create(name));
  for (const Setting& s : settings) set(*made, s.member, s.value);
  made->transform = transform;
  prepare_tree(*made);
  return made;
}

inline Ref<Scene> scene(const std::string& name, std::vector<Ref<SceneObject>> objects,
                        const AnimatedTransform& transform = {}) {
  Ref<Scene> made = ref_cast<Scene>(Registry::instance().create(name));
  made->objects = std::move(objects);
  made->transform = transform;
  prepare_tree(*made);
  return made;
}

/// The surface of a cube from -1 to 1, facing out.
inline std::vector<Setting> cube_settings() {
  return {{"positions", {-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1}},
          {"triangles",
           {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7}}};
}
inline std::vector<Setting> l_shape_settings() {  // concave, area 3
  return {{"points", {0, 0, 0, 2, 0, 0, 2, 1, 0, 1, 1, 0, 1, 2, 0, 0, 2, 0}}};
}

inline Ray ray(const Point3& origin, const Vector3& direction, float time = 0) {
  Ray r;
  r.origin = origin;
  r.direction = direction;
  r.time = time;
  return r;
}

/// The mean of a sample and its standard error.
struct Mean {
  double sum = 0, squares = 0, count = 0;
  void add(double x) {
    sum += x;
    squares += x * x;
    ++count;
  }
  double value() const { return sum / count; }
  double error() const { return std::sqrt(std::max(0.0, squares / count - value() * value()) / count); }
};

}  // namespace etendue::geometry_test
