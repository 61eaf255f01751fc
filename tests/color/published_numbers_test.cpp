// Numbers of colour published by others, typed from their sources: colour spaces, transfer functions, illuminants, the
// observer, black bodies. Tables that other tests compare with whole files are checked here against some of their published
// rows, so that an accidentally changed digit is noticed without any file outside the repository.

#include <gtest/gtest.h>

#include <cmath>

#include "etendue/describe/color.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

// ---- colour spaces ----------------------------------------------------------------------------------------------------------

// Matrices from RGB to XYZ as the standards print them (and as Lindbloom's tables and the Academy's documents do).
TEST(PublishedNumbers, MatricesOfAllSpaces) {
  const struct {
    const char* name;
    double matrix[9], tolerance;
  } spaces[] = {{"srgb",  // IEC 61966-2-1
                 {0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505},
                 1e-4},
                {"display_p3",  // SMPTE EG 432-1 with the white D65
                 {0.486571, 0.265668, 0.198217, 0.228975, 0.691739, 0.079287, 0.000000, 0.045113, 1.043944},
                 6e-5},
                {"rec2020",  // ITU-R BT.2020-2 and BT.2087
                 {0.636958, 0.144617, 0.168881, 0.262700, 0.677998, 0.059302, 0.000000, 0.028073, 1.060985},
                 6e-5},
                {"adobe_rgb",  // Adobe RGB (1998) Color Image Encoding, section 4.3.5.3
                 {0.57667, 0.18556, 0.18823, 0.29734, 0.62736, 0.07529, 0.02703, 0.07069, 0.99134},
                 6e-5},
                {"aces2065-1",  // SMPTE ST 2065-1, table 2
                 {0.9525523959, 0, 0.0000936786, 0.3439664498, 0.7281660966, -0.0721325464, 0, 0, 1.0088251844},
                 1e-9},
                {"acescg",  // Academy S-2014-004, appendix A
                 {0.6624541811, 0.1340042065, 0.1561876870, 0.2722287168, 0.6740817658, 0.0536895174, -0.0055746495,
                  0.0040607335, 1.0103391003},
                 1e-9}};
  for (const auto& s : spaces)
    for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(rgb_space(s.name).to_xyz[i], s.matrix[i], s.tolerance) << s.name << " " << i;
  // The inverse matrices (ITU-R BT.2020's luma, S-2014-004).
  const double from[] = {1.6410233797, -0.3248032942, -0.2364246952, -0.6636628587, 1.6153315917,
                         0.0167563477, 0.0117218943,  -0.0082844420, 0.9883948585};
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(rgb_space("acescg").from_xyz[i], from[i], 1e-9) << i;
}

// As radiance, (1, 1, 1) of each space has that space's white, and (r, g, b) has the colour that the matrix gives.
TEST(PublishedNumbers, LightsHaveTheirSpacesWhite) {
  for (const std::string& name : rgb_space_names()) {
    const RgbSpace& space = rgb_space(name);
    for (const auto& rgb : {std::array{1.0, 1.0, 1.0}, {0.7, 0.5, 0.4}}) {
      const Xyz c = to_xyz(*rgb_color(name, rgb[0], rgb[1], rgb[2]), ColorUse::radiance);
      const auto row = [&](size_t r) {
        return space.to_xyz[3 * r] * rgb[0] + space.to_xyz[3 * r + 1] * rgb[1] + space.to_xyz[3 * r + 2] * rgb[2];
      };
      EXPECT_NEAR(c.x, row(0), 2e-3) << name;
      EXPECT_NEAR(c.y, row(1), 2e-3) << name;
      EXPECT_NEAR(c.z, row(2), 2e-3) << name;
    }
  }
}

TEST(PublishedNumbers, TransferFunctions) {
  // IEC 61966-2-1: 8-bit codes and their linear values.
  EXPECT_NEAR(decode_transfer("srgb", 10 / 255.0), 0.003035, 1e-6);
  EXPECT_NEAR(decode_transfer("srgb", 64 / 255.0), 0.051269, 1e-6);
  EXPECT_NEAR(decode_transfer("srgb", 188 / 255.0), 0.502886, 1e-6);
  EXPECT_NEAR(encode_transfer("srgb", 0.18), 0.461356, 1e-6);
  EXPECT_NEAR(encode_transfer("srgb", 0.002), 0.02584, 1e-6);
  // ITU-R BT.709-6, section 1.2: 1.099 L^0.45 - 0.099, and 4.5 L below 0.018.
  for (const double l : {0.02, 0.18, 0.4, 0.9})
    EXPECT_NEAR(encode_transfer("rec709", l), 1.099 * std::pow(l, 0.45) - 0.099, 4e-4) << l;
  EXPECT_NEAR(encode_transfer("rec709", 0.01), 0.045, 1e-9);
  EXPECT_NEAR(decode_transfer("rec709", 0.5), 0.259589, 2e-4);
  EXPECT_NEAR(decode_transfer("gamma2.2", 0.5), 0.217638, 1e-6);
  EXPECT_NEAR(encode_transfer("gamma2.2", 0.18), 0.458657, 1e-6);
}

