#pragma once
// Images in several files, one for each unit square of the surface coordinates (UDIM).

#include <string>
#include <vector>

namespace etendue {

inline constexpr const char* udim_mark = "<UDIM>";
struct UdimFile {
  int u, v;  ///< the unit square the image covers begins at (u, v)
  std::string path;
};
/// The files that a path with "<UDIM>" in its name stands for: there are numbers 1001 + u + 10 v in its place, u from 0 to 9.
std::vector<UdimFile> udim_files(const std::string& pattern);

}  // namespace etendue
