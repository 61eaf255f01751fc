// The mathematics of `etendue compare`, on numbers with known answers.

#include <gtest/gtest.h>

#include <random>

#include "check/compare/pixel_errors.h"
#include "check/compare/plot.h"
#include "check/compare/reference.h"
#include "check/compare/statistics.h"
#include "check/verify/student.h"
#include "etendue/film/image_tools.h"

namespace etendue::comparing {
namespace {

using Random = std::mt19937_64;

// ---- estimates
// ----------------------------------------------------------------------------------------------------------------

TEST(CompareEstimates, a_mean_and_its_jackknife_have_the_usual_standard_error) {
  const std::vector<double> x = {1, 2, 2, 7};
  const Estimate mean = mean_of(x);
  EXPECT_DOUBLE_EQ(mean.value, 3);
  EXPECT_DOUBLE_EQ(mean.error, std::sqrt(22.0 / 3 / 4));
  EXPECT_EQ(mean.freedom, 3);
  std::vector<double> without_each;
  for (const double one : x) without_each.push_back((12 - one) / 3);
  EXPECT_NEAR(jackknife(3, without_each).error, mean.error, 1e-14);
  EXPECT_TRUE(std::isinf(mean_of(std::vector<double>{5}).error));
}

TEST(CompareEstimates, a_band_is_students_interval_of_the_logarithm) {
  const std::optional<Band> b = band({2, 0.2, 10}, 0.95);
  ASSERT_TRUE(b);
  EXPECT_NEAR(b->high, 2 * std::exp(2.228139 * 0.1), 1e-6);
  EXPECT_NEAR(b->low * b->high, 4, 1e-12);
  EXPECT_FALSE(band({-1, 0.2, 10}, 0.95));
  EXPECT_FALSE(band({1, HUGE_VAL, 0}, 0.95));
}

TEST(CompareEstimates, curves_are_lines_between_logarithms) {
  const std::vector<double> x = {1, 2, 8}, y = {6, 3, 0.75};
  EXPECT_DOUBLE_EQ(*read_curve(x, y, 1), 6);
  EXPECT_NEAR(*read_curve(x, y, 3), 2, 1e-14);
  EXPECT_NEAR(*read_curve(x, y, 8), 0.75, 1e-14);
  EXPECT_FALSE(read_curve(x, y, 0.9));
  EXPECT_FALSE(read_curve(x, y, 8.1));
  EXPECT_FALSE(read_curve({}, {}, 1));
  EXPECT_DOUBLE_EQ(*read_curve(x, std::vector<double>{6, -2, 1}, 1.5), 2);
}

TEST(CompareEstimates, exponents_are_those_of_powers) {
  const std::vector<double> x = {1, 2, 4, 64};
  std::vector<double> y;
  for (const double each : x) y.push_back(7 * std::pow(each, -0.7));
  EXPECT_NEAR(*exponent(x, y), -0.7, 1e-13);
  y[1] = 0;  // left out
  EXPECT_NEAR(*exponent(x, y), -0.7, 1e-13);
  EXPECT_FALSE(exponent(std::vector<double>{3, 3}, std::vector<double>{1, 2}));
  EXPECT_FALSE(exponent(std::vector<double>{1, 2}, std::vector<double>{1, -2}));
}

TEST(CompareEstimates, errors_of_exponents_cover_the_true_one) {
  // Values at the marks of a run are correlated, as a mean of n samples is with that of its first n/2. The 95 % interval should
  // contain -1 in 95 of 100 cases; of 400 cases in more than 88 %, with a probability of 1 - 1e-4.
  Random random(1);
  std::gamma_distribution<double> gamma(20, 1.0 / 20);
  int covered = 0, cases = 400;
  const std::vector<double> x = {1, 2, 4, 8, 16, 32};
  for (int i = 0; i < cases; ++i) {
    std::vector<std::vector<double>> runs(8);
    for (auto& run : runs) {
      double common = 1;
      for (const double at : x) {
        common = 0.5 * common + 0.5 * gamma(random);
        run.push_back(common / at);
      }
    }
    const std::optional<Estimate> e = exponent_of_mean(x, runs);
    ASSERT_TRUE(e);
    covered += std::abs(e->value + 1) < verify::student_upper_quantile(0.025, e->freedom) * e->error;
  }
  EXPECT_GT(covered, 352);
  EXPECT_LT(covered, 396);
}

// ---- who is better
// --------------------------------------------------------------------------------------------------------------

TEST(CompareContests, are_welchs_test_of_logarithms) {
  // Logarithms 0, 1, 2 and 3, 5, 7: t = (1 - 5) / sqrt(1/3 + 4/3), nu = (5/3)^2 / ((1/3)^2/2 + (4/3)^2/2) = 50/17.
  const std::vector<double> a = {1, std::exp(1), std::exp(2)}, b = {std::exp(3), std::exp(5), std::exp(7)};
  const std::vector<Contest> all = contests({{a, b, {}}}, 0.1);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].ratio, std::exp(-4), 1e-12);
  EXPECT_NEAR(all[0].p, verify::student_two_sided(4 / std::sqrt(5.0 / 3), 50.0 / 17), 1e-12);
  EXPECT_EQ(all[0].corrected, all[0].p);
  EXPECT_TRUE(all[0].significant);
  const Winner w = winner({a, b, {}}, all, 0);
  EXPECT_EQ(w.variant, 0u);
  EXPECT_TRUE(w.significant);
}

