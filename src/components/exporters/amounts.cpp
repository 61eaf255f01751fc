#include "components/exporters/amounts.h"

#include <algorithm>

#include "components/exporters/members.h"
#include "etendue/describe/description.h"
#include "etendue/emission_shader.h"

namespace etendue {

namespace {

constexpr const char* amounts[] = {"power", "luminous_flux", "luminous_intensity", "illuminance"};

}  // namespace

bool has_amount(const Component& e) {
  return std::ranges::any_of(amounts,
                             [&](const char* member) { return e.class_info().find(member) && number_of(e, member) > 0; });
}

// The ratio of the object's power with the amount to its power without.
double strength_of(const SceneObject& o, const Component& e) {
  if (!has_amount(e)) return 1;
  const Ref<Component> object = copy(o);
  prepare_tree(*object);
  const Ref<Component> whole = part_of(*object, "emission"), bare = copy(*whole);
  for (const char* member : amounts)
    if (bare->class_info().find(member)) set(*bare, member, Value(Number{0}));
  prepare_tree(*bare);
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) w.place(i, 500 + 20 * float(i), 1);
  const auto emitted = [&](const Component& emission) {
    return double(dynamic_cast<const EmissionShader&>(emission).power(dynamic_cast<const SceneObject&>(*object), w)[0]);
  };
  const double without = emitted(*bare);
  return without > 0 ? emitted(*whole) / without : 1;
}

}  // namespace etendue
