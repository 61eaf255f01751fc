// etendue manual: the pages of all classes, in Markdown.

#include <fmt/format.h>

#include <filesystem>

#include "app/commands.h"
#include "app/text.h"
#include "etendue/reflection.h"

namespace etendue {

namespace {

struct ManualOptions {
  std::string folder;
  std::vector<std::string> plugins;
};

int write_manual(const ManualOptions& options) {
  for (const std::string& plugin : options.plugins) Registry::instance().load_plugin(plugin);
  const std::vector<ManualPage> pages = manual_pages();
  if (options.folder.empty()) {
    for (const ManualPage& page : pages) fmt::print("{}\n", page.text);
    return exit_status::done;
  }
  std::error_code problem;
  std::filesystem::create_directories(options.folder, problem);
  if (problem) throw Error(fmt::format("cannot make the folder '{}': {}", options.folder, problem.message()));
  for (const ManualPage& page : pages) write_file((std::filesystem::path(options.folder) / page.file).string(), page.text);
  fmt::print("{} pages in {}\n", pages.size(), options.folder);
  return exit_status::done;
}

}  // namespace

void add_manual_command(CLI::App& program, Run& run) {
  CLI::App* command = program.add_subcommand("manual", "Write the manual of all classes, in Markdown");
  auto options = std::make_shared<ManualOptions>();
  command->add_option("-o,--output", options->folder, "A folder for one page per class; without it, all on the terminal")
      ->type_name("FOLDER");
  command->add_option("--plugin", options->plugins, "Load a shared library of further classes; may be repeated")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command->footer("\nExamples\n  etendue manual | less\n  etendue manual -o manual");
  command->callback([options, &run] { run = [options] { return write_manual(*options); }; });
}

}  // namespace etendue
