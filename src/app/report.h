#pragma once
// Reports errors to the user.

#include "commands.h"

namespace etendue {

/// Runs a command; shows the errors it throws on standard error and turns them into an exit status.
int reporting_errors(const Run&);

}  // namespace etendue
