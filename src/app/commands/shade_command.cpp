// etendue shade: runs shaders of the Open Shading Language alone. The library of that language is opened for it.

#include <dlfcn.h>

#include "app/commands.h"
#include "etendue/core/error.h"
#include "files/own_library.h"

namespace etendue {
namespace {

using Shade = int (*)(int count, const char* const* words);

Shade open_library() {
  void* const library = open_own_library("libetendue_osl.so", "the library of the shading language");
  const auto shade = reinterpret_cast<Shade>(dlsym(library, "etendue_osl_shade"));
  if (!shade) throw Error("the library of the shading language is not of this version of Étendue");
  return shade;
}

}  // namespace

void add_shade_command(Command& program) {
  Command command = program.add_command("shade", "Run shaders of the Open Shading Language at a grid of points");
  auto words = std::make_shared<std::vector<std::string>>();
  command.words(*words);
  command.runs([words] {
    std::vector<const char*> texts;
    for (const std::string& word : *words) texts.push_back(word.c_str());
    return open_library()(int(texts.size()), texts.data());
  });
}

}  // namespace etendue
