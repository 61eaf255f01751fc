// etendue schema: prints the JSON Schema of all render descriptions.

#include <fmt/format.h>

#include "app/commands.h"
#include "app/common_options.h"
#include "etendue/describe/reflection.h"

namespace etendue {

void add_schema_command(Command& program) {
  Command command = program.add_command("schema", "Print a JSON Schema (draft 2020-12) of all classes");
  auto plugins = std::make_shared<std::vector<std::string>>();
  add_plugin_option(command, *plugins);
  command.runs([plugins] {
    load_plugins(*plugins);
    fmt::print("{}\n", json_schema());
    return exit_status::done;
  });
}

}  // namespace etendue
