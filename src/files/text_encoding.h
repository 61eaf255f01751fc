#pragma once
// Texts in other encodings than UTF-8.

#include <string>
#include <string_view>

namespace etendue {

/// A text that begins with a byte order mark as UTF-8 without one: UTF-16 of either order, or UTF-8. Any other: nothing.
bool has_byte_order_mark(std::string_view);
std::string as_utf8(std::string_view);

}  // namespace etendue
