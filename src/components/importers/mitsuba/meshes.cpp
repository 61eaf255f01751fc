// Meshes, curves, groups of shapes and their instances.

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstring>

#include "converter.h"
#include "files/regular_file.h"

namespace etendue::mitsuba {

Ref<Component> Converter::mesh(const Element& e, Uv& uv) {
  Ref<Component> mesh = make("TriangleMesh", e);
  set_member(*mesh, "file", file(e), e.location_of("filename"));
  if (e.type == "serialized")
    set_member(*mesh, "part", std::to_string(e.integer("shape_index", 0)), e.location_of("shape_index"));
  // Missing normals are computed from the triangles, unless faces are to be flat.
  set_member(*mesh, e.boolean("face_normals", false) ? "flat" : "smooth", true, e.at);
  if (e.has("max_smooth_angle")) {
    e.find("max_smooth_angle");
    importing_.inexact("'max_smooth_angle' is not used: edges are smooth where vertices are shared",
                       e.location_of("max_smooth_angle"));
  }
  uv = e.boolean("flip_tex_coords", e.type == "obj") ? Uv::from_top : Uv::as_is;
  set_transform(*mesh, e.transform(), e.location_of("to_world"));
  e.ignore({"srgb", "collapse", "vertex_colors"});
  return mesh;
}

namespace {

struct Strands {
  Numbers points{{}, 3, Dimension::none}, radius{{}, 1, Dimension::none}, counts{{}, 1, Dimension::none};
};

constexpr size_t fewest_of_spline = 4;

constexpr std::string_view binary_hair = "BINARY_HAIR";

/// Mitsuba 0.5's binary hair: after the first word the number of vertices (32 bits), then x, y and z of each as little-endian
/// floats; an infinity precedes the first vertex of a strand.
Strands read_binary_hair(const std::string& path, std::string_view bytes, Location at, double radius) {
  size_t next = binary_hair.size();
  const auto take = [&](auto& to) {
    if (bytes.size() - next < sizeof to) throw Error(fmt::format("'{}': it ends too early", path), at);
    std::memcpy(&to, bytes.data() + next, sizeof to);
    next += sizeof to;
  };
  std::uint32_t count = 0;
  take(count);
  if (count > bytes.size() / 12) throw Error(fmt::format("'{}': it ends too early", path), at);
  Strands all;
  for (std::uint32_t i = 0; i < count; ++i) {
    float v[3];
    take(v[0]);
    const bool begins = std::isinf(v[0]);
    if (begins) take(v[0]);
    take(v[1]), take(v[2]);
    if (begins || i == 0) all.counts.values.push_back(0);
    ++all.counts.values.back();
    for (const float x : v) {
      if (!(std::abs(x) < 1e18f)) throw Error(fmt::format("'{}': vertex {} is not finite", path, i), at);
      all.points.values.push_back(double(x));
    }
    all.radius.values.push_back(radius);
  }
  for (const double n : all.counts.values)
    if (n < 2) throw Error(fmt::format("'{}': a strand has one point, but 2 are needed", path), at);
  if (all.counts.values.empty()) throw Error(fmt::format("'{}' holds no curves", path), at);
  return all;
}

/// Lines of x, y, z and a radius; an empty line ends a strand.
Strands read_strands(const std::string& path, Location at, bool with_radius, double radius, size_t fewest) {
  std::string text;
  try {
    text = read_regular_file(path);
  } catch (const Error& error) {
    throw Error(fmt::format("'{}': {}", path, error.what()), at);
  }
  if (text.starts_with(binary_hair)) return read_binary_hair(path, text, at, radius);
  Strands all;
  size_t points = 0, line_number = 0;
  const auto end_strand = [&] {
    if (points > 0 && points < fewest)
      throw Error(fmt::format("'{}', line {}: a strand has {} points, but {} are needed", path, line_number, points, fewest),
                  at);
    if (points > 0) all.counts.values.push_back(double(points));
    points = 0;
  };
  for (size_t begin = 0; begin < text.size();) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    ++line_number;
    double v[4] = {0, 0, 0, radius};
    int n = 0;
    const char *c = text.data() + begin, *stop = text.data() + end;
    while (n < (with_radius ? 4 : 3)) {
      while (c < stop && (*c == ' ' || *c == '\t' || *c == ',' || *c == '\r')) ++c;
      if (c == stop) break;
      const auto [next, code] = std::from_chars(c, stop, v[n]);
      if (code != std::errc{} || !(std::abs(v[n]) < 1e18))
        throw Error(fmt::format("'{}', line {}: a number is expected", path, line_number), at);
      c = next;
      ++n;
    }
    if (n == 0) {
      end_strand();
    } else {
      if (n < 3) throw Error(fmt::format("'{}', line {}: {} numbers where x, y and z are expected", path, line_number, n), at);
      all.points.values.insert(all.points.values.end(), v, v + 3);
      all.radius.values.push_back(v[3]);
      ++points;
    }
    begin = end + 1;
  }
  end_strand();
  if (all.counts.values.empty()) throw Error(fmt::format("'{}' holds no curves", path), at);
  return all;
}

}  // namespace

