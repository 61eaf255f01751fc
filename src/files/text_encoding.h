#pragma once
// Conversion of texts in other Unicode encodings to UTF-8.

#include <string>
#include <string_view>

namespace etendue {

/// Texts with a byte order mark, in UTF-16 of either byte order or UTF-8, are converted to UTF-8 without the mark. Texts
/// without one are returned unchanged.
bool has_byte_order_mark(std::string_view);
std::string as_utf8(std::string_view);

}  // namespace etendue
