// etendue schema: prints the JSON Schema of all render descriptions.

#include <fmt/format.h>

#include "app/commands.h"
#include "etendue/describe/reflection.h"

namespace etendue {

void add_schema_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("schema", "Print a JSON Schema (draft 2020-12) of all classes");
  auto plugins = std::make_shared<std::vector<std::string>>();
  command->add_option("--plugin", *plugins, "Load a shared library of further classes; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->callback([plugins, &run] {
    run = [plugins] {
      for (const std::string& plugin : *plugins) Registry::instance().load_plugin(plugin);
      fmt::print("{}\n", json_schema());
      return exit_status::done;
    };
  });
}

}  // namespace etendue
