// etendue save FILE -o OUT: reads a render description and writes it again.

#include <fmt/format.h>

#include <filesystem>

#include "app/scene_options.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "files/whole_file.h"
#include "language/json.h"
#include "render/checkpoint.h"

namespace etendue {

namespace {

struct SaveOptions : SceneOptions {
  std::string output;
  bool all = false;
};

int save(const SaveOptions& options) {
  const Ref<Job> job = options.load();
  if (options.output == "-") {
    fmt::print("{}", write_description(*job, options.all));
    return exit_status::done;
  }
  note_inputs_of(*job);
  OutputFiles files;
  files.add(options.output, {intern("--output"), 0, 0});
  files.raise();
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::absolute(options.output, error).parent_path();
  if (error) throw Error(fmt::format("cannot write '{}': {}", options.output, error.message()), {intern("--output"), 0, 0});
  write_whole_file(options.output, language::is_json(options.output) ? write_json(*job, options.all, folder.string())
                                                                     : write_description(*job, options.all, folder.string()));
  return exit_status::done;
}

}  // namespace

void add_save_command(Command& program) {
  Command command =
      program.add_command("save", "Write a file again as one description, with its overrides, includes and params worked in");
  auto options = std::make_shared<SaveOptions>();
  options->add_to(command);
  command
      .option("-o,--output FILE", options->output,
              "The file to write: .etd, or JSON if its name ends in .json; - for standard output")
      .required();
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
