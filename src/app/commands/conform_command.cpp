// etendue conform [CLASS...]: tests whether components fulfil the contracts of their interfaces.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "app/commands.h"
#include "app/common_options.h"
#include "app/scene_options.h"
#include "check/conform/conformance.h"
#include "files/output_files.h"
#include "files/whole_file.h"

namespace etendue {

namespace {

struct ConformOptions {
  std::vector<std::string> classes, plugins;
  bool quick = false, thorough = false, parts = false, interfaces = false;
  int drawn = 3, threads = 0;
  std::uint64_t seed = 1;
  std::string report;

  void add_to(Command& command);
  std::string command_line() const;
};

void ConformOptions::add_to(Command& command) {
  command.argument("CLASS", classes, "Classes, such as PhongShader, or interfaces, such as Shader; none: all");
  add_plugin_option(command, plugins);
  command.flag("--quick", quick, "A quarter of the samples");
  command.flag("--thorough", thorough, "Ten times the samples").excludes({"--quick"});
  command
      .option("--drawn N", drawn,
              "Number of components with random members to test of each class, besides the one with defaults")
      .show_default()
      .range(0, 100000);
  command.option("--seed N", seed, "Seed of the random members and samples").show_default();
  command.option("--report FILE", report, "Write all outcomes as an HTML page");
  command.flag("--parts", parts, "Print the components that were tested");
  command.flag("--interfaces", interfaces, "Only list the interfaces, and which of them have checks of their own");
  add_threads_option(command, threads);
}

std::string ConformOptions::command_line() const {
  std::string text = "etendue conform";
  for (const std::string& name : classes) text += " " + shell_quoted(name);
  for (const std::string& plugin : plugins) text += " --plugin " + shell_quoted(plugin);
  if (quick) text += " --quick";
  if (thorough) text += " --thorough";
  return text + fmt::format(" --drawn {} --seed {}", drawn, seed);
}

/// Lists all interfaces, and whether there are checks of their own for their classes.
int list_interfaces() {
  const std::vector<std::string> checked = conform::checked_interfaces();
  for (const ClassInfo* info : Registry::instance().all()) {
    if (info->parent) continue;
    const bool own = std::ranges::find(checked, info->name) != checked.end();
    fmt::print("{:20} {}\n", info->name, own ? "checked as a component and by its own checks" : "checked as a component");
  }
  return exit_status::done;
}

int run_conform(const ConformOptions& options) {
  load_plugins(options.plugins);
  if (options.interfaces) return list_interfaces();
  if (!options.report.empty()) {
    OutputFiles files;
    files.add(options.report, {intern("--report"), 0, 0});
    files.raise();
  }
  conform::Options asked;
  asked.classes = options.classes;
  asked.effort = options.quick      ? conform::Effort::quick
                 : options.thorough ? conform::Effort::thorough
                                    : conform::Effort::standard;
  asked.drawn = options.drawn;
  asked.seed = options.seed;
  asked.threads = options.threads;
  const bool show = isatty(STDERR_FILENO);
  if (show)
    asked.progress = [](const std::string& name, int done, int of) {
      fmt::print(stderr, "\r\x1b[K[{}/{}] {}", done, of, name);
      std::fflush(stderr);
    };
  const std::vector<conform::Outcome> outcomes = conform::conform(asked);
  if (show) fmt::print(stderr, "\r\x1b[K");
  fmt::print("{}", conform::results_text(outcomes, options.parts));
  if (!options.report.empty()) write_whole_file(options.report, conform::html_report(outcomes, options.command_line()));
  const auto any = [&](conform::Result result) {
    return std::ranges::find(outcomes, result, &conform::Outcome::result) != outcomes.end();
  };
  if (any(conform::Result::failed)) return exit_status::failed;
  if (any(conform::Result::passed)) return exit_status::done;
  fmt::print(stderr, "nothing was tested: there are no checks of the named classes, or none could be run\n");
  return exit_status::failed;
}

}  // namespace

void add_conform_command(Command& program) {
  Command command =
      program.add_command("conform", "Test whether components, also of plugins, fulfil the contracts of their interfaces");
  auto options = std::make_shared<ConformOptions>();
  options->add_to(command);
  command.footer(
      "\nExamples\n"
      "  etendue conform                                        everything\n"
      "  etendue conform Shader --quick                         all shaders, a quick look\n"
      "  etendue conform GoldShader --plugin ./libgold.so --drawn 20\n"
      "  etendue conform --thorough --report conform.html\n"
      "\nExit status: 0 no check failed, 1 a check failed or nothing was tested, 2 bad input. docs/conform.md lists the "
      "checks.");
  command.runs([options] { return run_conform(*options); });
}

}  // namespace etendue
