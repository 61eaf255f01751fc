#pragma once
// Exact sums: sums that depend only on the set of addends, not on their order, by binned summation (Demmel & Nguyen 2013;
// Ahrens, Demmel & Nguyen 2020), here with integers. docs/decisions/023-exact-sums.md has the reasons.
//
// Numbers are written with digits of 40 bits at fixed places: digit j counts units of 2^(40 j - 960). Digits are signed, since
// they result from rounding to nearest: with N(x, j) = x / unit_j rounded to the nearest integer (ties to even), digit j of x
// is N(x, j) - 2^40 N(x, j + 1). So digits depend on x alone. A sum stores the sums of the digits at the two highest places
// that any addend has reached. These follow from the set of addends: when a larger addend comes, the lower place is dropped,
// and the digits of the earlier addends at the new upper place are already there (or are zero). Digits are at most 2^39 and
// their sums have 63 bits, so 2^24 - 1 addends cannot overflow.
//
// Precision: an addend is rounded to the lower place, an error of at most 2^-40 of the largest addend.

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace etendue {

/// The units of all places, and their inverses.
struct ExactUnits {
  static constexpr int place_bits = 40, lowest_exponent = -960, places = 49;
  std::array<double, places> unit{}, inverse{};
  constexpr ExactUnits() {
    double u = 1, i = 1;
    for (int e = 0; e > lowest_exponent; --e) u *= 0.5, i *= 2;
    for (size_t j = 0; j < unit.size(); ++j) {
      unit[j] = u;
      inverse[j] = i;
      for (int e = 0; e < place_bits && j + 1 < unit.size(); ++e) u *= 2, i *= 0.5;
    }
  }
};
inline constexpr ExactUnits exact_units;

/// An array of groups of sums. The sums of a group (X, Y and Z, say) have the same two places, those of the group's largest
/// addend.
class ExactSums {
 public:
  static constexpr std::uint32_t most_addends = (1u << 24) - 1;
  /// The largest magnitude of an addend; magnitudes below 2^-961 count as zero.
  static constexpr double largest_addend = 0x1p959;

  ExactSums() = default;
  ExactSums(size_t groups, size_t group_size) : size_(group_size), digits_(groups * 2 * group_size), places_(groups) {}

  bool empty() const { return places_.empty(); }

  /// Adds to the groups [begin, end): the addends of group i start at from[(i - begin) * stride].
  void add(size_t begin, size_t end, const double* from, size_t stride) {
    if (size_ == 3)
      add_range<3>(begin, end, from, stride);
    else
      add_range<1>(begin, end, from, stride);
  }
  /// Adds the sums of another array with as many groups.
  void add(const ExactSums& other) {
    for (size_t i = 0; i < places_.size(); ++i) {
      std::int64_t* to = &digits_[2 * size_ * i];
      raise(to, places_[i], other.places_[i]);
      const std::int64_t* from = &other.digits_[2 * size_ * i];
      const int lower = places_[i] - other.places_[i];  // number of places by which the other's digits are lower
      for (size_t c = 0; c < size_ && lower <= 1; ++c) {
        if (lower == 0) {
          to[c] += from[c];
          to[size_ + c] += from[size_ + c];
        } else {
          to[size_ + c] += from[c];
        }
      }
    }
  }

  /// Rounded once.
  double value(size_t i, size_t c) const {
    const std::int64_t* digits = &digits_[2 * size_ * i];
    return double((Wide(digits[c]) << place_bits) + digits[size_ + c]) * exact_units.unit[places_[i]];
  }

  // Access for saving and loading states.
  std::vector<std::int64_t>& digits() { return digits_; }
  const std::vector<std::int64_t>& digits() const { return digits_; }
  std::vector<std::uint8_t>& places() { return places_; }
  const std::vector<std::uint8_t>& places() const { return places_; }
  /// Whether the digits can be sums of this many addends.
  bool possible(std::uint32_t addends) const {
    const auto most = std::int64_t(addends) << (place_bits - 1);
    for (const std::uint8_t place : places_)
      if (place > highest_place) return false;
    for (const std::int64_t digit : digits_)
      if (digit > most || digit < -most) return false;
    return true;
  }

 private:
  __extension__ using Wide = __int128;
  static constexpr int place_bits = ExactUnits::place_bits, highest_place = ExactUnits::places - 3;

  /// Moves a group to higher places.
  void raise(std::int64_t* digits, std::uint8_t& place, std::uint8_t to) const {
    if (to <= place) return;
    for (size_t c = 0; c < size_; ++c) {
      digits[size_ + c] = to == place + 1 ? digits[c] : 0;
      digits[c] = 0;
    }
    place = to;
  }

  template <size_t n>
  void add_range(size_t begin, size_t end, const double* from, size_t stride) {
    std::int64_t* digits = digits_.data() + 2 * n * begin;
    for (size_t i = begin; i < end; ++i, digits += 2 * n, from += stride) {
      double largest = 0;
      for (size_t c = 0; c < n; ++c) largest = std::max(largest, std::abs(from[c]));
      if (largest == 0) continue;
      std::uint8_t& place = places_[i];
      if (largest > 0.5 * exact_units.unit[place + 2u]) [[unlikely]] {
        std::uint8_t higher = place;
        while (higher < highest_place && largest > 0.5 * exact_units.unit[higher + 2u]) ++higher;
        raise(digits, place, higher);
      }
      const double high_unit = exact_units.unit[place + 1u], to_high = exact_units.inverse[place + 1u],
                   to_low = exact_units.inverse[place];
      for (size_t c = 0; c < n; ++c) {
        const double high = std::nearbyint(from[c] * to_high);
        const double low = std::nearbyint((from[c] - high * high_unit) * to_low);  // the remainder is exact
        digits[c] += std::int64_t(high);
        digits[n + c] += std::int64_t(low);
      }
    }
  }

  size_t size_ = 1;
  std::vector<std::int64_t> digits_;  // for each group the upper digits, then the lower digits
  std::vector<std::uint8_t> places_;  // place of the lower digits, for each group
};

}  // namespace etendue
