#pragma once
// The command line: a tree of commands with their arguments, options and help.
//
// These classes hide the library CLI11. Its single header takes seconds to compile, so only command_line.cpp includes it.

#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace etendue {

/// What a command does. Returns the program's exit status.
using Run = std::function<int()>;

/// An option or argument of a Command. Other options are named as on the command line, as in "--output"; they must belong to
/// the same command and be added before.
class CommandOption {
 public:
  explicit CommandOption(CLI::Option& option) : option_(&option) {}

  CommandOption& required();
  CommandOption& range(int least, int most);
  CommandOption& range(double least, double most);
  CommandOption& one_of(const std::vector<std::string>& values);
  CommandOption& needs(const std::string& option);
  CommandOption& excludes(std::initializer_list<const char*> options);
  /// The help shows the variable's present value.
  CommandOption& show_default();
  /// The heading under which the help lists the option.
  CommandOption& heading(const std::string&);
  /// The help does not list the option.
  CommandOption& hidden();

 private:
  CLI::Option* option_;
};

/// A command of the program, or the program itself. The variables of its options must live as long as the command line.
class Command {
 public:
  Command add_command(const std::string& name, const std::string& description);
  /// One of the commands below this one must be given.
  void require_command();

  /// An argument is given by its position. T: std::string, or std::vector of them for any number of arguments.
  template <typename T>
  CommandOption argument(const std::string& name, T& variable, const std::string& description);
  /// `form` is how the help shows the option: its names and, after a blank, that of its value, as in "-o,--output FILE".
  /// T: std::string, int, std::uint64_t, double, std::optional<int>, std::optional<std::uint32_t>; or std::vector<std::string>
  /// for an option that may be repeated.
  template <typename T>
  CommandOption option(const std::string& form, T& variable, const std::string& description);
  CommandOption flag(const std::string& name, bool& variable, const std::string& description);
  /// All words behind the command's name, which has its own options and help.
  void words(std::vector<std::string>& variable);
  /// Text below the list of options in the help.
  void footer(const std::string&);

  /// What is done when this command is given.
  void runs(Run);

 private:
  friend class CommandLine;
  Command(CLI::App& app, Run& chosen) : app_(&app), chosen_(&chosen) {}
  CLI::App* app_;
  Run* chosen_;  // the CommandLine's
};

/// The command line of the whole program.
class CommandLine {
 public:
  /// `version` is the text that --version prints.
  CommandLine(const std::string& program, const std::string& description, const std::string& version);
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;
  ~CommandLine();

  /// The program itself, to which the commands are added.
  Command program();
  /// Runs the command that is given. Prints the help or version if one is wanted, and errors. Returns the exit status.
  int run(int argument_count, const char* const* arguments);

 private:
  std::unique_ptr<CLI::App> app_;
  Run chosen_;
};

}  // namespace etendue
