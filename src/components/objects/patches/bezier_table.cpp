#include "bezier_table.h"

#include <algorithm>

namespace etendue::bezier {
namespace {

// Gauss-Legendre quadrature on [0, 1] (Abramowitz & Stegun 1964, table 25.4).
struct Node {
  double x, weight;
};
constexpr Node three[] = {{0.5 - 0.3872983346207417, 5.0 / 18}, {0.5, 8.0 / 18}, {0.5 + 0.3872983346207417, 5.0 / 18}};
constexpr Node four[] = {{0.5 - 0.4305681557970263, 0.1739274225687269},
                         {0.5 - 0.1699905217924281, 0.3260725774312731},
                         {0.5 + 0.1699905217924281, 0.3260725774312731},
                         {0.5 + 0.4305681557970263, 0.1739274225687269}};

double area_of(const Patch& patch, const Trapezoid& part, std::span<const Node> nodes) {
  double sum = 0;
  for (const Node& b : nodes)
    for (const Node& a : nodes) {
      double stretch = 0;
      const auto [s, t] = part.at(a.x, b.x, stretch);
      const Derivatives d = evaluate(patch, s, t);
      sum += a.weight * b.weight * stretch * length(cross(d.ds, d.dt));
    }
  return sum * (part.t1 - part.t0);
}

}  // namespace

AreaTable::AreaTable(const std::vector<Patch>& patches, const Region& region) : grid_(region.grid()) {
  const std::size_t n = std::size_t(grid_);
  patches_.reserve(patches.size());
  rows_.reserve(patches.size() * n);
  squares_.reserve(patches.size() * n * n);
  pdfs_.reserve(patches.size() * n * n);
  double off = 0;
  for (std::uint32_t p = 0; p < patches.size(); ++p) {
    double patch_sum = 0;
    for (int j = 0; j < grid_; ++j) {
      double row_sum = 0;
      for (int i = 0; i < grid_; ++i) {
        Trapezoid scratch;
        double area = 0, plane = 0;
        for (const Trapezoid& part : region.parts(p, i, j, scratch)) {
          const double fine = area_of(patches[p], part, four);
          off += std::abs(fine - area_of(patches[p], part, three));
          area += fine;
          plane += part.area();
        }
        row_sum += area;
        squares_.push_back(row_sum);
        pdfs_.push_back(plane > 0 ? area / plane : 0);
      }
      patch_sum += row_sum;
      rows_.push_back(patch_sum);
    }
    area_ += patch_sum;
    patches_.push_back(area_);
  }
  if (!(area_ > 0)) return;
  error_ = off / area_;
  for (double& d : pdfs_) d /= area_;
}

std::size_t AreaTable::find(const double* sums, std::size_t count, double& x) {
  const double sum = x * sums[count - 1];
  std::size_t k = std::size_t(std::upper_bound(sums, sums + count, sum) - sums);
  while (k >= count || (k > 0 && !(sums[k] > sums[k - 1]))) --k;  // reached only by rounding at the end
  const double before = k > 0 ? sums[k - 1] : 0;
  x = std::clamp((sum - before) / (sums[k] - before), 0.0, 1.0);
  return k;
}

AreaTable::Choice AreaTable::choose(Point2 u, const Region& region) const {
  const std::size_t n = std::size_t(grid_);
  double x = double(u.x), y = double(u.y);
  const std::size_t patch = find(patches_.data(), patches_.size(), x);
  const std::size_t j = find(rows_.data() + patch * n, n, y);
  const std::size_t i = find(squares_.data() + (patch * n + j) * n, n, x);
  Trapezoid scratch;
  const std::span<const Trapezoid> parts = region.parts(std::uint32_t(patch), int(i), int(j), scratch);
  const Trapezoid* part = parts.data();
  if (parts.size() > 1) {
    double sum = 0;
    for (const Trapezoid& p : parts) sum += p.area();
    double rest = y * sum;
    const Trapezoid* last = parts.data() + parts.size() - 1;
    while (part != last && rest >= part->area()) rest -= (part++)->area();
    y = std::clamp(rest / part->area(), 0.0, 1.0);
  }
  // Uniform in the trapezoid: the fraction of its area below a height h is (w0 h + (w1 - w0) h^2 / 2) / ((w0 + w1) / 2).
  const double w0 = part->right0 - part->left0, w1 = part->right1 - part->left1, below = y * (w0 + w1);
  const double root = std::sqrt(std::max(0.0, w0 * w0 + (w1 - w0) * below));
  double stretch = 0;
  const auto [s, t] = part->at(x, below > 0 ? std::min(below / (w0 + root), 1.0) : 0, stretch);
  return {std::uint32_t(patch), float(s), float(t)};
}

double AreaTable::pdf(std::uint32_t patch, float s, float t) const {
  const auto index = [&](float x) { return std::size_t(std::clamp(int(double(x) * grid_), 0, grid_ - 1)); };
  const std::size_t n = std::size_t(grid_);
  return pdfs_[(patch * n + index(t)) * n + index(s)];
}

}  // namespace etendue::bezier
