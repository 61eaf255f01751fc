// Tabulated pdfs over directions.

#include "direction_table.h"

namespace etendue {
namespace {

constexpr double degree = 3.14159265358979323846 / 180;

}  // namespace

std::vector<double> subdivide(const std::vector<double>& borders, double longest) {
  std::vector<double> all;
  for (size_t i = 0; i + 1 < borders.size(); ++i) {
    const double step = borders[i + 1] - borders[i];
    const int parts = std::max(1, int(std::ceil(step / longest - 1e-9)));
    for (int k = 0; k < parts; ++k) all.push_back(borders[i] + step * k / parts);
  }
  if (!borders.empty()) all.push_back(borders.back());
  return all;
}

size_t choose_interval(const float* cumulative, size_t count, float& u) {
  const size_t i = std::min(size_t(std::upper_bound(cumulative, cumulative + count, u) - cumulative), count - 1);
  const float low = i == 0 ? 0 : cumulative[i - 1], high = cumulative[i];
  u = high > low ? clamp((u - low) / (high - low), 0, one_minus_epsilon) : 0.5f;
  return i;
}

void DirectionTable::build(const std::vector<double>& polar, const std::vector<double>& azimuth,
                           const std::function<double(size_t, size_t)>& importance) {
  const size_t rows = polar.size() - 1, count = azimuth.size() - 1;
  total_ = 0;
  first_ = float(azimuth.front() * degree);
  height_.clear();
  azimuth_.clear();
  for (const double a : polar) height_.push_back(float(2 * std::pow(std::sin(a * degree / 2), 2)));
  for (const double a : azimuth) azimuth_.push_back(float((a - azimuth.front()) * degree));
  pdfs_.assign(rows * count, 0);
  sums_.assign(rows * count, 1);
  row_sums_.assign(rows, 1);

  std::vector<double> row_totals(rows);
  for (size_t row = 0; row < rows; ++row) {
    // Computed from the borders as stored, in float, so that the pdf is exactly that of the samples.
    const double band = double(height_[row + 1]) - double(height_[row]);
    double sum = 0;
    std::vector<double> running(count);
    for (size_t column = 0; column < count; ++column) {
      const double value = std::max(importance(row, column), 0.0);
      pdfs_[row * count + column] = float(value);
      sum += value * band * (double(azimuth_[column + 1]) - double(azimuth_[column]));
      running[column] = sum;
    }
    for (size_t column = 0; column < count && sum > 0; ++column) sums_[row * count + column] = float(running[column] / sum);
    row_totals[row] = sum;
    total_ += sum;
  }
  if (!(total_ > 0)) return;
  double sum = 0;
  for (size_t row = 0; row < rows; ++row) row_sums_[row] = float((sum += row_totals[row]) / total_);
  for (float& d : pdfs_) d = float(double(d) / total_);
}

DirectionSample DirectionTable::sample(Point2 u) const {
  if (empty()) return {{0, 0, 1}, 0};
  const size_t row = choose_interval(row_sums_.data(), row_sums_.size(), u.x);
  const size_t column = choose_interval(sums_.data() + row * columns(), columns(), u.y);
  const float h = lerp(u.x, height_[row], height_[row + 1]), phi = first_ + lerp(u.y, azimuth_[column], azimuth_[column + 1]);
  const float r = safe_sqrt(h * (2 - h));
  const Vector3 local{r * std::cos(phi), r * std::sin(phi), 1 - h};
  return {local, pdf(local)};
}

size_t DirectionTable::cell(const std::vector<float>& borders, float x) {
  const size_t i = size_t(std::upper_bound(borders.begin(), borders.end(), x) - borders.begin());
  return std::clamp<size_t>(i, 1, borders.size() - 1) - 1;
}

float DirectionTable::longitude(const Vector3& local) const {
  const float phi = std::atan2(local.y, local.x) - first_;
  return phi - 2 * pi * std::floor(phi / (2 * pi));
}

float DirectionTable::pdf(const Vector3& local) const {
  if (empty()) return 0;
  const float h = polar_height(local), phi = longitude(local);
  if (h < height_.front() || h > height_.back() || phi > azimuth_.back()) return 0;
  return pdfs_[cell(height_, h) * columns() + cell(azimuth_, phi)];
}

Point2 DirectionTable::place(const Vector3& local) const {
  const auto within = [](const std::vector<float>& borders, size_t i, float x, const float* sums) {
    const float low = i == 0 ? 0 : sums[i - 1];
    const float t = clamp((x - borders[i]) / (borders[i + 1] - borders[i]), 0, 1);
    return std::min(lerp(t, low, sums[i]), one_minus_epsilon);
  };
  const float h = polar_height(local), phi = longitude(local);
  const size_t row = cell(height_, h);
  return {within(height_, row, h, row_sums_.data()),
          within(azimuth_, cell(azimuth_, phi), phi, sums_.data() + row * columns())};
}

}  // namespace etendue
