#pragma once
// Files that a command will write: refused, before anything is computed, where that could not be done or would do harm.

#include <string>
#include <vector>

#include "etendue/core/error.h"

namespace etendue {

class OutputFiles {
 public:
  /// Adds a file that is named at a place. Noted as wrong: that it cannot be written, that it is one of the files that are
  /// read (see files/input_files.h) other than `continued`, that it was added before; all by whatever name.
  void add(const std::string& path, Location at, const std::string& continued = {});
  /// Throws Errors when anything was wrong.
  void raise() const;

 private:
  struct File {
    std::string path, identity;
  };
  std::vector<File> files_;
  std::vector<Error> errors_;
};

}  // namespace etendue
