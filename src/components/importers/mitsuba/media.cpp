// Participating media.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <optional>

#include "components/importers/measured_media.h"
#include "converter.h"
#include "etendue/describe/color.h"
#include "formats/permissions.h"
#include "tabulated_color.h"

namespace etendue::mitsuba {

namespace {

const std::vector<std::string> known_media = {"homogeneous", "heterogeneous"};

/// Sets the anisotropy g of an 'hg' phase function, for a medium or a phase function.
void set_lobe(Component& part, const Element& hg) { set_member(part, "anisotropy", hg.number("g", 0.8), hg.at); }

/// The RGB colour that a property states directly or by a nested spectrum; null: the property is something else.
const ColorValue* written_rgb(const Element& e, const std::string& name) {
  const Property* p = e.find(name);
  if (!p) return nullptr;
  if (const auto* c = std::get_if<ColorValue>(&p->value)) return c->kind == ColorValue::Kind::rgb ? c : nullptr;
  const Element* inner = std::holds_alternative<Nested>(p->value) ? e.nested(name) : nullptr;
  return inner && inner->type == "srgb" ? written_rgb(*inner, "color") : nullptr;
}

}  // namespace

// Mitsuba's spectral variants convert the RGB values of a medium, albedo or coefficients (which 'scale' multiplies later), to
// the spectrum of a surface of that colour if none is above 1. Larger values are refused by Mitsuba; they are read here as
// everywhere else, as a spectrum bounded by twice the largest component. docs/colour.md compares the two.
Color Converter::medium_color(const Element& e, const std::string& name, double otherwise) {
  const Property* const given_by = e.find(name);
  const Element* inner = given_by && std::holds_alternative<Nested>(given_by->value) ? e.nested(name) : nullptr;
  if (inner && inner->type != "constvolume") inner = nullptr;
  std::optional<Reading> reading;  // the caller may be reading the volume already
  if (inner && !inner->being_read) reading.emplace(*inner);
  const Element& says = inner ? *inner : e;
  const std::string property = inner ? "value" : name;
  const Color read = spectrum_of(says, property, otherwise);
  const ColorValue* const written = imports_for_rgb() ? nullptr : written_rgb(says, property);
  if (!written || std::ranges::any_of(written->rgb, [](double x) { return x > 1; })) return read;
  if (name != "albedo") return used_spectrum(ColorUse::reflectance, read);
  const std::array<double, 3> given{written->rgb[0], written->rgb[1], written->rgb[2]}, there = tabulated_color(given);
  // Whether the absorption, 1 - albedo, differs visibly.
  const bool differs = std::ranges::any_of(std::array<size_t, 3>{0, 1, 2}, [&](size_t i) {
    return std::abs(there[i] - given[i]) > 0.05 * (1 - given[i]) && std::abs(there[i] - given[i]) > 2e-4;
  });
  if (!differs) return read;
  const auto digits = [](double x) { return std::round(std::clamp(x, 0.0, 1.0) * 1e5) / 1e5; };
  return rgb_color("srgb", digits(there[0]), digits(there[1]), digits(there[2]));
}

Ref<Component> Converter::medium(const Element& e, const Component& object, const Element* glow) {
  if (e.tag != "medium") throw Error(fmt::format("a medium is expected, not a {}", e.tag), e.at);
  if (const auto known = media_.find(&e); known != media_.end() && !glow) return known->second;
  const Reading reading(e);
  std::optional<Reading> of_glow;
  if (glow) of_glow.emplace(*glow);
  if (e.type == "heterogeneous") return heterogeneous(e, object, glow);
  if (e.type != "homogeneous") {
    stand_in(e, known_media, "the medium is left out");
    return nullptr;
  }
  Ref<Component> made = homogeneous(e);
  if (glow)
    shine(*made, *glow, object);
  else
    media_.emplace(&e, made);
  return made;
}

// Emitter 'volumelight' of a shape: its "radiance" is the emission of the medium inside per distance, independent of
// absorption.
void Converter::shine(Component& medium, const Element& glow, const Component& object) {
  glow.ignore({"sampling_weight"});
  if (!glow.has("radiance")) {
    inexact(glow, "a 'volumelight' without 'radiance' is dark");
    return;
  }
  const Element* const volume = glow.nested("radiance");
  if (!volume || volume->type != "gridvolume") {
    set(medium, "emission", light(glow, "radiance", Uv::as_is));
    return;
  }
  if (medium.class_info().name != "MapVolume")
    throw Error("a grid of light is read in a medium alone whose 'sigma_t' is a grid too", volume->at);
  const Reading reading(*volume);
  const Ref<Component> grid = make("GridMap", *volume), read = make("ReadAsMap", *volume, "");
  set_grid(*grid, *volume, object);
  set_member(*grid, "outside", beyond_grid(*volume), volume->at);
  set_member(*read, "map", grid, volume->at);
  set_member(*read, "as", "coefficient", volume->at);  // Mitsuba does not multiply a grid used as light by a white point
  set_member(medium, "emission", read, volume->at);
  volume->ignore({"raw", "accel"});
}

void Converter::set_phase(Component& volume, const Element& e) {
  for (const Element* phase : e.all("phase")) {
    if (phase->type == "hg") {
      const Reading reading(*phase);
      set_lobe(volume, *phase);
    } else if (phase->type != "isotropic") {
      set_member(volume, "phase", phase_function(*phase), phase->at);
    }
  }
  e.ignore({"sample_emitters", "has_spectral_extinction", "majorant_resolution_factor", "control_density", "method", "strategy",
            "medium_sampling_weight", "medium_sampling_mode", "sigma_n"});
}

Ref<Component> Converter::phase_function(const Element& e) {
  const Reading reading(e);
  if (e.type == "isotropic") return make("HenyeyGreensteinPhase", e);
  if (e.type == "hg") {
    Ref<Component> made = make("HenyeyGreensteinPhase", e);
    set_lobe(*made, e);
    return made;
  }
  if (e.type == "rayleigh") return make("RayleighPhase", e);
  if (e.type == "tabphase") {
    Ref<Component> made = make("TabulatedPhase", e);
    set_member(*made, "values", Numbers{parse_numbers({e.string("values", ""), e.location_of("values")}), 1, Dimension::none},
               e.location_of("values"));
    return made;
  }
  if (e.type == "blendphase" || e.type == "mixturephase") return blended_phases(e);
  inexact(e, fmt::format("phase function '{}' has no counterpart here: light scatters alike in all directions", e.type));
  e.dismiss();
  return make("HenyeyGreensteinPhase", e);
}

Ref<Component> Converter::blended_phases(const Element& e) {
  const std::vector<const Element*> parts = e.all("phase");
  std::vector<double> weights;
  if (e.type == "mixturephase") {  // of version 0.5
    weights = parse_numbers({e.string("weights", ""), e.location_of("weights")});
  } else if (e.nested("weight")) {
    inexact(*e.nested("weight"), "phase functions are blended alike everywhere, here half and half");
    weights = {0.5, 0.5};
  } else {
    const double second = e.number("weight", 0.5);
    weights = {1 - second, second};
  }
  if (parts.size() < 2 || parts.size() != weights.size())
    throw Error(fmt::format("'{}' has {} phase functions and {} weights", e.type, parts.size(), weights.size()), e.at);
  if (std::ranges::any_of(weights, [](double w) { return !(w >= 0); })) throw Error("weights must not be negative", e.at);
  std::vector<Ref<Component>> made;
  for (const Element* part : parts) made.push_back(phase_function(*part));
  // Blends neighbours in pairs, then the results in pairs: a balanced tree, so that no phase function is nested deeply.
  while (made.size() > 1) {
    const size_t left = made.size() / 2;
    for (size_t k = 0; k < left; ++k) {
      const double sum = weights[2 * k] + weights[2 * k + 1];
      const Ref<Component> blend = make("BlendPhase", e);
      set_member(*blend, "first", made[2 * k], e.at);
      set_member(*blend, "second", made[2 * k + 1], e.at);
      set_member(*blend, "amount", sum > 0 ? weights[2 * k + 1] / sum : 0.0, e.at);
      made[k] = blend;
      weights[k] = sum;
    }
    if (made.size() % 2) made[left] = made.back(), weights[left] = weights.back();
    made.resize(left + made.size() % 2);
  }
  return made.front();
}

namespace {

/// The measured medium of this name, ignoring case; null: there is none.
const MeasuredMedium* measured_medium(std::string name) {
  const auto small = [](std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
  };
  name = small(name);
  if (name == "orange juice powder") name = "orange powder";
  for (const MeasuredMedium& m : measured_media())
    if (small(m.name) == name) return &m;
  return nullptr;
}

}  // namespace

Ref<Component> Converter::homogeneous(const Element& e) {
  Ref<Component> volume = make("HomogeneousVolume", e);
  set_phase(*volume, e);
  const double scale = e.number("scale", 1);
  const auto scaled = [&](const Color& c) { return scale == 1 ? c : scaled_spectrum(scale, c); };
  if (!e.old && !e.has("material") && !e.has("sigma_a") && !e.has("sigma_s")) {
    set_member(*volume, "extinction", scaled(medium_color(e, "sigma_t", 1)), e.location_of("sigma_t"));
    set_member(*volume, "albedo", medium_color(e, "albedo", 0.75), e.location_of("albedo"));
    return volume;
  }
  // Before version 2 coefficients that are not given come from a measured medium, in 1/mm.
  const MeasuredMedium* known = measured_medium("Skin1");
  if (e.has("material")) {
    const std::string name = e.string("material", "");
    if (const MeasuredMedium* named = measured_medium(name)) {
      known = named;
    } else {
      std::vector<std::string> names;
      for (const MeasuredMedium& m : measured_media()) names.emplace_back(m.name);
      importing_.inexact(fmt::format("there is no measured medium '{}'{}: Skin1 stands for it", name, suggestion(name, names)),
                         e.location_of("material"));
    }
  }
  std::array<double, 3> absorbed{}, scattered{}, whole{}, albedo{};
  const auto a_metre = [](double x) { return std::round(x * 1e11) / 1e9; };  // Mitsuba multiplies by 100; adds no digits
  for (size_t i = 0; i < 3; ++i) {
    absorbed[i] = a_metre(known->absorption[i]);
    scattered[i] = a_metre(known->scattering[i]);
    whole[i] = absorbed[i] + scattered[i];
    albedo[i] = scattered[i] / whole[i];
  }
  const auto given = [&](const char* name, const std::array<double, 3>& otherwise) {
    return e.has(name) ? medium_color(e, name, 0) : rgb_color("srgb", otherwise[0], otherwise[1], otherwise[2]);
  };
  if (!e.has("sigma_a") && !e.has("sigma_s") && (e.has("sigma_t") || e.has("albedo"))) {
    set_member(*volume, "extinction", scaled(given("sigma_t", whole)), e.location_of("sigma_t"));
    set_member(*volume, "albedo", given("albedo", albedo), e.location_of("albedo"));
  } else {
    set_member(*volume, "absorption", scaled(given("sigma_a", absorbed)), e.location_of("sigma_a"));
    set_member(*volume, "scattering", scaled(given("sigma_s", scattered)), e.location_of("sigma_s"));
  }
  return volume;
}

}  // namespace etendue::mitsuba
