// Media.

#include <fmt/format.h>

#include <algorithm>

#include "media.h"

namespace etendue::pbrt {

namespace {

/// Of Jensen et al. 2001, "A practical model for subsurface light transport", table 1; from "Lowfat Milk" on of Narasimhan et
/// al. 2006, "Acquiring scattering properties of participating media by dilution", as pbrt has them.
constexpr Measured measured[] = {
    {"Apple", {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}},
    {"Chicken1", {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}},
    {"Chicken2", {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}},
    {"Cream", {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}},
    {"Ketchup", {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}},
    {"Marble", {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
    {"Potato", {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}},
    {"Skimmilk", {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}},
    {"Skin1", {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},
    {"Skin2", {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}},
    {"Spectralon", {11.6, 20.4, 14.9}, {0.00, 0.00, 0.00}},
    whole_milk,
    {"Lowfat Milk", {0.89187, 1.5136, 2.532}, {0.002875, 0.00575, 0.0115}},
    {"Reduced Milk", {2.4858, 3.1669, 4.5214}, {0.0025556, 0.0051111, 0.012778}},
    {"Regular Milk", {4.5513, 5.8294, 7.136}, {0.0015333, 0.0046, 0.019933}},
    {"Espresso", {0.72378, 0.84557, 1.0247}, {4.7984, 6.5751, 8.8493}},
    {"Mint Mocha Coffee", {0.31602, 0.38538, 0.48131}, {3.772, 5.8228, 7.82}},
    {"Lowfat Soy Milk", {0.30576, 0.34233, 0.61664}, {0.0014375, 0.0071875, 0.035937}},
    {"Regular Soy Milk", {0.59223, 0.73866, 1.4693}, {0.0019167, 0.0095833, 0.065167}},
    {"Lowfat Chocolate Milk", {0.64925, 0.83916, 1.1057}, {0.0115, 0.0368, 0.1564}},
    {"Regular Chocolate Milk", {1.4585, 2.1289, 2.9527}, {0.010063, 0.043125, 0.14375}},
    {"Coke", {8.9053e-05, 8.372e-05, 0}, {0.10014, 0.16503, 0.2468}},
    {"Pepsi", {6.1697e-05, 4.2564e-05, 0}, {0.091641, 0.14158, 0.20729}},
    {"Sprite", {6.0306e-06, 6.4139e-06, 6.5504e-06}, {0.001886, 0.0018308, 0.0020025}},
    {"Gatorade", {0.0024574, 0.003007, 0.0037325}, {0.024794, 0.019289, 0.008878}},
    {"Chardonnay", {1.7982e-05, 1.3758e-05, 1.2023e-05}, {0.010782, 0.011855, 0.023997}},
    {"White Zinfandel", {1.7501e-05, 1.9069e-05, 1.288e-05}, {0.012072, 0.016184, 0.019843}},
    {"Merlot", {2.1129e-05, 0, 0}, {0.11632, 0.25191, 0.29434}},
    {"Budweiser Beer", {2.4356e-05, 2.4079e-05, 1.0564e-05}, {0.011492, 0.024911, 0.057786}},
    {"Coors Light Beer", {5.0922e-05, 4.301e-05, 0}, {0.006164, 0.013984, 0.034983}},
    {"Clorox", {0.0024035, 0.0031373, 0.003991}, {0.0033542, 0.014892, 0.026297}},
    {"Apple Juice", {0.00013612, 0.00015836, 0.000227}, {0.012957, 0.023741, 0.052184}},
    {"Cranberry Juice", {0.00010402, 0.00011646, 7.8139e-05}, {0.039437, 0.094223, 0.12426}},
    {"Grape Juice", {5.382e-05, 0, 0}, {0.10404, 0.23958, 0.29325}},
    {"Ruby Grapefruit Juice", {0.011002, 0.010927, 0.011036}, {0.085867, 0.18314, 0.25262}},
    {"White Grapefruit Juice", {0.22826, 0.23998, 0.32748}, {0.0138, 0.018831, 0.056781}},
    {"Shampoo", {0.0007176, 0.0008303, 0.0009016}, {0.014107, 0.045693, 0.061717}},
    {"Strawberry Shampoo", {0.00015671, 0.00015947, 1.518e-05}, {0.01449, 0.05796, 0.075823}},
    {"Head & Shoulders Shampoo", {0.023805, 0.028804, 0.034306}, {0.084621, 0.15688, 0.20365}},
    {"Lemon Tea Powder", {0.040224, 0.045264, 0.051081}, {2.4288, 4.5757, 7.2127}},
    {"Orange Powder", {0.00015617, 0.00017482, 0.0001762}, {0.001449, 0.003441, 0.007863}},
    {"Pink Lemonade Powder", {0.00012103, 0.00013073, 0.00012528}, {0.001165, 0.002366, 0.003195}},
    {"Cappuccino Powder", {1.8436, 2.5851, 2.1662}, {35.844, 49.547, 61.084}},
    {"Salt Powder", {0.027333, 0.032451, 0.031979}, {0.28415, 0.3257, 0.34148}},
    {"Sugar Powder", {0.00022272, 0.00025513, 0.000271}, {0.012638, 0.031051, 0.050124}},
    {"Suisse Mocha Powder", {2.7979, 3.5452, 4.3365}, {17.502, 27.004, 35.433}},
    {"Pacific Ocean Surface Water", {0.0001764, 0.00032095, 0.00019617}, {0.031845, 0.031324, 0.030147}},
};

void homogeneous(Reader& reader, const std::string& name, const Parameters& p) {
  const Location at = p.at;
  const Ref<Component> medium = reader.make("HomogeneousVolume", at, name);
  const Measured* const found = measured_medium(reader, p, "preset");
  // Where nothing is said v3 takes whole milk, v4 the number 1; what is said beside a preset counts in v3 alone.
  const Measured* const otherwise = found ? found : reader.version == 3 ? &whole_milk : nullptr;
  const double scale = p.number("scale", 1);
  const auto coefficient = [&](const char* parameter, const std::array<double, 3> Measured::* part) {
    const Parameter* given = found && reader.version != 3 ? nullptr : p.find(parameter);
    const Color color = given       ? spectrum_of(reader, p, *given, Use::coefficient)
                        : otherwise ? rgb_color("srgb", (otherwise->*part)[0], (otherwise->*part)[1], (otherwise->*part)[2])
                                    : flat_spectrum(1);
    return scale == 1 ? color : scaled_spectrum(scale, color);
  };
  const Color absorption = coefficient("sigma_a", &Measured::absorption);
  set_member(*medium, "absorption", absorption, at);
  set_member(*medium, "scattering", coefficient("sigma_s", &Measured::scattering), at);
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
  std::vector<std::string> known;
  for (const Measured& m : measured) {
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
