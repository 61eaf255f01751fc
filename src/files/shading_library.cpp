#include "shading_library.h"

#include <mutex>

#include "own_library.h"

namespace etendue {

void load_shading_library() {
  static std::mutex guard;
  const std::lock_guard lock(guard);
  static bool loaded = false;
  if (loaded) return;
  open_own_library("libetendue_osl.so", "the library for the Open Shading Language ('./etendue build' builds it)");
  loaded = true;
}

}  // namespace etendue
