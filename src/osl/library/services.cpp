#include "services.h"

#include "files/regular_file.h"

namespace etendue::osl {

bool Services::from_common(const String* space, Matrix& out) {
  Matrix to;
  return to_common(space, to) && invert(to, out);
}

std::string Services::dictionary(const String* file) {
  constexpr std::uint64_t most = 64 << 20;
  return read_regular_file(file->text(), most);
}

const Wavelengths& Services::wavelengths() const {
  static const Wavelengths none;
  return none;
}

}  // namespace etendue::osl
