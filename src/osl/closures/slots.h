#pragma once
// Slots: maps and spectra whose values are those of the closure that is bound, so that the shaders of the house serve as models
// of closures: their maps are the closure's arguments.
//
// A shader reads its maps within `bind`, so the values are kept by thread, for the length of one call (SlotScope).

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/shader.h"

namespace etendue::osl {

/// The arguments of a closure, as a model's members take them.
struct SlotValues {
  Spectrum colors[2];
  float numbers[3] = {};
  Spectrum index = Spectrum(1.5f), extinction;  ///< a complex refractive index
  Spectrum film = Spectrum(1.5f);               ///< index of a film
  Spectrum length = Spectrum(1e-3f);            ///< [m]
};

/// Makes the values those of all slots of this thread as long as it lives.
class SlotScope {
 public:
  explicit SlotScope(const SlotValues&);
  ~SlotScope();
  SlotScope(const SlotScope&) = delete;
  SlotScope& operator=(const SlotScope&) = delete;

 private:
  const SlotValues* before_;
};

Ref<ObjectMap> color_slot(int);
Ref<ObjectMap> number_slot(int);
/// The real index, or with `complex` the complex one.
Color index_slot(bool complex);
Color film_slot();
Color length_slot();

/// Creates and prepares a shader of the house with given members.
Ref<etendue::Shader> make_model(std::string_view class_name, std::initializer_list<std::pair<const char*, Value>> members);

}  // namespace etendue::osl
