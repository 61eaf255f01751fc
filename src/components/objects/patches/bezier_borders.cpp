#include "bezier_borders.h"

#include <algorithm>
#include <utility>

namespace etendue::bezier {
namespace {

constexpr double same = 1e-7;  // relative to the size of a patch: differences up to this may come from rounding control points
                               // to float

struct Border {
  std::vector<Vector> points;
  std::vector<double> weights;  // defined up to a common factor
  std::size_t patch = 0;
  double key = 0;  // hash of the end points, independent of the direction
};

/// Appends the borders of a patch, with the patch on their left seen from the side to which S_s x S_t points.
void add_borders(const Patch& patch, std::size_t number, std::vector<Border>& borders) {
  const int m = patch.m, n = patch.n;
  const auto at = [&](int i, int j) { return patch.points[std::size_t(i + j * (m + 1))]; };
  for (int side = 0; side < 4; ++side) {
    Border b;
    b.patch = number;
    const int last = side % 2 ? n : m;
    double extent = 0;
    for (int k = 0; k <= last; ++k) {
      const Control c = side == 0 ? at(k, 0) : side == 1 ? at(m, k) : side == 2 ? at(m - k, n) : at(0, n - k);
      b.points.push_back(position(c));
      b.weights.push_back(c[3]);
      extent = std::max(extent, length(b.points.back() - b.points.front()));
    }
    if (extent <= same * patch.size) continue;
    const Vector sum = b.points.front() + b.points.back();
    b.key = sum.x + 0.7 * sum.y + 0.4 * sum.z;
    borders.push_back(std::move(b));
  }
}

enum class Match { none, alike, opposed };

bool equal(const Border& a, const Border& b, bool backwards, double tolerance) {
  const std::size_t n = a.points.size();
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = backwards ? n - 1 - i : i;
    if (length(a.points[i] - b.points[k]) > tolerance) return false;
    const double wa = a.weights[i] / a.weights[0], wb = b.weights[k] / b.weights[backwards ? n - 1 : 0];
    if (std::abs(wa - wb) > 1e-6 * wa) return false;
  }
  return true;
}

Match match(const Border& a, const Border& b, double tolerance) {
  if (a.points.size() != b.points.size()) return Match::none;
  if (equal(a, b, true, tolerance)) return Match::opposed;
  return equal(a, b, false, tolerance) ? Match::alike : Match::none;
}

/// 3 times the signed volume between a patch and a point, positive if S_s x S_t faces away from the point.
double spanned(const Patch& patch, const Vector& from) {
  constexpr int steps = 8;
  double sum = 0;
  for (int j = 0; j < steps; ++j)
    for (int i = 0; i < steps; ++i) {
      const Derivatives d = evaluate(patch, (i + 0.5) / steps, (j + 0.5) / steps);
      sum += dot(d.position - from, cross(d.ds, d.dt));
    }
  return sum / (steps * steps);
}

}  // namespace

bool close(std::vector<Patch>& patches) {
  std::vector<Border> borders;
  double size = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    add_borders(patches[i], i, borders);
    size = std::max(size, patches[i].size);
  }
  if (borders.empty()) return false;
  std::sort(borders.begin(), borders.end(), [](const Border& a, const Border& b) { return a.key < b.key; });
  struct Neighbour {
    std::size_t patch;
    bool opposed;
  };
  std::vector<std::vector<Neighbour>> neighbours(patches.size());
  std::vector<int> partners(borders.size());
  const double tolerance = same * size;
  for (std::size_t i = 0; i < borders.size(); ++i)
    for (std::size_t k = i + 1; k < borders.size() && borders[k].key - borders[i].key <= 5 * tolerance; ++k) {
      const Match m = match(borders[i], borders[k], tolerance);
      if (m == Match::none) continue;
      ++partners[i];
      ++partners[k];
      neighbours[borders[i].patch].push_back({borders[k].patch, m == Match::opposed});
      neighbours[borders[k].patch].push_back({borders[i].patch, m == Match::opposed});
    }
  if (!std::all_of(partners.begin(), partners.end(), [](int n) { return n == 1; })) return false;
  std::vector<bool> flipped(patches.size()), seen(patches.size());
  for (std::size_t start = 0; start < patches.size(); ++start) {
    if (seen[start]) continue;
    std::vector<std::size_t> part{start};  // a connected component
    seen[start] = true;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (const Neighbour& next : neighbours[part[i]]) {
        const bool turn = next.opposed ? flipped[part[i]] : !flipped[part[i]];
        if (!seen[next.patch]) {
          seen[next.patch] = true;
          flipped[next.patch] = turn;
          part.push_back(next.patch);
        } else if (flipped[next.patch] != turn) {
          return false;  // not orientable, as a Möbius strip or a Klein bottle
        }
      }
    double volume = 0;
    const Vector from = position(patches[start].points[0]);
    for (const std::size_t i : part) volume += (flipped[i] ? -1 : 1) * spanned(patches[i], from);
    if (volume < 0)
      for (const std::size_t i : part) flipped[i] = !flipped[i];
  }
  for (std::size_t i = 0; i < patches.size(); ++i) patches[i].flipped = flipped[i];
  return true;
}

}  // namespace etendue::bezier
