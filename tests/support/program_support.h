#pragma once
// Shared by tests of the program: a temporary folder, and runs of the program with their output.

#include <gtest/gtest.h>

#include "process.h"

namespace etendue {

class RunsProgram : public testing::Test {
 protected:
  /// Runs the program with these arguments; returns its exit status.
  int run(const std::vector<std::string>& arguments) { return finish(Process(program, arguments, folder)); }
  /// Waits for the end of a process, and stores its output.
  int finish(Process&& process) {
    const int status = process.wait();
    out = process.out();
    err = process.err();
    return status;
  }

  static bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
  /// Whether the program's errors and warnings contain a text.
  bool says(const std::string& part) const { return has(err, part); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }

  const std::string program = ETENDUE_BINARY_DIR "/etendue";
  TemporaryFolder folder;
  std::string out, err;
};

}  // namespace etendue
