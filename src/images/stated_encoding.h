#pragma once
// What an image file says of the encoding of its colours.

#include <string>
#include <vector>

namespace etendue {

/// One line for each thing that a PNG or OpenEXR file says, in the order of the file; none for files of other formats, and
/// where the file is damaged. ("gAMA: 0.45455, values are light to the power of 1 / 2.2", "chromaticities: red 0.64 0.33, …")
std::vector<std::string> stated_encoding(const std::string& path);

}  // namespace etendue
