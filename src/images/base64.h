#pragma once
// Bytes as text.

#include <string>
#include <vector>

namespace etendue {

/// RFC 4648, with padding.
std::string base64(const std::vector<unsigned char>& bytes);

}  // namespace etendue
