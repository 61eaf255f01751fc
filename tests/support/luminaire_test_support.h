#pragma once
// Shared by tests of luminaires: components from texts, and integrals over directions.

#include <gtest/gtest.h>

#include "component_test_support.h"
#include "etendue/language/language.h"

namespace etendue::test {

inline Ref<Component> prepared(const std::string& text) {
  Ref<Component> made = parse_component(text, "test.etd");
  prepare_tree(*made);
  return made;
}
template <class T>
Ref<T> prepared_as(const std::string& text) {
  return ref_cast<T>(prepared(text));
}

/// Expects that preparing a component throws Error at the member's column of the text, with a message that contains `words`.
inline void expect_refused(const std::string& text, const std::string& member, const std::string& words) {
  const Ref<Component> made = parse_component(text, "test.etd");
  try {
    prepare_tree(*made);
    ADD_FAILURE() << "accepted: " << text;
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find(words), std::string::npos) << e.what();
    EXPECT_STREQ(e.location.file, "test.etd");
    EXPECT_EQ(e.location.line, 1);
    const size_t at = text.find(member + ":");
    ASSERT_NE(at, std::string::npos);
    EXPECT_GE(e.location.column, int(at) + 1) << text << " -> " << e.what();
    EXPECT_LE(e.location.column, int(at + member.size()) + 3) << text << " -> " << e.what();
  }
}

/// A motion from one transform to another within one second.
inline AnimatedTransform motion(const Transform& from, const Transform& to) {
  return AnimatedTransform(std::vector<AnimatedTransform::Key>{{0, from}, {1, to}});
}

inline void expect_near(const Vector3& a, const Vector3& b, float tolerance = 1e-6f) { EXPECT_LT(length(a - b), tolerance); }

/// The integral of a function over all directions, by the midpoint rule in 1 - cos(theta) around an axis. `borders` [in
/// 1 - cos(theta)] divide it into parts with `steps` midpoints each.
inline double integrate_around(const Vector3& axis, const std::vector<double>& borders,
                               const std::function<double(const Vector3&)>& f, int steps = 2000, int sectors = 8) {
  const Frame frame{Normal3(axis)};
  double sum = 0;
  for (size_t part = 0; part + 1 < borders.size(); ++part) {
    const double dh = (borders[part + 1] - borders[part]) / steps;
    for (int i = 0; i < steps; ++i)
      for (int k = 0; k < sectors; ++k) {
        const double h = borders[part] + (i + 0.5) * dh, r = std::sqrt(h * (2 - h)), phi = 2 * M_PI * (k + 0.5) / sectors;
        sum += f(frame.to_world({float(r * std::cos(phi)), float(r * std::sin(phi)), float(1 - h)})) * dh * 2 * M_PI / sectors;
      }
  }
  return sum;
}

inline double one_minus_cosine(double degrees) { return 2 * std::pow(std::sin(degrees * M_PI / 360), 2); }

}  // namespace etendue::test
