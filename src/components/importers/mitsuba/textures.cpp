// Converts colours, spectra and textures.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "converter.h"
#include "etendue/describe/color.h"

namespace etendue::mitsuba {

namespace {

const std::vector<std::string> known_textures = {
    "bitmap",    "checkerboard", "mesh_attribute", "vertexcolors", "scale",     "rawconstant", "srgb",   "uniform", "d65",
    "blackbody", "regular",      "irregular",      "gridtexture",  "wireframe", "curvature",   "volume", "uv"};

Numbers pair(double x, double y) { return {{x, y}, 1, Dimension::none}; }

}  // namespace

Color Converter::spectrum_of(const Element& e, const std::string& name, double otherwise) {
  const Property* p = e.find(name);
  if (!p) return flat_spectrum(float(otherwise));
  if (const auto* c = std::get_if<ColorValue>(&p->value)) return c->color;
  if (std::holds_alternative<Nested>(p->value)) {
    const Value v = texture(*e.nested(name), Uv::as_is);
    if (const auto* c = v.as<Color>()) return *c;
    if (const auto* n = v.as<Number>()) return flat_spectrum(float(n->value));
    throw Error(fmt::format("'{}' of '{}' must be the same everywhere here: textures are not read", name, e.type), p->at);
  }
  return flat_spectrum(float(e.number(name, otherwise)));
}

Value Converter::color(const Element& e, const std::string& name, double otherwise, Uv uv, Read read) {
  const Property* p = e.find(name);
  if (!p) return Value(Number{otherwise}, e.at);
  if (const auto* c = std::get_if<ColorValue>(&p->value))
    return c->kind == ColorValue::Kind::flat ? Value(Number{c->rgb[0]}, p->at) : Value(c->color, p->at);
  if (std::holds_alternative<Nested>(p->value)) return texture(*e.nested(name), uv, read);
  return Value(Number{e.number(name, otherwise)}, p->at);
}

Value Converter::scalar(const Element& e, const std::string& name, double otherwise, Uv uv) {
  Value v = color(e, name, otherwise, uv, e.old ? Read::mean : Read::luminance);
  if (const auto* c = e.find(name) ? std::get_if<ColorValue>(&e.find(name)->value) : nullptr) {
    // A colour used as a number is replaced by its luminance.
    const double y = 0.2126 * c->rgb[0] + 0.7152 * c->rgb[1] + 0.0722 * c->rgb[2];
    if (c->kind != ColorValue::Kind::table) v = Value(Number{y}, v.location);
  }
  return v;
}

Value Converter::texture(const Element& e, Uv uv, Read read) {
  const Reading reading(e);
  if (e.tag == "volume" && e.type == "constvolume") return color(e, "value", 1, uv);
  if (e.tag != "texture" && e.tag != "spectrum") throw Error(fmt::format("a texture is expected, not a {}", e.tag), e.at);
  if (e.type == "bitmap") return bitmap(e, uv, read);
  if (e.type == "checkerboard") return checkerboard(e, uv, read);
  if (e.type == "mesh_attribute" || e.type == "vertexcolors") return attribute_map(e);
  if (e.type == "srgb") return color(e, "color", 0.5, uv);
  if (e.type == "uniform" || e.type == "rawconstant") return color(e, "value", 1, uv);
  if (e.type == "d65") {
    const double scale = e.number("scale", 1);
    if (!e.has("color")) return Value(scaled_spectrum(scale, illuminant_spectrum("D65")), e.at);
    const Property& tint = *e.find("color");
    if (const auto* c = std::get_if<ColorValue>(&tint.value); c && c->kind == ColorValue::Kind::rgb)
      return Value(rgb_color("srgb", scale * c->rgb[0], scale * c->rgb[1], scale * c->rgb[2]), e.at);
    throw Error("the colour of 'd65' is read as rgb alone", tint.at);
  }
  if (e.type == "blackbody")
    return Value(scaled_spectrum(e.number("scale", 1), blackbody_spectrum(e.number("temperature", 5000))), e.at);
  if (e.type == "regular" || e.type == "irregular") {
    const std::vector<double> values = parse_numbers({e.string("values", ""), e.location_of("values")});
    std::vector<double> places;
    if (e.type == "irregular") {
      places = parse_numbers({e.string("wavelengths", ""), e.location_of("wavelengths")});
    } else {
      const double low = e.number("wavelength_min", e.number("lambda_min", 360)),  // "lambda_min" in version 2
          high = e.number("wavelength_max", e.number("lambda_max", 830));
      for (size_t i = 0; i < values.size(); ++i)
        places.push_back(low + (high - low) * double(i) / double(std::max<size_t>(values.size(), 2) - 1));
    }
    try {
      return Value(table_spectrum({places.begin(), places.end()}, {values.begin(), values.end()}), e.at);
    } catch (const Error& error) {
      throw Error(error.what(), e.at);
    }
  }
  if (e.type == "volume")
    if (const Element* inner = e.nested("volume"); inner && inner->type == "constvolume") return texture(*inner, uv);
  if (e.type == "scale") {
    const std::vector<const Element*> inner = e.all("texture");
    if (inner.empty()) throw Error("texture 'scale' needs a texture", e.at);
    Ref<Component> product = make("MultiplyMap", e);
    set(*product, "first", texture(*inner.front(), uv, read));
    set(*product, "second", color(e, "scale", 1, uv, read));
    return Value(product, e.at);
  }
  stand_in(e, known_textures, "0.5 stands for it");
  return Value(Number{0.5}, e.at);
}

Value Converter::bitmap(const Element& e, Uv uv, Read read) {
  Ref<Component> image = make("ImageMap", e);
  const auto found = importing_.optional_file(e.string("filename", ""), e.location_of("filename"), e.folder);
  if (!found) return Value(Number{0.5}, e.at);
  set_member(*image, "file", FilePath{*found, {}}, e.location_of("filename"));
  const std::string filter = e.string("filter_type", "bilinear");
  if (filter == "nearest")
    set_member(*image, "interpolation", "nearest", e.location_of("filter_type"));
  else if (filter != "bilinear")
    importing_.inexact(fmt::format("filter_type '{}' is taken for 'bilinear'", filter), e.location_of("filter_type"));
  const auto continued = [&](const char* key, const std::string& otherwise) {
    const std::string said = e.string(key, otherwise);
    if (said == "one") importing_.inexact("wrap mode 'one' is taken for 'black'", e.location_of(key));
    return said == "zero" || said == "one" ? std::string("black") : said;
  };
  const std::string both = e.string("wrap_mode", "").empty() ? "repeat" : continued("wrap_mode", "repeat"),
                    wrap = continued("wrap_mode_u", both), wrap_v = continued("wrap_mode_v", both);
  if (wrap != "repeat") set_member(*image, "wrap", wrap, e.location_of("wrap_mode"));
  if (wrap_v != wrap) set_member(*image, "wrap_v", wrap_v, e.location_of("wrap_mode_v"));
  if (e.boolean("raw", false)) set_member(*image, "transfer", "linear", e.location_of("raw"));
  if (e.has("gamma")) {
    const double gamma = e.number("gamma", 0);
    if (gamma == 1)
      set_member(*image, "transfer", "linear", e.location_of("gamma"));
    else if (gamma == 2.2)
      set_member(*image, "transfer", "gamma2.2", e.location_of("gamma"));
    else if (gamma > 0)
      importing_.inexact(fmt::format("a gamma of {} is taken for sRGB's", gamma), e.location_of("gamma"));
  }
  std::string channel = e.string("channel", "");
  if (channel == "r" || channel == "g" || channel == "b" || channel == "a")
    set_member(*image, "channel", std::string(1, char(std::toupper(channel[0]))), e.location_of("channel"));
  else if (!channel.empty())
    importing_.inexact(fmt::format("channel '{}' is not chosen", channel), e.location_of("channel"));
  else if (read == Read::luminance && importing_.image_channels(*found).size() >= 3)
    set_member(*image, "as_number", "luminance", e.at);
  e.ignore({"max_anisotropy", "cache", "format", "accel"});
  return placed(image, e, uv, true);
}

// When a number is read instead of a colour, Mitsuba 2 and 3 exchange the two colours.
Value Converter::checkerboard(const Element& e, Uv uv, Read read) {
  const bool exchanged = read != Read::color && !e.old;
  Ref<Component> map = make("CheckerMap", e);
  set(*map, exchanged ? "second" : "first", color(e, "color0", 0.4, uv, read));
  set(*map, exchanged ? "first" : "second", color(e, "color1", 0.2, uv, read));
  set_member(*map, "repeat", Numbers{{2, 2, 2}, 1, Dimension::none}, e.at);
  return placed(map, e, uv, false);
}

Value Converter::attribute_map(const Element& e) {
  Ref<Component> map = make("AttributeMap", e);
  std::string name = e.string("name", "vertex_color");
  // Vertex attributes have names without this prefix here.
  if (name.starts_with("vertex_")) name = name.substr(std::string_view("vertex_").size());
  set_member(*map, "name", name, e.location_of("name"));
  const double scale = e.number("scale", 1);
  if (scale == 1) return Value(map, e.at);
  Ref<Component> product = make("MultiplyMap", e, "");
  set_member(*product, "first", map, e.at);
  set_member(*product, "second", scale, e.at);
  return Value(product, e.at);
}

Transform Converter::to_uv(const Element& e) {
  Transform t = e.transform("to_uv").transform.still();
  if (e.has("uscale") || e.has("vscale") || e.has("uoffset") || e.has("voffset") || e.has("uvscale"))
    t = Transform::translate({e.number("uoffset", 0), e.number("voffset", 0), 0}) *
        Transform::scale({e.number("uscale", e.number("uvscale", 1)), e.number("vscale", e.number("uvscale", 1)), 1});
  return t;
}

Value Converter::placed(const Ref<Component>& map, const Element& e, Uv uv, bool counts_from_top) {
  const Transform turn_over(Transform::DoubleMatrix{1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 1, 0});
  Transform t = to_uv(e);
  if (uv == Uv::from_top) t = t * turn_over;
  if (counts_from_top) t = turn_over * t;
  const Transform::DoubleMatrix& m = t.exact();
  const double a = m[0], b = m[1], c = m[4], d = m[5];
  if (a == 1 && b == 0 && c == 0 && d == 1 && m[3] == 0 && m[7] == 0) return Value(map, e.at);
  const auto wrap = [&](const Ref<Component>& inner, double su, double sv, double angle, double x, double y) {
    Ref<Component> outer = make("UvTransformMap", e, "");
    set_member(*outer, "map", inner, e.at);
    if (su != 1 || sv != 1) set_member(*outer, "scale", pair(su, sv), e.at);
    if (angle != 0) set_member(*outer, "angle", angle * 180 / std::numbers::pi, e.at);
    if (x != 0 || y != 0) set_member(*outer, "shift", pair(x, y), e.at);
    return outer;
  };
  if (b == 0 && c == 0) return Value(wrap(map, a, d, 0, m[3], m[7]), e.at);
  // Coordinates are rotated, scaled and rotated again: the singular value decomposition of a 2 x 2 matrix.
  const double sum = std::atan2(c - b, a + d), difference = std::atan2(c + b, a - d);
  const double q = std::hypot(a + d, c - b) / 2, r = std::hypot(a - d, c + b) / 2;
  const double last = (sum + difference) / 2, first = (sum - difference) / 2;
  const Ref<Component> inner = wrap(map, q + r, q - r, last, m[3], m[7]);
  return Value(std::abs(first) < 1e-12 ? inner : wrap(inner, 1, 1, first, 0, 0), e.at);
}

}  // namespace etendue::mitsuba
