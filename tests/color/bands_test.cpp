// Colours and spectra in the bands of an RGB space.

#include "etendue/describe/bands.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "etendue/core/error.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

const Wavelengths& srgb_bands() {
  static const Wavelengths bands = bands_of(rgb_space("srgb"));
  return bands;
}

void expect_bands(const Spectrum& s, double r, double g, double b, double tolerance = 1e-6) {
  const double expected[3] = {r, g, b};
  for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(double(s[i]), expected[i % 3], tolerance) << "lane " << i;
}
void expect_near(const Xyz& a, const Xyz& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Bands, ComponentsOfTheirOwnSpaceAreTakenAsTheyAre) {
  const Color c = rgb_color("srgb", 0.9, 0.1, 2);
  expect_bands(c->evaluate(srgb_bands(), ColorUse::reflectance), 0.9, 0.1, 1);
  expect_bands(c->evaluate(srgb_bands(), ColorUse::radiance), 0.9, 0.1, 2);
  expect_bands(c->evaluate(srgb_bands(), ColorUse::coefficient), 0.9, 0.1, 2);
  expect_bands(rgb_spectrum(rgb_space("srgb"), 0.9f, 0.1f, 2, ColorUse::radiance, srgb_bands()), 0.9, 0.1, 2);
  expect_bands(scaled_spectrum(3, c)->evaluate(srgb_bands(), ColorUse::coefficient), 2.7, 0.3, 6, 1e-5);
  expect_bands(used_spectrum(ColorUse::reflectance, c)->evaluate(srgb_bands(), ColorUse::coefficient), 0.9, 0.1, 1);
}

// IEC 61966-2-1: the luminances of the primaries.
TEST(Bands, TheirColorIsThatOfTheSpace) {
  const Xyz red = to_xyz(band_spectrum(1, 0, 0), srgb_bands()), green = to_xyz(band_spectrum(0, 1, 0), srgb_bands());
  EXPECT_NEAR(red.y, 0.2126, 1e-4);
  EXPECT_NEAR(red.x, 0.4124, 1e-4);
  EXPECT_NEAR(green.y, 0.7152, 1e-4);
  EXPECT_NEAR(to_xyz(Spectrum(1.0f), srgb_bands()).z, 1.0890, 2e-4);
}

// Dispersion would leave the hero alone: such a sample must not pass for a colour.
TEST(Bands, OneAloneIsNoColor) {
  Wavelengths bands = srgb_bands();
  bands.drop_secondary();
  EXPECT_TRUE(std::isnan(to_xyz(Spectrum(1.0f), bands).y));
}

TEST(Bands, LightHasTheColorOfItsSpectrum) {
  for (const Color& light :
       {illuminant_spectrum("D65"), illuminant_spectrum("A"), illuminant_spectrum("F2"), blackbody_spectrum(4000),
        flat_spectrum(3), xyz_color(0.5, 0.6, 0.4), rgb_color("acescg", 0.4, 0.5, 0.6)}) {
    const Xyz exact = to_xyz(*light, ColorUse::radiance);
    const Xyz found = to_xyz(light->evaluate(srgb_bands(), ColorUse::radiance), srgb_bands());
    expect_near(found, exact, 1e-4 * exact.y);
  }
}

// Mitsuba 3.9.1, scalar_rgb, prints these of <spectrum value="400:1, 500:1.2, 600:0.2, 700:0.5"> as a reflectance, before it
// clips them to [0, 1]. It integrates with steps of 0.47 nm and its own tables.
TEST(Bands, ReflectancesAreSeenUnderTheWhiteAsInMitsuba) {
  const Color paint = table_spectrum({400, 500, 600, 700}, {1, 1.2f, 0.2f, 0.5f});
  expect_bands(paint->evaluate(srgb_bands(), ColorUse::coefficient), 0.0158166, 0.795784, 1.15933, 2e-3);
  expect_bands(paint->evaluate(srgb_bands(), ColorUse::reflectance), 0.0158166, 0.795784, 1, 2e-3);
}

TEST(Bands, WhatIsTheSameEverywhereIsTheSameInAllBands) {
  const Color flat = table_spectrum({300, 900}, {0.4f, 0.4f});
  const Spectrum s = flat->evaluate(srgb_bands(), ColorUse::coefficient);
  EXPECT_EQ(s.minimum(), 0.4f);
  EXPECT_EQ(s.maximum(), 0.4f);
  expect_bands(flat_spectrum(0.7f)->evaluate(srgb_bands(), ColorUse::reflectance), 0.7, 0.7, 0.7);
}

// A colour of another space as a texel, which is converted by a matrix, and as a spectrum, which is integrated.
TEST(Bands, ColorsOfOtherSpacesLookTheSame) {
  const RgbSpace& aces = rgb_space("acescg");
  expect_bands(rgb_spectrum(aces, 1, 1, 1, ColorUse::reflectance, srgb_bands()), 1, 1, 1, 2e-5);
  for (const std::array<float, 3>& c : {std::array{0.4f, 0.5f, 0.6f}, std::array{0.5f, 0.35f, 0.3f}}) {
    const Color whole = rgb_color("acescg", double(c[0]), double(c[1]), double(c[2]));
    const Spectrum exact = whole->evaluate(srgb_bands(), ColorUse::reflectance);
    expect_bands(rgb_spectrum(aces, c[0], c[1], c[2], ColorUse::reflectance, srgb_bands()), double(exact[0]), double(exact[1]),
                 double(exact[2]), 6e-3);
    const Xyz light = to_xyz(rgb_spectrum(aces, c[0], c[1], c[2], ColorUse::radiance, srgb_bands()), srgb_bands());
    expect_near(light, to_xyz(*whole, ColorUse::radiance), 1e-3);
  }
}

TEST(Bands, OfASpaceWithoutANameThereAreNone) {
  const RgbSpace own = make_rgb_space("mine", {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}}, {0.3127, 0.3290});
  EXPECT_THROW(bands_of(own), Error);
}

TEST(Bands, ValuesAreComputedByManyThreads) {
  const Color light = blackbody_spectrum(3000);
  std::vector<Spectrum> found(8);
  std::vector<std::thread> threads;
  for (size_t i = 0; i < found.size(); ++i)
    threads.emplace_back([&, i] { found[i] = light->evaluate(srgb_bands(), ColorUse::radiance); });
  for (std::thread& t : threads) t.join();
  for (const Spectrum& s : found) EXPECT_EQ(s[0], found[0][0]);
}

// The midpoint rule with steps of 5 nm against the sum with steps of 1 nm.
TEST(Bands, FunctionsOfTheWavelengthAreProjected) {
  const Color light = blackbody_spectrum(2856);
  const Spectrum exact = light->evaluate(srgb_bands(), ColorUse::radiance);
  const Spectrum found = projected([&](float w) { return light->at(w, ColorUse::radiance); }, ColorUse::radiance, srgb_bands());
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], exact[i], 1e-3f * exact.maximum());
  const RgbCoefficients c = rgb_coefficients(rgb_space("srgb"), 0.6f, 0.3f, 0.1f);
  expect_bands(c.evaluate(srgb_bands()), 0.6, 0.3, 0.1, 3e-3);
}

}  // namespace
}  // namespace etendue
