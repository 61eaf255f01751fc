// Pmj02Sampler: progressive multi-jittered (0,2)-sequences with blue noise, from tables that are computed at the first use.

#include <array>
#include <bit>

#include "hashed_permutation.h"
#include "owen_scrambling.h"

namespace etendue {
namespace {

// Christensen, Kensler & Kilpatrick 2018 ("Progressive multi-jittered sample sequences", Computer Graphics Forum 37(4)): the
// first 2^m points have one point in each elementary interval of area 2^-m, as those of SobolSampler, but are otherwise random,
// and each new point is chosen among several candidates as the one that is farthest from all points before (best candidate).
// Candidates are found as in Pharr 2019 ("Efficient generation of points that satisfy two-dimensional elementary intervals",
// Journal of Computer Graphics Techniques 8(1)): digit by digit, leaving out those whose intervals have a point.
//
// Only the first 2^m points are promised to be a net, so the points 2^m ... 2^(m+1) - 1 may come in any order. Pairs of
// dimensions are made independent by a table, a change of its points (below) and such orders of their own.

using Fixed = std::uint32_t;  ///< a coordinate in [0, 1), times 2^32
struct FixedPoint {
  Fixed x, y;
};

constexpr std::uint32_t table_bits = 12, table_size = 1u << table_bits, table_count = 16;
using Table = std::array<FixedPoint, table_size>;

/// Which elementary intervals of area 2^-m have a point.
class Intervals {
 public:
  void begin(std::uint32_t m) {
    m_ = m;
    taken_.assign(size_t(m + 1) << m, 0);
  }
  void add(FixedPoint p) {
    for (std::uint32_t digits = 0; digits <= m_; ++digits) taken_[place(digits, p.x, p.y)] = 1;
  }
  /// Appends to `found` the beginnings of the first coordinate (of the second, if `swapped`), m digits long, whose intervals of
  /// points with the other coordinate v are free. Their first `digits` digits are those of u; v is known as far as is needed.
  void find_free(Fixed u, Fixed v, std::uint32_t digits, bool swapped, std::vector<Fixed>& found) const {
    if (digits == m_) return found.push_back(u);
    for (const Fixed digit : {0u, 1u}) {
      const Fixed next = u | (digit << (31 - digits));
      const bool taken = swapped ? taken_[place(m_ - digits - 1, v, next)] : taken_[place(digits + 1, next, v)];
      if (!taken) find_free(next, v, digits + 1, swapped, found);
    }
  }

 private:
  static std::uint32_t first(Fixed u, std::uint32_t digits) { return digits ? u >> (32 - digits) : 0; }
  /// Of the interval with so many digits of x, and m less that of y.
  size_t place(std::uint32_t digits, Fixed x, Fixed y) const {
    return (size_t(digits) << m_) + (size_t(first(x, digits)) << (m_ - digits)) + first(y, m_ - digits);
  }
  std::uint32_t m_ = 0;
  std::vector<std::uint8_t> taken_;
};

class TableMaker {
 public:
  explicit TableMaker(std::uint64_t seed) : state_(seed) {}

  Table make() {
    table_[0] = {random(), random()};
    // With n = 4^k points, each cell of a grid of 2^k by 2^k has one. The next n points lie in the quarters of the cells that
    // are diagonally opposite to the first ones, the n after them in one of the two quarters that remain, and the last n in the
    // other.
    for (std::uint32_t k = 0, n = 1; n < table_size; ++k, n *= 4) {
      const Fixed half = 1u << (31 - k), known = ~(half - 1);
      grid_ = 1u << (k + 1);
      near_.assign(size_t(grid_) * grid_, no_point);
      for (std::uint32_t i = 0; i < n; ++i) near_[cell_of(table_[i])] = i;
      const auto quarter = [&](std::uint32_t i, bool flip_x, bool flip_y) {
        const FixedPoint p = table_[i];
        return FixedPoint{(p.x ^ (flip_x ? half : 0)) & known, (p.y ^ (flip_y ? half : 0)) & known};
      };
      begin_net(2 * k + 1, n);
      for (std::uint32_t i = 0; i < n; ++i) add(n + i, quarter(i, true, true), k + 1, 2 * k + 1);
      begin_net(2 * k + 2, 2 * n);
      std::vector<bool> first_along_x(n);
      for (std::uint32_t i = 0; i < n; ++i) first_along_x[i] = random() & 1;
      for (std::uint32_t i = 0; i < n; ++i) add(2 * n + i, quarter(i, first_along_x[i], !first_along_x[i]), k + 1, 2 * k + 2);
      for (std::uint32_t i = 0; i < n; ++i) add(3 * n + i, quarter(i, !first_along_x[i], first_along_x[i]), k + 1, 2 * k + 2);
    }
    return table_;
  }

 private:
  static constexpr std::uint32_t no_point = ~0u;

  std::uint32_t random() {
    state_ += 0x9e3779b97f4a7c15ull;
    return std::uint32_t(mix_bits(state_) >> 32);
  }

