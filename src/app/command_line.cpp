// The command line, by the library CLI11.

#include "command_line.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <sstream>
#include <type_traits>

#include "commands.h"
#include "describe/words.h"
#include "report.h"

namespace etendue {

// ---- options ----------------------------------------------------------------------------------------------------------

CommandOption& CommandOption::required() {
  option_->required();
  return *this;
}

// The empty descriptions keep the ranges out of the help.
CommandOption& CommandOption::range(int least, int most) {
  option_->check(CLI::Range(least, most).description(""));
  return *this;
}

CommandOption& CommandOption::range(double least, double most) {
  option_->check(CLI::Validator(  // a range lets what is no number pass
      [](const std::string& value) {
        double number = 0;
        return CLI::detail::lexical_cast(value, number) && std::isnan(number) ? "'" + value + "' is not a number"
                                                                              : std::string();
      },
      ""));
  option_->check(CLI::Range(least, most).description(""));
  return *this;
}

CommandOption& CommandOption::one_of(const std::vector<std::string>& values) {
  option_->check(CLI::IsMember(values));
  return *this;
}

CommandOption& CommandOption::needs(const std::string& option) {
  option_->needs(option);
  return *this;
}

CommandOption& CommandOption::excludes(std::initializer_list<const char*> options) {
  for (const char* option : options) option_->excludes(std::string(option));
  return *this;
}

CommandOption& CommandOption::show_default() {
  option_->capture_default_str();
  return *this;
}

CommandOption& CommandOption::heading(const std::string& text) {
  option_->group(text);
  return *this;
}

CommandOption& CommandOption::hidden() { return heading(""); }

// ---- commands ---------------------------------------------------------------------------------------------------------

Command Command::add_command(const std::string& name, const std::string& description) {
  return {*app_->add_subcommand(name, description), *chosen_};
}

void Command::require_command() { app_->require_subcommand(1); }

template <typename T>
CommandOption Command::argument(const std::string& name, T& variable, const std::string& description) {
  return CommandOption(*app_->add_option(name, variable, description)->type_name(""));
}

template CommandOption Command::argument(const std::string&, std::string&, const std::string&);
template CommandOption Command::argument(const std::string&, std::vector<std::string>&, const std::string&);

template <typename T>
CommandOption Command::option(const std::string& form, T& variable, const std::string& description) {
  const size_t blank = form.find(' ');
  CLI::Option* option = app_->add_option(form.substr(0, blank), variable, description)->type_name(form.substr(blank + 1));
  // Each value of a list needs the option's name, else the list would take the command's arguments that follow.
  if constexpr (std::is_same_v<T, std::vector<std::string>>) option->allow_extra_args(false);
  return CommandOption(*option);
}

template CommandOption Command::option(const std::string&, std::string&, const std::string&);
template CommandOption Command::option(const std::string&, int&, const std::string&);
template CommandOption Command::option(const std::string&, std::uint64_t&, const std::string&);
template CommandOption Command::option(const std::string&, double&, const std::string&);
template CommandOption Command::option(const std::string&, std::optional<int>&, const std::string&);
template CommandOption Command::option(const std::string&, std::optional<std::uint32_t>&, const std::string&);
template CommandOption Command::option(const std::string&, std::vector<std::string>&, const std::string&);

CommandOption Command::flag(const std::string& name, bool& variable, const std::string& description) {
  return CommandOption(*app_->add_flag(name, variable, description));
}

void Command::words(std::vector<std::string>& variable) {
  app_->prefix_command();
  app_->set_help_flag();
  app_->parse_complete_callback([app = app_, &variable] { variable = app->remaining(); });
}

void Command::footer(const std::string& text) { app_->footer(text); }

void Command::runs(Run run) {
  app_->callback([chosen = chosen_, run = std::move(run)] { *chosen = run; });
}

// ---- parsing ----------------------------------------------------------------------------------------------------------

namespace {

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

/// The message that there is no such command, with the nearest known one.
std::string no_command(const CLI::App& program, const std::string& given) {
  return fmt::format("there is no command '{}'{}", given, meant(&program, given));
}

/// The message of an error of usage, and where the help is.
std::string failure_text(const std::string& message, const std::string& command) {
  return fmt::format("etendue: {}\n{} --help tells more\n", message, command);
}

/// The message for a command line that cannot be parsed, with the nearest known option or command.
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
  std::string full_name = program->get_name();
  for (const CLI::App* app = program; app != command;) {
    app = app->get_subcommands().front();
    full_name += " " + app->get_name();
  }
  return failure_text(text, full_name);
}

}  // namespace

CommandLine::CommandLine(const std::string& program, const std::string& description, const std::string& version)
    : app_(std::make_unique<CLI::App>(description, program)) {
  app_->set_version_flag("--version", version, "Print the version");
  app_->set_help_flag("-h,--help", "Print this help");
  app_->failure_message(usage_failure);
}

CommandLine::~CommandLine() = default;

Command CommandLine::program() { return {*app_, chosen_}; }

int CommandLine::run(int argument_count, const char* const* arguments) {
  refuse_empty_values(*app_);

  // CLI11 would answer --help after an unknown command with the program's help and exit status 0.
  const std::string first = argument_count > 1 ? arguments[1] : "";
  const std::vector<CLI::App*> commands = app_->get_subcommands({});
  if (!first.empty() && !first.starts_with("-") &&
      std::ranges::none_of(commands, [&](const CLI::App* command) { return command->get_name() == first; })) {
    fmt::print(stderr, "{}", failure_text(no_command(*app_, first), app_->get_name()));
    return exit_status::bad_input;
  }
  try {
    app_->parse(argument_count, arguments);
  } catch (const CLI::ParseError& error) {
    std::ostringstream out, err;
    const int status = app_->exit(error, out, err);
    fmt::print("{}", out.str());
    fmt::print(stderr, "{}", err.str());
    return status == 0 ? exit_status::done : exit_status::bad_input;
  }
  return reporting_errors(chosen_);
}

}  // namespace etendue