Ref<Component> Converter::curves(const Element& e) {
  const bool spline = e.type == "bsplinecurve";
  Strands strands = read_strands(file(e).resolved(), e.location_of("filename"), e.type != "hair",
                                 e.number("radius", e.type == "hair" ? 0.025 : 1), spline ? fewest_of_spline : 2);
  Ref<Component> curve = make("Curve", e);
  if (e.type == "hair") {
    set_transform(*curve, e.transform(), e.location_of("to_world"));
  } else {  // Mitsuba transforms only the points; radii are unchanged
    const TransformValue placed = e.transform();
    if (placed.transform.animated()) inexact(e, "curves stay where they are at first");
    const Transform to_world = placed.transform.still();
    std::vector<double>& v = strands.points.values;
    for (size_t i = 0; i + 2 < v.size(); i += 3) {
      const DoublePoint3 p = to_world(DoublePoint3{v[i], v[i + 1], v[i + 2]});
      v[i] = p.x, v[i + 1] = p.y, v[i + 2] = p.z;
    }
  }
  if (e.type == "linearcurve") inexact(e, "the ends of curves are open here, and round in Mitsuba");
  set_member(*curve, "points", strands.points, e.at);
  set_member(*curve, "radius", strands.radius, e.at);
  set_member(*curve, "counts", strands.counts, e.at);
  set_member(*curve, "basis", spline ? "b_spline" : "linear", e.at);
  if (e.number("reduction", 0) > 0)
    importing_.inexact("all hairs are there: Mitsuba leaves out the part that 'reduction' says, and makes the others thicker",
                       e.location_of("reduction"));
  e.ignore({"angle_threshold"});
  return curve;
}

Ref<Component> Converter::group(const Element& e) {
  if (const auto known = groups_.find(&e); known != groups_.end()) return known->second;
  Ref<Component> scene = make(imported_structure, e);
  Value::List list;
  ++groups_read_;
  for (const Element* inner : e.all("shape"))
    if (const Ref<SceneObject> object = shape(*inner)) list.emplace_back(Ref<Component>(object), inner->at);
  --groups_read_;
  if (list.empty()) inexact(e, "the group holds no shapes");
  set(*scene, "objects", Value(std::move(list)));
  groups_.emplace(&e, scene);
  return scene;
}

Ref<Component> Converter::instance(const Element& e) {
  const std::vector<const Element*> shapes = e.all("shape");
  if (shapes.empty()) throw Error("an instance needs a shapegroup", e.at);
  const Element& of = *shapes.front();
  if (of.type != "shapegroup") throw Error(fmt::format("an instance is of a shapegroup, not of a '{}'", of.type), e.at);
  Ref<Component> instance = make("Instance", e);
  const bool known = groups_.contains(&of);
  if (known) {
    set_member(*instance, "scene", group(of), e.at);
  } else {
    const Reading reading(of);
    set_member(*instance, "scene", group(of), e.at);
  }
  const char* const placement = e.has("animation") ? "animation" : "to_world";  // if present, "animation" alone counts
  set_transform(*instance, e.transform(placement), e.location_of(placement));
  return instance;
}

}  // namespace etendue::mitsuba
