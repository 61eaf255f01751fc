#pragma once
// Files that are read: no output may take their place.

#include <string>

namespace etendue {

/// Notes that this program reads a file, or will. RegularFile does for all it opens; who knows earlier, or lets a library of
/// the system open a file, calls it. Thread-safe.
void note_input(const std::string& path);

/// The noted file that stands at a path, by whatever name: through links of both kinds, "..", other spellings. Empty: none.
std::string input_at(const std::string& path);

}  // namespace etendue
