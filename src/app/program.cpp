// The command line program.

#include "program.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "commands.h"
#include "etendue/language/language.h"
#include "program_team.h"
#include "render/team/message_library.h"
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
  etendue measure desk.etd                               what a meter reads: lux, W/m2 per band, with errors
  etendue cryptomatte box.etd -o mattes.exr              mattes of all objects and materials, for compositing
  etendue conform Shader                                 whether parts do what their interfaces promise
  etendue cluster submit box.etd --parts 16              renders on the machines of a cluster
  etendue studio box.etd                                 describes, shows and controls a render in the browser

Help on one command: etendue render --help
Exit status: 0 done, 1 failed, 2 bad input or usage, 130 interrupted.
)";

/// Of the processes that mpirun or srun has started, each would do all of the work of other commands, and write the same files.
bool is_one_of_many(const char* command) {
  constexpr std::array<std::string_view, 2> by_teams{"render", "studio"};
  if (processes_started() == 1 || *command == '-' || std::ranges::find(by_teams, command) != by_teams.end()) return false;
  fmt::print(stderr, "{}\n",
             show(Error(fmt::format(
                 "this is one of {} processes that mpirun or srun has started, and each would do all of '{}': start one, or "
                 "set ETENDUE_MPI=off if that is meant. Several processes share 'render' and 'studio'.",
                 processes_started(), command))));
  return true;
}

int run_program(int argument_count, char** arguments) {
  if (argument_count > 1 && is_one_of_many(arguments[1])) return exit_status::bad_input;
  CommandLine command_line("etendue", introduction, "etendue " ETENDUE_VERSION);
  Command program = command_line.program();
  program.footer(closing);
  program.require_command();

  add_render_command(program);
  if (argument_count < 2 || std::string_view(arguments[1]) != "render") {
    try {
      add_other_commands(program);
    } catch (const Error& error) {
      fmt::print(stderr, "etendue: {}\n", error.what());
      return exit_status::failed;
    }
  }
  return command_line.run(argument_count, arguments);
}

}  // namespace

extern "C" int etendue_main(int argument_count, char** arguments) {
  open_standard_streams();
  const int status = close_standard_streams(run_program(argument_count, arguments));
  leave_team();
  return status;
}
