// Options that several commands have in common.

#include "common_options.h"

#include "etendue/describe/registry.h"

namespace etendue {

void add_plugin_option(Command& command, std::vector<std::string>& plugins) {
  command.option("--plugin FILE", plugins, "Load a shared library of further classes; may be repeated");
}

void load_plugins(const std::vector<std::string>& plugins) {
  for (const std::string& plugin : plugins) Registry::instance().load_plugin(plugin);
}

void add_threads_option(Command& command, int& threads, const std::string& note) {
  command.option("--threads N", threads, "Threads to use; 0: all cores" + note).range(0, 4096);
}

}  // namespace etendue