// ---- illuminants, observer
// ----------------------------------------------------------------------------------------------------

// Rows of CIE 15: relative powers, F11's in its own units; only ratios count.
TEST(PublishedNumbers, RowsOfIlluminants) {
  const struct {
    const char* name;
    double wavelength, power;
  } rows[] = {{"A", 400, 14.708},    {"A", 450, 33.0859},   {"A", 500, 59.8611},   {"A", 560, 100},      {"A", 600, 129.043},
              {"A", 650, 165.028},   {"A", 700, 198.261},   {"A", 780, 241.675},   {"D50", 400, 49.308}, {"D50", 450, 87.247},
              {"D50", 500, 95.724},  {"D50", 560, 100},     {"D50", 600, 97.688},  {"D50", 650, 95.667}, {"D50", 700, 91.604},
              {"D65", 400, 82.7549}, {"D65", 450, 117.008}, {"D65", 500, 109.354}, {"D65", 560, 100},    {"D65", 600, 90.0062},
              {"D65", 650, 80.0268}, {"D65", 700, 71.6091}, {"F2", 435, 34.98},    {"F2", 560, 16.16},   {"F2", 545, 24.88},
              {"F2", 600, 16.54},    {"F2", 650, 4.68},     {"F11", 435, 33.94},   {"F11", 545, 72.84},  {"F11", 560, 2.83},
              {"F11", 610, 55.27},   {"F11", 490, 14.96},   {"F11", 585, 14.76},   {"F11", 540, 39.59},  {"F11", 615, 42.58}};
  for (const auto& r : rows) {
    const Color light = illuminant_spectrum(r.name);
    const double reference = std::string(r.name) == "F11" ? 2.83 : std::string(r.name) == "F2" ? 16.16 : 100;
    EXPECT_NEAR(double(light->at(float(r.wavelength), ColorUse::radiance) / light->at(560, ColorUse::radiance)),
                r.power / reference, 2e-6 * r.power / reference)
        << r.name << " " << r.wavelength;
  }
  // Chromaticities of CIE 15:2004, tables T.3 and T.8; they depend on the whole spectrum.
  const struct {
    const char* name;
    double x, y;
  } whites[] = {{"A", 0.44758, 0.40745}, {"D50", 0.34567, 0.35851}, {"D65", 0.31272, 0.32903},
                {"E", 1.0 / 3, 1.0 / 3}, {"F2", 0.3721, 0.3751},    {"F11", 0.3805, 0.3769}};
  for (const auto& w : whites) {
    const Xyz c = to_xyz(*illuminant_spectrum(w.name), ColorUse::radiance);
    const double tolerance = w.name[0] == 'F' ? 3e-4 : w.name[0] == 'E' ? 1e-4 : 3e-5;
    EXPECT_NEAR(c.x / (c.x + c.y + c.z), w.x, tolerance) << w.name;
    EXPECT_NEAR(c.y / (c.x + c.y + c.z), w.y, tolerance) << w.name;
  }
}

