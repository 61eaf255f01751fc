// Sums that do not depend on order, against integers with as many bits as doubles have binary places.

#include "film/exact_sums.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace etendue {
namespace {

/// An integer multiple of 2^-1074, as every double is: two's complement, lowest word first.
class Exact {
 public:
  void add(double x) {
    int exponent = 0;
    const auto mantissa = std::int64_t(std::frexp(x, &exponent) * 0x1p53);
    shift_add(mantissa, exponent - 53 + 1074);
  }
  /// Adds mantissa * 2^shift; the bits that a negative shift cuts off must be zero.
  void shift_add(std::int64_t mantissa, int shift) {
    if (shift < 0) mantissa >>= std::min(-shift, 63), shift = 0;
    const bool negative = mantissa < 0;
    const auto size = negative ? -std::uint64_t(mantissa) : std::uint64_t(mantissa);
    std::array<std::uint64_t, words> v{};
    v[size_t(shift / 64)] = size << (shift % 64);
    if (shift % 64 > 0) v[size_t(shift / 64) + 1] = size >> (64 - shift % 64);
    std::uint64_t carry = negative;
    for (size_t i = 0; i < words; ++i) {
      const std::uint64_t with = negative ? ~v[i] : v[i], sum = words_[i] + with, all = sum + carry;
      carry = std::uint64_t(sum < with) + std::uint64_t(all < sum);
      words_[i] = all;
    }
  }
  Exact operator-(const Exact& other) const {
    Exact result = *this;
    std::uint64_t carry = 1;
    for (size_t i = 0; i < words; ++i) {
      const std::uint64_t with = ~other.words_[i], sum = words_[i] + with, all = sum + carry;
      carry = std::uint64_t(sum < with) + std::uint64_t(all < sum);
      result.words_[i] = all;
    }
    return result;
  }
  /// The value to a relative 2^-60 or so: summed from the highest word, without cancellation.
  long double approximately() const {
    Exact positive = *this;
    const bool negative = words_.back() >> 63;
    if (negative) positive = Exact() - *this;
    long double value = 0;
    for (size_t i = words; i-- > 0;) value += std::ldexp((long double)positive.words_[i], int(64 * i) - 1074);
    return negative ? -value : value;
  }
  bool operator==(const Exact&) const = default;

 private:
  static constexpr size_t words = 36;
  std::array<std::uint64_t, words> words_{};
};

constexpr int place_bits = 40, lowest = -960;

/// N(x, place) of exact_sums.h, computed with integers.
std::int64_t rounded(double x, int place) {
  if (x == 0) return 0;
  int exponent = 0;
  const auto mantissa = std::int64_t(std::frexp(std::abs(x), &exponent) * 0x1p53);
  const int down = lowest + place_bits * place - (exponent - 53);  // bits below the unit
  std::int64_t n = 0;
  if (down <= 0) {
    if (down < -10) return std::numeric_limits<std::int64_t>::max();  // much more than a digit
    n = mantissa << -down;
  } else if (down <= 54) {
    const std::int64_t rest = mantissa & ((std::int64_t(1) << down) - 1), half = std::int64_t(1) << (down - 1);
    n = mantissa >> down;
    n += rest > half || (rest == half && n % 2 == 1);
  }
  return x < 0 ? -n : n;
}

/// The exact result for these addends: each is rounded to the place below the highest that any of them reaches.
Exact expected(const std::vector<double>& addends, int& place) {
  place = 0;
  for (const double x : addends)
    while (rounded(x, place + 2) != 0) ++place;
  Exact sum;
  for (const double x : addends) {
    const std::int64_t high = rounded(x, place + 1);
    const double rest = x - std::ldexp(double(high), lowest + place_bits * (place + 1));
    sum.shift_add(high, lowest + place_bits * (place + 1) + 1074);
    sum.shift_add(rounded(rest, place), lowest + place_bits * place + 1074);
  }
  return sum;
}

std::vector<double> hostile(unsigned seed, size_t count, double low, double high) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> exponent(low, high), mantissa(-1, 1);
  std::vector<double> addends;
  for (size_t i = 0; i < count; ++i) {
    double x = std::ldexp(mantissa(random), int(exponent(random)));
    switch (random() % 12) {
      case 0: x = 0; break;
      case 1: x = std::ldexp(random() % 2 ? 0.5 : -0.5, lowest + place_bits * int(random() % 20 + 5)); break;  // ties
      case 2: x = std::ldexp(1 + 0x1p-52, int(exponent(random))); break;
      case 3: x = addends.empty() ? x : -addends[random() % addends.size()]; break;
      case 4: x = std::ldexp(double(random() | 1), int(exponent(random)) - 64); break;
      default: break;
    }
    if (std::abs(x) > ExactSums::largest_addend) x = ExactSums::largest_addend;
    addends.push_back(x);
  }
  return addends;
}

