#pragma once
// Hashes of lattice points: Bob Jenkins' lookup3 (public domain, 2006, burtleburtle.net/bob/c/lookup3.c), which the reference
// implementation uses for all patterns, so that its values are those of the language.

#include <bit>
#include <cstdint>

namespace etendue::osl {

/// lookup3's `final`: three words to one.
constexpr std::uint32_t jenkins_final(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  c ^= b, c -= std::rotl(b, 14);
  a ^= c, a -= std::rotl(c, 11);
  b ^= a, b -= std::rotl(a, 25);
  c ^= b, c -= std::rotl(b, 16);
  a ^= c, a -= std::rotl(c, 4);
  b ^= a, b -= std::rotl(a, 14);
  c ^= b, c -= std::rotl(b, 24);
  return c;
}

/// lookup3's `mix`: of three words, reversibly.
constexpr void jenkins_mix(std::uint32_t& a, std::uint32_t& b, std::uint32_t& c) {
  a -= c, a ^= std::rotl(c, 4), c += b;
  b -= a, b ^= std::rotl(a, 6), a += c;
  c -= b, c ^= std::rotl(b, 8), b += a;
  a -= c, a ^= std::rotl(c, 16), c += b;
  b -= a, b ^= std::rotl(a, 19), a += c;
  c -= b, c ^= std::rotl(b, 4), b += a;
}

/// The hash of one to five words: lookup3's hashword with initval 13 - the words' bytes are counted by lookup3 itself.
constexpr std::uint32_t hash_words(std::uint32_t k0) {
  constexpr std::uint32_t s = 0xdeadbeef + (1 << 2) + 13;
  return jenkins_final(s + k0, s, s);
}
constexpr std::uint32_t hash_words(std::uint32_t k0, std::uint32_t k1) {
  constexpr std::uint32_t s = 0xdeadbeef + (2 << 2) + 13;
  return jenkins_final(s + k0, s + k1, s);
}
constexpr std::uint32_t hash_words(std::uint32_t k0, std::uint32_t k1, std::uint32_t k2) {
  constexpr std::uint32_t s = 0xdeadbeef + (3 << 2) + 13;
  return jenkins_final(s + k0, s + k1, s + k2);
}
constexpr std::uint32_t hash_words(std::uint32_t k0, std::uint32_t k1, std::uint32_t k2, std::uint32_t k3) {
  std::uint32_t a = 0xdeadbeef + (4 << 2) + 13, b = a, c = a;
  a += k0, b += k1, c += k2;
  jenkins_mix(a, b, c);
  return jenkins_final(a + k3, b, c);
}
constexpr std::uint32_t hash_words(std::uint32_t k0, std::uint32_t k1, std::uint32_t k2, std::uint32_t k3, std::uint32_t k4) {
  std::uint32_t a = 0xdeadbeef + (5 << 2) + 13, b = a, c = a;
  a += k0, b += k1, c += k2;
  jenkins_mix(a, b, c);
  return jenkins_final(a + k3, b + k4, c);
}

/// A hash as a number in [0, 1].
inline float to_unit(std::uint32_t bits) { return float(bits) * float(1.0 / 0xffffffffu); }

}  // namespace etendue::osl
