// Light in translucent bodies against the papers: the diffusion profile, and the internal reflectance of a boundary.

#include <gtest/gtest.h>

#include <cmath>

#include "components/shaders/fresnel.h"
#include "components/shaders/subsurface/diffusion_profile.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

// Christensen & Burley 2015: R(r) A = A s (e^(-s r / l) + e^(-s r / 3 l)) / (8 pi l r), s = 1.9 - A + 3.5 (A - 0.8)^2 (eqs. 3,
// 6).
TEST(DiffusionNumbers, ProfileOfThePaper) {
  for (const double A : {0.1, 0.4, 0.8, 0.95}) {
    const double l = 0.002, s = 1.9 - A + 3.5 * (A - 0.8) * (A - 0.8);
    const DiffusionProfile profile(DiffusionProfile::scale(float(A), float(l)));
    for (const double r : {0.0001, 0.001, 0.004, 0.01}) {
      const double expected = s * (std::exp(-s * r / l) + std::exp(-s * r / (3 * l))) / (8 * M_PI * l * r);
      EXPECT_NEAR(double(profile.by_area(float(r))), expected, 5e-4 * expected) << A << " " << r;
    }
    // Radii are sampled from the paper's cumulative distribution, 1 - e^-x / 4 - 3/4 e^(-x/3).
    for (const float u : {0.05f, 0.3f, 0.6f, 0.9f, 0.99f}) {
      const double x = double(profile.sample(u)) * s / l;
      const double cdf = 1 - std::exp(-x) / 4 - 0.75 * std::exp(-x / 3);
      const double narrow = 1 - std::exp(-x), wide = 1 - std::exp(-x / 3);
      // One of the two exponentials is inverted: the narrow one for a quarter of the random numbers.
      EXPECT_TRUE(std::abs(u < 0.25f ? narrow - u / 0.25 : wide - (u - 0.25) / 0.75) < 2e-3) << u << " " << cdf;
      EXPECT_NEAR(double(profile.within(profile.sample(u))), cdf, 5e-4);
    }
  }
}

// Under a boundary with the internal reflectance F, the albedo A seen from outside is A0 (1 - F) / (1 - A0 F), and light makes
// 1 / (1 - A0 F) rounds on average.
TEST(DiffusionNumbers, RoundsBelowABoundary) {
  for (const double F : {0.3, 0.6})
    for (const double A0 : {0.3, 0.7, 0.9}) {
      const double A = A0 * (1 - F) / (1 - A0 * F), s = 1.9 - A0 + 3.5 * (A0 - 0.8) * (A0 - 0.8);
      EXPECT_NEAR(double(DiffusionProfile::scale(float(A), 1, float(F))), 1 / s / (1 - A0 * F), 1e-4) << F << " " << A0;
    }
}

// Light leaves a body through its boundary's transmittance, normalised so that nothing is lost: (1 - F(c)) / (pi times its own
// mean).
TEST(DiffusionNumbers, ExitsAreNormalisedByTheirOwnMean) {
  for (const double eta : {1.3, 1.6}) {
    double mean = 0;
    constexpr int steps = 4000;
    for (int i = 0; i < steps; ++i) {
      const double c = (i + 0.5) / steps;
      mean += 2 * c * (1 - double(fresnel_dielectric(float(c), float(eta)))) / steps;
    }
    EXPECT_NEAR(1 - double(mean_fresnel_dielectric(float(eta))), mean, 1e-5);
  }
}

}  // namespace
}  // namespace etendue
