// Functions that make colours, spectra and refractive indices.

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

#include "calls.h"
#include "etendue/describe/color.h"
#include "etendue/describe/sensor_curves.h"

namespace etendue::language {

namespace {

Value rgb(const Arguments& a) {
  if (const auto* list = a.as<Numbers>(a.count() == 2 ? 1 : 0); list && a.count() <= 2 && list->values.size() == 3)
    a.fail(a.count() - 1, fmt::format("the three numbers stand without brackets: write rgb({}{}, {}, {})",
                                      a.count() == 2 ? "\"…\", " : "", list->values[0], list->values[1], list->values[2]));
  if (a.count() != 3 && a.count() != 4) a.wrong_count();
  const size_t first = a.count() - 3;
  const std::string space = first == 1 ? a.string(0) : "srgb";
  return Value(rgb_color(space, a.number(first), a.number(first + 1), a.number(first + 2)));
}

Value srgb(const Arguments& a) {
  if (a.count() == 3) return Value(srgb_color(a.number(0), a.number(1), a.number(2)));
  if (a.count() != 1) a.wrong_count();
  const std::string& text = a.string(0);
  unsigned value = 0;
  const char* end = text.data() + text.size();
  if (text.size() != 7 || text[0] != '#' || std::from_chars(text.data() + 1, end, value, 16).ptr != end)
    a.fail(0, fmt::format("expects a colour such as \"#ff8000\", not \"{}\"", text));
  return Value(srgb_color((value >> 16) / 255.0, (value >> 8 & 255) / 255.0, (value & 255) / 255.0));
}

Value xyz(const Arguments& a) {
  if (a.count() != 3) a.wrong_count();
  return Value(xyz_color(a.number(0), a.number(1), a.number(2)));
}

Value blackbody(const Arguments& a) {
  if (a.count() != 1) a.wrong_count();
  return Value(blackbody_spectrum(a.number(0, Dimension::temperature)));
}

/// A colour from a table of names; errors are reported at the argument.
Value named(const Arguments& a, Color (*make)(const std::string&)) {
  if (a.count() != 1) a.wrong_count();
  const std::string& name = a.string(0);
  try {
    return Value(make(name));
  } catch (const Error& e) {
    a.fail(0, e.what());
  }
}

std::vector<float> floats(const Arguments& a, size_t i, double scale) {
  std::vector<float> result;
  for (const double x : a.numbers(i).values) {
    if (!(std::abs(x * scale) <= double(std::numeric_limits<float>::max()))) a.too_large(i, x * scale);
    result.push_back(float(x * scale));
  }
  return result;
}

Value spectrum(const Arguments& a) {
  if (a.count() != 1 && a.count() != 2) a.wrong_count();
  if (a.as<Numbers>(0)) {
    if (a.count() != 2) a.wrong_count();
    const Dimension unit = a.numbers(0).dimension;
    if (unit != Dimension::none && unit != Dimension::length) a.wrong(0, "a list of wavelengths [nm]");
    if (a.numbers(1).dimension != Dimension::none) a.wrong(1, "a list of plain numbers");
    return Value(table_spectrum(floats(a, 0, unit == Dimension::length ? 1e9 : 1), floats(a, 1, 1)));
  }
  const auto* text = a.as<std::string>(0);
  if (!text) a.wrong(0, "a file name or a list of wavelengths [nm]");
  const std::string column = a.count() == 2 ? a.string(1) : std::string();
  if (!a.files_allowed()) a.fail(0, "files are not allowed here");
  if (text->empty()) a.fail(0, "the file name is empty");
  // The path is made absolute: a spectrum does not store the folder of its description, and may be saved in another folder.
  const std::filesystem::path path = FilePath{*text, a[0].folder}.resolved();
  try {
    return Value(file_spectrum({std::filesystem::absolute(path).lexically_normal().string(), {}}, column));
  } catch (const Error& e) {
    a.fail(0, e.what());
  }
}

Value complex(const Arguments& a) {
  if (a.count() != 2) a.wrong_count();
  const auto part = [&](size_t i) {
    const auto* color = a.as<Color>(i);
    if (color) return *color;
    if (!a.as<Number>(i)) a.wrong(i, "a number or a spectrum");
    return flat_spectrum(float(a.number(i)));
  };
  return Value(complex_index(part(0), part(1)));
}

Value read_as(const Arguments& a) {
  if (a.count() != 2) a.wrong_count();
  const auto* color = a.as<Color>(1);
  if (!color) a.wrong(1, "a colour");
  try {
    return Value(used_spectrum(a.string(0), *color));
  } catch (const Error& e) {
    a.fail(0, e.what());
  }
}

Value sensor(const Arguments& a) {
  if (a.count() != 2) a.wrong_count();
  const std::string camera = a.string(0), channel = a.string(1);
  const auto curve_of = [&](const std::string& of, size_t blamed) {
    try {
      return sensor_curve(camera, of);
    } catch (const Error& e) {
      a.fail(blamed, e.what());
    }
  };
  static_cast<void>(curve_of(sensor_channels[0], 0));
  return Value(curve_of(channel, 1));
}

constexpr Function functions[] = {
    {"rgb", "rgb(red, green, blue) or rgb(\"space\", red, green, blue)", rgb},
    {"srgb", "srgb(red, green, blue) or srgb(\"#rrggbb\")", srgb},
    {"xyz", "xyz(x, y, z)", xyz},
    {"blackbody", "blackbody(temperature)", blackbody},
    {"illuminant", "illuminant(\"name\")", [](const Arguments& a) { return named(a, illuminant_spectrum); }},
    {"spectrum", "spectrum(\"file\"), spectrum(\"file\", \"column\") or spectrum([wavelengths in nm], [values])", spectrum},
    {"glass", "glass(\"name\")", [](const Arguments& a) { return named(a, glass_index); }},
    {"metal", "metal(\"name\")", [](const Arguments& a) { return named(a, metal_index); }},
    {"sensor", "sensor(\"camera\", \"red\")", sensor},
    {"complex", "complex(n, k)", complex},
    {"read_as", "read_as(\"use\", color)", read_as},
};

}  // namespace

std::span<const Function> color_functions() { return functions; }

}  // namespace etendue::language
