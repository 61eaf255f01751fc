// Plugins that are written in Python.

#include "python_plugins.h"

#include <dlfcn.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <system_error>
#include <vector>

#include "etendue/describe/registry.h"

namespace etendue {

namespace {

namespace fs = std::filesystem;

/// The file of the package that runs the program within Python.
constexpr const char* starter = "_program.py";

std::atomic<bool> restarts = true;

/// The package's file `starter`; empty: there is no package.
std::string package_file() {
  std::error_code none;
  // In a build's folder; in a wheel, etendue/_prefix/ARCHITECTURE; in the Debian package, /usr/lib/etendue/ARCHITECTURE.
  for (const char* way : {"python/etendue", "../..", "../../python3/dist-packages/etendue"}) {
    const fs::path file = fs::path(program_folder()) / way / starter;
    if (fs::is_regular_file(file, none)) return file.lexically_normal().string();
  }
  return {};
}

[[noreturn]] void restart(std::vector<std::string> arguments) {
  const std::string file = package_file();
  if (file.empty())
    throw Error(
        "it is written in Python, and the Python package of Étendue, which reads it, is not beside the program: "
        "'./etendue python' builds it");
  const char* chosen = std::getenv("ETENDUE_PYTHON");
  std::string python = chosen && *chosen ? chosen : "python3";
  arguments.insert(arguments.begin(), {python, file});
  std::vector<char*> list;
  for (std::string& a : arguments) list.push_back(a.data());
  list.push_back(nullptr);
  std::fflush(stdout);
  execvp(python.c_str(), list.data());
  throw Error("it is written in Python, but '" + python + "' cannot be started (" + std::generic_category().message(errno) +
              "): install Python 3 and its package numpy, or name a Python that has it by ETENDUE_PYTHON");
}

}  // namespace

std::string program_folder() {
  Dl_info own{};
  if (!::dladdr(reinterpret_cast<void*>(&program_folder), &own) || !own.dli_fname) return {};
  std::error_code none;
  return fs::absolute(own.dli_fname, none).parent_path().string();
}

void refuse_restarts() { restarts = false; }

void restart_for_python_plugins(int argument_count, char** arguments) {
  const std::vector<std::string> given(arguments + std::min(1, argument_count), arguments + argument_count);
  Registry::instance().read_plugins(".py", [given](const std::string& file) {
    if (!restarts)
      throw Error("it is written in Python, and must be known when the program starts: give '--plugin " + file + "'");
    restart(given);
  });
}

}  // namespace etendue
