#pragma once
// The set of input files, which no output may overwrite.

#include <set>
#include <string>

namespace etendue {

/// Adds a file that this program reads or will read. RegularFile calls this for all files it opens; code that has the path
/// earlier, or lets a system library open the file, calls it as well. Thread-safe.
void note_input(const std::string& path);

/// Records the files noted by any thread during its lifetime.
class InputsRead {
 public:
  InputsRead();
  ~InputsRead();
  InputsRead(const InputsRead&) = delete;
  InputsRead& operator=(const InputsRead&) = delete;
  /// Absolute paths.
  std::set<std::string> paths() const;

 private:
  std::set<std::string> paths_;
  friend void note_input(const std::string&);
};

/// The noted file at this path, under any name: through hard and symbolic links, "..", other spellings. Empty: none.
std::string input_at(const std::string& path);

}  // namespace etendue
