#include "services.h"

namespace etendue::osl {

bool Services::from_common(const String* space, Matrix& out) {
  Matrix to;
  return to_common(space, to) && invert(to, out);
}

const Wavelengths& Services::wavelengths() const {
  static const Wavelengths none;
  return none;
}

}  // namespace etendue::osl
