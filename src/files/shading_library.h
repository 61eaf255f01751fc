#pragma once
// The library of the Open Shading Language (libetendue_osl.so; src/osl). It is loaded when a description first names a file
// that is written in the language.

namespace etendue {

/// Opens the library, whose static initializers make it the registry's reader of such files. Throws Error if there is none
/// beside this one. Thread-safe.
void load_shading_library();

}  // namespace etendue
