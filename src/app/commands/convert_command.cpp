// etendue convert IN -o OUT: imports a file of another format as a render description.

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

struct ConvertOptions : SceneOptions {
  std::string output;
};

/// The import's notes of what is not exact, as comments for the top of the description.
std::string comments(const std::string& file, const std::vector<Error>& notes) {
  std::string text = fmt::format("# Converted from {}.\n", std::filesystem::path(file).filename().string());
  if (!notes.empty()) text += "# What is not as there:\n";
  for (const Error& note : notes) {
    std::string words = note.what();
    for (char& c : words)
      if (c == '\n' || c == '\r') c = ' ';
    // A note about an included file names that file before the line number.
    const std::filesystem::path named = std::filesystem::path(note.location.file).filename();
    const std::string other = named == std::filesystem::path(file).filename() ? "" : named.string();
    text += "#   " + (other.empty() ? "" : other + ", ") +
            (note.location.line > 0 ? fmt::format("line {}: {}\n", note.location.line, words) : words + "\n");
  }
  return text + "\n";
}

int convert(const ConvertOptions& options) {
  const ImportedJob imported = options.load_imported();
  for (const Error& note : imported.notes) warn(note.what(), note.location);
  const Job& job = *imported.job;
  if (options.output == "-") {
    fmt::print("{}{}", comments(options.file, imported.notes), write_description(job));
    return exit_status::done;
  }
  note_inputs_of(job);
  OutputFiles files;
  files.add(options.output, {intern("--output"), 0, 0});
  files.raise();
  const std::string folder = std::filesystem::absolute(options.output).parent_path().string();
  write_whole_file(options.output, language::is_json(options.output)
                                       ? write_json(job, false, folder)
                                       : comments(options.file, imported.notes) + write_description(job, false, folder));
  return exit_status::done;
}

}  // namespace

void add_convert_command(Command& program) {
  Command command = program.add_command("convert", "Write a file of another program as a render description");
  auto options = std::make_shared<ConvertOptions>();
  options->add_to(command);
  command
      .option("-o,--output FILE", options->output,
              "The file to write: .etd, or JSON if its name ends in .json; - for standard output")
      .required();
  command.footer(
      "\nExamples\n"
      "  etendue convert scene.xml -o scene.etd                 comments at its top say what is not as there\n"
      "  etendue convert scene.xml --strict -o scene.etd        fails instead\n"
      "  etendue convert model.glb -o -                         on the terminal");
  command.runs([options] { return convert(*options); });
}

}  // namespace etendue
