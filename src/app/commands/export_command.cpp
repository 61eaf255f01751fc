// etendue export FILE -o OUT: exports a render description to a file of another format.

#include "app/scene_options.h"
#include "saving/save_job.h"

namespace etendue {

namespace {

struct ExportOptions : SceneOptions {
  std::string output;
};

int write(const ExportOptions& options) {
  const Location at{intern("--output"), 0, 0};
  require_exporter(options.output, at);
  export_job(*options.load(), options.output, options.import.strict, at);
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
