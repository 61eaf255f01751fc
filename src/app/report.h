#pragma once
// Reports errors to the user.

#include <string>

#include "commands.h"

namespace etendue {

/// Runs a command; shows the errors it throws on standard error and turns them into an exit status.
int reporting_errors(const Run&);

/// The message that the program has no such command, with the nearest known one.
std::string no_command(const CLI::App& program, const std::string& given);

/// The message for a command line that cannot be parsed, with the nearest known option or command.
std::string usage_failure(const CLI::App* program, const CLI::Error& error);

}  // namespace etendue
