// Writes numbers, spectra and transforms in Mitsuba's syntax.

#include <algorithm>

#include "writer.h"

namespace etendue::mitsuba_export {

void Writer::value(Node parent, const char* tag, const char* name, const std::string& text) {
  Node n = parent.append_child(tag);
  n.append_attribute("name") = name;
  n.append_attribute("value") = text.c_str();
}

void Writer::spectrum(Node parent, const char* name, const Color& c, ColorUse use) {
  if (auto rgb = written_rgb(c)) {
    // This program clamps reflectances to 1, Mitsuba refuses larger ones.
    if (use == ColorUse::reflectance)
      for (double& component : *rgb) component = std::clamp(component, 0.0, 1.0);
    value(parent, "rgb", name, fmt::format("{} {} {}", (*rgb)[0], (*rgb)[1], (*rgb)[2]));
  } else if (!c->varies()) {
    value(parent, "spectrum", name, fmt::format("{}", c->at(550, use)));
  } else {
    std::string table;
    for (const auto& [nm, x] : sampled(c, use)) table += fmt::format("{}{}:{:.7g}", table.empty() ? "" : ", ", nm, x);
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
