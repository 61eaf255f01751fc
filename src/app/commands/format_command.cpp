// etendue format FILE: gives a description a uniform layout.

#include <fmt/format.h>

#include <filesystem>

#include "app/commands.h"
#include "app/report.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "files/whole_file.h"
#include "language/format/formatter.h"
#include "language/json.h"

namespace etendue {

namespace {

struct FormatOptions {
  std::vector<std::string> files;
  std::string output;
  bool check = false;
};

/// Formats the file, or with --check compares it. Returns false if --check finds another layout.
bool format(const std::string& file, const FormatOptions& options) {
  const Location at{intern(file), 0, 0};
  if (language::is_json(file)) throw Error("'format' is for .etd files, not for JSON", at);
  const language::Source source{at.file, {}, language::read_text_file(file, at)};
  const std::string text = language::formatted(source);
  if (options.check) {
    if (text != source.text) fmt::print("{}\n", file);
    return text == source.text;
  }
  if (options.output == "-") {
    fmt::print("{}", text);
    return true;
  }
  const std::string& target = options.output.empty() ? file : options.output;
  if (options.output.empty() && text == source.text) return true;
  OutputFiles files;
  files.add(target, options.output.empty() ? at : Location{intern("--output"), 0, 0}, file);
  files.raise();
  write_whole_file(target, text);
  return true;
}

int format_all(const FormatOptions& options) {
  if (options.files.size() > 1 && !options.output.empty())
    throw Error("several files cannot be written to one: format them in place, or one by one", {intern("--output"), 0, 0});
  int status = exit_status::done;
  for (const std::string& file : options.files)
    status =
        std::max(status, reporting_errors([&] { return format(file, options) ? exit_status::done : exit_status::failed; }));
  return status;
}

}  // namespace

void add_format_command(Command& program) {
  Command command =
      program.add_command("format", "Give a render description the standard layout: indentation, blanks, comments");
  auto options = std::make_shared<FormatOptions>();
  command.argument("FILE", options->files, "The render descriptions (.etd), which are replaced").required();
  command.option("-o,--output FILE", options->output, "Write to this file instead; - for standard output");
  command.flag("--check", options->check, "Change nothing; print the files whose layout would change, and exit with 1 if any")
      .excludes({"--output"});
  command.footer(
      "\nExamples\n"
      "  etendue format box.etd                             in place, in one go or not at all\n"
      "  etendue format box.etd -o -                        on the terminal\n"
      "  etendue format --check scenes/*.etd                which of them have another layout\n"
      "\nLine breaks and comments stay, and a file is only written if its meaning is unchanged.");
  command.runs([options] { return format_all(*options); });
}

}  // namespace etendue
