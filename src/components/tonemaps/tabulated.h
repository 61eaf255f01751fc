#pragma once
// Tabulated: a lookup table of a curve, for speed: AgX and an encoding take nine powers and logarithms for each pixel.

#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace etendue {

/// A function of positive numbers on [2^low, 2^high], tabulated at 512 points of each octave and linear between them. Below
/// 2^low it is linear to f(0) = 0, above 2^high constant. If |x^2 f''| <= 1 the error is at most (1/512)^2 / 8 = 5e-7.
class Tabulated {
 public:
  template <class F>
  Tabulated(int low, int high, const F& f) : low_(std::ldexp(1.0, low)), first_(key(low_)) {
    const std::uint64_t last = key(std::ldexp(1.0, high));
    values_.reserve(last - first_ + 2);
    for (std::uint64_t k = first_; k <= last; ++k) values_.push_back(f(std::bit_cast<double>(k << shift)));
    values_.push_back(values_.back());
  }

  double operator()(double x) const {
    if (!(x > low_)) return x > 0 ? values_[0] * (x / low_) : 0;
    const std::uint64_t bits = std::bit_cast<std::uint64_t>(x), i = (bits >> shift) - first_;
    if (i + 1 >= values_.size()) return values_.back();
    const double part = double(bits & ((std::uint64_t(1) << shift) - 1)) * 0x1p-43;
    return values_[i] + part * (values_[i + 1] - values_[i]);
  }

 private:
  // A double's exponent and the first 9 bits of its fraction number the points in order.
  static constexpr int shift = 52 - 9;
  static std::uint64_t key(double x) { return std::bit_cast<std::uint64_t>(x) >> shift; }

  double low_;
  std::uint64_t first_;
  std::vector<double> values_;
};

}  // namespace etendue
