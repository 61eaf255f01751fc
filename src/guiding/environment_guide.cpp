#include "etendue/guiding/environment_guide.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "etendue/core/math.h"

namespace etendue {
namespace {

constexpr int dimensions = 6;
using Coordinates = std::array<float, dimensions>;

/// The dimension in which points are spread furthest, by their variance.
std::uint32_t widest(std::span<const std::uint32_t> some, const std::vector<Coordinates>& at) {
  std::uint32_t best = 0;
  double most = -1;
  for (std::uint32_t d = 0; d < dimensions; ++d) {
    double sum = 0, squares = 0;
    for (const std::uint32_t i : some) {
      const double x = double(at[i][d]) - double(at[some.front()][d]);
      sum += x;
      squares += x * x;
    }
    const double variance = squares - sum * sum / double(some.size());
    if (variance > most) {
      most = variance;
      best = d;
    }
  }
  return best;
}

/// A value that divides points as evenly as it can in a dimension. Many coordinates are equal, as walls are flat: it lies
/// half-way between two different ones.
float halving(std::span<const std::uint32_t> some, const std::vector<Coordinates>& at, std::uint32_t dimension) {
  std::vector<float> x;
  for (const std::uint32_t i : some) x.push_back(at[i][dimension]);
  std::ranges::sort(x);
  const auto middle = x.begin() + std::ptrdiff_t(x.size() / 2);
  const auto from = std::lower_bound(x.begin(), middle, *middle), to = std::upper_bound(middle, x.end(), *middle);
  const bool below = to == x.end() || (from != x.begin() && middle - from < to - middle);
  const auto first = below ? from : to;  // of the upper half
  return first == x.begin() ? infinity : first[-1] + (*first - first[-1]) / 2;
}

using Sums = std::array<std::uint8_t, EnvironmentGuide::side>;

/// The probability of an entry, in parts of 256.
int share(const Sums& sums, int i) { return (i + 1 < EnvironmentGuide::side ? sums[size_t(i) + 1] : 256) - sums[size_t(i)]; }

/// The entry that contains u, and the position within it, uniform in [0, 1).
int find(const Sums& sums, float& u) {
  const auto part = std::uint8_t(256 * u);
  std::uint8_t up_to = 0;
  for (const std::uint8_t sum : sums) up_to = std::uint8_t(up_to + (sum <= part));  // one instruction for all
  const int i = up_to - 1;
  u = std::min((256 * u - float(sums[size_t(i)])) / float(share(sums, i)), one_minus_epsilon);
  return i;
}

/// Rounds probabilities: each entry has one part of 256, and its share of the others.
Sums rounded(const std::array<double, EnvironmentGuide::side>& weights) {
  constexpr int side = EnvironmentGuide::side;
  const double whole = std::accumulate(weights.begin(), weights.end(), 0.0);
  Sums sums;
  double below = 0;
  for (int i = 0; i < side; ++i) {
    const double before = whole > 0 ? below / whole : double(i) / side;
    sums[size_t(i)] = std::uint8_t(i + int(std::lround(std::min(before, 1.0) * (256 - side))));
    below += weights[size_t(i)];
  }
  return sums;
}

constexpr float evenly = 0.125f;  // d

/// R_t of a tile whose learned probability is so many parts of 256^2.
float mixed(int parts) { return evenly + (1 - evenly) * float(parts) / EnvironmentGuide::tiles; }

/// A place's coordinate as a tile's, with the position within the tile.
int tile_of(float u) { return std::min(int(u * EnvironmentGuide::side), EnvironmentGuide::side - 1); }

}  // namespace

void EnvironmentGuide::divide(const std::vector<Place>& places, int each, int deepest) {
  depth_ = 0;
  while (depth_ < deepest && (places.size() >> (depth_ + 1)) >= size_t(each)) ++depth_;
  nodes_.assign(size_t(1) << depth_, {infinity, 0});
  tables_.assign(size_t(1) << depth_, {});

  // A unit of normals is as long as places are apart, by the median: a few far away count for nothing.
  std::vector<float> spread;
  for (int d = 0; d < 3 && !places.empty(); ++d) {
    std::vector<float> x;
    for (const Place& p : places) x.push_back(d == 0 ? p.position.x : d == 1 ? p.position.y : p.position.z);
    const auto quartile = [&](size_t k) {
      std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(x.size() * k / 4), x.end());
      return x[x.size() * k / 4];
    };
    const float low = quartile(1);
    spread.push_back(quartile(3) - low);
  }
  stretch_ = spread.empty() ? 1 : *std::max_element(spread.begin(), spread.end()) / 2;

  std::vector<Coordinates> at;
  for (const auto& [p, n] : places) at.push_back({p.x, p.y, p.z, stretch_ * n.x, stretch_ * n.y, stretch_ * n.z});
  std::vector<std::uint32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto divide = [&](const auto& self, std::uint32_t node, std::span<std::uint32_t> some, int levels) -> void {
    if (levels == 0 || some.empty()) return;
    const std::uint32_t d = widest(some, at);
    const float border = halving(some, at, d);
    nodes_[node] = {border, d};
    const auto right = std::partition(some.begin(), some.end(), [&](std::uint32_t i) { return !(at[i][d] > border); });
    self(self, 2 * node, std::span(some.begin(), right), levels - 1);
    self(self, 2 * node + 1, std::span(right, some.end()), levels - 1);
  };
  divide(divide, 1, order, depth_);
  for (std::uint32_t r = 0; r < regions(); ++r) learn(r, {});
}

void EnvironmentGuide::learn(std::uint32_t region, const Squares& squares) {
  Table& table = tables_[region];
  std::array<double, side> rows{};
  for (size_t row = 0; row < side; ++row) {
    std::array<double, side> columns{};
    for (size_t column = 0; column < side; ++column) {
      columns[column] = std::sqrt(double(squares[row * side + column]));
      rows[row] += columns[column];
    }
    table.columns[row] = rounded(columns);
  }
  table.rows = rounded(rows);
}

EnvironmentGuide::Guided EnvironmentGuide::sample(std::uint32_t region, Point2 r) const {
  if (r.x < evenly) {
    r.x = std::min(r.x / evenly, one_minus_epsilon);
    return {r, ratio(region, r)};
  }
  r.x = std::min((r.x - evenly) / (1 - evenly), one_minus_epsilon);
  const Table& table = tables_[region];
  const int row = find(table.rows, r.y), column = find(table.columns[size_t(row)], r.x);
  return {{std::min((float(column) + r.x) / side, one_minus_epsilon), std::min((float(row) + r.y) / side, one_minus_epsilon)},
          mixed(share(table.rows, row) * share(table.columns[size_t(row)], column))};
}

float EnvironmentGuide::ratio(std::uint32_t region, Point2 place) const {
  const Table& table = tables_[region];
  const int row = tile_of(place.y);
  return mixed(share(table.rows, row) * share(table.columns[size_t(row)], tile_of(place.x)));
}

}  // namespace etendue
