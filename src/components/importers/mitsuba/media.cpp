// Participating media.

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "converter.h"
#include "etendue/describe/color.h"

namespace etendue::mitsuba {

namespace {

const std::vector<std::string> known_media = {"homogeneous", "heterogeneous"};

std::string wrap_mode(const Element& volume) {
  const std::string wrap = volume.string("wrap_mode", "clamp");
  if (wrap != "clamp" && wrap != "repeat" && wrap != "mirror")
    throw Error(fmt::format("there is no wrap mode '{}'{}", wrap, suggestion(wrap, {"clamp", "repeat", "mirror"})),
                volume.location_of("wrap_mode"));
  return wrap;
}

/// Of a medium or a phase function: the lobe of an 'hg'.
void set_lobe(Component& part, const Element& hg) { set_member(part, "anisotropy", hg.number("g", 0.8), hg.at); }

}  // namespace

Ref<Component> Converter::medium(const Element& e, const Component& object) {
  if (e.tag != "medium") throw Error(fmt::format("a medium is expected, not a {}", e.tag), e.at);
  if (const auto known = media_.find(&e); known != media_.end()) return known->second;
  const Reading reading(e);
  if (e.type == "heterogeneous") return heterogeneous(e, object);
  if (e.type != "homogeneous") fail_unknown(e, known_media);
  Ref<Component> made = homogeneous(e);
  media_.emplace(&e, made);
  return made;
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
            "medium_sampling_weight"});
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
  return make("HenyeyGreensteinPhase", e);
}

Ref<Component> Converter::blended_phases(const Element& e) {
  const std::vector<const Element*> parts = e.all("phase");
  std::vector<double> weights;
  if (e.type == "mixturephase") {  // of 0.5
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
  // Neighbours by twos, and those again: of many parts none lies deep.
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

Ref<Component> Converter::homogeneous(const Element& e) {
  Ref<Component> volume = make("HomogeneousVolume", e);
  set_phase(*volume, e);
  const double scale = e.number("scale", 1);
  const auto scaled = [&](const char* name, double otherwise) {
    const Color c = spectrum_of(e, name, otherwise);
    return scale == 1 ? c : scaled_spectrum(scale, c);
  };
  if (e.has("material")) {
    inexact(e, fmt::format("the medium of the material '{}' is not known: it neither absorbs nor scatters",
                           e.string("material", "")));
    return volume;
  }
  if (e.has("sigma_a") || e.has("sigma_s")) {
    if (e.has("sigma_a")) set_member(*volume, "absorption", scaled("sigma_a", 0), e.location_of("sigma_a"));
    if (e.has("sigma_s")) set_member(*volume, "scattering", scaled("sigma_s", 0), e.location_of("sigma_s"));
  } else {
    set_member(*volume, "extinction", scaled("sigma_t", 1), e.location_of("sigma_t"));
    set_member(*volume, "albedo", spectrum_of(e, "albedo", 0.75), e.location_of("albedo"));
  }
  return volume;
}

Ref<Component> Converter::heterogeneous(const Element& e, const Component& object) {
  const char* const name = e.has("sigma_t") ? "sigma_t" : "density";  // the latter in 0.5
  const Element* const volume = e.nested(name);
  if (!volume) {
    if (!e.has(name)) throw Error("a heterogeneous medium needs a volume called 'sigma_t'", e.at);
    return homogeneous(e);
  }
  const Reading reading(*volume);
  if (volume->type == "constvolume") {
    Ref<Component> same = make("HomogeneousVolume", e);
    set_phase(*same, e);
    set_member(*same, "extinction", scaled_spectrum(e.number("scale", 1), spectrum_of(*volume, "value", 1)), volume->at);
    set_member(*same, "albedo", spectrum_of(e, "albedo", 0.75), e.location_of("albedo"));
    return same;
  }
  if (volume->type != "gridvolume") {
    inexact(*volume, fmt::format("volume '{}' is not known here: the medium is left out", volume->type));
    return nullptr;
  }
  return grid(e, *volume, object);
}

// Density on a grid, and an albedo that is a colour or a grid too. Where both grids lie in one place they are a GridVolume.
Ref<Component> Converter::grid(const Element& e, const Element& volume, const Component& object) {
  const Element* albedo = e.nested("albedo");
  if (albedo && albedo->tag != "volume") albedo = nullptr;
  std::optional<Reading> reading;
  if (albedo) reading.emplace(*albedo);
  const bool albedos = albedo && albedo->type == "gridvolume";
  const auto same_place = [&] {
    // Boxes that two files name may differ.
    if (albedo->boolean("use_grid_bbox", false) && file(*albedo).resolved() != file(volume).resolved()) return false;
    return albedo->transform().transform.still().exact() == volume.transform().transform.still().exact() &&
           albedo->boolean("use_grid_bbox", false) == volume.boolean("use_grid_bbox", false) &&
           albedo->string("filter_type", "trilinear") == volume.string("filter_type", "trilinear");
  };
  const bool apart = albedos && !same_place();
  Ref<Component> medium;
  if (apart) {
    medium = make("MapVolume", e);
    const Ref<Component> density = make("GridMap", volume), part = make("GridMap", *albedo);
    set_grid(*density, volume, object);
    set_grid(*part, *albedo, object);
    set_member(*density, "outside", "cut", volume.at);
    set_member(*part, "outside", wrap_mode(*albedo), albedo->at);
    set_member(*medium, "extinction", density, volume.at);
    set_member(*medium, "albedo", part, albedo->at);
  } else {
    medium = make("GridVolume", e);
    set_grid(*medium, volume, object);
    wrap_mode(volume);
    set_member(*medium, "outside", "cut", volume.at);  // the medium ends with the box of its densities, whatever is around it
    if (albedos) {
      set_member(*medium, "albedo", 1, albedo->at);
      set_member(*medium, "albedo_file", file(*albedo), albedo->location_of("filename"));
      albedo->ignore({"wrap_mode"});
    } else if (albedo) {
      set_member(*medium, "albedo", spectrum_of(*albedo, "value", 0.75), albedo->at);
    } else {
      set_member(*medium, "albedo", spectrum_of(e, "albedo", 0.75), e.location_of("albedo"));
    }
  }
  set_phase(*medium, e);
  set_member(*medium, apart ? "density" : "extinction", e.number("scale", 1), e.location_of("scale"));
  for (const Element* grid : {&volume, albedo})
    if (grid) grid->ignore({"raw", "accel"});
  return medium;
}

/// The file of a grid and its place.
void Converter::set_grid(Component& grid, const Element& volume, const Component& object) {
  set_member(grid, "file", file(volume), volume.location_of("filename"));
  const Value transform = get(object, "transform");
  const auto* placed = transform.as<AnimatedTransform>();
  const auto* still = transform.as<Transform>();
  const Transform to_world = placed ? placed->still() : (still ? *still : Transform());
  const Transform placement = to_world.inverse() * volume.transform().transform.still();
  if (!placement.identity()) set_member(grid, "placement", placement, volume.location_of("to_world"));
  set_member(grid, "file_box", volume.boolean("use_grid_bbox", false), volume.at);
  set_member(grid, "filter", volume.string("filter_type", "trilinear"), volume.location_of("filter_type"));
}

}  // namespace etendue::mitsuba
