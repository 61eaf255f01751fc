#pragma once
// Plugins that are written in Python.
//
// Only an interpreter can run them, and the program has none. So when the first one is met, the process is replaced by Python,
// which imports the package etendue and calls the program as a function (program.h) with the same arguments. The package lies
// beside the program in a build, in a wheel and in the Debian package.

#include <string>

namespace etendue {

/// From now on a plugin that is written in Python restarts the program within Python. For the executable's own `main`.
void restart_for_python_plugins(int argument_count, char** arguments);

/// To be called before something is done that must not be done twice: from now on such a plugin is refused, with a message that
/// says how to name it earlier.
void refuse_restarts();

/// The folder of the library that holds the program; empty: unknown.
std::string program_folder();

}  // namespace etendue
