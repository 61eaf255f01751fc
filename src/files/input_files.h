#pragma once
// Files that are read: no output may take their place.

#include <set>
#include <string>

namespace etendue {

/// Notes that this program reads a file, or will. RegularFile does for all it opens; who knows earlier, or lets a library of
/// the system open a file, calls it. Thread-safe.
void note_input(const std::string& path);

/// The files that are noted, by any thread, as long as this is there.
class InputsRead {
 public:
  InputsRead();
  ~InputsRead();
  InputsRead(const InputsRead&) = delete;
  InputsRead& operator=(const InputsRead&) = delete;
  /// As full paths.
  std::set<std::string> paths() const;

 private:
  std::set<std::string> paths_;
  friend void note_input(const std::string&);
};

/// The noted file that stands at a path, by whatever name: through links of both kinds, "..", other spellings. Empty: none.
std::string input_at(const std::string& path);

}  // namespace etendue
