// etendue convert IN -o OUT: imports a file of another format as a render description.

#include <fmt/format.h>

#include <filesystem>

#include "app/scene_options.h"
#include "description_output.h"

namespace etendue {

namespace {

struct ConvertOptions : SceneOptions {
  std::string output;
};

/// The import's notes of what is not exact, as comments for the top of the description.
std::string comments(const std::string& file, const std::vector<Error>& notes) {
  std::string text = fmt::format("# Converted from {}.\n", std::filesystem::path(file).filename().string());
  if (!notes.empty()) text += "# Differences from it:\n";
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
  write_description_to(options.output, *imported.job, comments(options.file, imported.notes), false);
  return exit_status::done;
}

}  // namespace

void add_convert_command(Command& program) {
  Command command = program.add_command("convert", "Write a file of another program as a render description");
  auto options = std::make_shared<ConvertOptions>();
  options->add_to(command);
  add_description_output(command, options->output);
  command.footer(
      "\nExamples\n"
      "  etendue convert scene.xml -o scene.etd                 comments at its top list the differences\n"
      "  etendue convert scene.xml --strict -o scene.etd        fails instead\n"
      "  etendue convert model.glb -o -                         on the terminal");
  command.runs([options] { return convert(*options); });
}

}  // namespace etendue
