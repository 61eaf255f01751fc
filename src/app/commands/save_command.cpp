// etendue save FILE -o OUT: reads a render description and writes it again.

#include "app/scene_options.h"
#include "description_output.h"

namespace etendue {

namespace {

struct SaveOptions : SceneOptions {
  std::string output;
  bool all = false;
};

int save(const SaveOptions& options) {
  write_description_to(options.output, *options.load(), "", options.all);
  return exit_status::done;
}

}  // namespace

void add_save_command(Command& program) {
  Command command =
      program.add_command("save", "Write a description as a single file, with overrides, includes and params resolved");
  auto options = std::make_shared<SaveOptions>();
  options->add_to(command);
  add_description_output(command, options->output);
  command.flag("--all", options->all, "Write every member, also those that have their defaults");
  command.footer(
      "\nExamples\n"
      "  etendue save box.etd -o -                          on the terminal\n"
      "  etendue save box.etd --all -o full.etd             with all defaults, to learn from\n"
      "  etendue save box.etd -o box.json                   as JSON, for programs; 'etendue schema' describes it\n"
      "  etendue save box.etd -D samples=16 -o quick.etd    with a param replaced");
  command.runs([options] { return save(*options); });
}

}  // namespace etendue
