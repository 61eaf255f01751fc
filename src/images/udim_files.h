#pragma once
// Images in several files, one for each unit square of the uv coordinates (UDIM).

#include <string>
#include <vector>

namespace etendue {

inline constexpr const char* udim_mark = "<UDIM>";
struct UdimFile {
  int u, v;  ///< lower corner of the unit square that the image covers
  std::string path;
};
/// The files that match a path with "<UDIM>" in its name: in its place they have the numbers 1001 + u + 10 v, u from 0 to 9.
std::vector<UdimFile> udim_files(const std::string& pattern);

}  // namespace etendue
