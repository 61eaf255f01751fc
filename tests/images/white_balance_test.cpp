// Chromatic adaptation against published matrices.

#include "images/white_balance.h"

#include <gtest/gtest.h>

#include <cmath>

#include "etendue/core/error.h"

namespace etendue {
namespace {

constexpr Xyz lamp{1.0985, 1, 0.35585}, daylight{0.95047, 1, 1.08883};  // A and D65, ASTM E308-01

// B. Lindbloom, Chromatic Adaptation (brucelindbloom.com), A to D65.
TEST(WhiteBalance, MatricesAreThePublishedOnes) {
  const std::pair<const char*, std::array<double, 9>> published[] = {
      {"bradford", {0.8446965, -0.1179225, 0.3948108, -0.1366303, 1.1041226, 0.1291718, 0.0798489, -0.1348999, 3.1924009}},
      {"von_kries", {0.9394987, -0.2339150, 0.4281177, -0.0256939, 1.0263828, 0.0051761, 0, 0, 3.0598005}}};
  for (const auto& [method, expected] : published) {
    const std::array<double, 9> matrix = adaptation_matrix(method, lamp, daylight);
    for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(matrix[i], expected[i], 2e-6) << method << " " << i;
  }
}

TEST(WhiteBalance, WhiteBecomesWhiteAndBackAgain) {
  for (const std::string& method : adaptation_names()) {
    Image image(2, 1, {"object.ID", "X", "Y", "Z"});
    image.values = {5, lamp.x, lamp.y, lamp.z, 6, 0.3, 0.2, 0.1};
    const Image there = white_balanced(image, method, lamp, daylight), back = white_balanced(there, method, daylight, lamp);
    EXPECT_NEAR(there.at(0, 0, 1), daylight.x, 1e-12);
    EXPECT_NEAR(there.at(0, 0, 3), daylight.z, 1e-12);
    EXPECT_EQ(there.at(1, 0, 0), 6);
    for (size_t i = 0; i < image.values.size(); ++i) EXPECT_NEAR(back.values[i], image.values[i], 1e-12) << method;
  }
}

// CAT16's degree of adaptation is 1 here: the formula of Li et al. 2017, appendix, step 0, evaluated for one colour by NumPy.
TEST(WhiteBalance, Cat16) {
  const std::array<double, 9> m = adaptation_matrix("cat16", lamp, daylight);
  const double x = 0.3, y = 0.2, z = 0.1;
  EXPECT_NEAR(m[0] * x + m[1] * y + m[2] * z, 0.274010612, 1e-6);
  EXPECT_NEAR(m[3] * x + m[4] * y + m[5] * z, 0.197605818, 1e-6);
  EXPECT_NEAR(m[6] * x + m[7] * y + m[8] * z, 0.298633949, 1e-6);
}

TEST(WhiteBalance, SaysWhatIsWrong) {
  EXPECT_THROW(adaptation_matrix("cat17", lamp, daylight), Error);
  EXPECT_THROW(adaptation_matrix("bradford", {1, 0, 0}, daylight), Error);
  EXPECT_THROW(white_balanced(Image(1, 1, {"R", "G", "B"}), "cat16", lamp, daylight), Error);
}

}  // namespace
}  // namespace etendue
