// etendue export FILE -o OUT: exports a render description to a file of another format.

#include <fmt/format.h>

#include "app/scene_options.h"
#include "components/scenes/import.h"
#include "etendue/exporter.h"
#include "files/output_files.h"
#include "files/whole_file.h"
#include "render/checkpoint.h"

namespace etendue {

namespace {

struct ExportOptions : SceneOptions {
  std::string output;
};

int write(const ExportOptions& options) {
  const Location at{intern("--output"), 0, 0};
  const Ref<Exporter> exporter = exporter_of(options.output);
  if (!exporter) {
    std::string known;
    for (const std::string& ending : exported_extensions()) known += (known.empty() ? "." : ", .") + ending;
    throw Error(fmt::format("no exporter for files named like '{}'; there are those for {}", options.output, known), at);
  }
  const Ref<Job> job = options.load();
  note_inputs_of(*job);
  read_imports(*job);
  OutputFiles files;
  files.add(options.output, at);
  files.raise();
  Exporting exporting(options.output);
  const std::string text = exporter->write(*job, exporting);
  const std::vector<Error> notes = exporting.notes();
  if (options.import.strict && !notes.empty()) throw Errors(notes);
  for (const Error& note : notes) warn(note.what(), note.location);
  // The files that the exported file refers to are written first, so that it never exists without them.
  for (const std::string& file : exporting.files_beside()) files.add(file, at);
  files.raise();
  exporting.write_files();
  write_whole_file(options.output, text);
  return exit_status::done;
}

}  // namespace

void add_export_command(Command& program) {
  Command command = program.add_command("export", "Write a render description as a file of another program");
  auto options = std::make_shared<ExportOptions>();
  options->add_to(command);
  command.option("-o,--output FILE", options->output, "The file to write; its ending chooses the format").required();
  command.footer(
      "\nExamples\n"
      "  etendue export scenes/cornell_box.etd -o box.pbrt      meshes and images are written beside it\n"
      "  etendue export box.etd --strict -o box.pbrt            fails if it cannot be expressed exactly\n"
      "  etendue export box.etd -o box.glb                      a model for viewers, with simple materials");
  command.runs([options] { return write(*options); });
}

}  // namespace etendue
