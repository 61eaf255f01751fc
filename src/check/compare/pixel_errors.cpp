#include "pixel_errors.h"

#include <algorithm>
#include <cmath>

namespace etendue::comparing {

std::vector<double> relative_weights(std::span<const double> reference) {
  double sum = 0;
  for (const double r : reference) sum += r;
  const double mean = sum / double(std::max<size_t>(reference.size(), 1)), floor = 1e-2 * mean * mean;
  std::vector<double> weights;
  weights.reserve(reference.size());
  for (const double r : reference) weights.push_back(r != 0 || floor > 0 ? 1 / (r * r + floor) : 0);
  return weights;
}

double relative_square_error(std::span<const float> picture, const Reference& reference, std::span<const double> weights) {
  double sum = 0;
  for (size_t i = 0; i < picture.size(); ++i) {
    const double d = double(picture[i]) - reference.mean[i];
    sum += weights[i] * (d * d - reference.variance_at(i));
  }
  return sum / double(picture.size());
}

double symmetric_error(std::span<const float> picture, std::span<const double> reference) {
  double sum = 0;
  for (size_t i = 0; i < picture.size(); ++i) {
    const double x = double(picture[i]), size = std::abs(x) + std::abs(reference[i]);
    if (size > 0) sum += 2 * std::abs(x - reference[i]) / size;
  }
  return sum / double(picture.size());
}

void RunSums::add(std::span<const float> picture) {
  for (size_t i = 0; i < sum_.size(); ++i) {
    const double x = double(picture[i]);
    sum_[i] += x;
    squares_[i] += x * x;
  }
  runs_ += 1;
}

double RunSums::variance(size_t i) const {
  return runs_ > 1 ? std::max(0.0, squares_[i] - sum_[i] * sum_[i] / runs_) / (runs_ - 1) : 0;
}

double RunSums::relative_variance(std::span<const double> weights) const {
  double sum = 0;
  for (size_t i = 0; i < sum_.size(); ++i) sum += weights[i] * variance(i);
  return sum / double(sum_.size());
}

namespace {

/// ((sum d)^2 - sum d^2) / (n (n - 1)), the mean of the products of two different ones of n numbers.
double product_of_two(double sum, double squares, double n) { return (sum * sum - squares) / (n * (n - 1)); }

}  // namespace

double RunSums::relative_square_bias(const Reference& reference, std::span<const double> weights) const {
  double total = 0;
  for (size_t i = 0; i < sum_.size(); ++i) {
    const double r = reference.mean[i], sum = sum_[i] - runs_ * r, squares = squares_[i] - 2 * r * sum_[i] + runs_ * r * r;
    total += weights[i] * (product_of_two(sum, squares, runs_) - reference.variance_at(i));
  }
  return total / double(sum_.size());
}

double RunSums::relative_square_bias_without(std::span<const float> run, const Reference& reference,
                                             std::span<const double> weights) const {
  double total = 0;
  for (size_t i = 0; i < sum_.size(); ++i) {
    const double r = reference.mean[i], d = double(run[i]) - r;
    const double sum = sum_[i] - runs_ * r - d, squares = squares_[i] - 2 * r * sum_[i] + runs_ * r * r - d * d;
    total += weights[i] * (product_of_two(sum, squares, runs_ - 1) - reference.variance_at(i));
  }
  return total / double(sum_.size());
}

}  // namespace etendue::comparing
