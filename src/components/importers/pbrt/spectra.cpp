// Converts pbrt's spectra: RGB, lists, names, black bodies.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "color/planck.h"
#include "reader.h"

namespace etendue::pbrt {

namespace {

/// pbrt's names of glasses, and the names here. pbrt's "F5", "F10" and "F11" are SF5, SF10 and SF11.
constexpr std::pair<const char*, const char*> glasses[] = {
    {"BK7", "N-BK7"}, {"BAF10", "N-BAF10"}, {"FK51A", "N-FK51A"}, {"LASF9", "N-LASF9"}, {"F5", "N-SF5"},
    {"SF5", "N-SF5"}, {"F10", "N-SF10"},    {"SF10", "N-SF10"},   {"F11", "N-SF11"},    {"SF11", "N-SF11"},
};

/// Throws Error for an unknown name with one of pbrt's prefixes.
[[noreturn]] void fail_unknown_spectrum(const std::string& name) {
  std::vector<std::string> known;
  for (const auto& [theirs, ours] : glasses) known.push_back(std::string("glass-") + theirs);
  for (const std::string& light : illuminant_names()) known.push_back("stdillum-" + light);
  for (const std::string& metal : metal_names())
    for (const char* part : {"-eta", "-k"}) known.push_back("metal-" + metal + part);
  throw Error(fmt::format("the spectrum '{}' is not known here{}", name, suggestion(name, known)));
}

/// From pairs of wavelength [nm] and value. Outside their range v3 continues the first and last value, v4 is 0. v3 accepts them
/// in any order.
Color from_pairs(const Reader& reader, const Parameter& p) {
  if (p.numbers.empty() || p.numbers.size() % 2 != 0)
    throw Error(fmt::format("'{}' must be pairs of a wavelength and a value", p.name), p.at);
  std::vector<std::pair<double, double>> pairs;
  for (size_t i = 0; i < p.numbers.size(); i += 2) pairs.emplace_back(p.numbers[i], p.numbers[i + 1]);
  std::vector<float> wavelengths, values;
  const auto add = [&](double nm, double value) {
    wavelengths.push_back(float(nm));
    values.push_back(float(value));
  };
  if (reader.version == 3) std::ranges::stable_sort(pairs);
  if (reader.version == 3 && pairs[0].first > 360) add(360, pairs[0].second);
  for (const auto& [nm, value] : pairs) add(nm, value);
  if (reader.version == 3 && wavelengths.back() < 830) add(830, values.back());
  return table_spectrum(wavelengths, values);
}

/// A file of wavelengths and values. If it is missing, v3 continues with black; for an index of refraction 0 is invalid, so
/// this throws Error.
Color from_file(Reader& reader, const Parameters& parameters, const Parameter& p, Use use) {
  try {
    return file_spectrum(FilePath{reader.importing.file(p.strings[0], p.at, parameters.folder), {}});
  } catch (const Error& e) {
    if (reader.version != 3 || use == Use::coefficient) throw;
    reader.importing.inexact(fmt::format("{}: '{}' is black, as by version 3 of pbrt", e.what(), p.name), p.at);
    return flat_spectrum(0);
  }
}

/// Normalized to a maximum of 1.
Color normalized_blackbody(double kelvin, Location at) {
  if (!(kelvin > 0)) throw Error("a black body's temperature must be more than 0 K", at);
  return scaled_spectrum(1 / highest_planck(kelvin), blackbody_spectrum(kelvin));
}

Color by_name(Reader& reader, const Parameters& parameters, const Parameter& p, Use use) {
  if (p.strings.size() != 1 || !p.numbers.empty()) throw Error(fmt::format("'{}' must be one spectrum", p.name), p.at);
  if (Color named = named_spectrum(p.strings[0])) return named;
  return from_file(reader, parameters, p, use);
}

void tell_cut(Reader& reader, const Parameter& p) {
  reader.importing.inexact(fmt::format("'{}' is at most 1 here: more light would leave than arrives", p.name), p.at);
}

/// Clamps to at most 1 at every wavelength.
Color cut_reflectance(Reader& reader, const Color& color, const Parameter& p) {
  if (range_of(*color, ColorUse::reflectance).most <= 1.0001) return color;
  tell_cut(reader, p);
  std::vector<float> wavelengths, values;
  for (int nm = 360; nm <= 830; ++nm) {
    wavelengths.push_back(float(nm));
    values.push_back(std::min(color->at(float(nm), ColorUse::reflectance), 1.0f));
  }
  return table_spectrum(wavelengths, values);
}

Color components(Reader& reader, const Parameters& parameters, const Parameter& p, Use use) {
  if (p.numbers.size() > 3 && reader.version == 3)
    reader.importing.inexact(fmt::format("'{}' must be three numbers, not {}: the first three count", p.name, p.numbers.size()),
                             p.at);
  else if (p.numbers.size() != 3)
    throw Error(fmt::format("'{}' must be three numbers, not {}", p.name, p.numbers.size()), p.at);
  std::array<double, 3> n{p.numbers[0], p.numbers[1], p.numbers[2]};
  if (p.is("xyz")) return xyz_color(n[0], n[1], n[2]);
  for (double& x : n) {
    if (x < 0) throw Error(fmt::format("'{}' must not be negative", p.name), p.at);
    if (use == Use::reflectance && x > 1) {
      tell_cut(reader, p);
      x = 1;
    }
  }
  return rgb_color(parameters.space ? parameters.space->name : "srgb", n[0], n[1], n[2]);
}

Color located(const Parameter& p, const auto& make) {
  try {
    return make();
  } catch (const Error& e) {
    throw Error(e.what(), e.location.known() ? e.location : p.at);
  }
}

/// Normalized to a luminance of 1, as v4 does for every light.
Color with_unit_luminance(const Color& color, const Parameter& p) {
  const double y = double(to_xyz(*color, ColorUse::radiance).y);
  if (!(y > 0)) throw Error(fmt::format("the light of '{}' has no brightness, by which pbrt divides it", p.name), p.at);
  return scaled_spectrum(1 / y, color);
}

}  // namespace

Color named_spectrum(const std::string& name) {
  if (name.starts_with("glass-")) {
    const std::string glass = name.substr(6);
    for (const auto& [theirs, ours] : glasses)
      if (glass == theirs) return glass_index(ours);
  }
  // The ACES D60 illuminant has the chromaticity (0.32168, 0.33767); 0.728 of the way from D50 to D65 comes within 0.0007 of
  // it.
  if (name == "illum-acesD60") {
    const Color d50 = illuminant_spectrum("D50"), d65 = illuminant_spectrum("D65");
    std::vector<float> wavelengths, power;
    for (int nm = 360; nm <= 830; nm += 5) {
      wavelengths.push_back(float(nm));
      power.push_back(std::lerp(d50->at(float(nm), ColorUse::radiance), d65->at(float(nm), ColorUse::radiance), 0.728f));
    }
    return table_spectrum(wavelengths, power);
  }
  if (name.starts_with("stdillum-"))
    for (const std::string& known : illuminant_names())
      if (name.substr(9) == known) return illuminant_spectrum(known);
  if (name.starts_with("metal-"))
    for (const std::string& metal : metal_names()) {
      if (name == "metal-" + metal + "-eta") return metal_index(metal);
      if (name == "metal-" + metal + "-k") return metal_index(metal)->imaginary();
    }
  for (const char* kind : {"glass-", "stdillum-", "metal-"})
    if (name.starts_with(kind)) fail_unknown_spectrum(name);
  return nullptr;
}

Color spectrum_of(Reader& reader, const Parameters& parameters, const Parameter& p, Use use) {
  return located(p, [&]() -> Color {
    const bool normalize = use == Use::light && reader.version == 4;
    Color color;
    if (p.is("rgb") || p.is("color") || p.is("xyz")) return components(reader, parameters, p, use);
    if (p.is("blackbody")) {
      if (p.numbers.empty() || !p.strings.empty() || p.numbers.size() > 2)
        throw Error(fmt::format("'{}' must be a temperature in kelvins", p.name), p.at);
      color = normalized_blackbody(p.numbers[0], p.at);
      // v3 has an optional scale as a second number.
      if (p.numbers.size() == 2 && p.numbers[1] != 1) color = scaled_spectrum(p.numbers[1], color);
    } else if (p.is("spectrum") && !p.strings.empty()) {
      color = by_name(reader, parameters, p, use);
    } else if (p.is("spectrum")) {
      color = from_pairs(reader, p);
    } else if (p.is("float") && p.numbers.size() == 1) {
      // A number instead of a spectrum is constant over wavelengths.
      color = flat_spectrum(float(p.numbers[0]));
    } else {
      throw Error(fmt::format("'{}' of {} must be a spectrum, not a {}", p.name, parameters.of, p.type), p.at);
    }
    if (use == Use::reflectance) return cut_reflectance(reader, color, p);
    return normalize ? with_unit_luminance(color, p) : color;
  });
}

Value index_of(Reader& reader, const Parameters& parameters, std::initializer_list<std::string_view> names, double otherwise) {
  const Parameter* p = parameters.first_of(names);
  if (!p) return Value(Number{otherwise}, parameters.at);
  if (p->is("texture")) {
    reader.importing.inexact(fmt::format("an index of refraction that a texture says is {} everywhere here", otherwise), p->at);
    return Value(Number{otherwise}, p->at);
  }
  if (p->is("float")) return Value(Number{parameters.number(p->name, otherwise)}, p->at);
  Color color;
  try {
    color = spectrum_of(reader, parameters, *p, Use::coefficient);
  } catch (const Error& e) {
    reader.importing.inexact(fmt::format("{}: {} is taken", e.what(), otherwise), p->at);
    return Value(Number{otherwise}, p->at);
  }
  return Value(color, p->at);
}

Color metal_of(Reader& reader, const Parameters& parameters, const std::string& prefix) {
  const Parameter* eta = parameters.find(prefix + "eta");
  const Parameter* k = parameters.find(prefix + "k");
  const auto either = [&](const Parameter* p, bool imaginary) -> Color {
    const Color copper = metal_index("Cu");
    if (!p) return imaginary ? copper->imaginary() : copper;
    if (p->is("texture")) {
      reader.importing.inexact("a metal's index of refraction that a texture says is copper's here", p->at);
      return imaginary ? copper->imaginary() : copper;
    }
    try {
      return spectrum_of(reader, parameters, *p, Use::coefficient);
    } catch (const Error& e) {
      reader.importing.inexact(fmt::format("{}: that of copper is taken", e.what()), p->at);
      return imaginary ? copper->imaginary() : copper;
    }
  };
  // If n and k name the same metal, that metal is used by its name.
  const auto named = [](const Parameter* p, const char* ending) {
    const std::string name = !p ? std::string("metal-Cu") + ending : p->strings.size() == 1 ? p->strings[0] : std::string();
    const std::string_view end = ending;
    return name.starts_with("metal-") && name.ends_with(end) ? name.substr(6, name.size() - 6 - end.size()) : std::string();
  };
  const std::string metal = named(eta, "-eta");
  for (const std::string& known : metal_names())
    if (metal == known && named(k, "-k") == known) return metal_index(known);
  const auto real = [](Color c) {
    if (!c->imaginary()) return c;
    // Only the real part, as a table.
    std::vector<float> wavelengths, n;
    for (int nm = 360; nm <= 830; nm += 5) {
      wavelengths.push_back(float(nm));
      n.push_back(c->at(float(nm), ColorUse::coefficient));
    }
    return table_spectrum(wavelengths, n);
  };
  return complex_index(real(either(eta, false)), either(k, true));
}

}  // namespace etendue::pbrt
