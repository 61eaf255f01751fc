#include "places.h"

#include <fmt/format.h>

namespace etendue::osl {

std::string place_text(const Location& at) { return fmt::format("{}:{}", at.file, at.line); }

}  // namespace etendue::osl
