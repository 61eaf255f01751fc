#pragma once
// What tests of the program share: a folder of their own, the program run there to its end, and what it said.

#include <gtest/gtest.h>

#include "process.h"

namespace etendue {

class RunsProgram : public testing::Test {
 protected:
  /// Runs the program with these arguments; returns its exit status.
  int run(const std::vector<std::string>& arguments) { return finish(Process(program, arguments, folder)); }
  /// Waits for a process, and keeps what it said.
  int finish(Process&& process) {
    const int status = process.wait();
    out = process.out();
    err = process.err();
    return status;
  }

  static bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
  /// Whether its errors and warnings do.
  bool says(const std::string& part) const { return has(err, part); }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder / name); }

  const std::string program = ETENDUE_BINARY_DIR "/etendue";
  TemporaryFolder folder;
  std::string out, err;
};

}  // namespace etendue
