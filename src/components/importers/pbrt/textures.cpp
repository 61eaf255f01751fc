// Converts textures, and parameters that may refer to one.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "reader.h"

namespace etendue::pbrt {

namespace {

/// 2D textures are evaluated at (s, t), which "mapping" computes from (u, v) or a position: wraps the map in that mapping.
Ref<Component> mapped(Reader& reader, const Parameters& p, Ref<Component> map) {
  const std::string mapping = p.text("mapping", "uv");
  const auto within = [&](const char* class_name) {
    Ref<Component> outer = reader.make(class_name, p.at);
    set_member(*outer, "map", map, p.at);
    return outer;
  };
  const auto in_world = [&](Ref<Component> outer, const Transform& inner) {
    set_member(*outer, "world", true, p.at);
    const AnimatedTransform to_world = reader.to_world(inner);
    if (to_world.valid()) set_member(*outer, "transform", to_world, p.at);
    return outer;
  };
  const auto delta = [&](const char* name) { return p.number(name, 0); };
  if (mapping == "uv") {
    const double du = delta("udelta"), dv = delta("vdelta");
    const double su = p.number("uscale", 1), sv = p.number("vscale", 1);
    if (su == 1 && sv == 1 && du == 0 && dv == 0) return map;
    if (su == 0 || sv == 0) throw Error(fmt::format("'{}' must not be 0", su == 0 ? "uscale" : "vscale"), p.at);
    const Ref<Component> outer = within("UvTransformMap");
    set_member(*outer, "scale", Numbers{{su, sv}, 1, Dimension::none}, p.at);
    set_member(*outer, "shift", Numbers{{du, dv}, 1, Dimension::none}, p.at);
    return outer;
  }
  if (mapping == "planar") {
    const double du = delta("udelta"), dv = delta("vdelta");
    // s = udelta + v1 . p, t = vdelta + v2 . p: PlanarMap's x and y, with any third axis.
    const DoublePoint3 v1 = p.point("v1", {1, 0, 0}), v2 = p.point("v2", {0, 1, 0});
    const DoubleVector3 a{v1.x, v1.y, v1.z}, b{v2.x, v2.y, v2.z}, c = cross(a, b);
    const Transform projection(Transform::DoubleMatrix{a.x, a.y, a.z, du, b.x, b.y, b.z, dv, c.x, c.y, c.z, 0});
    if (!projection.valid()) throw Error("v1 and v2 must be two directions", p.place("v1"));
    // v3 maps world-space positions, ignoring the directive's transform.
    const Ref<Component> outer = within("PlanarMap");
    if (reader.version != 3) return in_world(outer, projection.inverse());
    set_member(*outer, "world", true, p.at);
    set_member(*outer, "transform", projection.inverse(), p.at);
    return outer;
  }
  if (mapping == "spherical" || mapping == "cylindrical") {
    // pbrt's (s, t) is (1 - v, u) of a SphericalMap, and (u + 1/2, v) of a CylindricalMap.
    const bool sphere = mapping == "spherical";
    if (!sphere && reader.version == 3)
      reader.importing.inexact("t of a cylindrical mapping is the height, where v3 has the cosine of the angle to the axis",
                               p.at);
    const Ref<Component> turned = within("UvTransformMap");
    if (sphere) set_member(*turned, "angle", 90, p.at);
    set_member(*turned, "shift", Numbers{{sphere ? 1 : 0.5, 0}, 1, Dimension::none}, p.at);
    map = turned;
    return in_world(within(sphere ? "SphericalMap" : "CylindricalMap"), Transform());
  }
  throw Error(
      fmt::format("there is no mapping '{}'{}", mapping, suggestion(mapping, {"uv", "planar", "spherical", "cylindrical"})),
      p.place("mapping"));
}

Ref<Component> checkerboard(Reader& reader, const Parameters& p, const auto& value) {
  const Location at = p.at;
  const Value first = value({"tex1"}, 1.0), second = value({"tex2"}, 0.0);
  p.ignore({"aamode"});  // filtering within a pixel
  if (p.integer("dimension", 2) == 2) {
    const Ref<Component> map = reader.make("CheckerMap", at);
    set_map(*map, "first", first, at);
    set_map(*map, "second", second, at);
    set_member(*map, "repeat", Numbers{{1, 1, 1}, 1, Dimension::none}, at);
    return mapped(reader, p, map);
  }
  // Cubes in texture space, written as a formula of world-space coordinates.
  const Transform from_world = reader.state.ctm[0].inverse();
  const auto& m = from_world.exact();
  const auto row = [&](size_t r) {
    return fmt::format("floor({} * x + {} * y + {} * z + {})", m[4 * r], m[4 * r + 1], m[4 * r + 2], m[4 * r + 3]);
  };
  const Ref<Component> which = formula(reader, at, fmt::format("mod({} + {} + {}, 2)", row(0), row(1), row(2)), {});
  set_member(*which, "space", "world", at);
  const Ref<Component> map = reader.make("MixMap", at);
  set_map(*map, "first", first, at);
  set_map(*map, "second", second, at);
  set_member(*map, "amount", which, at);
  return map;
}

/// v00 at (0, 0), v01 at (0, 1), v10 at (1, 0), v11 at (1, 1).
Ref<Component> bilerp(Reader& reader, const Parameters& p, const auto& value) {
  const auto ramp = [&](const char* along, Value a, Value b) {
    const Ref<Component> map = reader.make("RampMap", p.at);
    set_member(*map, "along", along, p.at);
    const auto part = [&](Value v) {
      if (v.template as<Ref<Component>>()) return v;
      const Ref<Component> constant = reader.make("ConstantMap", p.at);
      set_map(*constant, "value", v, p.at);
      return Value(constant, p.at);
    };
    set_member(*map, "colors", Value::List{part(a), part(b)}, p.at);
    return Value(map, p.at);
  };
  const Value left = ramp("v", value({"v00"}, 0.0), value({"v01"}, 1.0));
  const Value right = ramp("v", value({"v10"}, 0.0), value({"v11"}, 1.0));
  return mapped(reader, p, *ramp("u", left, right).template as<Ref<Component>>());
}

/// The absolute cosine between the surface normal and "dir", which is in the directive's coordinates.
Ref<Component> along_direction(Reader& reader, const Parameters& p) {
  const DoublePoint3 given = p.point("dir", {0, 1, 0});
  const auto& m = reader.state.ctm[0].exact();
  const auto along = [&](size_t r) { return m[4 * r] * given.x + m[4 * r + 1] * given.y + m[4 * r + 2] * given.z; };
  const DoubleVector3 d{along(0), along(1), along(2)};
  const double length = std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
  if (!(length > 0)) throw Error("'dir' must be a direction", p.place("dir"));
  const Ref<Component> cosine =
      formula(reader, p.at, fmt::format("abs({} * nx + {} * ny + {} * nz)", d.x / length, d.y / length, d.z / length), {});
  set_member(*cosine, "space", "world", p.at);
  return cosine;
}

/// 1 within dots: every other unit square, at random, contains a dot of radius 0.35, displaced a little.
Ref<Component> dots(Reader& reader, const Parameters& p) {
  reader.importing.inexact("the texture 'dots' has the same character as pbrt's: its dots are in other squares", p.at);
  const auto chance = [](double a, double b) {
    return fmt::format("fract(sin(floor(u + 0.5) * {} + floor(v + 0.5) * {}) * 43758.5453)", a, b);
  };
  const auto off = [&](const char* axis, double a, double b) {
    return fmt::format("pow(abs({0} - floor({0} + 0.5) - 0.15 * (2 * {1} - 1)), 2)", axis, chance(a, b));
  };
  return formula(reader, p.at,
                 fmt::format("step(0.5, {}) * (1 - step(0.1225, {} + {}))", chance(12.9898, 78.233), off("u", 39.346, 11.135),
                             off("v", 73.156, 52.235)),
                 {});
}

Ref<Component> make_map(Reader& reader, const std::string& type, bool spectrum, const Parameters& p) {
  const Location at = p.at;
  const auto value = [&](std::initializer_list<std::string_view> names, double otherwise) {
    return spectrum ? color_map(reader, p, names, otherwise, Use::reflectance) : number_map(reader, p, names, otherwise);
  };
  const auto combine = [&](const char* class_name, Value first, Value second) {
    const Ref<Component> map = reader.make(class_name, at);
    set_map(*map, "first", std::move(first), at);
    set_map(*map, "second", std::move(second), at);
    return map;
  };
  if (type == "constant") {
    const Ref<Component> map = reader.make("ConstantMap", at);
    set_map(*map, "value", value({"value"}, 1), at);
    return map;
  }
  if (type == "imagemap") return mapped(reader, p, image_texture(reader, p, spectrum));
  if (type == "checkerboard") return checkerboard(reader, p, value);
  if (type == "bilerp") return bilerp(reader, p, value);
  // v4 multiplies "tex" by the number or texture "scale", v3 "tex1" by "tex2".
  if (type == "scale")
    return combine("MultiplyMap", value({"tex", "tex1"}, 1),
                   p.has("tex2") ? value({"tex2"}, 1) : number_map(reader, p, {"scale"}, 1));
  if (type == "mix") {
    const Ref<Component> map = combine("MixMap", value({"tex1"}, 0), value({"tex2"}, 1));
    set_map(*map, "amount", number_map(reader, p, {"amount"}, 0.5), at);
    return map;
  }
  if (type == "directionmix") {
    const Ref<Component> map = combine("MixMap", value({"tex2"}, 1), value({"tex1"}, 0));
    set_map(*map, "amount", Value(along_direction(reader, p)), at);
    return map;
  }
  if (type == "fbm" || type == "wrinkled" || type == "windy" || type == "marble") return noise_texture(reader, type, p);
  if (type == "dots") {  // both versions of pbrt exchange the two: the dots show "outside"
    const Ref<Component> map = combine("MixMap", value({"inside"}, 1), value({"outside"}, 0));
    set_map(*map, "amount", Value(dots(reader, p)), at);
    return mapped(reader, p, map);
  }
  if (type == "uv" && spectrum) return mapped(reader, p, reader.make("UvMap", at));
  if (type == "ptex") {
    reader.importing.inexact("a Ptex texture cannot be read: it is 0.5 everywhere", at);
    p.forget();
    return reader.make("ConstantMap", at);
  }
  throw LeftOut(fmt::format("there is no texture '{}'{}", type,
                            suggestion(type, {"constant", "imagemap", "checkerboard", "bilerp", "scale", "mix", "directionmix",
                                              "fbm", "wrinkled", "windy", "marble", "dots", "uv", "ptex"})),
                at);
}

/// A texture that does not exist: version 3 uses the parameter's default.
Value texture(Reader& reader, const Parameter& p, bool spectrum, double otherwise) {
  if (p.strings.size() != 1) throw Error(fmt::format("'{}' must name one texture", p.name), p.at);
  const auto& textures = spectrum ? reader.spectrum_textures : reader.float_textures;
  const auto& others = spectrum ? reader.float_textures : reader.spectrum_textures;
  if (const auto found = textures.find(p.strings[0]); found != textures.end()) {
    reader.named_depth = std::max(reader.named_depth, reader.texture_depths[found->second.get()]);
    return Value(found->second, p.at);
  }
  std::vector<std::string> known;
  for (const auto& [name, map] : textures) known.push_back(name);
  reader.tolerate(fmt::format("there is no {} texture '{}'{}", spectrum ? "spectrum" : "float", p.strings[0],
                              others.contains(p.strings[0]) ? fmt::format(", but a {} texture", spectrum ? "float" : "spectrum")
                                                            : suggestion(p.strings[0], known)),
                  fmt::format("'{}' is {}", p.name, otherwise), p.at);
  return Value(Number{otherwise}, p.at);
}

}  // namespace

std::optional<FilePath> image_file(Reader& reader, const Parameters& p, std::string_view name) {
  const std::string named = p.text(name);
  if (named.empty()) throw Error(fmt::format("{} needs '{}'", p.of, name), p.place(name));
  const auto found = reader.importing.optional_file(named, p.place(name), p.folder);
  if (!found) return std::nullopt;
  return FilePath{*found, {}};
}

void set_map(Component& part, std::string_view member, Value value, Location at) {
  value.location = at;
  set(part, member, value);
}

Ref<Component> formula(Reader& reader, Location at, const std::string& text,
                       const std::vector<std::pair<std::string, Value>>& maps) {
  const Ref<Component> map = reader.make("FormulaMap", at);
  set_member(*map, "formula", text, at);
  Value::List names, parts;
  for (const auto& [name, value] : maps) {
    names.emplace_back(name);
    parts.push_back(value);
  }
  if (!maps.empty()) {
    set_member(*map, "names", names, at);
    set_member(*map, "maps", parts, at);
  }
  return map;
}

Value number_map(Reader& reader, const Parameters& p, std::initializer_list<std::string_view> names, double otherwise) {
  const Parameter* found = p.first_of(names);
  if (!found) return Value(Number{otherwise}, p.at);
  if (found->is("texture")) return texture(reader, *found, false, otherwise);
  return Value(Number{p.first_number(found->name, otherwise)}, found->at);
}

Value color_map(Reader& reader, const Parameters& p, std::initializer_list<std::string_view> names, double otherwise, Use use) {
  const Parameter* found = p.first_of(names);
  if (!found) return Value(Number{otherwise}, p.at);
  if (found->is("texture")) return texture(reader, *found, true, otherwise);
  return Value(spectrum_of(reader, p, *found, use), found->at);
}

void make_texture(Reader& reader, const std::string& name, const std::string& kind, const std::string& type, Parameters&& p) {
  const bool spectrum = kind == "spectrum" || kind == "color";
  if (!spectrum && kind != "float") throw LeftOut(fmt::format("a texture is of float or spectrum, not of '{}'", kind), p.at);
  reader.named_depth = 0;
  Ref<Component> map = make_map(reader, type, spectrum, p);
  if (reader.named_depth >= Reader::most_nested)
    throw Error(fmt::format("textures that name textures nest more than {} deep", Reader::most_nested), p.at);
  reader.texture_depths[map.get()] = reader.named_depth + 1;
  if (map->origin && map->origin->name.empty()) map->origin->name = name;
  p.tell_unused(reader.importing);
  (spectrum ? reader.spectrum_textures : reader.float_textures)[name] = std::move(map);
}

}  // namespace etendue::pbrt
