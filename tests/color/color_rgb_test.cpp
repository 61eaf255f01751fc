// RGB spaces, and spectra for RGB values: Jakob & Hanika's sigmoids.

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"

namespace etendue {
namespace {

using Rgb = std::array<double, 3>;

Rgb to_rgb(const RgbSpace& space, const Xyz& c) {
  Rgb rgb;
  for (size_t i = 0; i < 3; ++i)
    rgb[i] = space.from_xyz[3 * i] * c.x + space.from_xyz[3 * i + 1] * c.y + space.from_xyz[3 * i + 2] * c.z;
  return rgb;
}
Rgb reflected(const RgbSpace& space, const Color& c) {
  return to_rgb(space, to_xyz(*c, ColorUse::reflectance, space.illuminant.get()));
}
Rgb emitted(const RgbSpace& space, const Color& c) { return to_rgb(space, to_xyz(*c, ColorUse::radiance)); }
double difference(const Rgb& a, const Rgb& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

/// A texel as a SpectralFunction, so that it is integrated by the same sum as everything else.
class Texel final : public SpectralFunction {
 public:
  Texel(const RgbSpace& space, const Rgb& rgb) : space_(space), rgb_(rgb) {}
  Spectrum evaluate(const Wavelengths& w, ColorUse use) const override {
    return rgb_spectrum(space_, float(rgb_[0]), float(rgb_[1]), float(rgb_[2]), use, w);
  }
  float at(float wavelength, ColorUse use) const override {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, wavelength, 1);
    return evaluate(w, use)[0];
  }
  std::string expression() const override { return "texel"; }

 private:
  const RgbSpace& space_;
  Rgb rgb_;
};

/// Calls f for a grid of the cube, with its corners and faces.
template <class F>
void for_cube(int steps, double low, double high, F&& f) {
  const auto value = [&](int i) { return low + (high - low) * i / steps; };
  for (int r = 0; r <= steps; ++r)
    for (int g = 0; g <= steps; ++g)
      for (int b = 0; b <= steps; ++b) f(Rgb{value(r), value(g), value(b)});
}

TEST(RgbSpace, MatricesOfSrgb) {
  const RgbSpace& s = rgb_space("srgb");
  const double expected[9] = {0.412391, 0.357584, 0.180481, 0.212639, 0.715169, 0.072192, 0.019331, 0.119195, 0.950532};
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(s.to_xyz[i], expected[i], 1e-6);
  EXPECT_EQ(&s, &rgb_space("rec709"));
  EXPECT_EQ(s.illuminant->expression(), "illuminant(\"D65\")");
  try {
    rgb_space("srbg");
    FAIL();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'srgb'"), std::string::npos) << e.what();
  }
  EXPECT_THROW(make_rgb_space("line", {{{0.1, 0.1}, {0.2, 0.2}, {0.3, 0.3}}}, {0.3127, 0.3290}), Error);
}

TEST(RgbSpace, WhiteOfEverySpace) {
  for (const std::string& name : rgb_space_names()) {
    const RgbSpace& s = rgb_space(name);
    EXPECT_NEAR(s.to_xyz[3] + s.to_xyz[4] + s.to_xyz[5], 1, 1e-12) << name;
    // As radiance, (1, 1, 1) is the white with Y = 1; as reflectance, it is 1 everywhere.
    const Color white = rgb_color(name, 1, 1, 1);
    EXPECT_LT(difference(emitted(s, white), {1, 1, 1}), 5e-4) << name;
    EXPECT_NEAR(to_xyz(*white, ColorUse::radiance).y, 1, 1e-5) << name;
    for (float w = 360; w <= 830; w += 10) {
      EXPECT_FLOAT_EQ(white->at(w, ColorUse::reflectance), 1) << name;
      EXPECT_FLOAT_EQ(white->at(w, ColorUse::coefficient), 1) << name;
      EXPECT_FLOAT_EQ(white->at(w, ColorUse::radiance), s.illuminant->at(w, ColorUse::radiance)) << name;
    }
    for (size_t i = 0; i < 9; ++i) {
      double sum = 0;
      for (size_t k = 0; k < 3; ++k) sum += s.to_xyz[i / 3 * 3 + k] * s.from_xyz[3 * k + i % 3];
      EXPECT_NEAR(sum, i % 4 == 0 ? 1 : 0, 1e-12);
    }
  }
}

TEST(RgbSpace, WhitesWithoutATable) {
  // The DCI theatre white and a strongly coloured one get a positive spectrum of their own.
  for (const std::array<double, 2>& white : {std::array{0.314, 0.351}, std::array{0.45, 0.30}}) {
    const RgbSpace s = make_rgb_space("own", {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}}, white);
    const Xyz c = to_xyz(*s.illuminant, ColorUse::radiance);
    EXPECT_NEAR(c.x / (c.x + c.y + c.z), white[0], 1e-5);
    EXPECT_NEAR(c.y / (c.x + c.y + c.z), white[1], 1e-5);
    EXPECT_NEAR(c.y, 1, 1e-5);
    for (float w = 400; w <= 700; w += 5) EXPECT_GT(s.illuminant->at(w, ColorUse::radiance), 0);
  }
}

TEST(RgbColor, RoundTripOverTheCube) {
  const RgbSpace& s = rgb_space("srgb");
  double worst = 0, worst_emitted = 0;
  for_cube(8, 0, 1, [&](const Rgb& rgb) {
    const Color c = rgb_color("srgb", rgb[0], rgb[1], rgb[2]);
    worst = std::max(worst, difference(reflected(s, c), rgb));
    worst_emitted = std::max(worst_emitted, difference(emitted(s, c), rgb));
    for (float w = 360; w <= 830; w += 23.5f) {
      EXPECT_GE(c->at(w, ColorUse::reflectance), 0);
      EXPECT_LE(c->at(w, ColorUse::reflectance), 1);
    }
  });
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("worst_emitted", std::to_string(worst_emitted));
  EXPECT_LT(worst, 5e-4);
  EXPECT_LT(worst_emitted, 5e-4);
}

TEST(RgbColor, RoundTripInOtherSpaces) {
  // The cube of a wide space contains colours that no reflectance can have; colours well inside the cube are reproduced.
  for (const char* name : {"display_p3", "rec2020", "acescg"}) {
    const RgbSpace& s = rgb_space(name);
    for_cube(3, 0.2, 0.8, [&](const Rgb& rgb) {
      const Color c = rgb_color(name, rgb[0], rgb[1], rgb[2]);
      EXPECT_LT(difference(reflected(s, c), rgb), 1e-3) << name << " " << rgb[0] << " " << rgb[1] << " " << rgb[2];
      EXPECT_LT(difference(emitted(s, c), rgb), 1e-3) << name << " " << rgb[0] << " " << rgb[1] << " " << rgb[2];
      EXPECT_LT(difference(reflected(s, Color(new Texel(s, rgb))), rgb), 1e-3) << name;
    });
  }
}

TEST(RgbColor, OutOfRange) {
  const RgbSpace& s = rgb_space("srgb");
  EXPECT_LT(difference(reflected(s, rgb_color("srgb", 2, 0.5, -0.5)), {1, 0.5, 0}), 1e-3);
  EXPECT_LT(difference(emitted(s, rgb_color("srgb", 20, 5, -5)), {20, 5, 0}), 1e-2);
  for (const ColorUse use : {ColorUse::reflectance, ColorUse::radiance, ColorUse::coefficient})
    EXPECT_EQ(rgb_color("srgb", 0, 0, 0)->at(550, use), 0);
  EXPECT_THROW(rgb_color("srgb", std::nan(""), 0, 0), Error);
  EXPECT_THROW(rgb_color("srgb", INFINITY, 0, 0), Error);
  EXPECT_THROW(srgb_color(1.1, 0, 0), Error);
  EXPECT_THROW(rgb_color("no_space", 0, 0, 0), Error);
  // Colours that no reflectance can have still give bounded values.
  for (const auto& extreme : {Rgb{1, 0, 0}, Rgb{0, 1, 0}, Rgb{0, 0, 1}, Rgb{0, 1, 1}}) {
    const Color c = rgb_color("aces2065-1", extreme[0], extreme[1], extreme[2]);
    for (float w = 360; w <= 830; w += 10) {
      EXPECT_GE(c->at(w, ColorUse::reflectance), 0);
      EXPECT_LE(c->at(w, ColorUse::reflectance), 1);
    }
  }
}

TEST(RgbColor, CoefficientsScale) {
  const Color one = rgb_color("srgb", 0.2, 0.3, 0.1), ten = rgb_color("srgb", 2, 3, 1);
  for (float w = 360; w <= 830; w += 10)
    EXPECT_NEAR(ten->at(w, ColorUse::coefficient), 10 * one->at(w, ColorUse::coefficient), 1e-5f);
}

TEST(RgbColor, XyzAndEncoded) {
  const RgbSpace& e = rgb_space("xyz");
  EXPECT_LT(difference(reflected(e, xyz_color(0.3, 0.4, 0.25)), {0.3, 0.4, 0.25}), 1e-3);
  const Xyz light = to_xyz(*xyz_color(3, 4, 2.5), ColorUse::radiance);
  EXPECT_NEAR(light.x, 3, 5e-3);
  EXPECT_NEAR(light.y, 4, 5e-3);
  EXPECT_NEAR(light.z, 2.5, 5e-3);
  const Rgb decoded = reflected(rgb_space("srgb"), srgb_color(0.5, 0.25, 1));
  EXPECT_LT(difference(decoded, {decode_transfer("srgb", 0.5), decode_transfer("srgb", 0.25), 1}), 1e-3);
}

TEST(Texel, RoundTripOverTheCube) {
  const RgbSpace& s = rgb_space("srgb");
  double worst = 0, worst_emitted = 0;
  const auto check = [&](const Rgb& rgb) {
    const Texel texel(s, rgb);
    worst = std::max(worst, difference(to_rgb(s, to_xyz(texel, ColorUse::reflectance, s.illuminant.get())), rgb));
    worst_emitted = std::max(worst_emitted, difference(to_rgb(s, to_xyz(texel, ColorUse::radiance)), rgb));
  };
  for_cube(12, 0, 1, check);
  for_cube(6, 0, 0.03, check);
  for_cube(6, 0.97, 1, check);
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("worst_emitted", std::to_string(worst_emitted));
  EXPECT_LT(worst, 1e-3);
  EXPECT_LT(worst_emitted, 1e-3);
}

TEST(Texel, BlackWhiteAndBeyond) {
  const RgbSpace& s = rgb_space("srgb");
  Wavelengths w;
  for (int i = 0; i < spectrum_size; ++i) w.place(i, 400 + 90 * float(i), 1);
  EXPECT_TRUE(rgb_spectrum(s, 0, 0, 0, ColorUse::reflectance, w).black());
  EXPECT_TRUE(rgb_spectrum(s, 0, 0, 0, ColorUse::radiance, w).black());
  EXPECT_TRUE(rgb_spectrum(s, -1, -1, -1, ColorUse::radiance, w).black());
  EXPECT_EQ(rgb_spectrum(s, 1, 1, 1, ColorUse::reflectance, w).minimum(), 1);
  EXPECT_EQ(rgb_spectrum(s, 7, 7, 7, ColorUse::reflectance, w).minimum(), 1);
  EXPECT_FLOAT_EQ(rgb_spectrum(s, 7, 7, 7, ColorUse::coefficient, w).minimum(), 7);
  // NaN stays NaN, so that it is found and reported.
  for (const ColorUse use : {ColorUse::reflectance, ColorUse::radiance, ColorUse::coefficient}) {
    EXPECT_FALSE(rgb_spectrum(s, NAN, 0.5f, 0.5f, use, w).finite());
    EXPECT_FALSE(rgb_spectrum(s, 0.5f, 0.5f, NAN, use, w).finite());
  }
  EXPECT_TRUE(rgb_spectrum(s, 1e-30f, 1e-35f, 0, ColorUse::reflectance, w).finite());
  EXPECT_TRUE(rgb_spectrum(s, 1e-30f, 1e-35f, 0, ColorUse::radiance, w).finite());
  EXPECT_TRUE(rgb_spectrum(s, 1e-44f, 0, 1e-45f, ColorUse::reflectance, w).finite());
  EXPECT_TRUE(rgb_spectrum(s, 1e-44f, 0, 1e-45f, ColorUse::coefficient, w).finite());
  EXPECT_LT(rgb_spectrum(s, 1e-6f, 1e-7f, 0, ColorUse::reflectance, w).maximum(), 1e-5f);
}

TEST(Texel, FirstUseFromManyThreads) {
  // A new space, so that its table has not been built yet.
  const RgbSpace s = make_rgb_space("own", {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, {0.3127, 0.3290});
  std::array<RgbCoefficients, 4> found;
  std::vector<std::thread> threads;
  for (auto& f : found) threads.emplace_back([&] { f = rgb_coefficients(s, 0.3f, 0.4f, 0.6f); });
  for (auto& t : threads) t.join();
  const RgbCoefficients same = rgb_coefficients(rgb_space("srgb"), 0.3f, 0.4f, 0.6f);
  for (const auto& f : found) {
    EXPECT_EQ(f.c0, same.c0);
    EXPECT_EQ(f.c1, same.c1);
    EXPECT_EQ(f.c2, same.c2);
  }
}

}  // namespace
}  // namespace etendue
