#include "format_library.h"

#include "own_library.h"

namespace etendue {

std::recursive_mutex& libraries_guard() {
  static auto* guard = new std::recursive_mutex;  // never destroyed: used until the program ends
  return *guard;
}

bool load_format_library() {
  const std::lock_guard lock(libraries_guard());
  static bool loaded = false;
  if (loaded) return false;
  open_own_library("libetendue_formats.so", "the library for files of other programs ('./etendue build' builds it)");
  return loaded = true;
}

}  // namespace etendue
