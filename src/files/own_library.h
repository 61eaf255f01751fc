#pragma once
// Libraries of this program that are opened when they are first needed: they stand beside the one that contains this code.

#include <string>

namespace etendue {

/// The path of the library with this file name; empty if there is none.
std::string own_library_path(const char* file_name);

/// Which of a library's names others that are opened later can refer to.
enum class LibraryNames : unsigned char { own, shared };

/// Opens the library with this file name, beside this one or else where the system finds it, and returns dlopen's handle. It is
/// never closed, as objects of its classes and its code may be in use until the program ends. Throws Error, which says that
/// `what` cannot be loaded and why.
void* open_own_library(const char* file_name, const std::string& what, LibraryNames names = LibraryNames::own);

}  // namespace etendue
