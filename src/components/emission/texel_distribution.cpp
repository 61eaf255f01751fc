#include "texel_distribution.h"

#include <algorithm>
#include <limits>

#include "etendue/core/math.h"

namespace etendue {

TexelDistribution::Searched::Node::Node() { std::fill_n(cumulative, fanout, std::numeric_limits<float>::infinity()); }

TexelDistribution::Searched::Searched(size_t lists, size_t count)
    : count_(count), lowest_nodes_((count + fanout - 1) / fanout) {
  for (size_t nodes = lowest_nodes_; nodes > 1;) {
    nodes = (nodes + fanout - 1) / fanout;
    levels_.insert(levels_.begin(), nodes);
    upper_nodes_ += nodes;
  }
  upper_.resize(lists * upper_nodes_);
  lowest_.resize(lists * lowest_nodes_);
}

void TexelDistribution::Searched::set(size_t list, size_t i, float cumulative) {
  lowest_[list * lowest_nodes_ + i / fanout].cumulative[i % fanout] = cumulative;
  size_t behind = (list + 1) * upper_nodes_;  // the end of the current level's nodes
  for (size_t level = levels_.size(); level-- > 0;) {
    i /= fanout;
    upper_[behind - levels_[level] + i / fanout].cumulative[i % fanout] =
        cumulative;  // ends as the last entry of the node below
    behind -= levels_[level];
  }
}

size_t TexelDistribution::Searched::find(size_t list, float& u) const {
  const auto next = [&](const Node& node) {
    int below = 0;
    for (size_t i = 0; i < fanout; ++i) below += node.cumulative[i] <= u;
    return size_t(below);
  };
  const Node* level = upper_.data() + list * upper_nodes_;
  size_t place = 0;  // index of the node in the current level
  for (size_t k = 0; k < levels_.size(); ++k) {
    const size_t below = k + 1 < levels_.size() ? levels_[k + 1] : lowest_nodes_;
    // By rounding the CDF may end below 1, and u may be no less than this end: then the last entry is taken.
    place = std::min(place * fanout + next(level[place]), below - 1);
    level += levels_[k];
  }
  const size_t i = std::min(place * fanout + next(lowest_[list * lowest_nodes_ + place]), count_ - 1);
  const float low = i == 0 ? 0 : at(list, i - 1), high = at(list, i);
  u = high > low ? clamp((u - low) / (high - low), 0, one_minus_epsilon) : 0.5f;
  return i;
}

void TexelDistribution::build(const std::vector<float>& weights, size_t width, const std::vector<double>& measures) {
  measures_.assign(measures.begin(), measures.end());
  const size_t height = measures.size();
  columns_ = Searched(height, width);
  rows_ = Searched(1, height);
  std::vector<double> row_sums(height);
  total_ = 0;
  for (size_t y = 0; y < height; ++y) {
    double row = 0, sum = 0;
    for (size_t x = 0; x < width; ++x) row += double(weights[y * width + x]);
    for (size_t x = 0; x < width; ++x) {
      sum += double(weights[y * width + x]);
      columns_.set(y, x, row > 0 ? float(sum / row) : float(x + 1) / float(width));
    }
    row_sums[y] = row * measures[y];
    total_ += row_sums[y];
  }
  double sum = 0;
  for (size_t y = 0; y < height; ++y) {
    sum += row_sums[y];
    rows_.set(0, y, total_ > 0 ? float(sum / total_) : float(y + 1) / float(height));
  }
}

TexelDistribution::Choice TexelDistribution::choose(Point2 u) const {
  const size_t y = rows_.find(0, u.y), x = columns_.find(y, u.x);
  return {x, y, u, pdf(x, y)};
}

}  // namespace etendue
