#pragma once
// The quantity that a colour is used as, by its name in the description language.

#include <string>

#include "etendue/core/error.h"
#include "etendue/core/spectral_function.h"

namespace etendue::python {

inline ColorUse color_use(const std::string& name) {
  if (name == "reflectance") return ColorUse::reflectance;
  if (name == "radiance") return ColorUse::radiance;
  if (name == "coefficient") return ColorUse::coefficient;
  throw Error("a colour is used as 'reflectance', 'radiance' or 'coefficient', not '" + name + "'");
}

}  // namespace etendue::python
