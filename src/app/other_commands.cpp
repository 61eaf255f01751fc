#include <dlfcn.h>
#include <fmt/format.h>

#include "app/commands.h"
#include "etendue/core/error.h"
#include "files/own_library.h"

namespace etendue {

void add_other_commands(Command& program) {
  constexpr const char* file_name = "libetendue_commands.so";
  void* const library = open_own_library(file_name, "the library of commands ('./etendue build' builds it)");
  const auto add = reinterpret_cast<bool (*)(Command&, const char*)>(dlsym(library, "etendue_add_commands"));
  if (!add || !add(program, ETENDUE_VERSION)) throw Error(fmt::format("'{}' is not of this version of Étendue", file_name));
}

}  // namespace etendue
