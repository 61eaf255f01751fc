// Media.

#include <fmt/format.h>

#include "reader.h"

namespace etendue::pbrt {

namespace {

/// Measured media of Jensen et al. 2001, "A practical model for subsurface light transport", table 1, in 1/mm: the reduced
/// scattering coefficient and absorption of red, green and blue.
struct Measured {
  const char* name;
  std::array<double, 3> scattering, absorption;
};
constexpr Measured measured[] = {
    {"Apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}}, {"Chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}},
    {"Chicken2", {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}}, {"Cream", {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}},
    {"Ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}},   {"Marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
    {"Potato", {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}}, {"Skimmilk", {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}},
    {"Skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},     {"Skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}},
    {"Spectralon", {11.6, 20.4, 14.9}, {0.00, 0.00, 0.00}}, {"Wholemilk", {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}},
};

void homogeneous(Reader& reader, const std::string& name, const Parameters& p) {
  const Location at = p.at;
  const Ref<Component> medium = reader.make("HomogeneousVolume", at, name);
  std::array<double, 3> a{0.0011, 0.0024, 0.014}, s{2.55, 3.21, 3.77};
  const std::string preset = p.text("preset");
  const Measured* found = nullptr;
  for (const Measured& m : measured)
    if (preset == m.name) found = &m;
  if (found) {
    a = found->absorption, s = found->scattering;
  } else if (!preset.empty()) {
    reader.importing.inexact(fmt::format("the medium '{}' is not known here: whole milk is taken", preset), p.place("preset"));
  }
  const double scale = p.number("scale", 1);
  const auto coefficient = [&](const char* parameter, const std::array<double, 3>& otherwise) {
    const Parameter* given = found ? nullptr : p.find(parameter);
    const Color color =
        given ? spectrum_of(reader, p, *given, Use::coefficient) : rgb_color("srgb", otherwise[0], otherwise[1], otherwise[2]);
    return scale == 1 ? color : scaled_spectrum(scale, color);
  };
  set_member(*medium, "absorption", coefficient("sigma_a", a), at);
  set_member(*medium, "scattering", coefficient("sigma_s", s), at);
  set_member(*medium, "anisotropy", p.number("g", 0), at);
  if (p.has("Le")) {
    p.ignore({"Lescale"});
    reader.importing.inexact("the light that a medium emits is left out", p.place("Le"));
  }
  reader.media[name] = medium;
}

}  // namespace

void make_medium(Reader& reader, const std::string& name, Parameters&& p) {
  const std::string type = p.text("type", "homogeneous");
  if (type == "homogeneous") {
    homogeneous(reader, name, p);
  } else if (type == "heterogeneous" || type == "uniformgrid" || type == "rgbgrid" || type == "cloud" || type == "nanovdb") {
    reader.importing.inexact(fmt::format("a medium of type '{}' is left out: there is none where it would be", type), p.at);
    p.forget();
    reader.media[name] = nullptr;
  } else {
    throw Error(fmt::format("there is no medium '{}'{}", type,
                            suggestion(type, {"homogeneous", "heterogeneous", "uniformgrid", "rgbgrid", "cloud", "nanovdb"})),
                p.place("type"));
  }
  p.tell_unused(reader.importing);
}

}  // namespace etendue::pbrt
