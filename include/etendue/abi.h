#pragma once
// What a plugin was built against, as a text that both sides compare before anything else is done. GCC and Clang lay out
// classes and pass arguments alike; that they use the same standard library is what has to be said.

#include <string>

#include "etendue/spectrum.h"

#define ETENDUE_TEXT_OF(x) #x
#define ETENDUE_TEXT(x) ETENDUE_TEXT_OF(x)

namespace etendue::detail {

/// Raised whenever a public header changes what plugins see.
#define ETENDUE_INTERFACE_VERSION 4

inline constexpr int abi_wavelengths = spectrum_size;
static_assert(spectrum_size == 4 || spectrum_size == 8 || spectrum_size == 16);
inline constexpr const char* abi_text =
    spectrum_size == 4 ? "interfaces " ETENDUE_TEXT(ETENDUE_INTERFACE_VERSION) ", C++11 strings " ETENDUE_TEXT(
                             _GLIBCXX_USE_CXX11_ABI) ", 4 wavelengths"
    : spectrum_size == 8 ? "interfaces " ETENDUE_TEXT(ETENDUE_INTERFACE_VERSION) ", C++11 strings " ETENDUE_TEXT(
                               _GLIBCXX_USE_CXX11_ABI) ", 8 wavelengths"
                         : "interfaces " ETENDUE_TEXT(ETENDUE_INTERFACE_VERSION) ", C++11 strings " ETENDUE_TEXT(
                               _GLIBCXX_USE_CXX11_ABI) ", 16 wavelengths";

}  // namespace etendue::detail

/// Emitted into every library that includes this header.
extern "C" {
[[gnu::used, gnu::visibility("default")]] inline const char* etendue_plugin_abi() { return etendue::detail::abi_text; }
}
