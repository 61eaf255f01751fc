// Functions that make transforms. Lengths without a unit are in metres.

#include <fmt/format.h>

#include "calls.h"

namespace etendue::language {

namespace {

Value checked(const Arguments& a, const Transform& t) {
  if (!t.valid()) a.fail(a.count(), "gives a singular transform: it has no inverse");
  return Value(t);
}

Value translate(const Arguments& a) { return checked(a, Transform::translate(a.vector_or_three(Dimension::length))); }

Value rotate(const Arguments& a) {
  if (a.count() != 2) a.wrong_count();
  const double angle = a.angle(0);
  DoubleVector3 axis;
  if (const auto* letter = a.as<std::string>(1)) {
    if (*letter != "x" && *letter != "y" && *letter != "z")
      a.fail(1, fmt::format("the axis must be \"x\", \"y\", \"z\" or a vector, not \"{}\"", *letter));
    (*letter == "x" ? axis.x : *letter == "y" ? axis.y : axis.z) = 1;
  } else {
    if (!a.as<Numbers>(1)) a.wrong(1, "a vector or \"x\", \"y\", \"z\"");
    axis = a.vector(1);
    const double size = std::max({std::abs(axis.x), std::abs(axis.y), std::abs(axis.z)});
    if (size == 0) a.fail(1, "the axis has no length");
    axis = 1 / size * axis;  // so that its squared length neither vanishes nor overflows
  }
  return checked(a, Transform::rotate(angle, axis));
}

Value scale(const Arguments& a) {
  if (a.count() == 1 && !a.as<Numbers>(0)) {
    if (!a.as<Number>(0)) a.wrong(0, "a number or 3 numbers in brackets");
    const double s = a.number(0);
    return checked(a, Transform::scale({s, s, s}));
  }
  return checked(a, Transform::scale(a.vector_or_three()));
}

Value look_at(const Arguments& a) {
  if (a.count() != 3) a.wrong_count();
  const auto point = [&](size_t i) {
    const DoubleVector3 v = a.vector(i, Dimension::length);
    return DoublePoint3{v.x, v.y, v.z};
  };
  const DoublePoint3 from = point(0), to = point(1);
  const DoubleVector3 up = a.vector(2);
  const DoubleVector3 side = cross(up, to - from);
  if (!(length(side) > 0))
    a.fail(a.count(), from == to ? "look_at: from and to are the same point" : "look_at: up points along the view");
  return checked(a, Transform::look_at(from, to, up));
}

Value matrix(const Arguments& a) {
  std::vector<double> m;
  if (a.count() == 1) {
    const auto* list = a.as<Numbers>(0);
    if (!list || list->dimension != Dimension::none) a.wrong(0, "a list of 12 or 16 plain numbers");
    m = list->values;
    if (m.size() != 12 && m.size() != 16) a.wrong(0, "a list of 12 or 16 plain numbers");
    for (const double x : m)
      if (std::abs(x) > double(std::numeric_limits<float>::max())) a.too_large(0, x);
  } else {
    const bool rows = a.count() > 1 && a.as<Numbers>(0);
    if (rows) a.fail(0, "the rows of a matrix stand in one list: write matrix([[…], […], […]])");
    if (a.count() != 12 && a.count() != 16) a.wrong_count();
    for (size_t i = 0; i < a.count(); ++i) m.push_back(a.number(i));
  }
  if (m.size() == 16 && (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1))
    a.fail(a.count() == 1 ? 0 : 12, "the last row of a matrix must be 0 0 0 1");
  Transform::DoubleMatrix rows;
  for (size_t i = 0; i < rows.size(); ++i) rows[i] = m[i];
  return checked(a, Transform(rows));
}

Value keyframes(const Arguments& a) {
  if (a.count() < 2 || a.count() % 2 != 0) a.wrong_count();
  std::vector<AnimatedTransform::Key> keys;
  for (size_t i = 0; i < a.count(); i += 2) {
    const auto time = float(a.number(i, Dimension::time));
    const auto* transform = a.as<Transform>(i + 1);
    if (!transform) a.wrong(i + 1, "a transform");
    if (!keys.empty() && !(time > keys.back().time)) a.fail(i, "the times of keyframes must increase");
    keys.push_back({time, *transform});
  }
  return Value(AnimatedTransform(std::move(keys)));
}

constexpr Function functions[] = {
    {"translate", "translate(x, y, z) or translate([x, y, z])", translate},
    {"rotate", "rotate(angle, axis)", rotate},
    {"scale", "scale(factor), scale(x, y, z) or scale([x, y, z])", scale},
    {"look_at", "look_at(from, to, up)", look_at},
    {"matrix", "matrix(12 or 16 numbers, row by row)", matrix},
    {"keyframes", "keyframes(time, transform, time, transform, …)", keyframes},
};

}  // namespace

std::span<const Function> transform_functions() { return functions; }

}  // namespace etendue::language
