#pragma once
// The colour encoding that an image file states.

#include <string>
#include <vector>

namespace etendue {

/// One line for each statement about colours in a PNG or OpenEXR file, in the order of the file; empty for other formats. In a
/// damaged file it ends at the damage. ("gAMA: 0.45455, values are light to the power of 1 / 2.2", "chromaticities: red 0.64
/// 0.33, …")
std::vector<std::string> stated_encoding(const std::string& path);

}  // namespace etendue
