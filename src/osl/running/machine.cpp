#include "machine.h"

#include <fmt/format.h>

#include <atomic>
#include <cstdlib>
#include <optional>
#include <string_view>

#include "etendue/core/error.h"
#include "files/own_library.h"

namespace etendue::osl {
namespace {

constexpr const char* file_name = "libetendue_osl_machine.so";

constinit std::atomic<const Machine*> announced = nullptr;

/// It is no fault: the pictures are the same.
void say(const std::string& text) { fmt::print(stderr, "etendue: {}\n", text); }

const Machine* load() {
  if (own_library_path(file_name).empty()) {
    say("shaders are interpreted: this build has no compiler for them (docs/shading-language.md)");
    return nullptr;
  }
  try {
    open_own_library(file_name, "their compiler");
    if (!announced) say(fmt::format("shaders are interpreted: '{}' is not of this version of Étendue", file_name));
  } catch (const Error& error) {
    say(fmt::format("shaders are interpreted: {}", error.what()));
  }
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
