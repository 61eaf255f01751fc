#include "reflectance.h"

#include <fmt/format.h>

#include "etendue/describe/registry.h"

namespace etendue {
namespace {

/// Whether a map only evaluates the maps it holds at other coordinates or mixes them, so that its values do not exceed theirs.
bool passes_values_on(const ObjectMap& map) {
  static constexpr const char* names[] = {"UvTransformMap", "TransformedMap", "PlanarMap",  "CylindricalMap", "SphericalMap",
                                          "TriplanarMap",   "MixMap",         "CheckerMap", "BricksMap"};
  for (const char* name : names)
    if (map.class_info().name == name) return true;
  return false;
}

void look_at(const Component& owner, const char* member, const ObjectMap& map, int depth) {
  const std::string where = owner.class_info().name + "." + member;
  const Color color = map.constant();
  const float component = color ? color->largest_component() : 0, most = std::max(map.largest(), component);
  if (most > 1.0001f)
    warn(fmt::format("{}: a reflectance lies between 0 and 1, and this {} up to {:.4g}: what is more than 1 is cut to 1; scale "
                     "it down, or it is not what was meant",
                     where, color ? "color has components" : "map holds values", most),
         map.origin && map.origin->location.known() && !color ? map.location_of() : owner.location_of(member));
  if (depth > 8 || !passes_values_on(map)) return;
  for (const Member& m : map.class_info().members) {
    if (m.kind != Kind::component || m.list) continue;
    const Value value = m.get(map, m);
    const auto* part = value.as<Ref<Component>>();
    if (const auto* inner = part ? dynamic_cast<const ObjectMap*>(part->get()) : nullptr)
      look_at(owner, member, *inner, depth + 1);
  }
}

}  // namespace

void warn_of_sum(const Component& owner, const char* first_member, const Ref<ObjectMap>& first, const char* second_member,
                 const Ref<ObjectMap>& second) {
  const Color a = first->constant(), b = second->constant();
  if (!a || !b || !owner.location_of().known()) return;
  // The mean over the visible range: at its ends the smooth spectra of saturated colours may well exceed 1 in sum.
  double sum = 0;
  int count = 0;
  for (float wavelength = 400; wavelength <= 700; wavelength += 5, ++count)
    sum += double(a->at(wavelength, ColorUse::reflectance)) + double(b->at(wavelength, ColorUse::reflectance));
  const double mean = sum / count;
  if (mean <= 1.001) return;
  warn(fmt::format(
           "{}: {} and {} together are {:.4g}, the mean over 400 to 700 nm, more light than arrives: both are scaled down "
           "to a sum of 1",
           owner.class_info().name, first_member, second_member, mean),
       owner.location_of(second_member));
}

void require_reflectance(const Component& owner, const char* member, const Ref<ObjectMap>& map) {
  if (!map) owner.fail(member, "a map or a colour is needed");
  if (const Color color = map->constant()) {
    const ValueRange range = range_of(*color, ColorUse::reflectance);
    const bool low = !(range.least >= 0);
    if (low || !(range.most <= 1.0001f))
      owner.fail(member, fmt::format("a reflectance lies between 0 and 1, and this is {:.6f} at {:g} nm",
                                     low ? range.least : range.most, low ? range.least_at : range.most_at));
  }
  look_at(owner, member, *map, 0);
}

}  // namespace etendue
