#pragma once
// etendue shade: runs a network of shaders at the points of a grid.

#include <span>
#include <string>

namespace etendue::osl {

/// Returns the exit status: 0 done, 2 bad input.
int shade(std::span<const std::string> words);

}  // namespace etendue::osl

/// The same, for the program, which opens this library when it is first needed.
extern "C" int etendue_osl_shade(int count, const char* const* words);
