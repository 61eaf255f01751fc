#pragma once
// The files that a command will write. Outputs that cannot be written, or would do harm, are refused before anything is
// computed.

#include <string>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {

class OutputFiles {
 public:
  /// Adds a file that is named at a location of a description or command line. Collects errors: the file cannot be written; it
  /// is an input (see files/input_files.h) other than `continued`; it was added before. Files are compared by identity, not by
  /// name.
  void add(const std::string& path, Location at, const std::string& continued = {});
  /// Throws Errors if there were any.
  void raise() const;

 private:
  struct File {
    std::string path, identity;
  };
  std::vector<File> files_;
  std::vector<Error> errors_;
};

}  // namespace etendue
