#pragma once
// The output of commands that write a render description: save and convert.

#include <string>

#include "app/command_line.h"
#include "etendue/render/job.h"

namespace etendue {

/// --output, which must be given.
void add_description_output(Command&, std::string& output);

/// Writes the job to the file, in JSON if its name says so, or to standard output if it is "-". `comments` are the first lines,
/// except in JSON, which has no comments. `all`: with members that have their default values. Throws Errors.
void write_description_to(const std::string& output, const Job&, const std::string& comments, bool all);

}  // namespace etendue
