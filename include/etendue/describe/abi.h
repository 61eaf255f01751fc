#pragma once
// The ABI that a plugin was built for, as a text that program and plugin compare before anything else: everything that changes
// the memory layout of objects or how they are passed to functions. GCC and Clang agree on both; the compiler options that
// change them are checked below.

#include <cstddef>
#include <string>
#include <vector>

#include "etendue/core/spectrum.h"

#define ETENDUE_TEXT_OF(x) #x
#define ETENDUE_TEXT(x) ETENDUE_TEXT_OF(x)

namespace etendue::detail {

/// Increased whenever a public header changes in a way that is incompatible for plugins.
#define ETENDUE_INTERFACE_VERSION 15

/// The width [bytes] of the widest vector registers that the compiler may use. A Spectrum is passed in one of them if it fits,
/// else in memory or in several registers: code compiled with another width reads it from the wrong place.
#if defined(__AVX512F__)
inline constexpr std::size_t vector_register = 64;
#elif defined(__AVX__)
inline constexpr std::size_t vector_register = 32;
#else
inline constexpr std::size_t vector_register = 16;
#endif

/// Types whose sizes are changed by the compiler options -fshort-enums and -fpack-struct.
enum SmallEnum { small_enum };
struct Padded {
  char first;
  double second;
};
struct WithBase : Padded {
  char third;
};

/// A text that is composed at compile time.
struct AbiText {
  char text[320] = {};
  std::size_t size = 0;

  constexpr void add(const char* part) {
    for (; *part && size + 1 < sizeof text; ++part) text[size++] = *part;
  }
  constexpr void add(std::size_t number) {
    if (number >= 10) add(number / 10);
    const char digit[2] = {char('0' + number % 10), 0};
    add(digit);
  }
};

/// Parts separated by ", ", in the same order in program and plugin; src/describe/plugin.cpp has a remedy for each.
constexpr AbiText make_abi_text() {
  AbiText t;
  t.add("interfaces " ETENDUE_TEXT(ETENDUE_INTERFACE_VERSION));
  t.add(", ");
  t.add(std::size_t(spectrum_size));
  t.add(" wavelengths, spectra in ");
  t.add(vector_register >= sizeof(Spectrum) ? "one vector register" : "memory");
#if defined(_LIBCPP_VERSION)
  t.add(", libc++ " ETENDUE_TEXT(_LIBCPP_ABI_VERSION));
#elif defined(_GLIBCXX_USE_CXX11_ABI)
  t.add(", libstdc++ with C++11 strings " ETENDUE_TEXT(_GLIBCXX_USE_CXX11_ABI));
#else
  t.add(", another standard library");
#endif
#if defined(_GLIBCXX_DEBUG) || defined(_LIBCPP_DEBUG)
  t.add(", containers for debugging");
#else
  t.add(", usual containers");
#endif
  t.add(", layout");
  for (const std::size_t n :
       {sizeof(Spectrum), alignof(Spectrum), sizeof(Wavelengths), sizeof(std::string), sizeof(std::vector<std::string>),
        sizeof(void*), sizeof(long), sizeof(long double), sizeof(SmallEnum), sizeof(Padded), sizeof(WithBase)}) {
    t.add(" ");
    t.add(n);
  }
  return t;
}
/// Has internal linkage, so that a plugin reports its own text, and never that of the program.
static constexpr AbiText abi_text = make_abi_text();

/// The extensions of the instruction set that the compiler may have used, each followed by a blank.
static constexpr const char* instructions =
#if defined(__SSE4_2__)
    "sse4.2 "
#endif
#if defined(__AVX__)
    "avx "
#endif
#if defined(__AVX2__)
    "avx2 "
#endif
#if defined(__FMA__)
    "fma "
#endif
#if defined(__BMI2__)
    "bmi2 "
#endif
#if defined(__AVX512F__)
    "avx512f "
#endif
#if defined(__AVX512VL__)
    "avx512vl "
#endif
#if defined(__AVX512BW__)
    "avx512bw "
#endif
#if defined(__AVX512DQ__)
    "avx512dq "
#endif
    "";

}  // namespace etendue::detail

/// Exported by every library that includes this header.
extern "C" {
[[gnu::used, gnu::visibility("default")]] inline const char* etendue_plugin_abi() { return etendue::detail::abi_text.text; }
[[gnu::used, gnu::visibility("default")]] inline const char* etendue_plugin_instructions() {
  return etendue::detail::instructions;
}
}
