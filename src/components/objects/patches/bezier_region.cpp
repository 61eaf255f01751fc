#include "bezier_region.h"

#include <cmath>

namespace etendue::bezier {
namespace {

double s_at(const Segment& g, double t) { return g.s0 + (t - g.t0) / (g.t1 - g.t0) * (g.s1 - g.s0); }

}  // namespace

void Region::trim(std::uint32_t patch, const std::vector<Segment>& loops, bool keep_inside) {
  if (squares_.empty()) squares_.resize(whole_.size() * std::size_t(grid_) * std::size_t(grid_));
  whole_[patch] = false;
  std::vector<Segment> row;
  for (int j = 0; j < grid_; ++j) {
    const double t0 = double(j) / grid_, t1 = double(j + 1) / grid_;
    row.clear();
    for (const Segment& g : loops)
      if (g.t0 != g.t1 && std::min(g.t0, g.t1) < t1 && std::max(g.t0, g.t1) > t0) row.push_back(g);
    for (int i = 0; i < grid_; ++i) {
      Square& to = squares_[std::size_t(patch * grid_ + j) * std::size_t(grid_) + std::size_t(i)];
      to.first = std::uint32_t(parts_.size());
      cut_square(row, keep_inside, i, j);
      to.count = std::uint32_t(parts_.size()) - to.first;
    }
  }
}

// Between consecutive heights t at which segments begin, end, or cross the sides of the square, the kept region consists of
// trapezoids bounded by segments or sides (as in Žalik & Clapworthy 1999, "A universal trapezoidation algorithm for planar
// polygons").
void Region::cut_square(const std::vector<Segment>& row, bool keep_inside, int i, int j) {
  const double s0 = double(i) / grid_, s1 = double(i + 1) / grid_, t0 = double(j) / grid_, t1 = double(j + 1) / grid_;
  std::vector<double> heights{t0, t1};
  const auto add = [&](double t) {
    if (t > t0 && t < t1) heights.push_back(t);
  };
  for (const Segment& g : row) {
    if (std::max(g.s0, g.s1) < s0 || std::min(g.s0, g.s1) > s1) continue;
    add(g.t0);
    add(g.t1);
    for (const double s : {s0, s1})
      if ((g.s0 - s) * (g.s1 - s) < 0) add(g.t0 + (s - g.s0) / (g.s1 - g.s0) * (g.t1 - g.t0));
  }
  std::sort(heights.begin(), heights.end());
  struct Crossing {
    double s;
    const Segment* segment;
  };
  std::vector<Crossing> crossings;
  for (std::size_t k = 0; k + 1 < heights.size(); ++k) {
    const double low = heights[k], high = heights[k + 1], middle = (low + high) / 2;
    if (!(high > low)) continue;
    crossings.clear();
    for (const Segment& g : row)
      if ((g.t0 <= middle) != (g.t1 <= middle)) crossings.push_back({s_at(g, middle), &g});
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.s < b.s; });
    crossings.push_back({s1, nullptr});
    int winding = 0;
    Crossing last{s0, nullptr};  // where the current interval begins
    for (const Crossing& next : crossings) {
      if (next.s > s0) {
        const bool right_side = next.s >= s1;
        const Segment *left = last.s > s0 ? last.segment : nullptr, *right = right_side ? nullptr : next.segment;
        if ((winding != 0) == keep_inside) {
          const auto held = [&](const Segment* g, double t, double side) { return g ? std::clamp(s_at(*g, t), s0, s1) : side; };
          const Trapezoid part{
              low, high, held(left, low, s0), held(left, high, s0), held(right, low, s1), held(right, high, s1)};
          if (part.area() > 0) parts_.push_back(part);
        }
        if (right_side) break;
        last = next;
      }
      winding += next.segment->t1 > next.segment->t0 ? 1 : -1;
    }
  }
}

std::span<const Trapezoid> Region::parts(std::uint32_t patch, int i, int j, Trapezoid& scratch) const {
  if (!whole_[patch]) {
    const Square& q = square(patch, i, j);
    return {parts_.data() + q.first, q.count};
  }
  const double s0 = double(i) / grid_, s1 = double(i + 1) / grid_;
  scratch = {double(j) / grid_, double(j + 1) / grid_, s0, s0, s1, s1};
  return {&scratch, 1};
}

bool Region::contains(std::uint32_t patch, double s, double t) const {
  if (whole_[patch]) return true;
  const Square& q = square(patch, index(s), index(t));
  const std::span<const Trapezoid> all(parts_.data() + q.first, q.count);
  auto part = std::partition_point(all.begin(), all.end(), [&](const Trapezoid& p) { return p.t1 < t; });
  for (; part != all.end() && part->t0 <= t; ++part) {
    const double y = (t - part->t0) / (part->t1 - part->t0);
    if (s >= part->left0 + y * (part->left1 - part->left0) && s <= part->right0 + y * (part->right1 - part->right0))
      return true;
  }
  return false;
}

bool Region::touches(std::uint32_t patch, double s0, double s1, double t0, double t1) const {
  if (whole_[patch]) return true;
  for (int j = index(t0); j <= index(t1); ++j)
    for (int i = index(s0); i <= index(s1); ++i)
      if (square(patch, i, j).count > 0) return true;
  return false;
}

}  // namespace etendue::bezier
