#pragma once
// What a plugin was built against, as a text that both sides compare before anything else is done: whatever changes how
// objects lie in memory or how they are handed over. GCC and Clang agree on both; which of their options decide is below.

#include <cstddef>
#include <string>
#include <vector>

#include "etendue/core/spectrum.h"

#define ETENDUE_TEXT_OF(x) #x
#define ETENDUE_TEXT(x) ETENDUE_TEXT_OF(x)

namespace etendue::detail {

/// Raised whenever a public header changes what plugins see.
#define ETENDUE_INTERFACE_VERSION 10

/// The width [bytes] of the widest vector registers the compiler may use. A Spectrum is handed over in one of them when it
/// fits, else in memory or in several: who was compiled otherwise reads it from the wrong place.
#if defined(__AVX512F__)
inline constexpr std::size_t vector_register = 64;
#elif defined(__AVX__)
inline constexpr std::size_t vector_register = 32;
#else
inline constexpr std::size_t vector_register = 16;
#endif

/// Of sizes that options change: -fshort-enums, -fpack-struct.
enum SmallEnum { small_enum };
struct Padded {
  char first;
  double second;
};
struct WithBase : Padded {
  char third;
};

/// A text that is put together by the compiler.
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

/// Parts separated by ", ", in the same order on both sides; src/describe/plugin.cpp knows a remedy for each.
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
/// Of internal linkage, as what a plugin says must be its own, never what the program says.
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

/// Emitted into every library that includes this header.
extern "C" {
[[gnu::used, gnu::visibility("default")]] inline const char* etendue_plugin_abi() { return etendue::detail::abi_text.text; }
[[gnu::used, gnu::visibility("default")]] inline const char* etendue_plugin_instructions() {
  return etendue::detail::instructions;
}
}
