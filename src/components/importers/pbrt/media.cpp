// Media.

#include <fmt/format.h>

#include <algorithm>

#include "media.h"

namespace etendue::pbrt {

namespace {

/// Of Jensen et al. 2001, "A practical model for subsurface light transport", table 1.
constexpr Measured measured[] = {
    {"Apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}}, {"Chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}},
    {"Chicken2", {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}}, {"Cream", {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}},
    {"Ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}},   {"Marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
    {"Potato", {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}}, {"Skimmilk", {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}},
    {"Skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},     {"Skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}},
    {"Spectralon", {11.6, 20.4, 14.9}, {0.00, 0.00, 0.00}}, whole_milk,
};

void homogeneous(Reader& reader, const std::string& name, const Parameters& p) {
  const Location at = p.at;
  const Ref<Component> medium = reader.make("HomogeneousVolume", at, name);
  const Measured* const found = measured_medium(reader, p, "preset");
  const std::array<double, 3> a = found ? found->absorption : whole_milk.absorption;
  const std::array<double, 3> s = found ? found->scattering : whole_milk.scattering;
  const double scale = p.number("scale", 1);
  const auto coefficient = [&](const char* parameter, const std::array<double, 3>& otherwise) {
    const Parameter* given = found ? nullptr : p.find(parameter);
    const Color color =
        given ? spectrum_of(reader, p, *given, Use::coefficient) : rgb_color("srgb", otherwise[0], otherwise[1], otherwise[2]);
    return scale == 1 ? color : scaled_spectrum(scale, color);
  };
  const Color absorption = coefficient("sigma_a", a);
  set_member(*medium, "absorption", absorption, at);
  set_member(*medium, "scattering", coefficient("sigma_s", s), at);
  set_member(*medium, "anisotropy", p.number("g", 0), at);
  set_emission_of_medium(reader, *medium, p, absorption);
  reader.media[name] = medium;
}

}  // namespace

double light_scale(const Reader& reader, const Parameters& p) {
  const double scale = p.number("Lescale", p.number("LeScale", 1)) * reader.exposure;
  if (scale < 0) throw Error("the scale of a medium's light must not be negative", p.place("Lescale"));
  return scale;
}

// Per distance: pbrt's Le is a radiance, and what the medium adds is that times its absorption.
void set_emission_of_medium(Reader& reader, Component& medium, const Parameters& p, const Color& absorption) {
  const Parameter* const given = p.find("Le");
  if (!given) return;
  const double scale = light_scale(reader, p);
  const Color light = spectrum_of(reader, p, *given, Use::light);
  constexpr int first = 360, last = 830, step = 5;  // [nm]
  std::vector<float> wavelengths, values;
  for (int nm = first; nm <= last; nm += step) {
    wavelengths.push_back(float(nm));
    values.push_back(float(scale * double(light->at(float(nm), ColorUse::radiance)) *
                           double(absorption->at(float(nm), ColorUse::coefficient))));
  }
  if (std::ranges::any_of(values, [](float v) { return v != 0; }))
    set_member(medium, "emission", table_spectrum(std::move(wavelengths), std::move(values)), given->at);
}

void place_medium(Reader& reader, const std::string& name, const Ref<Component>& medium, const Transform& placed,
                  Location box_at) {
  if (!placed.valid()) throw Error("the coordinates of a medium, or its box from p0 to p1, have no volume", box_at);
  reader.grids[name] = placed;
  reader.media[name] = medium;
}

const Measured* measured_medium(Reader& reader, const Parameters& p, const char* parameter) {
  const std::string name = p.text(parameter);
  if (name.empty()) return nullptr;
  for (const Measured& m : measured)
    if (name == m.name) return &m;
  reader.importing.inexact(fmt::format("the medium '{}' is not known here: whole milk is taken", name), p.place(parameter));
  return nullptr;
}

Ref<Component> medium_for(Reader& reader, const std::string& name, const AnimatedTransform& object, Location at) {
  const auto found = reader.media.find(name);
  if (found == reader.media.end()) {
    std::vector<std::string> known;
    for (const auto& [n, m] : reader.media) known.push_back(n);
    throw Error(fmt::format("there is no medium named '{}'{}", name, suggestion(name, known)), at);
  }
  const auto placed = reader.grids.find(name);
  if (placed == reader.grids.end() || !found->second) return found->second;
  if (object.animated())
    reader.importing.inexact("a medium that differs from place to place moves with the object it is in", at);
  // Each object has a medium of its own, placed in its own coordinates.
  const Ref<Component> own = copy(*found->second);
  own->origin = std::make_unique<Component::Origin>();
  own->origin->location = at;
  own->origin->name = name;
  set_member(*own, "placement", object.still().inverse() * placed->second, at);
  return own;
}

void make_medium(Reader& reader, const std::string& name, Parameters&& p) {
  const std::string type = p.text("type", "homogeneous");
  if (type == "homogeneous") {
    homogeneous(reader, name, p);
  } else if (type == "heterogeneous" || type == "uniformgrid") {
    make_grid(reader, name, p);
  } else if (type == "rgbgrid") {
    make_rgb_grid(reader, name, p);
  } else if (type == "cloud") {
    make_cloud(reader, name, p);
  } else if (type == "nanovdb") {
    make_nanovdb(reader, name, p);
  } else {
    throw Error(fmt::format("there is no medium '{}'{}", type,
                            suggestion(type, {"homogeneous", "heterogeneous", "uniformgrid", "rgbgrid", "cloud", "nanovdb"})),
                p.place("type"));
  }
  p.tell_unused(reader.importing);
}

}  // namespace etendue::pbrt