  /// The points so far belong to a net of 2^m points.
  void begin_net(std::uint32_t m, std::uint32_t count) {
    intervals_.begin(m);
    for (std::uint32_t i = 0; i < count; ++i) intervals_.add(table_[i]);
  }

  size_t cell_of(FixedPoint p) const {
    const auto along = [&](Fixed u) { return size_t((std::uint64_t(u) * grid_) >> 32); };
    return along(p.y) * grid_ + along(p.x);
  }

  /// Adds point i of a net of 2^m points, whose coordinates begin with the `digits` digits of a corner.
  void add(std::uint32_t i, FixedPoint corner, std::uint32_t digits, std::uint32_t m) {
    xs_.clear();
    ys_.clear();
    intervals_.find_free(corner.x, corner.y, digits, false, xs_);
    intervals_.find_free(corner.y, corner.x, digits, true, ys_);
    constexpr int candidates = 20;
    FixedPoint best{};
    double farthest = -1;
    for (int c = 0; c < candidates; ++c) {
      const Fixed within = (1u << (32 - m)) - 1;
      const FixedPoint p{xs_[random() % xs_.size()] | (random() & within), ys_[random() % ys_.size()] | (random() & within)};
      if (const double d = squared_distance(p); d > farthest) {
        farthest = d;
        best = p;
      }
    }
    table_[i] = best;
    intervals_.add(best);
    near_[cell_of(best)] = i;
  }

  /// To the nearest point within two cells of the grid, on the torus.
  double squared_distance(FixedPoint p) const {
    double nearest = 4;
    const size_t cell = cell_of(p);
    const auto column = int(cell % grid_), row = int(cell / grid_), size = int(grid_);
    for (int dy = -2; dy <= 2; ++dy)
      for (int dx = -2; dx <= 2; ++dx) {
        const auto y = size_t((row + dy + 2 * size) % size), x = size_t((column + dx + 2 * size) % size);
        const std::uint32_t other = near_[y * grid_ + x];
        if (other == no_point) continue;
        const double a = double(std::int32_t(table_[other].x - p.x)) * 0x1p-32;
        const double b = double(std::int32_t(table_[other].y - p.y)) * 0x1p-32;
        nearest = std::min(nearest, a * a + b * b);
      }
    return nearest;
  }

  std::uint64_t state_;
  Table table_{};
  Intervals intervals_;
  std::uint32_t grid_ = 1;
  std::vector<std::uint32_t> near_;  ///< the point in each cell of the grid
  std::vector<Fixed> xs_, ys_;
};

const std::vector<Table>& tables() {
  static const std::vector<Table> made = [] {
    std::vector<Table> all;
    for (std::uint64_t seed = 1; all.size() < table_count; ++seed) all.push_back(TableMaker(seed).make());
    return all;
  }();
  return made;
}

// A table has only so many different points. To make each number uniform, every pair of dimensions of every walk changes its
// points at random, in one of two ways:
// - a shift of the unit square as a torus (Cranley & Patterson 1976): distances stay, but strata at the border are cut, which
//   costs convergence for smooth integrands: error n^-3/4 instead of n^-3/2;
// - a random exclusive or of the digits (Kollig & Keller 2002): the points stay a (0,m,2)-net, but not their distances.
// Samples beyond a table's are further tables, each with an order and a change of its own.
class Pmj02Sampler final : public Sampler {
  bool blue_noise = false;

 public:
  static void describe(Description<Pmj02Sampler>& d) {
    d.summary(
         "Progressive multi-jittered points: as well spread over pairs of dimensions as SobolSampler's, and no two points "
         "close "
         "together; best with a power of two of samples, up to 4096.",
         "Christensen, Kensler & Kilpatrick 2018, Progressive multi-jittered sample sequences; Pharr 2019, Efficient "
         "generation "
         "of points that satisfy two-dimensional elementary intervals")
        .member<&Pmj02Sampler::blue_noise>(
            "blue_noise", "",
            "keeps the points apart, by shifts of them in random directions; otherwise their "
            "digits are random, which keeps the strata, and converges faster where the integrand "
            "is smooth");
  }

  void prepare() override { tables_ = tables().data(); }

  float number(SampleKey key, std::uint32_t dimension) const override { return pair(key, dimension).x; }

  Point2 pair(SampleKey key, std::uint32_t dimension) const override {
    const std::uint64_t h = mix_bits(hash(key, dimension) + (key.sample >> table_bits)), g = mix_bits(h);
    const std::uint32_t i = key.sample % table_size, octave = std::bit_floor(i);
    const FixedPoint p = tables_[h >> 60][i < 2 ? i : octave + permuted(i - octave, octave, h)];
    const auto x = std::uint32_t(g >> 32), y = std::uint32_t(g);
    if (blue_noise) return {to_unit_float(p.x + x), to_unit_float(p.y + y)};
    return {to_unit_float(p.x ^ x), to_unit_float(p.y ^ y)};
  }

 private:
  static_assert(table_count == 16);  // four bits of a hash choose
  const Table* tables_ = nullptr;
};

const Register<Pmj02Sampler> registered;

}  // namespace
}  // namespace etendue
