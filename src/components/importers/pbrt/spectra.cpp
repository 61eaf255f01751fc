// Spectra as pbrt writes them: RGB, lists, names, black bodies.

#include <fmt/format.h>

#include <cmath>

#include "color/planck.h"
#include "reader.h"

namespace etendue::pbrt {

namespace {

/// Glasses by Sellmeier's formula, with the figures of the Schott catalogue: B1 B2 B3, C1 C2 C3 [um^2].
struct Glass {
  const char* name;
  std::array<double, 3> b, c;
};
constexpr Glass glasses[] = {
    {"BAF10", {1.5851495, 0.143559385, 1.08521269}, {0.00926681282, 0.0424489805, 105.613573}},
    {"FK51A", {0.971247817, 0.216901417, 0.904651666}, {0.00472301995, 0.0153575612, 168.68133}},
    {"LASF9", {2.00029547, 0.298926886, 1.80691843}, {0.0121426017, 0.0538736236, 156.530829}},
    {"SF5", {1.52481889, 0.187085527, 1.42729015}, {0.011254756, 0.0588995392, 129.141675}},
    {"SF10", {1.62153902, 0.256287842, 1.64447552}, {0.0122241457, 0.0595736775, 147.468793}},
};

Color by_sellmeier(const Glass& glass) {
  std::vector<float> wavelengths, n;
  for (int nm = 360; nm <= 830; nm += 5) {
    const double l2 = nm * 1e-3 * nm * 1e-3;
    double squared = 1;
    for (size_t i = 0; i < 3; ++i) squared += glass.b[i] * l2 / (l2 - glass.c[i]);
    wavelengths.push_back(float(nm));
    n.push_back(float(std::sqrt(squared)));
  }
  return table_spectrum(wavelengths, n);
}

/// What pbrt names beside the metals that the language has: brass (Querry 1985, at three wavelengths), magnesia and rutile
/// (Palik 1985, n alone, as they do not absorb).
struct Optical {
  const char* name;
  std::vector<float> wavelengths, n, k;
};
const Optical opticals[] = {
    {"CuZn", {360, 465, 532, 630, 830}, {0.947f, 0.947f, 0.5682f, 0.445f, 0.445f}, {1.92f, 1.92f, 2.588f, 3.522f, 3.522f}},
    {"MgO",
     {360, 382, 436, 486, 546, 589, 633, 706, 768, 830},
     {1.7732f, 1.7668f, 1.7547f, 1.7471f, 1.7408f, 1.7374f, 1.7346f, 1.731f, 1.7287f, 1.727f},
     {0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
    {"TiO2",
     {360, 388, 400, 420, 440, 460, 480, 500, 540, 580, 620, 660, 700, 760, 830},
     {3.87f, 3.49f, 3.4f, 3.29f, 3.2f, 3.13f, 3.08f, 3.03f, 2.96f, 2.92f, 2.88f, 2.85f, 2.83f, 2.81f, 2.79f},
     {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}},
};

/// From pairs of wavelength [nm] and value. v3 goes on with the first and last value, v4 with nothing.
Color from_pairs(const Reader& reader, const Parameter& p) {
  if (p.numbers.empty() || p.numbers.size() % 2 != 0)
    throw Error(fmt::format("'{}' must be pairs of a wavelength and a value", p.name), p.at);
  std::vector<float> wavelengths, values;
  const auto add = [&](double nm, double value) {
    wavelengths.push_back(float(nm));
    values.push_back(float(value));
  };
  for (size_t i = 0; i < p.numbers.size(); i += 2) {
    if (reader.version == 3 && i == 0 && p.numbers[0] > 360) add(360, p.numbers[1]);
    add(p.numbers[i], p.numbers[i + 1]);
  }
  if (reader.version == 3 && wavelengths.back() < 830) add(830, values.back());
  return table_spectrum(wavelengths, values);
}

/// A file of wavelengths and values.
Color from_file(Reader& reader, const Parameters& parameters, const Parameter& p) {
  const std::string path = reader.importing.file(p.strings[0], p.at, parameters.folder);
  return file_spectrum(FilePath{path, {}});
}

/// With a highest value of 1, wherever that lies.
Color normalized_blackbody(double kelvin, Location at) {
  if (!(kelvin > 0)) throw Error("a black body's temperature must be more than 0 K", at);
  return scaled_spectrum(1 / highest_planck(kelvin), blackbody_spectrum(kelvin));
}

Color by_name(Reader& reader, const Parameters& parameters, const Parameter& p) {
  if (p.strings.size() != 1 || !p.numbers.empty()) throw Error(fmt::format("'{}' must be one spectrum", p.name), p.at);
  if (Color named = named_spectrum(p.strings[0])) return named;
  return from_file(reader, parameters, p);
}

Color components(Reader& reader, const Parameters& parameters, const Parameter& p, Use use) {
  if (p.numbers.size() != 3) throw Error(fmt::format("'{}' must be three numbers, not {}", p.name, p.numbers.size()), p.at);
  std::array<double, 3> n{p.numbers[0], p.numbers[1], p.numbers[2]};
  if (p.is("xyz")) return xyz_color(n[0], n[1], n[2]);
  for (double& x : n) {
    if (x < 0) throw Error(fmt::format("'{}' must not be negative", p.name), p.at);
    if (use == Use::reflectance && x > 1) {
      reader.importing.inexact(fmt::format("'{}' is at most 1 here: more light would leave than arrives", p.name), p.at);
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

/// With a luminance of 1, as v4 makes every light's spectrum.
Color with_unit_luminance(const Color& color, const Parameter& p) {
  const double y = double(to_xyz(*color, ColorUse::radiance).y);
  if (!(y > 0)) throw Error(fmt::format("the light of '{}' has no brightness, by which pbrt divides it", p.name), p.at);
  return scaled_spectrum(1 / y, color);
}

}  // namespace

Color named_spectrum(const std::string& name) {
  if (name.starts_with("glass-")) {
    const std::string glass = name.substr(6);
    if (glass == "BK7") return glass_index("N-BK7");
    if (glass == "SF11" || glass == "F11") return glass_index("N-SF11");
    for (const Glass& g : glasses)
      if (glass == g.name || (glass[0] == 'F' && glass == std::string(g.name).substr(1))) return by_sellmeier(g);
  }
  // D60 as the ACES state it, of the chromaticity (0.32168, 0.33767): 0.728 of the way from D50 to D65, which comes within
  // 0.0007.
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
  for (const Optical& o : opticals) {
    if (name == fmt::format("metal-{}-eta", o.name)) return table_spectrum(o.wavelengths, o.n);
    if (name == fmt::format("metal-{}-k", o.name)) return table_spectrum(o.wavelengths, o.k);
  }
  for (const char* kind : {"glass-", "stdillum-", "metal-"})
    if (name.starts_with(kind)) throw Error(fmt::format("the spectrum '{}' is not known here", name));
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
      // v3 has a scale as a second number.
      if (p.numbers.size() == 2 && p.numbers[1] != 1) color = scaled_spectrum(p.numbers[1], color);
    } else if (p.is("spectrum") && !p.strings.empty()) {
      color = by_name(reader, parameters, p);
    } else if (p.is("spectrum")) {
      color = from_pairs(reader, p);
    } else if (p.is("float") && p.numbers.size() == 1) {
      // A number where a spectrum is expected is the same at all wavelengths.
      color = flat_spectrum(float(p.numbers[0]));
    } else {
      throw Error(fmt::format("'{}' of {} must be a spectrum, not a {}", p.name, parameters.of, p.type), p.at);
    }
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
  // A metal whose n and k are both named is that metal, by its name.
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
    // The real part alone, as a table.
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
