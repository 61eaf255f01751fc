// Numbers, spectra and transforms as pbrt writes them.

#include <regex>

#include "writer.h"

namespace etendue::pbrt_export {

namespace {

/// What a float holds, as it would be written: 0.3 and not 0.30000001192092896.
double shortest(double value) { return double(float(value)) == value ? std::stod(fmt::format("{}", float(value))) : value; }

}  // namespace

double number(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  const Number* n = value.as<Number>();
  if (!n) return 0;
  // Angles come in radians; pbrt has degrees, as all members here that it can express.
  return n->dimension == Dimension::angle ? shortest(double(float(n->value * 180 / 3.14159265358979323846)))
                                          : shortest(n->value);
}
bool truth(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  const bool* is = value.as<bool>();
  return is && *is;
}
std::string word(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  if (const FilePath* path = value.as<FilePath>()) return path->resolved();
  const std::string* text = value.as<std::string>();
  return text ? *text : std::string();
}
Ref<Component> part(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  const Ref<Component>* found = value.as<Ref<Component>>();
  return found ? *found : nullptr;
}
std::vector<double> numbers(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  const Numbers* found = value.as<Numbers>();
  std::vector<double> all = found ? found->values : std::vector<double>();
  for (double& x : all) x = shortest(x);
  return all;
}
Color color(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  if (const Color* found = value.as<Color>()) return *found;
  const Number* n = value.as<Number>();
  return n ? flat_spectrum(float(n->value)) : nullptr;
}
Color constant(const Component& map) { return map.class_info().name == "ConstantMap" ? color(map, "value") : nullptr; }

std::string matrix(const Transform& t) {
  const auto& m = t.exact();
  return fmt::format("[ {} {} {} 0 {} {} {} 0 {} {} {} 0 {} {} {} 1 ]", m[0], m[4], m[8], m[1], m[5], m[9], m[2], m[6], m[10],
                     m[3], m[7], m[11]);
}

namespace {

/// The three components of what was written as rgb(...), perhaps times a number; nothing: it was written otherwise.
std::string as_rgb(const Color& c) {
  static const std::regex form(R"((?:([-+0-9.e]+) \* )?rgb\(([-+0-9.e]+), ([-+0-9.e]+), ([-+0-9.e]+)\))");
  std::smatch match;
  const std::string text = c->expression();
  if (!std::regex_match(text, match, form)) return {};
  const double factor = match[1].matched ? std::stod(match[1]) : 1;
  return fmt::format("[ {} {} {} ]", factor * std::stod(match[2]), factor * std::stod(match[3]), factor * std::stod(match[4]));
}

/// Between whole nanometres everything is linear or smooth; steps of five are fine enough for what is smooth.
std::string sampled(const Color& c, ColorUse use, double factor = 1) {
  std::string text = "[";
  for (int nm = 360; nm <= 830; nm += 5) text += fmt::format(" {} {:.7g}", nm, factor * double(c->at(float(nm), use)));
  return text + " ]";
}

}  // namespace

std::string Writer::spectrum(const char* name, const Color& c, ColorUse use) const {
  if (const std::string rgb = as_rgb(c); !rgb.empty()) return fmt::format(" \"rgb {}\" {}", name, rgb);
  if (!c->varies()) {
    const float value = c->at(550, use);
    if (use == ColorUse::reflectance) return fmt::format(" \"rgb {}\" [ {} {} {} ]", name, value, value, value);
    return fmt::format(" \"spectrum {}\" [ 360 {} 830 {} ]", name, value, value);
  }
  return fmt::format(" \"spectrum {}\" {}", name, sampled(c, use));
}

std::string Writer::light(const char* name, const Color& c) const {
  if (const std::string rgb = as_rgb(c); !rgb.empty()) return fmt::format(" \"rgb {}\" {}", name, rgb);
  const double y = to_xyz(*c, ColorUse::radiance).y;
  if (!(y > 0)) return fmt::format(" \"rgb {}\" [ 0 0 0 ]", name);
  return fmt::format(" \"spectrum {}\" {} \"float scale\" {}", name, sampled(c, ColorUse::radiance, 1 / y), y);
}

std::string Writer::light_of(const Component& emission, const char* name, const SceneObject& object) {
  const Ref<Component> map = part(emission, "radiance");
  const Color c = map ? constant(*map) : nullptr;
  if (!c) {
    exporting.inexact("light that differs from place to place or with directions is white of 1", &emission);
    return {};
  }
  const double factor = amount_of(emission, *c, object);
  return light(name, factor == 1 ? c : scaled_spectrum(factor, c));
}

// A diffuse luminaire of area A sends out pi A times its radiance on each side, a point 4 pi times its intensity.
double Writer::amount_of(const Component& emission, const SpectralFunction& radiance, const SceneObject& object) {
  for (const char* amount : {"luminous_intensity", "illuminance"})
    if (emission.class_info().find(amount) && number(emission, amount) > 0)
      exporting.inexact(fmt::format("an amount of light in '{}' is left out: it is as strong as its radiance says", amount),
                        &emission);
  if (!emission.class_info().find("power")) return 1;
  const double watts = number(emission, "power"), lumens = number(emission, "luminous_flux");
  if (watts == 0 && lumens == 0) return 1;
  const bool point = object.class_info().name == "Point";
  if (emission.class_info().name != "DiffuseEmission" || object.infinite() || object.class_info().name == "Distant") {
    exporting.inexact("an amount of light is left out: it is as strong as its radiance says", &emission);
    return 1;
  }
  double sum = 0, seen = 0;  // over wavelengths, in W and lm per m^2 and sr
  for (int nm = 360; nm <= 830; ++nm) {
    const auto value = double(radiance.at(float(nm), ColorUse::radiance));
    sum += value;
    seen += 683.002 * observer(float(nm)).y * value;
  }
  // A copy, as objects may change what they hold when they are prepared.
  const Ref<SceneObject> twin = ref_cast<SceneObject>(copy(object));
  if (!point) prepare_tree(*twin);
  const double each = point ? 4 : double(twin->area(0)) * (word(emission, "sides") == "both" ? 2 : 1);
  const double given = 3.14159265358979323846 * each * (watts > 0 ? sum : seen);
  return given > 0 ? (watts > 0 ? watts : lumens) / given : 1;
}

std::string Writer::transform_of(const AnimatedTransform& t, const char* directive) {
  const auto& keys = t.keys();
  if (keys.size() == 1) return t.still().identity() ? "" : fmt::format("{} {}\n", directive, matrix(t.still()));
  if (keys.size() > 2) exporting.inexact("of a motion with more than two keys the first and the last are kept");
  return fmt::format("ActiveTransform StartTime {0} {1}\nActiveTransform EndTime {0} {2}\nActiveTransform All\n", directive,
                     matrix(keys.front().transform), matrix(keys.back().transform));
}

}  // namespace etendue::pbrt_export
