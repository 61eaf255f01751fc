// One sample alone, told vertex by vertex.

#include "app/replay.h"

#include <fmt/format.h>

namespace etendue {

namespace {

std::string numbers(const Spectrum& s) {
  std::string text;
  for (int i = 0; i < spectrum_size; ++i) text += fmt::format("{}{:>12.6g}", i ? " " : "", s[i]);
  return text;
}

template <class V>
std::string place(const V& v) {
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z);
}

std::string vertex_text(const PathRecord::Vertex& v, size_t place_in_path) {
  std::string text = fmt::format("vertex {}: {}{}\n", place_in_path, v.kind, v.object.empty() ? "" : " on " + v.object);
  const auto add = [&](const char* what, const std::string& value) { text += fmt::format("    {:<12}{}\n", what, value); };
  if (v.kind != "escaped") add("position", place(v.position) + " m");
  if (v.normal.x != 0 || v.normal.y != 0 || v.normal.z != 0) add("normal", place(v.normal));
  add("throughput", numbers(v.throughput));
  if (!v.emitted.black()) add("emitted", numbers(v.emitted));
  if (!v.direct.black()) add("direct", numbers(v.direct));
  if (!v.lobe.empty()) add("sampled", fmt::format("{}, density {:.6g}", v.lobe, v.density));
  if (!v.note.empty()) add("note", v.note);
  return text;
}

}  // namespace

std::string path_text(const PathRecord& record, Point2 film) {
  Spectrum lambda, density;
  for (int i = 0; i < spectrum_size; ++i) {
    lambda.set(i, record.wavelengths[i]);
    density.set(i, record.wavelengths.density(i));
  }
  std::string text = fmt::format("film point      ({:.6f}, {:.6f}) pixels\n", film.x, film.y);
  text += "wavelength [nm] " + numbers(lambda) + "\n";
  text += "density [1/nm]  " + numbers(density) + (record.wavelengths.single() ? "  (the hero alone is left)" : "") + "\n";
  for (size_t i = 0; i < record.vertices.size(); ++i) text += vertex_text(record.vertices[i], i);
  const Xyz color = to_xyz(record.result, record.wavelengths);
  text += "radiance        " + numbers(record.result) + "  W/(m^2 sr nm)\n";
  text += fmt::format("X Y Z           {:>12.6g} {:>12.6g} {:>12.6g}\n", color.x, color.y, color.z);
  return text;
}

}  // namespace etendue
