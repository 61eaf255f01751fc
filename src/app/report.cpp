// Reports errors to the user.

#include "report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "describe/guard.h"
#include "describe/words.h"
#include "etendue/core/error.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"

namespace etendue {

namespace {

void show_all(const std::vector<Error>& errors) {
  for (const Error& error : errors) {
    std::string text = show(error);
    if (text.empty() || text.back() != '\n') text += '\n';
    fmt::print(stderr, "{}", text);
  }
  fmt::print(stderr, "{} error{}\n", errors.size(), errors.size() == 1 ? "" : "s");
}

/// Names the plugins in use: their code runs in this process and may have failed.
std::string plugins_note() {
  std::string text;
  for (const std::string& file : Registry::instance().plugins()) {
    text += text.empty() ? "classes of plugins are in use:" : ";";
    for (const ClassInfo* info : Registry::instance().all())
      if (info->provider == file) text += " " + info->name;
    text += fmt::format(" of '{}'", file);
  }
  return text.empty() ? text : text + "\n";
}

const CLI::App* innermost_command(const CLI::App* app) {
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  return app;
}

/// A suggestion for an unknown option or command: the nearest known one.
std::string meant(const CLI::App* command, const std::string& given) {
  std::vector<std::string> known;
  if (given.starts_with("-")) {
    const std::string bare = given.substr(0, given.find('='));
    for (const CLI::Option* option : command->get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    if (std::ranges::find(known, bare) != known.end()) return " before the command; write it after";
    const std::string near = suggestion(bare, known), elsewhere = translation(bare, foreign_options());
    return elsewhere.empty() ? near : elsewhere;
  }
  for (const CLI::App* other : command->get_subcommands({})) known.push_back(other->get_name());
  return suggestion(given, known);
}

}  // namespace

int reporting_errors(const Run& run) {
  std::fflush(stdout);
  try {
    return run();
  } catch (const Errors& errors) {
    show_all(errors.errors);
    return exit_status::bad_input;
  } catch (const Error& error) {
    show_all({error});
    return exit_status::bad_input;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "etendue: out of memory\n");
  } catch (...) {
    fmt::print(stderr, "etendue: unexpected failure: {}\n{}", thrown_text(), plugins_note());
  }
  return exit_status::failed;
}

std::string no_command(const CLI::App& program, const std::string& given) {
  return fmt::format("there is no command '{}'{}", given, meant(&program, given));
}

std::string usage_failure(const CLI::App* program, const CLI::Error& error) {
  const CLI::App* command = innermost_command(program);
  std::string text = error.what();
  // Whatever error the parser reports, an argument it does not recognize is the most probable cause.
  const std::vector<std::string> extras = program->remaining(true);
  const auto option = std::ranges::find_if(extras, [](const std::string& extra) { return extra.starts_with("-"); });
  if (option != extras.end())
    text = fmt::format("there is no option '{}'{}", *option, meant(command, *option));
  else if (!extras.empty() && command->get_subcommands({}).empty())
    text = fmt::format("'{}' is one argument too many", extras.front());
  else if (!extras.empty())
    text = no_command(*command, extras.front());
  while (!text.empty() && text.back() == '\n') text.pop_back();
  std::string full_name = "etendue";
  for (const CLI::App* app = program; app != command;) {
    app = app->get_subcommands().front();
    full_name += " " + app->get_name();
  }
  return fmt::format("etendue: {}\n{} --help tells more\n", text, full_name);
}

}  // namespace etendue
