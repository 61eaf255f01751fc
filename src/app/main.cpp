// The command line program.

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "commands.h"
#include "report.h"
#include "streams.h"

using namespace etendue;

namespace {

constexpr const char* introduction = "Étendue: physically based, spectral Monte Carlo image synthesis.";

constexpr const char* closing = R"(
First steps
  etendue render scenes/cornell_box.etd                  renders a scene; the file says to which pictures
  etendue render box.etd -o box.png --samples 16         a quick look
  etendue render box.etd -o box.exr --time 5m            as good as five minutes make it
  etendue check box.etd                                  says what is wrong with a file, without rendering
  etendue format box.etd                                 gives a file the usual layout
  etendue classes                                        everything a file can contain
  etendue classes PathTracer                             one class: its members, units, defaults and ranges
  etendue image diff a.exr b.exr                         how much two pictures differ
  etendue verify box.etd                                 whether all algorithms agree on a scene
  etendue compare box.etd --renderers A,B --time 1m      which algorithm is better on a scene, and by how much
  etendue conform Shader                                 whether parts do what their interfaces promise
  etendue studio box.etd                                 describes, shows and controls a render in the browser

Help on one command: etendue render --help
Exit status: 0 done, 1 failed, 2 bad input or usage, 130 interrupted.
)";

/// An empty value is the result of an unset shell variable ("--checkpoint $FILE" in quotes). It has no meaning for any option,
/// so every option rejects it.
void refuse_empty_values(CLI::App& command) {
  for (CLI::Option* option : command.get_options())
    if (option->get_items_expected_max() > 0)
      option->transform(CLI::Validator(  // runs before the option's other validators
          [](std::string& value) {
            return value.empty() ? std::string("the value is empty; was a variable not set?") : std::string();
          },
          ""));
  for (CLI::App* inner : command.get_subcommands({})) refuse_empty_values(*inner);
}

int run_program(int argument_count, char** arguments) {
  CLI::App program(introduction, "etendue");
  program.footer(closing);
  program.set_version_flag("--version", "etendue " ETENDUE_VERSION, "Print the version");
  program.set_help_flag("-h,--help", "Print this help");
  program.require_subcommand(1);
  program.failure_message(usage_failure);

  Run run;
  add_render_command(program, run);
  add_check_command(program, run);
  add_save_command(program, run);
  add_convert_command(program, run);
  add_export_command(program, run);
  add_format_command(program, run);
  add_classes_command(program, run);
  add_schema_command(program, run);
  add_manual_command(program, run);
  add_image_command(program, run);
  add_verify_command(program, run);
  add_compare_command(program, run);
  add_conform_command(program, run);
  add_studio_command(program, run);

  refuse_empty_values(program);

  // CLI11 would answer --help after an unknown command with the program's help and exit status 0.
  const std::string first = argument_count > 1 ? arguments[1] : "";
  const std::vector<CLI::App*> commands = program.get_subcommands({});
  if (!first.empty() && !first.starts_with("-") &&
      std::ranges::none_of(commands, [&](const CLI::App* command) { return command->get_name() == first; })) {
    fmt::print(stderr, "etendue: {}\netendue --help tells more\n", no_command(program, first));
    return exit_status::bad_input;
  }
  try {
    program.parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int status = program.exit(error, out, err);
    fmt::print("{}", out.str());
    fmt::print(stderr, "{}", err.str());
    return status == 0 ? exit_status::done : exit_status::bad_input;
  }
  return reporting_errors(run);
}

}  // namespace

int main(int argument_count, char** arguments) {
  open_standard_streams();
  return close_standard_streams(run_program(argument_count, arguments));
}
