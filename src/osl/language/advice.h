#pragma once
// What is allowed in a shader and most likely a mistake.

#include "compile.h"

namespace etendue::osl {

/// Variables and parameters that nothing reads, and variables that are read before anything gave them a value: warnings, in the
/// order of the text. Only what stands in the shader's own file counts, not what it includes.
std::vector<Diagnostic> advice(const Shader&);

}  // namespace etendue::osl