TEST(CompareContests, without_randomness_equal_is_equal_and_different_is_different) {
  const std::vector<Contest> all = contests({{{1, 1, 1}, {1, 1, 1}, {2, 2, 2}}}, 0.01);
  EXPECT_EQ(all[0].p, 1);
  EXPECT_EQ(all[1].p, 0);
  EXPECT_FALSE(winner({{1, 1, 1}, {1, 1, 1}, {2, 2, 2}}, all, 0).significant);
  EXPECT_FALSE(winner({{1, 1, 1}}, {}, 0).significant);  // alone
}

TEST(CompareContests, equal_variants_are_not_told_apart_more_often_than_stated) {
  // Errors of runs with a heavy tail, as fireflies cause; 2 scenes, 3 variants. At a level of 5 %, at most 50 + 4 sqrt(47.5) =
  // 77 of 1000 comparisons may have a significant difference.
  Random random(2);
  std::lognormal_distribution<double> tail(0, 0.8);
  int alarms = 0;
  for (int i = 0; i < 1000; ++i) {
    std::vector<std::vector<std::vector<double>>> errors(2, std::vector<std::vector<double>>(3, std::vector<double>(8)));
    for (auto& scene : errors)
      for (auto& variant : scene)
        for (double& e : variant) e = 1 + 0.3 * tail(random);
    bool any = false;
    for (const Contest& c : contests(errors, 0.05)) any = any || c.significant;
    alarms += any;
  }
  EXPECT_LE(alarms, 77);
  EXPECT_GE(alarms, 10);  // the test is not too conservative
}

TEST(CompareContests, a_difference_of_a_tenth_is_found) {
  Random random(3);
  std::normal_distribution<double> noise(0, 0.02);
  std::vector<double> a(8), b(8);
  for (double& e : a) e = 1 + noise(random);
  for (double& e : b) e = 1.1 + noise(random);
  EXPECT_TRUE(contests({{a, b}}, 0.01)[0].significant);
}

TEST(CompareContests, geometric_means_are_of_scenes) {
  const std::vector<Estimate> logs = {{std::log(2), 0.3, 7}, {std::log(8), 0.4, 7}};
  const GeometricMean mean = geometric_mean(logs);
  EXPECT_NEAR(mean.value, 4, 1e-12);
  EXPECT_NEAR(mean.relative_error, 0.25, 1e-12);
  EXPECT_EQ(mean.scenes, 2u);
}

// ---- errors of pictures
// -----------------------------------------------------------------------------------------------------------

std::vector<float> random_pixels(size_t count, Random& random) {
  std::exponential_distribution<float> some(1);
  std::vector<float> pixels(count);
  for (float& x : pixels) x = some(random);
  return pixels;
}

TEST(ComparePixels, errors_are_those_of_image_diff) {
  Random random(4);
  const std::vector<float> x = random_pixels(48, random), r = random_pixels(48, random);
  Image a(4, 4, {"X", "Y", "Z"}), b = a;
  a.values.assign(x.begin(), x.end());
  b.values.assign(r.begin(), r.end());
  const Reference reference{b.values, {}};
  const Comparison c = compare(a, b);
  EXPECT_NEAR(relative_square_error(x, reference, relative_weights(reference.mean)), c.relative_mean_square_error, 1e-12);
  EXPECT_NEAR(symmetric_error(x, reference.mean), c.symmetric_error, 1e-12);
}

