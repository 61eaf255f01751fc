#pragma once
// Small texts in pictures: numbers and units.

#include <string_view>

namespace etendue {

/// Height and width of a character's cell [pixels], with the gap to the next one.
constexpr int character_width = 6, character_height = 7;

/// Whether a text has ink at a pixel of its line, x from its left and y from its top. Characters that are not known are blank:
/// there are digits, lower-case letters of the Latin alphabet and . - + / %
bool has_ink(std::string_view text, int x, int y);

}  // namespace etendue
