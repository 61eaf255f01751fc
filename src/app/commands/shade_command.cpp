// etendue shade: runs shaders of the Open Shading Language alone. The library of that language is opened for it.

#include <dlfcn.h>

#include <filesystem>

#include "app/commands.h"
#include "etendue/core/error.h"

namespace etendue {
namespace {

using Shade = int (*)(int count, const char* const* words);

Shade open_library() {
  constexpr const char* file_name = "libetendue_osl.so";
  Dl_info own{};
  std::string path = file_name;
  if (dladdr(reinterpret_cast<void*>(&open_library), &own) && own.dli_fname) {
    const std::filesystem::path beside = std::filesystem::path(own.dli_fname).parent_path() / file_name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(beside, ignored)) path = beside.string();
  }
  void* library = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (!library) throw Error(std::string("the library of the shading language cannot be loaded: ") + dlerror());
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
