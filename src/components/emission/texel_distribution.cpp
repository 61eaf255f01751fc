#include "texel_distribution.h"

#include <algorithm>
#include <bit>

#include "etendue/core/math.h"

namespace etendue {

// A power of two, so that the products and quotients with which a number finds its place in the guide are exact.
size_t TexelDistribution::guides_for(size_t count) { return std::bit_floor(std::max<size_t>(count / 4, 1)); }

void TexelDistribution::make_guide(const float* cumulative, size_t count, std::uint32_t* guide, size_t guides) {
  size_t i = 0;
  for (size_t k = 0; k < guides; ++k) {
    const float low = float(k) / float(guides);
    while (i + 1 < count && !(cumulative[i] > low)) ++i;
    guide[k] = std::uint32_t(i);
  }
}

void TexelDistribution::build(const std::vector<float>& weights, size_t width, const std::vector<double>& measures) {
  width_ = width;
  measures_.assign(measures.begin(), measures.end());
  const size_t height = measures.size();
  columns_.resize(width * height);
  std::vector<double> row_sums(height);
  total_ = 0;
  for (size_t y = 0; y < height; ++y) {
    double row = 0, sum = 0;
    for (size_t x = 0; x < width; ++x) row += double(weights[y * width + x]);
    for (size_t x = 0; x < width; ++x) {
      sum += double(weights[y * width + x]);
      columns_[y * width + x] = row > 0 ? float(sum / row) : float(x + 1) / float(width);
    }
    row_sums[y] = row * measures[y];
    total_ += row_sums[y];
  }
  rows_.resize(height);
  double sum = 0;
  for (size_t y = 0; y < height; ++y) {
    sum += row_sums[y];
    rows_[y] = total_ > 0 ? float(sum / total_) : float(y + 1) / float(height);
  }
  row_guide_.resize(guides_for(height));
  make_guide(rows_.data(), height, row_guide_.data(), row_guide_.size());
  const size_t guides = guides_for(width);
  column_guides_.resize(guides * height);
  for (size_t y = 0; y < height; ++y) make_guide(&columns_[y * width], width, &column_guides_[y * guides], guides);
}

/// An interval of the cumulative distribution; u becomes the uniform place in it.
size_t TexelDistribution::Guided::find(float& u) const {
  const size_t k = std::min(size_t(u * float(guides)), guides - 1);
  const size_t first = guide[k], last = k + 1 < guides ? guide[k + 1] : count - 1;
  const size_t i = std::min(size_t(std::upper_bound(cumulative + first, cumulative + last + 1, u) - cumulative), count - 1);
  const float low = i == 0 ? 0 : cumulative[i - 1], high = cumulative[i];
  u = high > low ? clamp((u - low) / (high - low), 0, one_minus_epsilon) : 0.5f;
  return i;
}

TexelDistribution::Choice TexelDistribution::choose(Point2 u) const {
  const size_t y = Guided{rows_.data(), rows_.size(), row_guide_.data(), row_guide_.size()}.find(u.y);
  const size_t guides = guides_for(width_);
  const size_t x = Guided{&columns_[y * width_], width_, &column_guides_[y * guides], guides}.find(u.x);
  return {x, y, u, density(x, y)};
}

}  // namespace etendue