// CIE 15: every tenth nanometre where the eye is most sensitive, in the order xbar, ybar, zbar.
TEST(PublishedNumbers, RowsOfTheObserver) {
  constexpr double rows[][4] = {
      {380, 0.001368, 0.000039, 0.00645}, {400, 0.01431, 0.000396, 0.06785}, {420, 0.13438, 0.004, 0.6456},
      {430, 0.2839, 0.0116, 1.3856},      {440, 0.34828, 0.023, 1.74706},    {450, 0.3362, 0.038, 1.77211},
      {460, 0.2908, 0.06, 1.6692},        {470, 0.19536, 0.09098, 1.28764},  {480, 0.09564, 0.13902, 0.81295},
      {490, 0.03201, 0.20802, 0.46518},   {500, 0.0049, 0.323, 0.272},       {510, 0.0093, 0.503, 0.1582},
      {520, 0.06327, 0.71, 0.07825},      {530, 0.1655, 0.862, 0.04216},     {540, 0.2904, 0.954, 0.0203},
      {550, 0.43345, 0.99495, 0.00875},   {560, 0.5945, 0.995, 0.0039},      {570, 0.7621, 0.952, 0.0021},
      {580, 0.9163, 0.87, 0.00165},       {590, 1.0263, 0.757, 0.0011},      {600, 1.0622, 0.631, 0.0008},
      {610, 1.0026, 0.503, 0.00034},      {620, 0.85445, 0.381, 0.00019},    {630, 0.6424, 0.265, 0.00005},
      {640, 0.4479, 0.175, 0.00002},      {650, 0.2835, 0.107, 0},           {660, 0.1649, 0.061, 0},
      {680, 0.04677, 0.017, 0},           {700, 0.011359, 0.004102, 0},      {750, 0.000332, 0.00012, 0}};
  for (const auto& r : rows) {
    const Xyz o = observer(float(r[0]));
    EXPECT_NEAR(o.x, r[1], 6e-6) << r[0];
    EXPECT_NEAR(o.y, r[2], 6e-6) << r[0];
    EXPECT_NEAR(o.z, r[3], 6e-6) << r[0];
  }
  // Between these rows the functions are smooth: no value departs from the cubic through its neighbours.
  for (int l = 382; l <= 690; ++l) {
    const auto at = [](int x) { return observer(float(x)); };
    const Xyz a = at(l - 2), b = at(l - 1), c = at(l), d = at(l + 1), e = at(l + 2);
    const auto smooth = [&](double v, double w, double x, double y, double z) {
      EXPECT_NEAR(x, (4 * (w + y) - v - z) / 6, 4e-4 + 2e-3 * x) << l;
    };
    smooth(a.x, b.x, c.x, d.x, e.x);
    smooth(a.y, b.y, c.y, d.y, e.y);
    smooth(a.z, b.z, c.z, d.z, e.z);
  }
  // The three functions have equal areas, to the digits of the tables.
  double x = 0, z = 0;
  for (int l = 360; l <= 830; ++l) x += observer(float(l)).x, z += observer(float(l)).z;
  EXPECT_NEAR(x, 106.865469, 2e-6);
  EXPECT_NEAR(z, 106.892251, 2e-6);
}

// Wien's law and the Stefan-Boltzmann law follow from Planck's law, with constants of their own (CODATA 2018).
TEST(PublishedNumbers, BlackBodies) {
  for (const double kelvin : {2856.0, 5778.0, 12000.0}) {
    const Color body = blackbody_spectrum(kelvin);
    double power = 0, highest = 0, at = 0;
    // Integrated in steps of constant relative size over the whole spectrum, far beyond the visible range.
    for (double l = 20; l < 4e6; l *= 1.0005) {
      const double value = double(body->at(float(l * 1.00025), ColorUse::radiance));
      power += value * l * 0.0005;
    }
    EXPECT_NEAR(M_PI * power, 5.670374419e-8 * std::pow(kelvin, 4), 3e-4 * 5.670374419e-8 * std::pow(kelvin, 4)) << kelvin;
    for (double l = 100; l < 2000; l += 0.1)
      if (const double value = double(body->at(float(l), ColorUse::radiance)); value > highest) highest = value, at = l;
    EXPECT_NEAR(at, 2.897771955e6 / kelvin, 0.3) << kelvin;
  }
  // CODATA 2018 first and second radiation constants: c1L = 1.191042972e-16 W m^2 / sr, c2 = 1.438776877e-2 m K.
  for (const double kelvin : {1500.0, 6504.0})
    for (const double l : {400.0, 555.0, 780.0}) {
      const double planck = 1.191042972e-16 / std::pow(l * 1e-9, 5) / std::expm1(1.438776877e-2 / (l * 1e-9 * kelvin)) * 1e-9;
      const Color body = blackbody_spectrum(kelvin);
      EXPECT_NEAR(double(body->at(float(l), ColorUse::radiance)), planck, 2e-6 * planck);
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, float(l), 1);
      EXPECT_NEAR(double(body->evaluate(w, ColorUse::radiance)[1]), planck, 2e-6 * planck);
    }
}

}  // namespace
}  // namespace etendue
