// The output of commands that write a render description: save and convert.

#include "description_output.h"

#include <fmt/format.h>

#include "etendue/language/language.h"
#include "saving/save_job.h"

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
  save_description(job, output, comments, all, {intern("--output"), 0, 0});
}

}  // namespace etendue
