// Perlin's gradient noise, cell noise and hash noise.

#include <algorithm>
#include <bit>
#include <cstring>

#include "lattice_hash.h"
#include "noise.h"

namespace etendue::osl {

namespace {

/// The hash of the first `n` of the words.
std::uint32_t hash_of(const std::uint32_t* k, int n) {
  switch (n) {
    case 1: return hash_words(k[0]);
    case 2: return hash_words(k[0], k[1]);
    case 3: return hash_words(k[0], k[1], k[2]);
    case 4: return hash_words(k[0], k[1], k[2], k[3]);
    default: return hash_words(k[0], k[1], k[2], k[3], k[4]);
  }
}

/// The fade curve 6 t^5 - 15 t^4 + 10 t^3.
template <class N>
N fade(const N& t) {
  return t * t * t * (t * (t * N(6) - N(15)) + N(10));
}

// Eight corners of a lattice cell are computed at once. Corner i is the upper one along axis d where bit d of i is set.
constexpr int lanes = 8;
using Lanes = float __attribute__((vector_size(lanes * sizeof(float))));
using Words = std::uint32_t __attribute__((vector_size(lanes * sizeof(std::uint32_t))));

/// Lane i: whether corner i is an upper one along the axis.
constexpr Words upper[3] = {
    {0, ~0u, 0, ~0u, 0, ~0u, 0, ~0u}, {0, 0, ~0u, ~0u, 0, 0, ~0u, ~0u}, {0, 0, 0, 0, ~0u, ~0u, ~0u, ~0u}};

Lanes chosen(Words first, Lanes a, Lanes b) {
  return std::bit_cast<Lanes>((first & std::bit_cast<Words>(a)) | (~first & std::bit_cast<Words>(b)));
}
Words mask(auto comparison) { return std::bit_cast<Words>(comparison); }

/// x, or -x where the bit of that number is set in h.
Lanes negated_if(Lanes x, Words h, int bit) { return std::bit_cast<Lanes>(std::bit_cast<Words>(x) ^ ((h >> bit) << 31)); }

/// The inner product of the lattice points' gradients, which the hashes choose, with x. In one dimension gradients are +-1 ...
/// +-8, in two (+-1, +-2) and (+-2, +-1), in three the middles of a cube's edges (Perlin 2002), in four those of a hypercube.
template <int n>
Lanes along_gradient(Words hash, const Lanes* x) {
  if constexpr (n == 1) {
    return negated_if(x[0] * (1 + __builtin_convertvector(hash & 7, Lanes)), hash, 3);
  } else if constexpr (n == 2) {
    const Words first = mask((hash & 7) < 4);
    return negated_if(chosen(first, x[0], x[1]), hash, 0) + negated_if(2 * chosen(first, x[1], x[0]), hash, 1);
  } else if constexpr (n == 3) {
    const Words h = hash & 15;
    const Lanes u = chosen(mask(h < 8), x[0], x[1]);
    const Lanes v = chosen(mask(h < 4), x[1], chosen(mask(h == 12) | mask(h == 14), x[0], x[2]));
    return negated_if(u, h, 0) + negated_if(v, h, 1);
  } else {
    const Words h = hash & 31;
    return negated_if(chosen(mask(h < 24), x[0], x[1]), h, 0) + negated_if(chosen(mask(h < 16), x[1], x[2]), h, 1) +
           negated_if(chosen(mask(h < 8), x[2], x[3]), h, 2);
  }
}

template <int n>
Words hash_of_corners(const Words* k) {
  if constexpr (n == 1)
    return hash_words(k[0]);
  else if constexpr (n == 2)
    return hash_words(k[0], k[1]);
  else if constexpr (n == 3)
    return hash_words(k[0], k[1], k[2]);
  else
    return hash_words(k[0], k[1], k[2], k[3]);
}

/// Brings the noise to about [-1, 1] (empirical factors of the reference implementation).
constexpr float scales[most_dimensions] = {0.2500f, 0.6616f, 0.9820f, 0.8344f};

/// The values at the corners, in up to two groups of eight; with derivatives by x and y if N is dual.
template <class N, int n>
struct Corners {
  static constexpr int parts = is_dual<N> ? 3 : 1;
  static constexpr int groups = n == 4 ? 2 : 1;
  float values[3][parts][groups * lanes];  // of a triple's component

  Corners(const std::uint32_t (&low)[most_dimensions], const std::uint32_t (&high)[most_dimensions], const N* offset,
          int count) {
    for (int group = 0; group < groups; ++group) {
      Words words[n];
      Lanes from[parts][n];
      for (int d = 0; d < n; ++d) {
        const Words up = d < 3 ? upper[d] : Words{} + (group ? ~0u : 0u);
        words[d] = (up & high[d]) | (~up & low[d]);
        const Lanes at = Lanes{} + value_of(offset[d]);
        from[0][d] = chosen(up, at - 1, at);
        if constexpr (is_dual<N>) from[1][d] = Lanes{} + offset[d].dx, from[2][d] = Lanes{} + offset[d].dy;
      }
      const Words hash = hash_of_corners<n>(words);
      // The three components of a triple take 8 bits of the hash each.
      for (int c = 0; c < count; ++c)
        for (int part = 0; part < parts; ++part) {
          const Lanes v = along_gradient<n>(count == 1 ? hash : (hash >> (8 * c)) & 0xff, from[part]);
          std::memcpy(&values[c][part][group * lanes], &v, sizeof v);
        }
    }
  }

