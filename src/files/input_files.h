#pragma once
// Files that are read: no output may take their place.

#include <string>

namespace etendue {

class Component;

/// Notes that this program reads a file, or will. RegularFile does for all it opens; who knows earlier, or lets a library of
/// the system open a file, calls it. Thread-safe.
void note_input(const std::string& path);
/// The same for all files that a description names to be read, whether or not that has happened yet: those of its parts, of
/// spectra, of plugins that its classes come from. What an Output names is written and is not among them.
void note_inputs_of(const Component&);

/// The noted file that stands at a path, by whatever name: through links of both kinds, "..", other spellings. Empty: none.
std::string input_at(const std::string& path);

}  // namespace etendue
