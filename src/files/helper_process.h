#pragma once
// Runs helper programs that read files for us, in processes of their own.

#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {

/// The program does not exist, or cannot be started.
class NotStarted : public Error {
  using Error::Error;
};

/// Runs a helper, which is installed beside this library or in libexec/etendue, and returns its standard output; `input` is a
/// file that becomes its standard input. Throws Error with the reason alone if the helper fails, crashes, takes too long, or
/// writes more than fits in memory.
std::string run_helper(const std::string& name, const std::vector<std::string>& arguments, std::string_view input = {});

/// The path of a helper; empty: it is not installed.
std::string helper_path(const std::string& name);

/// Runs any program with arguments in the same way.
std::string run_program(const std::string& path, const std::vector<std::string>& arguments, const std::string& shown_as,
                        std::string_view input = {});

}  // namespace etendue
