// Participating media.

#include <fmt/format.h>

#include <algorithm>

#include "media.h"

namespace etendue::pbrt {

namespace {

void homogeneous(Reader& reader, const std::string& name, const Parameters& p) {
  const Location at = p.at;
  const Ref<Component> medium = reader.make("HomogeneousVolume", at, name);
  const MeasuredMedium* const found = measured_medium(reader, p, "preset");
  // Default coefficients are those of whole milk in v3, and 1 in v4; coefficients beside a preset count in v3 alone.
  const MeasuredMedium* const otherwise = found ? found : reader.version == 3 ? &whole_milk : nullptr;
  const double scale = p.number("scale", 1);
  const auto coefficient = [&](const char* parameter, const std::array<double, 3> MeasuredMedium::* part) {
    const Parameter* given = found && reader.version != 3 ? nullptr : p.find(parameter);
    const Color color = given       ? spectrum_of(reader, p, *given, Use::coefficient)
                        : otherwise ? rgb_color("srgb", (otherwise->*part)[0], (otherwise->*part)[1], (otherwise->*part)[2])
                                    : flat_spectrum(1);
    return scale == 1 ? color : scaled_spectrum(scale, color);
  };
  const Color absorption = coefficient("sigma_a", &MeasuredMedium::absorption);
  set_member(*medium, "absorption", absorption, at);
  set_member(*medium, "scattering", coefficient("sigma_s", &MeasuredMedium::scattering), at);
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

// The emission per distance: pbrt's Le is a radiance, and the medium emits Le times its absorption coefficient.
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

const MeasuredMedium* measured_medium(Reader& reader, const Parameters& p, const char* parameter) {
  const std::string name = p.text(parameter);
  if (name.empty()) return nullptr;
  std::vector<std::string> known;
  for (const MeasuredMedium& m : measured_media()) {
    if (name == m.name) return &m;
    known.emplace_back(m.name);
  }
  reader.importing.inexact(fmt::format("there is no measured medium '{}'{}: it is left out", name, suggestion(name, known)),
                           p.place(parameter));
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
  // Each object gets its own copy of the medium, placed in object space.
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
