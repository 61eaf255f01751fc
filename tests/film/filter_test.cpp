// Reconstruction filters.

#include <gtest/gtest.h>

#include "etendue/film/image_buffer.h"
#include "support/filter_support.h"

namespace etendue::test {
namespace {

double integral(const Filter& f) {
  constexpr int n = 400;
  const float h = 2 * f.radius() / n;
  double sum = 0;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) sum += double(f.weight((float(i) + 0.5f) * h - f.radius(), (float(j) + 0.5f) * h - f.radius()));
  return sum * double(h) * double(h);
}

TEST(Filter, ValuesOfTheLiterature) {
  EXPECT_NEAR(integral(*make_filter("BoxFilter")), 1, 1e-6);
  EXPECT_NEAR(integral(*make_filter("TriangleFilter")), 1, 1e-4);
  EXPECT_NEAR(integral(*make_filter("MitchellFilter")), 1, 1e-4);
  // (erf(3 / sqrt 2) s sqrt(2 pi) - 3 exp(-9/2))^2 with s = 0.5 and radius 1.5
  const double gaussian = std::erf(3 / std::sqrt(2.0)) * 0.5 * std::sqrt(2 * M_PI) - 3 * std::exp(-4.5);
  EXPECT_NEAR(integral(*make_filter("GaussianFilter")), gaussian * gaussian, 1e-4);
  // int_-3^3 sinc(x) sinc(x/3) dx = 0.997055 (numerical)
  EXPECT_NEAR(integral(*make_filter("LanczosFilter")), 0.997055 * 0.997055, 1e-4);

  const auto mitchell = make_filter("MitchellFilter");
  const float centre = mitchell->weight(0, 0);  // (8/9)^2
  EXPECT_NEAR(centre, 64.0 / 81, 1e-6);
  EXPECT_NEAR(mitchell->weight(1, 0) / std::sqrt(centre), 1.0 / 18, 1e-6);
  const auto catmull_rom = make_filter("MitchellFilter", {{"b", 0}, {"c", 0.5}});
  EXPECT_NEAR(catmull_rom->weight(0.5f, 0), 0.5625, 1e-6);
  EXPECT_NEAR(catmull_rom->weight(1.5f, 0), -0.0625, 1e-6);
  EXPECT_NEAR(make_filter("LanczosFilter")->weight(1.5f, 0), -0.212207 * 0.636620, 1e-5);
  EXPECT_NEAR(make_filter("LanczosFilter")->weight(2, 0), 0, 1e-6);
}

TEST(Filter, SymmetricAndZeroBeyondTheRadius) {
  ASSERT_GE(all_filters().size(), 5u);
  for (const auto& f : all_filters()) {
    const float r = f->radius();
    for (float x = 0; x < r; x += 0.13f)
      for (float y = 0; y < r; y += 0.17f) {
        const float w = f->weight(x, y);
        EXPECT_TRUE(std::isfinite(w)) << name(*f);
        EXPECT_EQ(w, f->weight(-x, y)) << name(*f);
        EXPECT_EQ(w, f->weight(x, -y)) << name(*f);
        EXPECT_NEAR(w, f->weight(y, x), 1e-6) << name(*f);
      }
    EXPECT_EQ(f->weight(r * 1.001f, 0), 0) << name(*f);
    EXPECT_EQ(f->weight(0, -r * 1.001f), 0) << name(*f);
    EXPECT_GT(f->weight(0, 0), 0) << name(*f);
  }
}

TEST(Filter, MitchellWeightsOfAllPixelsAddUpToOne) {
  for (const auto& f :
       {make_filter("MitchellFilter"), make_filter("MitchellFilter", {{"b", 1}, {"c", 0}}), make_filter("TriangleFilter")})
    for (float x = 0; x < 1; x += 0.07f) {
      double sum = 0;
      for (int i = -3; i <= 3; ++i)
        for (int j = -3; j <= 3; ++j) sum += double(f->weight(x - float(i), 0.3f - float(j)));
      EXPECT_NEAR(sum, 1, 1e-5) << name(*f) << " at " << x;
    }
}

}  // namespace
}  // namespace etendue::test