  N at(int c, int corner) const {
    if constexpr (is_dual<N>)
      return N(values[c][0][corner], values[c][1][corner], values[c][2][corner]);
    else
      return values[c][0][corner];
  }
};

/// (1 - w) a + w b of pairs of neighbouring lanes.
template <int count>
auto between_pairs(const float __attribute__((vector_size(count * sizeof(float)))) & v, float w) {
  if constexpr (count == 8)
    return (1 - w) * __builtin_shufflevector(v, v, 0, 2, 4, 6) + w * __builtin_shufflevector(v, v, 1, 3, 5, 7);
  else
    return (1 - w) * __builtin_shufflevector(v, v, 0, 2) + w * __builtin_shufflevector(v, v, 1, 3);
}

/// The same as `perlin` for a number without derivatives and periods: nothing goes through memory.
template <int n>
float perlin_number(const std::array<float, n>& x) {
  std::uint32_t low[n];
  float offset[n], weight[n];
  for (std::size_t d = 0; d < n; ++d) {
    low[d] = std::uint32_t(floor_to_int(x[d]));
    offset[d] = x[d] - std::floor(x[d]);
    weight[d] = fade(offset[d]);
  }
  float ends[2] = {};  // of the fourth dimension
  for (int group = 0; group < (n == 4 ? 2 : 1); ++group) {
    Words words[n];
    Lanes from[n];
    for (int d = 0; d < n; ++d) {
      const Words up = d < 3 ? upper[d] : Words{} + (group ? ~0u : 0u);
      words[d] = low[d] - up;  // one more where the mask is set
      const Lanes at = Lanes{} + offset[d];
      from[d] = chosen(up, at - 1, at);
    }
    const Lanes corners = along_gradient<n>(hash_of_corners<n>(words), from);
    const auto four = between_pairs<8>(corners, weight[0]);
    if constexpr (n == 1) {
      ends[0] = four[0];
    } else {
      const auto two = between_pairs<4>(four, weight[1]);
      if constexpr (n == 2)
        ends[0] = two[0];
      else
        ends[group] = (1 - weight[2]) * two[0] + weight[2] * two[1];
    }
  }
  if constexpr (n == 4) ends[0] = (1 - weight[3]) * ends[0] + weight[3] * ends[1];
  return scales[n - 1] * ends[0];
}

template <int n, class N>
void perlin(const Position<N>& p, int count, N* out) {
  std::uint32_t low[most_dimensions] = {}, high[most_dimensions] = {};
  N offset[n], weight[n];
  for (int d = 0; d < n; ++d) {
    const N& x = p.at[std::size_t(d)];
    low[d] = std::uint32_t(floor_to_int(value_of(x)));
    high[d] = low[d] + 1;
    offset[d] = x - N(std::floor(value_of(x)));
    weight[d] = fade(offset[d]);
    if (p.periodic) {
      const long long period = std::max(floor_to_int(p.period[std::size_t(d)]), 1);
      for (std::uint32_t* corner : {&low[d], &high[d]}) *corner = std::uint32_t(((int(*corner) % period) + period) % period);
    }
  }
  const Corners<N, n> corners(low, high, offset, count);
  for (int c = 0; c < count; ++c) {
    // Interpolation along one axis after the other.
    N values[1 << n];
    for (int i = 0; i < 1 << n; ++i) values[i] = corners.at(c, i);
    for (int d = 0; d < n; ++d)
      for (int i = 0; i < 1 << (n - d - 1); ++i) values[i] = (N(1) - weight[d]) * values[2 * i] + weight[d] * values[2 * i + 1];
    out[c] = N(scales[n - 1]) * values[0];
  }
}

template <class N>
void perlin_of_dimensions(const Position<N>& p, int count, N* out) {
  switch (p.dimensions) {
    case 1: return perlin<1>(p, count, out);
    case 2: return perlin<2>(p, count, out);
    case 3: return perlin<3>(p, count, out);
    default: return perlin<4>(p, count, out);
  }
}

/// `count` hashes of words: of three, each has its index as a further word.
void hashes(std::uint32_t* words, int n, int count, float* out) {
  if (count == 1) {
    out[0] = to_unit(hash_of(words, n));
    return;
  }
  for (int c = 0; c < count; ++c) {
    words[n] = std::uint32_t(c);
    out[c] = to_unit(hash_of(words, n + 1));
  }
}

}  // namespace

void perlin_noise(const Position<float>& p, int count, float* out) { perlin_of_dimensions(p, count, out); }
void perlin_noise(const Position<Dual<float>>& p, int count, Dual<float>* out) { perlin_of_dimensions(p, count, out); }

float perlin_noise(float x) { return perlin_number<1>({x}); }
float perlin_noise(float x, float y) { return perlin_number<2>({x, y}); }
float perlin_noise(float x, float y, float z) { return perlin_number<3>({x, y, z}); }
float perlin_noise(float x, float y, float z, float t) { return perlin_number<4>({x, y, z, t}); }

void cell_noise(const Position<float>& p, int count, float* out) {
  std::uint32_t words[most_dimensions + 1];
  for (int d = 0; d < p.dimensions; ++d) {
    const float x = p.at[std::size_t(d)];
    words[d] = std::uint32_t(floor_to_int(p.periodic ? wrapped(x, p.period[std::size_t(d)]) : x));
  }
  hashes(words, p.dimensions, count, out);
}

void hash_noise(const Position<float>& p, int count, float* out) {
  std::uint32_t words[most_dimensions + 1];
  for (int d = 0; d < p.dimensions; ++d) {
    const float x = p.at[std::size_t(d)];
    words[d] = std::bit_cast<std::uint32_t>(p.periodic ? wrapped(x, p.period[std::size_t(d)]) : x);
  }
  hashes(words, p.dimensions, count, out);
}

}  // namespace etendue::osl
