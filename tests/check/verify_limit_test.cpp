// `verify` with consistent renderers, which are exact only in the limit: correct ones agree, wrong ones are found.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "check/verify/limit.h"
#include "etendue/core/error.h"
#include "support/program_support.h"
#include "support/render_support.h"

namespace etendue::verify {
namespace {

using Random = std::mt19937_64;

double photon_width(std::uint32_t step) { return std::pow(double(step + 1), -0.15); }

/// The means of a pass up to each mark, for steps that are biased by `bias(w)`, w being the width of the kernel.
template <class Bias>
std::vector<double> means_of(const LimitOfPass& pass, const Bias& bias) {
  std::vector<double> means;
  double sum = 0;
  std::uint32_t step = 0;
  for (const std::uint32_t mark : pass.marks()) {
    for (; step < mark; ++step) sum += 5 + bias(photon_width(step));
    means.push_back(sum / mark);
  }
  return means;
}

TEST(VerifyLimit, lines_are_extended_to_zero) {
  // Data on the line y = 3 + 2 x give 3 for any variances; two points at x = 1 and 3 have the weights 3/2 and -1/2.
  const std::vector<double> c = limit_weights({1, 3, 4}, {1, 0.1, 7});
  EXPECT_NEAR(5 * c[0] + 9 * c[1] + 11 * c[2], 3, 1e-12);
  EXPECT_NEAR(c[0] + c[1] + c[2], 1, 1e-12);
  const std::vector<double> two = limit_weights({1, 3}, {2, 5});
  EXPECT_NEAR(two[0], 1.5, 1e-12);
  EXPECT_NEAR(two[1], -0.5, 1e-12);
  EXPECT_TRUE(limit_weights({2, 2}, {1, 1}).empty());
}

TEST(VerifyLimit, a_bias_as_the_width_or_its_square_is_gone) {
  for (const std::uint32_t samples : {8u, 100u, 1024u}) {
    const LimitOfPass pass(samples, 1, photon_width);
    EXPECT_EQ(pass.marks().back(), samples);
    EXPECT_NEAR(pass.limit_by_width(means_of(pass, [](double w) { return 3 * w; })), 5, 1e-9);
    EXPECT_NEAR(pass.limit_by_square(means_of(pass, [](double w) { return -2 * w * w; })), 5, 1e-9);
    // With a bias between both forms, the limit lies between the two estimates.
    const auto both = means_of(pass, [](double w) { return w + w * w; });
    EXPECT_LT(pass.limit_by_width(both), 5);
    EXPECT_GT(pass.limit_by_square(both), 5);
  }
  EXPECT_THROW(LimitOfPass(4, 1, photon_width), Error);
  EXPECT_THROW(LimitOfPass(64, 1, [](std::uint32_t) { return 1.0; }), Error);
}

TEST(VerifyLimit, its_noise_is_what_it_says) {
  // Steps with the variance 1 / w^2, as with photons.
  constexpr std::uint32_t samples = 128;
  const LimitOfPass pass(samples, 1, photon_width);
  Random random(1);
  std::normal_distribution<double> normal(0, 1);
  double limits = 0, ends = 0;
  constexpr int passes = 4000;
  for (int p = 0; p < passes; ++p) {
    std::vector<double> means;
    double sum = 0;
    std::uint32_t step = 0;
    for (const std::uint32_t mark : pass.marks()) {
      for (; step < mark; ++step) sum += normal(random) / photon_width(step);
      means.push_back(sum / mark);
    }
    const double limit = 0.5 * (pass.limit_by_width(means) + pass.limit_by_square(means));
    limits += limit * limit;
    ends += means.back() * means.back();
  }
  EXPECT_NEAR(std::sqrt(limits / ends) / pass.noise(), 1,
              0.1);  // both deviations are known to 1.1 %; noise() takes the variances from means of w^2
}

TEST(VerifyLimit, rates_are_found_within_their_errors) {
  Random random(2);
  std::normal_distribution<double> normal(0, 1);
  const std::vector<std::uint32_t> marks = {1, 2, 4, 8, 16, 32, 64};
  std::vector<std::vector<double>> truth(12, std::vector<double>(16));
  for (auto& pass : truth)
    for (double& tile : pass) tile = 1 + 0.001 * normal(random);
  const auto measured = [&](double bias, double rate) {
    std::vector<std::vector<std::vector<double>>> tiles(12);
    for (auto& pass : tiles)
      for (const std::uint32_t mark : marks) {
        pass.emplace_back();
        for (int tile = 0; tile < 16; ++tile)
          pass.back().push_back(1 + (tile % 2 ? bias : -bias) * std::pow(mark, -rate) +
                                0.01 * normal(random) / std::sqrt(mark));
      }
    return convergence(marks, tiles, truth);
  };
  const Convergence c = measured(0.2, 0.3);
  ASSERT_TRUE(c.rate);
  EXPECT_LT(c.rate->error, 0.02);
  EXPECT_NEAR(c.rate->value, 0.3, 4 * c.rate->error);
  EXPECT_NEAR(c.bias[0], 0.2, 4 * c.error[0]);
  const Convergence none = measured(0, 1);
  EXPECT_FALSE(none.rate && none.bias[0] > 0.01);
}

TEST(VerifyLimit, what_is_not_known_of_a_mean_is_no_disagreement) {
  const Layout layout = Layout::of({0, 0, 4, 4}, 4, 0);
  Random random(3);
  std::normal_distribution<double> normal(0, 0.001);
  Measured a{"a", {}, true, {}}, b{"b", {}, true, {}};
  for (int pass = 0; pass < 16; ++pass) {
    a.passes.emplace_back(layout.count(), 1 + normal(random));
    b.passes.emplace_back(layout.count(), 1.02 + normal(random));
  }
  EXPECT_TRUE(compare(layout, {a, b}, 0.01).disagrees());
  b.systematic.assign(layout.count(), 0.02);
  EXPECT_FALSE(compare(layout, {a, b}, 0.01).disagrees());
  EXPECT_GT(compare(layout, {a, b}, 0.01).pairs[0].noticeable, 0.04);
  b.systematic.assign(layout.count(), 0.001);
  EXPECT_TRUE(compare(layout, {a, b}, 0.01).disagrees());
}

// ---- photon mappers
// -------------------------------------------------------------------------------------------------------------

class VerifyLimitProgram : public RunsProgram {
 protected:
  // A lamp over a ball between a floor and a wall, with a radius of a fifth of the scene's: a bias of 9 % in the first step.
  int verify(const std::string& renderer, const std::string& samples) {
    const std::string objects = R"(
      Sphere { radius: 1, shader: Lambertian { color: 0.5 } }
      Sphere { radius: 0.5, transform: translate(0, 3, 0), emission: DiffuseEmission { radiance: 5 } }
      Rectangle { corner: [-3, -1, -3], edge_u: [0, 0, 6], edge_v: [6, 0, 0], shader: Lambertian { color: 0.7 } }
      Rectangle { corner: [-3, -1, 3], edge_u: [6, 0, 0], edge_v: [0, 5, 0], shader: Lambertian { color: 0.6 } })";
    const std::string scene = folder.write(
        "photons.etd", test::job_text("PathTracer { max_depth: 4 }",
                                      "PerspectiveCamera { from: [0, 1, -6] m, to: [0, 0, 0] m, fov: 40 deg }", 16, objects));
    return run({"verify", scene, "--plugin", ETENDUE_FAULTY_RENDERERS, "--renderers", "PathTracer," + renderer, "--samples",
                samples, "--tile", "8", "--lengths", "4", "--json"});
  }
  nlohmann::json pair() const { return nlohmann::json::parse(out)["pairs"][0]; }
};

const std::string mapper = "SmallPhotonMapper{photons: 1000, radius: 0.2, alpha: 0.4}";

TEST_F(VerifyLimitProgram, a_photon_mapper_goes_to_the_truth_at_its_rate) {
  ASSERT_EQ(verify(mapper, "1024"), 0) << out << err;
  const auto rate = pair()["convergence"]["rate"];
  // The bias falls as N^-(1 - alpha) where the blur lies within one surface, and as N^-(1 - alpha)/2 at edges.
  EXPECT_GT(rate["value"].get<double>(), 0.3 - 4 * rate["standard_error"].get<double>()) << rate;
  EXPECT_LT(rate["value"].get<double>(), 0.6 + 4 * rate["standard_error"].get<double>()) << rate;
  EXPECT_LT(rate["standard_error"].get<double>(), 0.1);
  const auto bias = pair()["convergence"]["relative_bias_in_tiles"].get<std::vector<double>>();
  EXPECT_GT(*std::ranges::max_element(bias), 0.03);
}

TEST_F(VerifyLimitProgram, photons_of_wrong_power_are_found) {
  EXPECT_EQ(verify("FaultyPhotonMapper{power: 1, declared_alpha: 0.4, inner: " + mapper + "}", "2048"), 0) << out << err;
  EXPECT_EQ(verify("FaultyPhotonMapper{power: 1.03, declared_alpha: 0.4, inner: " + mapper + "}", "2048"), 1) << out << err;
}

TEST_F(VerifyLimitProgram, a_radius_that_does_not_shrink_is_found) {
  EXPECT_EQ(
      verify("FaultyPhotonMapper{declared_alpha: 0.4, inner: SmallPhotonMapper{photons: 1000, radius: 0.2, alpha: 1}}", "1024"),
      1)
      << out << err;
}

TEST_F(VerifyLimitProgram, passes_that_are_too_short_are_refused) {
  EXPECT_EQ(verify(mapper, "64"), 2);
  EXPECT_TRUE(says("too few to tell what a consistent renderer goes to")) << err;
}

}  // namespace
}  // namespace etendue::verify
