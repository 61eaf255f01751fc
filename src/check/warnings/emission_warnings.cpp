// Warns of emission profiles that send part of their power into the side of a surface that does not emit.

#include <fmt/format.h>

#include <cmath>

#include "etendue/describe/registry.h"
#include "scene_warnings.h"

namespace etendue {
namespace {

/// Whether the emission is defined for directions on both sides of the surface. A DiffuseEmission is the same on each side that
/// it emits from.
bool has_directions(const EmissionShader& emission) { return emission.class_info().name != "DiffuseEmission"; }

/// Whether the emission's directions are relative to the surface normal.
bool about_normal(const EmissionShader& emission) {
  if (!emission.class_info().find("about")) return false;
  const Value about = get(emission, "about");
  const auto* text = about.as<std::string>();
  return text && *text == "normal";
}

/// The emitted power, summed over a few wavelengths.
double power_of(const EmissionShader& emission, const SceneObject& object) {
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) w.place(i, std::lerp(420.0f, 680.0f, (float(i) + 0.5f) / float(spectrum_size)), 1);
  const Spectrum power = emission.power(object, w);
  double sum = 0;
  for (int i = 0; i < spectrum_size; ++i) sum += double(power[i]);
  return sum;
}

}  // namespace

void LostLight::look(const SceneObject& object, std::vector<SceneWarning>& list) {
  const EmissionShader* emission = object.emission.get();
  if (!emission || object.delta() || object.infinite() || emission->sides == Sides::both || !has_directions(*emission)) return;
  // The back side of a closed surface is its inside. An emission whose directions are fixed in space points inwards on half of
  // the surface, so it is not reported.
  if (object.closed() && !about_normal(*emission)) return;
  if (emission->origin)
    for (const auto& [name, place] : emission->origin->members)
      if (name == "sides") return;  // written in the file, so it is intended
  constexpr size_t most = 100;      // number of emitters that are checked: each may need some thousand directions
  if (++looked_at_ > most) return;
  Ref<EmissionShader>& both = with_both_sides_[emission];
  try {
    if (!both) {
      both = ref_cast<EmissionShader>(copy(*emission));
      both->sides = Sides::both;
      prepare_tree(*both);
    }
    const double all = power_of(*both, object), seen = power_of(*emission, object);
    constexpr double least = 0.01;
    if (!(all > 0) || !(seen < (1 - least) * all)) return;
    const std::string name =
        object.origin && !object.origin->name.empty() ? "'" + object.origin->name + "'" : "the " + object.class_info().name;
    list.push_back({"lost light",
                    fmt::format("{}: {:.0f} % of its emission's light is behind the surface, which emits to the front: it is "
                                "lost. 'sides: both' emits it as well; 'sides: front' confirms that this is intended",
                                name, 100 * (1 - seen / all)),
                    emission->location_of()});
  } catch (const Error&) {  // errors of this emission have been reported when it was prepared
  }
}

}  // namespace etendue
