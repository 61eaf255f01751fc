#include "warp2d.h"

#include <algorithm>

namespace etendue {
namespace {

/// The t in [0, 1] up to which a function that goes linearly from a to b has the given integral. Of the two forms of the root,
/// this one stays precise where a and b are nearly equal.
float up_to_integral(float integral, float a, float b) {
  const float root = safe_sqrt(a * a + 2 * integral * (b - a)), divisor = a + root;
  return divisor > 0 ? clamp(2 * integral / divisor, 0, 1) : 0;
}
float integral_up_to(float t, float a, float b) { return t * (a + 0.5f * t * (b - a)); }

/// The last i in [0, count - 2] for which a sum that grows with i is at most `wanted`.
template <class Sum>
size_t last_at_most(size_t count, float wanted, Sum&& sum) {
  size_t low = 0, high = count - 1;
  while (high - low > 1) {
    const size_t middle = (low + high) / 2;
    (sum(middle) <= wanted ? low : high) = middle;
  }
  return low;
}

}  // namespace

std::pair<std::uint32_t, float> find_interval(const std::vector<float>& increasing, float value) {
  if (increasing.size() < 2 || !(value > increasing.front())) return {0, 0};
  const size_t last = increasing.size() - 2;
  const size_t i =
      std::min(size_t(std::upper_bound(increasing.begin(), increasing.end(), value) - increasing.begin()) - 1, last);
  return {std::uint32_t(i), clamp((value - increasing[i]) / (increasing[i + 1] - increasing[i]), 0, 1)};
}

TableBlend ParameterGrid::locate(float first, float second) const {
  const auto [i, s] = find_interval(first_, first);
  const auto [k, t] = find_interval(second_, second);
  const std::uint32_t stride = std::uint32_t(second_.size());
  TableBlend blend;
  const auto add = [&](std::uint32_t table, float weight) {
    if (!(weight > 0)) return;
    blend.table[size_t(blend.count)] = table;
    blend.weight[size_t(blend.count++)] = weight;
  };
  add(i * stride + k, (1 - s) * (1 - t));
  add(i * stride + k + 1, (1 - s) * t);
  add((i + 1) * stride + k, s * (1 - t));
  add((i + 1) * stride + k + 1, s * t);
  return blend;
}

SquareTables::Cell SquareTables::cell(Point2 p) const {
  const float x = clamp(p.x, 0, 1) * float(width_ - 1), y = clamp(p.y, 0, 1) * float(height_ - 1);
  const int column = std::min(int(x), width_ - 2), row = std::min(int(y), height_ - 2);
  return {size_t(row) * size_t(width_) + size_t(column), x - float(column), y - float(row)};
}

Warp2D::Warp2D(int width, int height, std::vector<float> values) : tables_(width, height, 1, std::move(values)) {
  const size_t w = size_t(width), h = size_t(height), count = tables_.values().size() / (w * h);
  marginal_.resize(count * h);
  conditional_.resize(count * w * h);
  std::vector<double> left(w * h), below(h);
  for (size_t table = 0; table < count; ++table) {
    float* v = &tables_.values()[table * w * h];
    const auto integrate = [&] {
      for (size_t y = 0; y < h; ++y) {
        for (size_t x = 1; x < w; ++x)
          left[y * w + x] = left[y * w + x - 1] + (double(v[y * w + x - 1]) + double(v[y * w + x])) / (2 * double(w - 1));
        if (y > 0) below[y] = below[y - 1] + (left[y * w - 1] + left[y * w + w - 1]) / (2 * double(h - 1));
      }
      return below[h - 1];
    };
    double total = integrate();
    if (!(total > 0)) {
      std::fill(v, v + w * h, 1.0f);
      total = integrate();
    }
    const double scale = 1 / total;
    for (size_t i = 0; i < w * h; ++i) {
      v[i] = float(double(v[i]) * scale);
      conditional_[table * w * h + i] = float(left[i] * scale);
    }
    for (size_t y = 0; y < h; ++y) marginal_[table * h + y] = float(below[y] * scale);
  }
}

Warp2D::Placed Warp2D::sample(Point2 u, const TableBlend& b) const {
  const size_t w = size_t(tables_.width()), h = size_t(tables_.height());
  const float columns = float(w - 1), rows = float(h - 1);

  const float y_sum = u.y * below(h - 1, b);
  const size_t row = last_at_most(h, y_sum, [&](size_t i) { return below(i, b); });
  const size_t first = row * w, second = first + w;
  const float t = up_to_integral((y_sum - below(row, b)) * rows, left(first + w - 1, b), left(second + w - 1, b));

  const auto along = [&](size_t i) { return lerp(t, left(first + i, b), left(second + i, b)); };
  const float x_sum = u.x * along(w - 1);
  const size_t column = last_at_most(w, x_sum, along);
  const float v0 = lerp(t, value(first + column, b), value(second + column, b));
  const float v1 = lerp(t, value(first + column + 1, b), value(second + column + 1, b));
  const float s = up_to_integral((x_sum - along(column)) * columns, v0, v1);
  return {{(float(column) + s) / columns, (float(row) + t) / rows}, lerp(s, v0, v1)};
}

Warp2D::Placed Warp2D::invert(Point2 p, const TableBlend& b) const {
  const size_t w = size_t(tables_.width()), h = size_t(tables_.height());
  const auto [first, s, t] = tables_.cell(p);
  const size_t second = first + w, row = first / w, line = row * w;

  const float v0 = lerp(t, value(first, b), value(second, b)), v1 = lerp(t, value(first + 1, b), value(second + 1, b));
  const float end0 = left(line + w - 1, b), end1 = left(line + 2 * w - 1, b), whole = lerp(t, end0, end1);
  const float x_sum = lerp(t, left(first, b), left(second, b)) + integral_up_to(s, v0, v1) / float(w - 1);
  const float y_sum = below(row, b) + integral_up_to(t, end0, end1) / float(h - 1);
  return {{whole > 0 ? clamp(x_sum / whole, 0, 1) : 0, clamp(y_sum / below(h - 1, b), 0, 1)}, lerp(s, v0, v1)};
}

}  // namespace etendue
