#pragma once
// What goes wrong, told to the user.

#include <string>

#include "commands.h"

namespace etendue {

/// Runs a command; shows the errors it throws on standard error and turns them into an exit status.
int reporting_errors(const Run&);

/// That the program has no such command, with the one that was probably meant.
std::string no_command(const CLI::App& program, const std::string& given);

/// What is said about a command line that cannot be understood, with the name that was probably meant.
std::string usage_failure(const CLI::App* program, const CLI::Error& error);

}  // namespace etendue
