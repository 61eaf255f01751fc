// Numbers, spectra and transforms as Mitsuba writes them.

#include <regex>

#include "writer.h"

namespace etendue::mitsuba_export {

/// In degrees, of an angle.
double number_of(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  const Number* n = value.as<Number>();
  if (!n) return 0;
  return n->dimension == Dimension::angle ? n->value * 180 / std::numbers::pi : n->value;
}
bool truth_of(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  const bool* is = value.as<bool>();
  return is && *is;
}
std::string word_of(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  if (const FilePath* path = value.as<FilePath>()) return path->empty() ? "" : path->resolved();
  const std::string* text = value.as<std::string>();
  return text ? *text : std::string();
}
Ref<Component> part_of(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  const Ref<Component>* found = value.as<Ref<Component>>();
  return found ? *found : nullptr;
}
std::vector<double> numbers_of(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  const Numbers* found = value.as<Numbers>();
  return found ? found->values : std::vector<double>();
}
Color color_of(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  if (const Color* found = value.as<Color>()) return *found;
  const Number* n = value.as<Number>();
  return n ? flat_spectrum(float(n->value)) : nullptr;
}
AnimatedTransform transform_of(const Component& of, std::string_view member) {
  const Value value = get(of, member);
  if (const auto* moving = value.as<AnimatedTransform>()) return *moving;
  const auto* still = value.as<Transform>();
  return still ? AnimatedTransform(*still) : AnimatedTransform();
}

void Writer::value(Node parent, const char* tag, const char* name, const std::string& text) {
  Node n = parent.append_child(tag);
  n.append_attribute("name") = name;
  n.append_attribute("value") = text.c_str();
}

namespace {

/// The three components of what was written as rgb(...), perhaps times a number; nothing: it was written otherwise.
std::string as_rgb(const Color& c) {
  static const std::regex form(R"((?:([-+0-9.e]+) \* )?rgb\(([-+0-9.e]+), ([-+0-9.e]+), ([-+0-9.e]+)\))");
  std::smatch match;
  const std::string text = c->expression();
  if (!std::regex_match(text, match, form)) return {};
  const double factor = match[1].matched ? std::stod(match[1]) : 1;
  return fmt::format("{} {} {}", factor * std::stod(match[2]), factor * std::stod(match[3]), factor * std::stod(match[4]));
}

}  // namespace

void Writer::spectrum(Node parent, const char* name, const Color& c, ColorUse use) {
  if (const std::string rgb = as_rgb(c); !rgb.empty()) {
    value(parent, "rgb", name, rgb);
  } else if (!c->varies()) {
    value(parent, "spectrum", name, fmt::format("{}", c->at(550, use)));
  } else {
    // Between whole nanometres everything is linear or smooth; steps of five are fine enough for what is smooth.
    std::string table;
    for (int nm = 360; nm <= 830; nm += 5) table += fmt::format("{}{}:{:.7g}", nm > 360 ? ", " : "", nm, c->at(float(nm), use));
    value(parent, "spectrum", name, table);
  }
}

void Writer::transform(Node parent, const char* name, const Transform& t) {
  if (t.identity()) return;
  Node n = parent.append_child("transform");
  n.append_attribute("name") = name;
  const auto& m = t.exact();
  const std::string text = fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} 0 0 0 1", m[0], m[1], m[2], m[3], m[4], m[5], m[6],
                                       m[7], m[8], m[9], m[10], m[11]);
  n.append_child("matrix").append_attribute("value") = text.c_str();
}

Transform Writer::still(const AnimatedTransform& t, const Component& of) {
  if (t.animated()) exporting.inexact("motion is left out: things stand where their first key has them", &of);
  return t.written(t.keys().front().time);
}

}  // namespace etendue::mitsuba_export
