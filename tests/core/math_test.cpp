// Scalar functions and warps that are computed faster than by the standard library's functions.

#include <gtest/gtest.h>

#include <random>

#include "etendue/core/spectrum.h"
#include "etendue/core/warp.h"

namespace etendue {
namespace {

TEST(InverseSqrt, IsThatOfTheLibraryToTwoUnits) {
  std::mt19937 engine(1);
  std::uniform_real_distribution<float> exponent(-126, 127), mantissa(1, 2);
  double worst = 0;
  for (int i = 0; i < 1000000; ++i) {
    const float x = std::ldexp(mantissa(engine), int(exponent(engine)));
    worst = std::max(worst, std::abs(double(inverse_sqrt(x)) * std::sqrt(double(x)) - 1));
  }
  EXPECT_LT(worst, 2 * double(std::numeric_limits<float>::epsilon()));
}

TEST(InverseSqrt, AtTheEnds) {
  EXPECT_EQ(inverse_sqrt(0), infinity);
  EXPECT_EQ(inverse_sqrt(infinity), 0);
  EXPECT_TRUE(std::isnan(inverse_sqrt(-1)));
  EXPECT_TRUE(std::isnan(inverse_sqrt(std::numeric_limits<float>::quiet_NaN())));
  const float least = std::numeric_limits<float>::denorm_min(), greatest = std::numeric_limits<float>::max();
  EXPECT_FLOAT_EQ(inverse_sqrt(least), 1 / std::sqrt(least));
  EXPECT_FLOAT_EQ(inverse_sqrt(greatest), 1 / std::sqrt(greatest));
}

TEST(CosineHemisphere, DirectionsHaveUnitLength) {
  std::mt19937 engine(2);
  std::uniform_real_distribution<float> uniform(0, 1);
  for (int i = 0; i < 200000; ++i) {
    const Vector3 v = warp::cosine_hemisphere({uniform(engine), uniform(engine)});
    ASSERT_NEAR(length(v), 1, 3e-7f);
    ASSERT_GE(v.z, 0);
  }
  for (const Point2 u : {Point2{0, 0}, Point2{0.5f, 0.5f}, Point2{one_minus_epsilon, 0}, Point2{0.5f, one_minus_epsilon}})
    EXPECT_NEAR(length(warp::cosine_hemisphere(u)), 1, 3e-7f);
}

// Wavelengths placed all at once have the same table indices and fractions as wavelengths placed one by one, also beyond the
// tables' ends.
TEST(Wavelengths, AsVectorsAreTheSameAsOneByOne) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> uniform(wavelength_low - 20, wavelength_high + 20);
  for (int trial = 0; trial < 2000; ++trial) {
    std::array<float, spectrum_size> lambda, pdf;
    detail::Lanes wide_lambda, wide_pdf;
    for (int i = 0; i < spectrum_size; ++i) {
      constexpr float ends[] = {wavelength_low, wavelength_high, wavelength_high - 1};
      wide_lambda[i] = lambda[size_t(i)] = trial < 3 ? ends[trial] : uniform(engine);
      wide_pdf[i] = pdf[size_t(i)] = 0.001f * float(i + 1);
    }
    const Wavelengths a(lambda, pdf), b(wide_lambda, wide_pdf);
    for (int i = 0; i < spectrum_size; ++i) {
      EXPECT_EQ(a[i], b[i]);
      EXPECT_EQ(a.pdf(i), b.pdf(i));
      EXPECT_EQ(a.table_index(i), b.table_index(i)) << a[i];
      EXPECT_EQ(a.table_fraction(i), b.table_fraction(i)) << a[i];
    }
    EXPECT_FALSE(b.single());
  }
}

}  // namespace
}  // namespace etendue
