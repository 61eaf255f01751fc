// Markov chains of primary samples visit states in proportion to their brightness, also where states use different numbers of
// primary samples.

#include <gtest/gtest.h>

#include <cmath>

#include "etendue/transport/metropolis.h"
#include "etendue/transport/primary_sample_vectors.h"

namespace etendue {
namespace {

float asked(const MutatedPrimarySamples& numbers, std::uint64_t walk) {
  SampleKey key;
  key.walk = walk;
  return numbers.number(key, 0);
}

// States of two kinds lie in narrow stripes of one primary sample. States of the first kind have the brightness 1. The others
// use a second primary sample: its values within `width` give 1 / width, all others 0. So either kind has half of all
// brightness, and a chain is at each half of the time. The second sample has moved when a chain returns from the first kind.
TEST(MutatedPrimarySamples, StatesThatAskForMoreAreAsLikelyAsTheyShouldBe) {
  constexpr float width = 0.02f, deviation = 0.05f;
  constexpr int chains = 200, steps = 20000;
  double sum = 0, squares = 0;
  for (int chain = 0; chain < chains; ++chain) {
    MutatedPrimarySamples numbers(mix_bits(std::uint64_t(chain) + 1));
    ChoiceNumbers choices(mix_bits(std::uint64_t(chain) + 1000));
    bool more = false;
    const auto brought = [&] {
      const float stripe = 20 * asked(numbers, 1);
      more = stripe - std::floor(stripe) < 0.5f;
      if (!more) return 1.0;
      return std::abs(asked(numbers, 2) - 0.5f) < width / 2 ? 1.0 / double(width) : 0.0;
    };
    double I = brought();
    numbers.accept();
    bool at = more;
    int count = 0;
    for (int i = 0; i < steps; ++i) {
      if (choices.next() < 0.01)
        numbers.large_step();
      else
        numbers.small_step(deviation);
      const double J = brought();
      if (!(I > 0) || choices.next() < J / I) {
        numbers.accept();
        I = J;
        at = more;
      } else {
        numbers.reject();
      }
      count += at;
    }
    const double part = double(count) / steps;
    sum += part;
    squares += part * part;
  }
  const double mean = sum / chains, error = std::sqrt((squares / chains - mean * mean) / (chains - 1));
  EXPECT_LT(error, 0.005);
  // Four standard errors: a probability of 1 in 16,000. The first states, not drawn in proportion, are forgotten after some
  // hundred. If unused samples were mutated anew for each proposal, the result would be 0.64.
  EXPECT_NEAR(mean, 0.5, 4 * error) << "standard error " << error;
}

}  // namespace
}  // namespace etendue
