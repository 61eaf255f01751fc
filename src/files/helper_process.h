#pragma once
// Programs of ours that read files for us, in processes of their own.

#include <string>
#include <string_view>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {

/// There is no such program, or it is none that can be started.
class NotStarted : public Error {
  using Error::Error;
};

/// What a helper, which lies beside this library or in libexec/etendue, writes to its standard output; `input` is what it finds
/// as its standard input, which is a file. Throws Error with the reason alone when it fails, is ended by a fault, says nothing
/// for too long, or writes more than memory holds.
std::string run_helper(const std::string& name, const std::vector<std::string>& arguments, std::string_view input = {});

/// The path of a helper; empty: it is not there.
std::string helper_path(const std::string& name);

/// The same for any program with its arguments.
std::string run_program(const std::string& path, const std::vector<std::string>& arguments, const std::string& shown_as,
                        std::string_view input = {});

}  // namespace etendue
