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

Ref<Component> Converter::medium(const Element& e, const Component& object, const Element* glow) {
  if (e.tag != "medium") throw Error(fmt::format("a medium is expected, not a {}", e.tag), e.at);
  if (const auto known = media_.find(&e); known != media_.end() && !glow) return known->second;
  const Reading reading(e);
  std::optional<Reading> of_glow;
  if (glow) of_glow.emplace(*glow);
  if (e.type == "heterogeneous") return heterogeneous(e, object, glow);
  if (e.type != "homogeneous") fail_unknown(e, known_media);
  Ref<Component> made = homogeneous(e);
  if (glow)
    shine(*made, *glow, object);
  else
    media_.emplace(&e, made);
  return made;
}

// The emitter 'volumelight' of a shape: its "radiance" is what the medium inside adds per distance, whatever it absorbs.
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
  set_member(*grid, "outside", wrap_mode(*volume), volume->at);
  set_member(*read, "map", grid, volume->at);
  set_member(*read, "as", "coefficient", volume->at);  // a grid as light is not multiplied by a white there
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

Ref<Component> Converter::heterogeneous(const Element& e, const Component& object, const Element* glow) {
  const char* const name = e.has("sigma_t") ? "sigma_t" : "density";  // the latter in 0.5
  const Element *const volume = e.nested(name), *albedo = e.nested("albedo");
  if (albedo && albedo->tag != "volume") albedo = nullptr;
  std::optional<Reading> of_volume, of_albedo;
  if (volume) of_volume.emplace(*volume);
  if (albedo && albedo != volume) of_albedo.emplace(*albedo);
  const bool even = !volume || volume->type == "constvolume", albedos = albedo && albedo->type == "gridvolume";
  if (!even && volume->type != "gridvolume") {
    inexact(*volume, fmt::format("volume '{}' is not known here: the medium is left out", volume->type));
    return nullptr;
  }
  const double scale = e.number("scale", 1);
  const Color all_of_it = even ? scaled_spectrum(scale, volume ? spectrum_of(*volume, "value", 1) : spectrum_of(e, name, 1))
                               : flat_spectrum(float(scale));
  const bool of_maps = glow || (albedos && (even || !same_place(*albedo, *volume)));
  const bool boxed = !even || !e.old;  // before version 2 a constant volume had no bounds
  const Location at = e.location_of(name);
  if (!boxed && !of_maps) return even_everywhere(e, all_of_it, albedo);
  Ref<Component> medium = make(of_maps ? "MapVolume" : "GridVolume", e);
  if (of_maps) {
    // What shines ends with the box, too, which is therefore the density; a file's box is known to the grid alone.
    if (boxed && (even || !volume->boolean("use_grid_bbox", false)))
      set_member(*medium, "density", box_of(e, volume, object), at);
    Ref<Component> extinction;
    if (!even) {
      const Ref<Component> grid = make("GridMap", *volume);
      set_grid(*grid, *volume, object);
      set_member(*grid, "outside", "cut", at);
      extinction = make("MultiplyMap", e, "");
      set_member(*extinction, "first", grid, at);
      set_member(*extinction, "second", all_of_it, e.location_of("scale"));
    }
    set(*medium, "extinction", even ? Value(all_of_it, at) : Value(extinction, at));
  } else {
    set_member(*medium, "extinction", all_of_it, e.location_of("scale"));
    if (even)
      place_box(*medium, e, nullptr, object);
    else
      set_grid(*medium, *volume, object);
    set_member(*medium, "outside", "cut", at);  // the medium ends with the box, whatever is around it
  }
  if (!even) wrap_mode(*volume);
  set_albedo(*medium, e, albedo, object);
  set_phase(*medium, e);
  if (glow) shine(*medium, *glow, object);
  for (const Element* grid : {volume, albedo})
    if (grid) grid->ignore({"raw", "accel"});
  return medium;
}

