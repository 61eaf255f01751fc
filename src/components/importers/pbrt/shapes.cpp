// Shapes of pbrt other than meshes.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reader.h"

namespace etendue::pbrt {

namespace {

double positive(const Parameters& p, std::string_view name, double otherwise) {
  const double value = p.number(name, otherwise);
  if (!(value > 0)) throw Error(fmt::format("'{}' of {} must be more than 0, not {}", name, p.of, value), p.place(name));
  return value;
}

double sweep(const Parameters& p) {
  const double degrees = p.number("phimax", 360);
  if (!(degrees > 0)) throw Error(fmt::format("'phimax' must be more than 0, not {}", degrees), p.place("phimax"));
  return std::min(degrees, 360.0);
}

Shape sphere(Reader& reader, const Parameters& p) {
  const double radius = positive(p, "radius", 1), low = p.number("zmin", -radius), high = p.number("zmax", radius);
  if (sweep(p) < 360 || std::max(low, high) < radius || std::min(low, high) > -radius)
    return make_revolved(reader, "sphere", p);
  const Ref<Component> object = reader.make("Sphere", p.at);
  set_member(*object, "radius", radius, p.at);
  return {object, {}};
}

Shape cylinder(Reader& reader, const Parameters& p) {
  const double a = p.number("zmin", -1), b = p.number("zmax", 1);
  if (a == b) throw Error("zmin and zmax of a cylinder must differ", p.place("zmax"));
  const Ref<Component> object = reader.make("Cylinder", p.at);
  set_member(*object, "radius", positive(p, "radius", 1), p.at);
  set_member(*object, "height", std::abs(b - a), p.at);
  set_member(*object, "caps", false, p.at);
  set_member(*object, "sweep", sweep(p), p.at);
  return {object, Transform::translate({0, 0, (a + b) / 2})};
}

Shape disk(Reader& reader, const Parameters& p) {
  const double radius = positive(p, "radius", 1), inner = p.number("innerradius", 0), turn = sweep(p);
  const bool whole = inner == 0 && turn == 360;
  const Ref<Component> object = reader.make(whole ? "Disc" : "Annulus", p.at);
  set_member(*object, "radius", radius, p.at);
  if (!whole) {
    if (!(inner >= 0 && inner < radius)) throw Error("'innerradius' must be from 0 to the radius", p.place("innerradius"));
    set_member(*object, "inner_radius", inner, p.at);
    set_member(*object, "sweep", turn, p.at);
  }
  set_member(*object, "coordinates", "around", p.at);
  return {object, Transform::translate({0, 0, p.number("height", 0)})};
}

Shape cone(Reader& reader, const Parameters& p) {
  const Ref<Component> object = reader.make("Cone", p.at);
  set_member(*object, "radius", positive(p, "radius", 1), p.at);
  set_member(*object, "height", positive(p, "height", 1), p.at);
  set_member(*object, "caps", false, p.at);
  set_member(*object, "sweep", sweep(p), p.at);
  return {object, {}};
}

using Points = std::vector<std::array<double, 3>>;
std::array<double, 3> between(const std::array<double, 3>& a, const std::array<double, 3>& b, double t) {
  return {(1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1], (1 - t) * a[2] + t * b[2]};
}

/// Raises the segments of degree 2 to cubic Bézier curves with the same points.
Points cubic(const Points& points, bool bezier) {
  Points all;
  const size_t step = bezier ? 2 : 1;
  for (size_t i = 0; i + 2 < points.size(); i += step) {
    const auto& middle = points[i + 1];
    const auto first = bezier ? points[i] : between(points[i], middle, 0.5);
    const auto last = bezier ? points[i + 2] : between(middle, points[i + 2], 0.5);
    if (all.empty()) all.push_back(first);
    all.push_back(between(first, middle, 2.0 / 3));
    all.push_back(between(last, middle, 2.0 / 3));
    all.push_back(last);
  }
  return all;
}

Shape curve(Reader& reader, const Parameters& p) {
  const Location at = p.at;
  const std::vector<double>& numbers = p.numbers("P", 3);
  const int degree = p.integer("degree", 3);
  if (degree != 2 && degree != 3) throw Error(fmt::format("a curve's degree is 2 or 3, not {}", degree), p.place("degree"));
  std::string basis = p.text("basis", "bezier");
  if (basis != "bezier" && basis != "bspline")
    throw Error(fmt::format("a curve's basis is bezier or bspline, not '{}'", basis), p.place("basis"));
  Points points;
  for (size_t i = 0; i < numbers.size(); i += 3) points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  const bool bezier = basis == "bezier";
  const size_t order = size_t(degree);
  if (points.size() < order + 1 || (bezier && (points.size() - 1) % order != 0))
    throw Error(fmt::format("a curve of degree {} cannot have {} control points", degree, points.size()), p.place("P"));
  if (degree == 2) {
    points = cubic(points, bezier);
    basis = "bezier";
  }
  const bool spline = basis == "bspline";
  const double width = p.number("width", 1), w0 = p.number("width0", width), w1 = p.number("width1", width);
  std::vector<double> radii;
  if (w0 == w1)
    radii = {w0 / 2};
  else
    // The width changes linearly from end to end, which control values in linear steps produce. For a B-spline the steps are
    // counted from the second to the last but one control point, which are nearest to its ends.
    for (size_t i = 0; i < points.size(); ++i) {
      const double t = spline ? (double(i) - 1) / double(points.size() - 3) : double(i) / double(points.size() - 1);
      radii.push_back(std::max(0.0, ((1 - t) * w0 + t * w1) / 2));
    }
  const bool without_length = std::ranges::all_of(points, [&](const auto& point) { return point == points[0]; });
  if (without_length || std::max(w0, w1) <= 0) {
    reader.importing.inexact("a curve of no length or no width is left out", at);
    p.forget();
    return {};
  }
  std::vector<double> flat;
  for (const auto& point : points) flat.insert(flat.end(), point.begin(), point.end());
  const Ref<Component> object = reader.make("Curve", at);
  set_member(*object, "points", Numbers{std::move(flat), 3, Dimension::none}, at);
  set_member(*object, "radius", Numbers{std::move(radii), 1, Dimension::none}, at);
  set_member(*object, "basis", spline ? "b_spline" : "bezier", at);
  const std::string type = p.text("type", "flat");
  const std::vector<double>& normals = p.numbers("N", 3);
  if (type == "ribbon" && normals.size() >= 6) {
    set_member(*object, "form", "ribbon", at);
    // One normal at either end, interpolated linearly in between, not by a rotation as in pbrt.
    std::vector<double> list;
    for (size_t i = 0; i < points.size(); ++i)
      for (size_t c = 0; c < 3; ++c) {
        const double t = double(i) / double(points.size() - 1);
        list.push_back((1 - t) * normals[c] + t * normals[normals.size() - 3 + c]);
      }
    set_member(*object, "normals", Numbers{std::move(list), 3, Dimension::none}, at);
  } else if (type != "cylinder") {
    reader.importing.inexact(fmt::format("a curve of type '{}' is a round tube", type), at);
  }
  p.ignore({"splitdepth"});
  return {object, {}};
}

}  // namespace

Shape make_shape(Reader& reader, const std::string& type, Parameters& p) {
  Shape shape;
  if (type == "sphere")
    shape = sphere(reader, p);
  else if (type == "cylinder")
    shape = cylinder(reader, p);
  else if (type == "disk")
    shape = disk(reader, p);
  else if (type == "cone")
    shape = cone(reader, p);
  else if (type == "paraboloid" || type == "hyperboloid")
    shape = make_revolved(reader, type, p);
  else if (type == "curve")
    shape = curve(reader, p);
  else
    return make_mesh(reader, type, p);
  if (!shape.object) return shape;
  // Triangle meshes were reversed already.
  shape.turned = reader.state.reversed && shape.object->class_info().name != "TriangleMesh";
  return shape;
}

}  // namespace etendue::pbrt