ExactSums sum_of(const std::vector<double>& addends) {
  ExactSums sums(1, 1);
  for (const double x : addends) sums.add(0, 1, &x, 1);
  return sums;
}

void expect_same(const ExactSums& a, const ExactSums& b) {
  EXPECT_EQ(a.digits(), b.digits());
  EXPECT_EQ(a.places(), b.places());
}

TEST(ExactSums, are_those_of_rounded_addends) {
  const std::pair<double, double> ranges[] = {{-1000, 950}, {-970, -850}, {-30, 30}, {0, 90}, {880, 959}};
  unsigned seed = 0;
  for (const auto& [low, high] : ranges)
    for (const size_t count : {1u, 2u, 7u, 1000u}) {
      std::vector<double> addends = hostile(++seed, count, low, high);
      const ExactSums sums = sum_of(addends);
      int place = 0;
      const Exact wanted = expected(addends, place);
      EXPECT_EQ(int(sums.places()[0]), place) << low << " " << count;
      Exact got;
      got.shift_add(sums.digits()[0], lowest + place_bits * (place + 1) + 1074);
      got.shift_add(sums.digits()[1], lowest + place_bits * place + 1074);
      EXPECT_TRUE(got == wanted) << low << " " << count;
      // The result is rounded only once, when it is converted to double,
      const long double value = got.approximately();
      EXPECT_LE(std::abs((long double)sums.value(0, 0) - value), std::abs(value) * 0x1.1p-53L + 0x1p-1074L);
      // and it is close to the true sum.
      Exact truth;
      double largest = 0;
      for (const double x : addends) truth.add(x), largest = std::max(largest, std::abs(x));
      EXPECT_LE(std::abs((got - truth).approximately()),
                (long double)count * std::max(std::ldexp((long double)largest, -40), 0x1p-961L));
    }
}

TEST(ExactSums, do_not_depend_on_order_or_division) {
  for (unsigned seed = 100; seed < 130; ++seed) {
    std::vector<double> addends = hostile(seed, 300, seed % 2 ? -200 : -1000, seed % 3 ? 100 : 950);
    const ExactSums straight = sum_of(addends);
    std::mt19937 random(seed);
    for (int order = 0; order < 5; ++order) {
      if (order == 0) std::ranges::sort(addends);
      if (order == 1) std::ranges::reverse(addends);
      if (order > 1) std::ranges::shuffle(addends, random);
      expect_same(sum_of(addends), straight);
      // The sums of parts of any size, merged in any order.
      std::vector<ExactSums> parts;
      for (size_t i = 0; i < addends.size();) {
        const size_t n = std::min<size_t>(1 + random() % 60, addends.size() - i);
        parts.push_back(sum_of({addends.begin() + std::ptrdiff_t(i), addends.begin() + std::ptrdiff_t(i + n)}));
        i += n;
      }
      while (parts.size() > 1) {
        std::swap(parts.back(), parts[random() % parts.size()]);
        const ExactSums last = parts.back();
        parts.pop_back();
        parts[random() % parts.size()].add(last);
      }
      expect_same(parts[0], straight);
    }
  }
}

TEST(ExactSums, groups_have_the_places_of_their_largest) {
  const std::array<std::array<double, 3>, 3> addends = {{{1, 1e-20, 3}, {1e30, -1e-9, 0}, {0, 0, 1e-300}}};
  ExactSums forwards(2, 3), backwards(2, 3), none(2, 3);
  for (int i = 0; i < 3; ++i) {
    forwards.add(1, 2, addends[size_t(i)].data(), 3);
    backwards.add(1, 2, addends[size_t(2 - i)].data(), 3);
  }
  expect_same(forwards, backwards);
  EXPECT_EQ(forwards.value(0, 0), 0);
  EXPECT_EQ(forwards.value(1, 0), 1e30 + 1);
  EXPECT_NEAR(forwards.value(1, 2), 3, 1e30 * 0x1p-40);
  none.add(forwards);
  expect_same(none, forwards);
}

// The largest permitted number of largest digits fills 63 bits and no more.
TEST(ExactSums, have_room_for_the_addends_they_promise) {
  const double largest = 0x1p119 - 0x1p66;  // just below the tie: digits of 2^39 at a place, and nearly so below it
  ExactSums sums = sum_of({largest});
  for (int doubling = 0; doubling < 23; ++doubling) sums.add(ExactSums(sums));
  EXPECT_EQ(sums.value(0, 0), largest * 0x1p23);
  ExactSums twice = sums;
  for (std::int64_t& digit : twice.digits()) digit += digit - digit / (1 << 23);  // 2^24 - 1 of them
  EXPECT_TRUE(twice.possible(ExactSums::most_addends));
  EXPECT_FALSE(twice.possible(ExactSums::most_addends - 1));
  EXPECT_NEAR(twice.value(0, 0) / largest, 0x1p24 - 1, 1e-6);
}

}  // namespace
}  // namespace etendue
