// Perlin's gradient noise, cell noise and hash noise.

#include <algorithm>
#include <bit>

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

template <class N>
N negated_if(const N& x, std::uint32_t bit) {
  return bit ? -x : x;
}

/// The inner product of the lattice point's gradient, which the hash chooses, with the offset x. In one dimension gradients are
/// +-1 ... +-8, in two (+-1, +-2) and (+-2, +-1), in three the middles of a cube's edges (Perlin 2002), in four those of a
/// hypercube.
template <class N>
N along_gradient(std::uint32_t hash, int dimensions, const N* x) {
  switch (dimensions) {
    case 1: {
      const float size = 1 + float(hash & 7);
      return x[0] * N(hash & 8 ? -size : size);
    }
    case 2: {
      const bool first = (hash & 7) < 4;
      return negated_if(first ? x[0] : x[1], hash & 1) + negated_if(N(2) * (first ? x[1] : x[0]), hash & 2);
    }
    case 3: {
      const std::uint32_t h = hash & 15;
      return negated_if(h < 8 ? x[0] : x[1], h & 1) + negated_if(h < 4 ? x[1] : (h == 12 || h == 14 ? x[0] : x[2]), h & 2);
    }
    default: {
      const std::uint32_t h = hash & 31;
      return negated_if(h < 24 ? x[0] : x[1], h & 1) + negated_if(h < 16 ? x[1] : x[2], h & 2) +
             negated_if(h < 8 ? x[2] : x[3], h & 4);
    }
  }
}

/// Brings the noise to about [-1, 1] (empirical factors of the reference implementation).
constexpr float scales[most_dimensions] = {0.2500f, 0.6616f, 0.9820f, 0.8344f};

template <class N>
void perlin(const Position<N>& p, int count, N* out) {
  const int n = p.dimensions, corners = 1 << n;
  std::uint32_t lattice[2][most_dimensions];  // of the cell's lower and upper corner
  N offset[most_dimensions], weight[most_dimensions];
  for (int d = 0; d < n; ++d) {
    const N& x = p.at[std::size_t(d)];
    const int low = floor_to_int(value_of(x));
    offset[d] = x - N(std::floor(value_of(x)));
    weight[d] = fade(offset[d]);
    lattice[0][d] = std::uint32_t(low), lattice[1][d] = std::uint32_t(low) + 1;
    if (p.periodic) {
      const long long period = std::max(floor_to_int(p.period[std::size_t(d)]), 1);
      for (auto& corner : lattice) corner[d] = std::uint32_t(((int(corner[d]) % period) + period) % period);
    }
  }
  // Values at the corners, which then are interpolated along one axis after the other.
  N values[3][1 << most_dimensions];
  for (int corner = 0; corner < corners; ++corner) {
    std::uint32_t words[most_dimensions];
    N from[most_dimensions];
    for (int d = 0; d < n; ++d) {
      const bool upper = corner >> d & 1;
      words[d] = lattice[upper][d];
      from[d] = upper ? offset[d] - N(1) : offset[d];
    }
    const std::uint32_t hash = hash_of(words, n);
    // The three components of a triple take 8 bits of the hash each.
    if (count == 1)
      values[0][corner] = along_gradient(hash, n, from);
    else
      for (int c = 0; c < 3; ++c) values[c][corner] = along_gradient(hash >> (8 * c) & 0xff, n, from);
  }
  for (int c = 0; c < count; ++c) {
    for (int d = 0; d < n; ++d)
      for (int i = 0; i < corners >> (d + 1); ++i)
        values[c][i] = (N(1) - weight[d]) * values[c][2 * i] + weight[d] * values[c][2 * i + 1];
    out[c] = N(scales[n - 1]) * values[c][0];
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

void perlin_noise(const Position<float>& p, int count, float* out) { perlin(p, count, out); }
void perlin_noise(const Position<Dual<float>>& p, int count, Dual<float>* out) { perlin(p, count, out); }

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
