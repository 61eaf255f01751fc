// etendue classes [NAME]: prints the classes that a render description can contain.

#include <fmt/format.h>

#include "app/commands.h"
#include "app/common_options.h"
#include "describe/words.h"
#include "etendue/describe/reflection.h"

namespace etendue {

namespace {

struct ClassesOptions {
  std::string name;
  bool json = false;
  std::vector<std::string> plugins;
};

int show_classes(const ClassesOptions& options) {
  Registry& registry = Registry::instance();
  load_plugins(options.plugins);
  if (options.name.empty()) {
    fmt::print("{}{}", options.json ? classes_json() : class_tree_text(), options.json ? "\n" : "");
    return exit_status::done;
  }
  const ClassInfo* info = registry.find(options.name);
  if (!info) throw Error("there is no class '" + options.name + "'" + meant_class(options.name));
  fmt::print("{}{}", options.json ? class_json(*info) : class_text(*info), options.json ? "\n" : "");
  return exit_status::done;
}

}  // namespace

void add_classes_command(Command& program) {
  Command command = program.add_command("classes", "List all classes, or show one with its members");
  auto options = std::make_shared<ClassesOptions>();
  command.argument("NAME", options->name, "A class, such as PathTracer, or an interface, such as Shader");
  command.flag("--json", options->json, "As JSON, for programs");
  add_plugin_option(command, options->plugins);
  command.footer(
      "\nExamples\n"
      "  etendue classes                    the tree of all classes\n"
      "  etendue classes Shader             all shaders\n"
      "  etendue classes PathTracer         its members: type, unit, range, default, meaning");
  command.runs([options] { return show_classes(*options); });
}

}  // namespace etendue
