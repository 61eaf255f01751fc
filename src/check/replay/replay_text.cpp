// Writes replayed samples as text.

#include <fmt/format.h>

#include "etendue/describe/bands.h"
#include "replay.h"

namespace etendue {

std::string replay_command(const std::string& picture_command, int x, int y, std::uint32_t sample) {
  return fmt::format("{} --pixel {},{} --sample {}", picture_command, x, y, sample);
}

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

/// Far from the origin more digits are printed, so that nearby points differ.
std::string place(const DoublePoint3& p) {
  const double largest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z), 1.0});
  const int digits = std::clamp(4 + int(std::log10(largest)), 6, 15);
  return fmt::format("({:.{}g}, {:.{}g}, {:.{}g})", p.x, digits, p.y, digits, p.z, digits);
}

std::string vertex_text(const PathRecord::Vertex& v, const char* what, size_t place_in_path) {
  std::string text = fmt::format("{} {}: {}{}\n", what, place_in_path, v.kind, v.object.empty() ? "" : " on " + v.object);
  const auto add = [&](const char* label, const std::string& value) { text += fmt::format("    {:<12}{}\n", label, value); };
  if (v.kind != "escaped") add("position", place(v.position) + " m");
  if (v.normal.x != 0 || v.normal.y != 0 || v.normal.z != 0) add("normal", place(v.normal));
  add("throughput", numbers(v.throughput));
  if (!v.emitted.black()) add("emitted", numbers(v.emitted));
  if (!v.direct.black()) add("direct", numbers(v.direct));
  if (!v.lobe.empty()) add("sampled", fmt::format("{}, pdf {:.6g}", v.lobe, v.pdf));
  if (!v.note.empty()) add("note", v.note);
  return text;
}

std::string contribution_text(const PathRecord::Contribution& c, const Wavelengths& wavelengths) {
  std::string text =
      fmt::format("    {}, length {}, weight {:.6g}, Y {:.6g}", c.strategy, c.length, c.weight, to_xyz(c.value, wavelengths).y);
  if (c.splat) text += fmt::format(", falls at ({:.6f}, {:.6f})", c.film.x, c.film.y);
  return text + fmt::format("\n    {:<12}{}\n", "", numbers(c.value));
}

std::string percent(double fraction) { return fmt::format("{:.3g} %", 100 * fraction); }

}  // namespace

std::string path_text(const PathRecord& record, Point2 film) {
  Spectrum lambda, pdf;
  for (int i = 0; i < spectrum_size; ++i) {
    lambda.set(i, record.wavelengths[i]);
    pdf.set(i, record.wavelengths.pdf(i));
  }
  std::string text = fmt::format("film point      ({:.6f}, {:.6f}) pixels\n", film.x, film.y);
  if (in_bands(record.wavelengths))
    text += "bands           red, green, blue, repeated\n";
  else
    text += "wavelength [nm] " + numbers(lambda) + "\n" + "density [1/nm]  " + numbers(pdf) +
            (record.wavelengths.single() ? "  (the hero alone is left)" : "") + "\n";
  for (size_t i = 0; i < record.vertices.size(); ++i) text += vertex_text(record.vertices[i], "vertex", i);
  for (size_t i = 0; i < record.light_vertices.size(); ++i) text += vertex_text(record.light_vertices[i], "light vertex", i);
  if (!record.contributions.empty()) text += "contributions\n";
  for (const PathRecord::Contribution& c : record.contributions) text += contribution_text(c, record.wavelengths);
  const Xyz color = to_xyz(record.result, record.wavelengths);
  text += "radiance        " + numbers(record.result) + "  W/(m^2 sr nm)\n";
  text += fmt::format("X Y Z           {:>12.6g} {:>12.6g} {:>12.6g}\n", color.x, color.y, color.z);
  return text;
}

std::string replay_text(const PixelReplay& replay, const std::string& picture_command) {
  std::string text;
  if (replay.luminance) {
    double light = 0;
    for (const ReplayedPath& path : replay.paths) light += path.share.value_or(0);
    text += fmt::format("pixel {},{}: {} samples, mean Y {:.6g}", replay.x, replay.y, replay.samples, *replay.luminance);
    if (*replay.luminance > 0) text += fmt::format("; the {} brightest bring {} of it", replay.paths.size(), percent(light));
    text += "\n";
  }
  for (const ReplayedPath& path : replay.paths) {
    if (replay.luminance) {
      text += fmt::format("\nsample {}: Y {:.6g}", path.sample, path.luminance);
      if (path.share) text += fmt::format(", {} of its pixel's light", percent(*path.share));
      text += "\n" + replay_command(picture_command, replay.x, replay.y, path.sample) + "\n";
    } else {
      text += fmt::format("pixel {},{} sample {}\n", replay.x, replay.y, path.sample);
      if (path.sample >= replay.samples)
        text += fmt::format("(the picture has samples 0 to {}; this one is not in it)\n", replay.samples - 1);
    }
    text += path_text(path.record, path.film);
    if (path.bad) text += "This is not a finite non-negative spectrum: it counts as black.\n";
    if (path.splatted > 0) text += fmt::format("Y splatted      {:>12.6g}\n", path.splatted);
  }
  return text;
}

}  // namespace etendue
