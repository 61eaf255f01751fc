// Participating media.

#include <fmt/format.h>

#include "converter.h"
#include "etendue/describe/color.h"

namespace etendue::mitsuba {

Ref<Component> Converter::medium(const Element& e) {
  if (e.tag != "medium") throw Error(fmt::format("a medium is expected, not a {}", e.tag), e.at);
  if (const auto known = media_.find(&e); known != media_.end()) return known->second;
  const Reading reading(e);
  Ref<Component> made = make_medium(e);
  media_.emplace(&e, made);
  return made;
}

void Converter::set_phase(Component& volume, const Element& e) {
  for (const Element* phase : e.all("phase")) {
    const Reading reading(*phase);
    if (phase->type == "hg" || phase->type == "isotropic") {
      if (phase->type == "hg") set_member(volume, "anisotropy", phase->number("g", 0.8), phase->at);
    } else {
      inexact(*phase,
              fmt::format("phase function '{}' has no counterpart here: light scatters alike in all directions", phase->type));
    }
  }
}

Ref<Component> Converter::make_medium(const Element& e) {
  if (e.type != "homogeneous") {
    inexact(e, fmt::format("medium '{}' is not known here: it is left out", e.type));
    return nullptr;
  }
  Ref<Component> volume = make("HomogeneousVolume", e);
  set_phase(*volume, e);
  const double scale = e.number("scale", 1);
  const auto scaled = [&](const char* name, double otherwise) {
    const Color c = spectrum_of(e, name, otherwise);
    return scale == 1 ? c : scaled_spectrum(scale, c);
  };
  if (e.has("material")) inexact(e, "media by the name of their material are not known: it neither absorbs nor scatters");
  if (e.has("sigma_a") || e.has("sigma_s")) {
    if (e.has("sigma_a")) set_member(*volume, "absorption", scaled("sigma_a", 0), e.location_of("sigma_a"));
    if (e.has("sigma_s")) set_member(*volume, "scattering", scaled("sigma_s", 0), e.location_of("sigma_s"));
  } else if (volume->class_info().find("extinction")) {
    set_member(*volume, "extinction", scaled("sigma_t", 1), e.location_of("sigma_t"));
    set_member(*volume, "albedo", spectrum_of(e, "albedo", 0.75), e.location_of("albedo"));
  } else {
    inexact(e, "extinction and albedo are not known here");
  }
  e.ignore({"sample_emitters", "has_spectral_extinction"});
  return volume;
}

}  // namespace etendue::mitsuba