/// A heterogeneous medium of version 0.x whose volumes are constant: it fills its shape.
Ref<Component> Converter::even_everywhere(const Element& e, const Color& extinction, const Element* albedo) {
  Ref<Component> medium = make("HomogeneousVolume", e);
  set_member(*medium, "extinction", extinction, e.at);
  set_member(*medium, "albedo", albedo ? spectrum_of(*albedo, "value", 0.75) : spectrum_of(e, "albedo", 0.75), e.at);
  set_phase(*medium, e);
  return medium;
}

/// 1 in the box of a heterogeneous medium, and 0 outside. `volume`: its 'sigma_t', if that is one.
Ref<Component> Converter::box_of(const Element& e, const Element* volume, const Component& object) {
  Ref<Component> box = make("GridMap", e, "");
  place_box(*box, e, volume && volume->type == "gridvolume" ? volume : nullptr, object);
  set_member(*box, "outside", "cut", e.at);
  return box;
}

void Converter::place_box(Component& box, const Element& e, const Element* grid, const Component& object) {
  const Transform to_world = grid ? grid->transform().transform.still() : box_of_constant(e);
  const Transform placement = to_world_of(object).inverse() * to_world;
  if (!placement.identity()) set_member(box, "placement", placement, e.at);
}

/// Whether two grids lie in one place and are read alike.
bool Converter::same_place(const Element& a, const Element& b) {
  // Boxes that two files name may differ.
  if (a.boolean("use_grid_bbox", false) && file(a).resolved() != file(b).resolved()) return false;
  return a.transform().transform.still().exact() == b.transform().transform.still().exact() &&
         a.boolean("use_grid_bbox", false) == b.boolean("use_grid_bbox", false) &&
         a.string("filter_type", "trilinear") == b.string("filter_type", "trilinear");
}

/// `volume`: the volume that says it; null: the medium itself says it.
void Converter::set_albedo(Component& medium, const Element& e, const Element* volume, const Component& object) {
  if (!volume || volume->type != "gridvolume") {
    const Color same = volume ? spectrum_of(*volume, "value", 0.75) : spectrum_of(e, "albedo", 0.75);
    set_member(medium, "albedo", same, e.location_of("albedo"));
  } else if (medium.class_info().name == "MapVolume") {
    const Ref<Component> grid = make("GridMap", *volume);
    set_grid(*grid, *volume, object);
    set_member(*grid, "outside", wrap_mode(*volume), volume->at);
    set_member(medium, "albedo", grid, volume->at);
  } else {
    set_member(medium, "albedo", 1, volume->at);
    set_member(medium, "albedo_file", file(*volume), volume->location_of("filename"));
    volume->ignore({"wrap_mode"});
  }
}

// A heterogeneous medium ends there with the box, along the axes of the world, of its 'sigma_t', be that the same everywhere.
Transform Converter::box_of_constant(const Element& medium) {
  const Element* const volume = medium.nested("sigma_t");
  const Bounds3 box = (volume ? volume->transform().transform.still() : Transform())(Bounds3{Point3{0, 0, 0}, Point3{1, 1, 1}});
  const Vector3 size = box.high - box.low;
  return Transform::translate({box.low.x, box.low.y, box.low.z}) * Transform::scale({size.x, size.y, size.z});
}

Transform Converter::to_world_of(const Component& object) {
  const Value transform = get(object, "transform");
  const auto* placed = transform.as<AnimatedTransform>();
  const auto* still = transform.as<Transform>();
  return placed ? placed->still() : (still ? *still : Transform());
}

/// The file of a grid and its place.
void Converter::set_grid(Component& grid, const Element& volume, const Component& object) {
  set_member(grid, "file", file(volume), volume.location_of("filename"));
  const Transform placement = to_world_of(object).inverse() * volume.transform().transform.still();
  if (!placement.identity()) set_member(grid, "placement", placement, volume.location_of("to_world"));
  set_member(grid, "file_box", volume.boolean("use_grid_bbox", false), volume.at);
  set_member(grid, "filter", volume.string("filter_type", "trilinear"), volume.location_of("filter_type"));
}

}  // namespace etendue::mitsuba
