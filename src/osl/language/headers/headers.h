#pragma once
// The texts of the headers that shaders include beside stdosl.h, in the Open Shading Language; SourceFiles finds them by name.
// The sets of functions are those of the reference implementation's headers of these names; their texts are our own.

#include <string>

namespace etendue::osl {

std::string color2_header();
std::string color4_header();
std::string vector2_header();
std::string vector4_header();
std::string matrix33_header();
std::string oslutil_header();

/// Operators and functions of a structure that acts part by part, as `color` and `vector` do. Where the text is inserted,
/// macros state the structure: TUPLE, its name; EACH(F), F of each part's name, separated by commas; ALL(x), a number for all
/// parts; BOTH(F), F of each part's name, joined by `&&`. The text removes them.
extern const char* const tuple_functions;

}  // namespace etendue::osl
