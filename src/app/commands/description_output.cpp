// The output of commands that write a render description: save and convert.

#include "description_output.h"

#include <fmt/format.h>

#include <filesystem>

#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/output_files.h"
#include "files/whole_file.h"
#include "language/json.h"
#include "render/checkpoint.h"

namespace etendue {

void add_description_output(Command& command, std::string& output) {
  command
      .option("-o,--output FILE", output, "The file to write: .etd, or JSON if its name ends in .json; - for standard output")
      .required();
}

void write_description_to(const std::string& output, const Job& job, const std::string& comments, bool all) {
  if (output == "-") {
    fmt::print("{}{}", comments, write_description(job, all));
    return;
  }
  const Location at{intern("--output"), 0, 0};
  note_inputs_of(job);
  OutputFiles files;
  files.add(output, at);
  files.raise();
  std::error_code error;
  const std::string folder = std::filesystem::absolute(output, error).parent_path().string();
  if (error) throw Error(fmt::format("cannot write '{}': {}", output, error.message()), at);
  write_whole_file(output,
                   language::is_json(output) ? write_json(job, all, folder) : comments + write_description(job, all, folder));
}

}  // namespace etendue