TEST(ComparePixels, bias_and_variance_are_unbiased_and_known_without_a_run) {
  Random random(5);
  constexpr size_t n = 6;
  std::vector<std::vector<float>> runs;
  for (int k = 0; k < 4; ++k) runs.push_back(random_pixels(n, random));
  const Reference reference{std::vector<double>(n, 0.5), std::vector<double>(n, 0.01)};
  const std::vector<double> weights = {1, 2, 3, 4, 5, 6};
  const auto by_pairs = [&](std::optional<size_t> without) {
    double sum = 0;
    for (size_t i = 0; i < n; ++i) {
      double pairs = 0, count = 0;
      for (size_t j = 0; j < runs.size(); ++j)
        for (size_t k = 0; k < runs.size(); ++k)
          if (j != k && j != without && k != without) pairs += (runs[j][i] - 0.5) * (runs[k][i] - 0.5), count += 1;
      sum += weights[i] * (pairs / count - 0.01);
    }
    return sum / n;
  };
  RunSums sums(n);
  for (const auto& run : runs) sums.add(run);
  EXPECT_NEAR(sums.relative_square_bias(reference, weights), by_pairs({}), 1e-6);
  EXPECT_NEAR(sums.relative_square_bias_without(runs[2], reference, weights), by_pairs(2), 1e-6);
  // The error of a run is the sum of both parts: the mean over runs of (x - r)^2 is (K - 1)/K var + (mean - r)^2, and the pairs
  // give (mean - r)^2 - var / K.
  double error = 0;
  for (const auto& run : runs) error += relative_square_error(run, reference, weights) / 4;
  EXPECT_NEAR(error, sums.relative_variance(weights) + sums.relative_square_bias(reference, weights), 1e-6);
}

TEST(ComparePixels, the_noise_of_a_reference_is_no_error) {
  // Images of 20000 values: runs and reference have the variances 0.04 and 0.02 around 1, so the error is 0.04 / 1.01.
  Random random(6);
  std::normal_distribution<double> noise(0, 1);
  constexpr size_t n = 20000;
  Reference reference{std::vector<double>(n), std::vector<double>(n, 0.02)};
  for (double& r : reference.mean) r = 1 + std::sqrt(0.02) * noise(random);
  std::vector<float> x(n);
  for (float& each : x) each = float(1 + 0.2 * noise(random));
  const std::vector<double> weights(n, 1 / 1.01);
  EXPECT_NEAR(relative_square_error(x, reference, weights), 0.04 / 1.01, 5 * 0.06 * std::sqrt(2.0 / n));
}

// ---- the agreed mean
// ----------------------------------------------------------------------------------------------------------------

TEST(CompareReference, weighs_by_inverse_variance_and_leaves_out_what_it_is_asked_to) {
  RunSums a(3), b(3), none(3);
  // Means 2 and variances 1 and 4 for all values, so that the weights are 4/5 and 1/5.
  for (const float x : {1.f, 2.f, 3.f}) a.add(std::vector<float>(3, x));
  for (const float x : {0.f, 2.f, 4.f}) b.add(std::vector<float>(3, x));
  const AgreedMean agreed({&a, nullptr, &b});
  EXPECT_EQ(agreed.members(), 2u);
  EXPECT_FALSE(agreed.has(1));
  EXPECT_NEAR(agreed.weight(0), 0.8, 1e-12);
  EXPECT_NEAR(agreed.weight(2), 0.2, 1e-12);
  const Reference whole = agreed.whole();
  EXPECT_NEAR(whole.mean[0], 2, 1e-12);
  EXPECT_NEAR(whole.variance[0], 0.64 * 1 / 3 + 0.04 * 4 / 3, 1e-12);
  const Reference without = agreed.without(0);
  EXPECT_NEAR(without.mean[1], 2, 1e-12);
  EXPECT_NEAR(without.variance[1], 4.0 / 3, 1e-12);
  const Reference without_run = agreed.without_run(0, std::vector<float>(3, 1.f));
  EXPECT_NEAR(without_run.mean[2], 0.8 * 2.5 + 0.2 * 2, 1e-12);
  EXPECT_NEAR(without_run.variance[2], 0.64 * 1 / 2 + 0.04 * 4 / 3, 1e-12);
}

TEST(ComparePlot, ticks_are_round) {
  EXPECT_EQ(ticks(0.9, 11), (std::vector<double>{1, 2, 5, 10}));
  EXPECT_EQ(ticks(0.5, 5000), (std::vector<double>{1, 10, 100, 1000}));
  const std::string text = svg({"<t>", "x", "y", {{"a&b", {1, 10}, {1, 0.1}, {}, {}, 0, false}}, 3});
  EXPECT_NE(text.find("&lt;t&gt;"), std::string::npos);
  EXPECT_NE(text.find("a&amp;b"), std::string::npos);
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_EQ(svg({"", "x", "y", {{"", {0}, {-1}, {}, {}, 0, false}}, 0}).find("nan"), std::string::npos);
}

}  // namespace
}  // namespace etendue::comparing
