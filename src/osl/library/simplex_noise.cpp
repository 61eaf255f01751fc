// Simplex noise in one to four dimensions.
//
// Space is skewed so that its simplices become parts of cubes. Each of the n + 1 corners of the simplex around the point adds
// (1/2 - r^2)^4 times the inner product of its gradient with the offset from it, where r is the distance (1 - r^2 in one
// dimension). After Gustavson's public domain sdnoise1234 (2011), with the hashed gradients and the factors of the reference
// implementation.

#include <algorithm>

#include "lattice_hash.h"
#include "noise.h"

namespace etendue::osl {

namespace {

std::uint32_t scramble(std::uint32_t a, std::uint32_t b, std::uint32_t c) { return jenkins_final(a, b, c ^ 0xdeadbeef); }

constexpr float gradients2[8][2] = {{-1, -1}, {1, 0}, {-1, 0}, {1, 1}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}};

// The middles of a cube's twelve edges, and four again.
constexpr float gradients3[16][3] = {{1, 0, 1},   {0, 1, 1},   {-1, 0, 1}, {0, -1, 1}, {1, 0, -1}, {0, 1, -1},
                                     {-1, 0, -1}, {0, -1, -1}, {1, -1, 0}, {1, 1, 0},  {-1, 1, 0}, {-1, -1, 0},
                                     {1, 0, 1},   {-1, 0, 1},  {0, 1, -1}, {0, -1, -1}};

/// The i-th of the middles of a tesseract's 32 edges. In each group of eight one coordinate is zero (the first, second, third,
/// fourth), the bits of i, 1 meaning negative, are the signs of the others.
void tesseract_edge(std::uint32_t i, float* g) {
  const std::uint32_t zero = i >> 3;
  int bit = 2;
  for (std::uint32_t d = 0; d < 4; ++d) g[d] = d == zero ? 0 : (i >> bit-- & 1 ? -1.0f : 1.0f);
}

void gradient(const std::uint32_t* corner, int n, std::uint32_t seed, float* g) {
  switch (n) {
    case 1: {
      const std::uint32_t h = scramble(corner[0], seed, 0);
      g[0] = (h & 8 ? -1.0f : 1.0f) * (1 + float(h & 7));
      break;
    }
    case 2: std::copy_n(gradients2[scramble(corner[0], corner[1], seed) & 7], 2, g); break;
    case 3: std::copy_n(gradients3[scramble(corner[0], corner[1], scramble(corner[2], seed, 0)) & 15], 3, g); break;
    default: tesseract_edge(scramble(corner[0], corner[1], scramble(corner[2], corner[3], seed)) & 31, g);
  }
}

// Skew to cubes: F = (sqrt(n + 1) - 1) / n, and back: G = (1 - 1 / sqrt(n + 1)) / n. In one dimension there is no skew.
constexpr float skews[most_dimensions] = {0, 0.366025403f, 0.333333333f, 0.309016994f};
constexpr float unskews[most_dimensions] = {0, 0.211324865f, 0.166666667f, 0.138196601f};
constexpr float scales[most_dimensions] = {0.36f, 64, 68, 54};

/// The rank of each coordinate among the n, the largest has n - 1. Of equal ones, the comparisons of the reference
/// implementation decide: in three dimensions the first, in two and four the last is the larger.
void ranks(const float* x, int n, int* rank) {
  std::fill_n(rank, n, 0);
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j) {
      const bool first = n == 3 ? x[i] >= x[j] : x[i] > x[j];
      ++rank[first ? i : j];
    }
}

/// The noise at x, and its gradient if `slope` is not null.
float simplex(const float* x, int n, std::uint32_t seed, float* slope) {
  float sum = 0;
  for (int d = 0; d < n; ++d) sum += x[d];
  const float skew = sum * skews[n - 1], back = unskews[n - 1];
  int cell[most_dimensions];
  unsigned cell_sum = 0;  // it may wrap around far outside
  for (int d = 0; d < n; ++d) cell[d] = floor_to_int(x[d] + skew), cell_sum += unsigned(cell[d]);
  const float unskew = float(int(cell_sum)) * back;
  float first[most_dimensions];  // the offset from the cell's lowest corner
  for (int d = 0; d < n; ++d) first[d] = x[d] - (float(cell[d]) - unskew);
  int rank[most_dimensions];
  ranks(first, n, rank);

  float noise = 0, by[most_dimensions] = {};
  for (int k = 0; k <= n; ++k) {
    // Corner k is reached by steps along the k axes of highest rank.
    std::uint32_t corner[most_dimensions];
    float offset[most_dimensions], falloff = n == 1 ? 1 : 0.5f;
    for (int d = 0; d < n; ++d) {
      const int step = rank[d] >= n - k;
      corner[d] = std::uint32_t(cell[d]) + std::uint32_t(step);
      offset[d] = first[d] - float(step) + float(k) * back;
      falloff -= offset[d] * offset[d];
    }
    if (falloff < 0) continue;
    float g[most_dimensions], along = 0;
    gradient(corner, n, seed, g);
    for (int d = 0; d < n; ++d) along += g[d] * offset[d];
    const float square = falloff * falloff, fourth = square * square;
    noise += fourth * along;
    if (slope)
      for (int d = 0; d < n; ++d) by[d] += fourth * g[d] - 8 * square * falloff * along * offset[d];
  }
  if (slope)
    for (int d = 0; d < n; ++d) slope[d] = scales[n - 1] * by[d];
  return scales[n - 1] * noise;
}

}  // namespace

void simplex_noise(const Position<float>& p, int count, float* out) {
  for (int c = 0; c < count; ++c) out[c] = simplex(p.at.data(), p.dimensions, std::uint32_t(c), nullptr);
}

void simplex_noise(const Position<Dual<float>>& p, int count, Dual<float>* out) {
  float x[most_dimensions], slope[most_dimensions];
  for (int d = 0; d < p.dimensions; ++d) x[d] = p.at[std::size_t(d)].value;
  for (int c = 0; c < count; ++c) {
    out[c] = Dual<float>(simplex(x, p.dimensions, std::uint32_t(c), slope));
    for (int d = 0; d < p.dimensions; ++d) {
      out[c].dx += slope[d] * p.at[std::size_t(d)].dx;
      out[c].dy += slope[d] * p.at[std::size_t(d)].dy;
    }
  }
}

}  // namespace etendue::osl
