#include "machine.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>

#include "etendue/core/error.h"

namespace etendue::osl {
namespace {

constexpr const char* file_name = "libetendue_osl_machine.so";

constinit std::atomic<const Machine*> announced = nullptr;

/// It is no fault: the pictures are the same.
void say(const std::string& text) { fmt::print(stderr, "etendue: {}\n", text); }

const Machine* load() {
  Dl_info own{};
  std::filesystem::path path;
  if (dladdr(reinterpret_cast<void*>(&load), &own) && own.dli_fname)
    path = std::filesystem::path(own.dli_fname).parent_path() / file_name;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    say("shaders are interpreted: this build has no compiler for them (docs/shading-language.md)");
    return nullptr;
  }
  // Never closed: code may be in use until the program ends.
  if (!dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL))
    say(fmt::format("shaders are interpreted, as their compiler cannot be loaded: {}", dlerror()));
  else if (!announced)
    say(fmt::format("shaders are interpreted: '{}' is not of this version of Étendue", file_name));
  return announced;
}

Execute mode_of_environment() {
  const char* set = std::getenv("ETENDUE_OSL");
  const std::string_view word = set ? set : "";
  if (word == "interpreter") return Execute::interpreter;
  if (word == "compiler") return Execute::compiler;
  if (!word.empty() && word != "automatic")
    throw Error(fmt::format("ETENDUE_OSL is '{}'; known are automatic, interpreter, compiler", word));
  return Execute::automatic;
}

std::atomic<int> chosen = -1;

}  // namespace

const Machine* machine() {
  static const Machine* const loaded = load();
  return loaded;
}

void announce_machine(const Machine& machine, const char* version) {
  if (std::string_view(version) == ETENDUE_VERSION) announced = &machine;
}

Execute execution_mode() {
  static const Execute usual = mode_of_environment();
  const int c = chosen;
  return c < 0 ? usual : Execute(c);
}

void set_execution_mode(Execute mode) { chosen = int(mode); }

}  // namespace etendue::osl
