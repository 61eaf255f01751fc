#pragma once
// Hashes of lattice points: Bob Jenkins' lookup3 (public domain, 2006, burtleburtle.net/bob/c/lookup3.c), which the reference
// implementation uses for all patterns, so that its values are those of the language.

#include <cstdint>

namespace etendue::osl {

// The functions are templates over the word W: std::uint32_t, or a vector of them.

template <class W>
constexpr W rotated(W x, int by) {
  return (x << by) | (x >> (32 - by));
}

/// lookup3's `final`: three words to one.
template <class W>
constexpr W jenkins_final(W a, W b, W c) {
  c ^= b, c -= rotated(b, 14);
  a ^= c, a -= rotated(c, 11);
  b ^= a, b -= rotated(a, 25);
  c ^= b, c -= rotated(b, 16);
  a ^= c, a -= rotated(c, 4);
  b ^= a, b -= rotated(a, 14);
  c ^= b, c -= rotated(b, 24);
  return c;
}

/// lookup3's `mix`: of three words, reversibly.
template <class W>
constexpr void jenkins_mix(W& a, W& b, W& c) {
  a -= c, a ^= rotated(c, 4), c += b;
  b -= a, b ^= rotated(a, 6), a += c;
  c -= b, c ^= rotated(b, 8), b += a;
  a -= c, a ^= rotated(c, 16), c += b;
  b -= a, b ^= rotated(a, 19), a += c;
  c -= b, c ^= rotated(b, 4), b += a;
}

/// What lookup3's hashword begins with for so many words, with the initval 13.
constexpr std::uint32_t hash_begin(int words) { return 0xdeadbeef + (std::uint32_t(words) << 2) + 13; }

// lookup3's hashword of one to five words.
template <class W>
constexpr W hash_words(W k0) {
  const W s = W{} + hash_begin(1);
  return jenkins_final<W>(s + k0, s, s);
}
template <class W>
constexpr W hash_words(W k0, W k1) {
  const W s = W{} + hash_begin(2);
  return jenkins_final<W>(s + k0, s + k1, s);
}
template <class W>
constexpr W hash_words(W k0, W k1, W k2) {
  const W s = W{} + hash_begin(3);
  return jenkins_final<W>(s + k0, s + k1, s + k2);
}
template <class W>
constexpr W hash_words(W k0, W k1, W k2, W k3) {
  W a = W{} + hash_begin(4), b = a, c = a;
  a += k0, b += k1, c += k2;
  jenkins_mix(a, b, c);
  return jenkins_final<W>(a + k3, b, c);
}
template <class W>
constexpr W hash_words(W k0, W k1, W k2, W k3, W k4) {
  W a = W{} + hash_begin(5), b = a, c = a;
  a += k0, b += k1, c += k2;
  jenkins_mix(a, b, c);
  return jenkins_final<W>(a + k3, b + k4, c);
}

/// A hash as a number in [0, 1].
inline float to_unit(std::uint32_t bits) { return float(bits) * float(1.0 / 0xffffffffu); }

}  // namespace etendue::osl
