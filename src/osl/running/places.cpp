#include "places.h"

#include <fmt/format.h>

#include <string_view>

namespace etendue::osl {

std::string place_text(const Location& at) {
  const std::string_view path = at.file;
  return fmt::format("{}:{}", path.substr(path.rfind('/') + 1), at.line);
}

}  // namespace etendue::osl
