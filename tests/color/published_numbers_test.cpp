// Numbers that others have published, typed from where they stand: colour spaces, transfer functions, illuminants, the
// observer, metals, glasses, black bodies, paints, hair, translucent bodies. The tables that are read elsewhere are held to
// some of their rows here, so that a digit that was changed by mistake is noticed without any file beside the repository.

#include <gtest/gtest.h>

#include <cmath>

#include "components/shaders/fresnel.h"
#include "components/shaders/hair/hair.h"
#include "components/shaders/subsurface/diffusion_profile.h"
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
  // And back (ITU-R BT.2020's luma, S-2014-004).
  const double from[] = {1.6410233797, -0.3248032942, -0.2364246952, -0.6636628587, 1.6153315917,
                         0.0167563477, 0.0117218943,  -0.0082844420, 0.9883948585};
  for (size_t i = 0; i < 9; ++i) EXPECT_NEAR(rgb_space("acescg").from_xyz[i], from[i], 1e-9) << i;
}

// A light of each space's (1, 1, 1) has that space's white, and one of (r, g, b) has the colour the matrix says.
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
  // Chromaticities of CIE 15:2004, tables T.3 and T.8; all of the spectrum counts for them.
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

// CIE 15: every tenth nanometre of where the eye sees most, in the order xbar, ybar, zbar.
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
  // Between them the functions are smooth: no row departs from the cubic through its neighbours.
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
  // Equal areas, to the digits of the tables.
  double x = 0, z = 0;
  for (int l = 360; l <= 830; ++l) x += observer(float(l)).x, z += observer(float(l)).z;
  EXPECT_NEAR(x, 106.865469, 2e-6);
  EXPECT_NEAR(z, 106.892251, 2e-6);
}

// Wien's and Stefan and Boltzmann's laws are consequences of Planck's, with constants of their own (CODATA 2018).
TEST(PublishedNumbers, BlackBodies) {
  for (const double kelvin : {2856.0, 5778.0, 12000.0}) {
    const Color body = blackbody_spectrum(kelvin);
    double power = 0, highest = 0, at = 0;
    // In steps of relative size; all of it, far beyond what is seen.
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

// ---- metals, glasses, paints
// ----------------------------------------------------------------------------------------------------

// Rows of the luxpop.com tables as Mitsuba distributes them (ior/*.spd).
TEST(PublishedNumbers, RowsOfMetals) {
  const struct {
    const char* name;
    double wavelength, n, k;
  } rows[] = {{"Au", 413.280579, 1.636, 1.958}, {"Au", 459.200653, 1.426, 1.846},       {"Au", 495.936707, 0.916, 1.84},
              {"Au", 516.600769, 0.608, 2.12},  {"Au", 551.040771, 0.3455, 2.730625},   {"Au", 590.400818, 0.236, 2.97},
              {"Au", 652.548279, 0.166, 3.15},  {"Au", 708.481018, 0.160875, 4.087687}, {"Ag", 427.531647, 0.16, 2.26},
              {"Ag", 459.200653, 0.144, 2.56},  {"Ag", 495.936707, 0.13, 2.88},         {"Ag", 539.061646, 0.129, 3.25},
              {"Ag", 563.564453, 0.12, 3.45},   {"Ag", 590.400818, 0.121, 3.66},        {"Ag", 619.920898, 0.131, 3.88},
              {"Ag", 688.800964, 0.14, 4.44},   {"Al", 539.061646, 0.912, 6.55},        {"Al", 551.040771, 0.963, 6.7},
              {"Al", 527.592224, 0.867, 6.42},  {"Al", 563.564453, 1.02, 6.85},         {"Cu", 539.061646, 1.04, 2.583},
              {"Cu", 563.564453, 0.826, 2.599}, {"Cu", 551.040771, 0.950375, 2.5765},   {"Cr", 409.175018, 1.54, 3.71},
              {"Cr", 455.80899, 1.99, 4.22},    {"Cr", 490.040009, 2.49, 4.44},         {"Cr", 532.102966, 2.98, 4.45},
              {"Cr", 582.06604, 3.34, 4.38},    {"Cr", 610.739014, 3.48, 4.36},         {"Cr", 700.452026, 3.84, 4.37}};
  for (const auto& r : rows) {
    const Color metal = metal_index(r.name);
    EXPECT_NEAR(double(metal->at(float(r.wavelength), ColorUse::coefficient)), r.n, 2e-4 * r.n) << r.name << r.wavelength;
    EXPECT_NEAR(double(metal->imaginary()->at(float(r.wavelength), ColorUse::coefficient)), r.k, 2e-4 * r.k)
        << r.name << r.wavelength;
  }
  // Measured curves are smooth: no row departs far from its neighbours' mean.
  for (const std::string& name : metal_names()) {
    const Color metal = metal_index(name);
    for (double l = 410; l < 760; l += 5)
      for (const Color& part : {metal, metal->imaginary()}) {
        const auto at = [&](double x) { return double(part->at(float(x), ColorUse::coefficient)); };
        EXPECT_NEAR(at(l), (at(l - 25) + at(l + 25)) / 2, 0.07 * at(l) + 0.07) << name << " at " << l;
      }
  }
}

// Other people's numbers: the reflectance of mirrors straight on, as handbooks give them (CRC Handbook, section 12, at about
// 550 and 650 nm; rounded, and of films of several makes).
TEST(PublishedNumbers, ReflectancesOfMetals) {
  const struct {
    const char* name;
    double wavelength, reflectance, tolerance;
  } rows[] = {{"Ag", 550, 0.96, 0.02},  {"Ag", 650, 0.97, 0.02}, {"Al", 550, 0.915, 0.01}, {"Al", 650, 0.905, 0.012},
              {"Au", 450, 0.385, 0.03}, {"Au", 650, 0.95, 0.03}, {"Cu", 650, 0.95, 0.04},  {"Cr", 550, 0.68, 0.03}};
  for (const auto& r : rows) {
    const Color metal = metal_index(r.name);
    EXPECT_NEAR(double(fresnel_conductor(1, metal->at(float(r.wavelength), ColorUse::coefficient),
                                         metal->imaginary()->at(float(r.wavelength), ColorUse::coefficient))),
                r.reflectance, r.tolerance)
        << r.name << " " << r.wavelength;
  }
}

// Indices at g, F, e, d, C and r of the makers' data sheets, and of the papers the formulas are from.
TEST(PublishedNumbers, IndicesOfGlasses) {
  const struct {
    const char* name;
    double wavelength, n;
  } rows[] = {{"N-BK7", 435.8343, 1.52668},
              {"N-BK7", 486.1327, 1.52238},
              {"N-BK7", 587.5618, 1.51680},
              {"N-BK7", 706.5188, 1.51289},
              {"N-SF11", 435.8343, 1.82533},
              {"N-SF11", 587.5618, 1.78472},
              {"N-SF11", 656.2725, 1.77596},
              {"F2", 435.8343, 1.64202},
              {"F2", 587.5618, 1.62004},
              {"F2", 656.2725, 1.61503},
              {"fused silica", 404.656, 1.46962},
              {"fused silica", 589.29, 1.45841},
              {"fused silica", 706.519, 1.45515},
              {"diamond", 486.133, 2.43554},
              {"diamond", 589.29, 2.41726},
              {"diamond", 656.28, 2.40990},
              {"water", 400, 1.343557},
              {"water", 590, 1.333327},
              {"water", 700, 1.330518}};
  for (const auto& r : rows)
    EXPECT_NEAR(double(glass_index(r.name)->at(float(r.wavelength), ColorUse::coefficient)), r.n, 4e-5)
        << r.name << " " << r.wavelength;
}

// Six patches of the ColorChecker. Reflectances every 10 nm from 380 nm: Copyright (C) 2004-2012 Danny Pascale
// (www.babelcolor.com), the average of 30 charts; used by permission. X, Y, Z under D65, A and D50 with a white of Y = 100.
TEST(PublishedNumbers, PaintsUnderThreeLights) {
  const struct {
    const char* name;
    std::vector<float> reflectance;
    double xyz[9];
  } patches[] = {{"dark_skin",
                  {0.055f, 0.058f, 0.061f, 0.062f, 0.062f, 0.062f, 0.062f, 0.062f, 0.062f, 0.062f, 0.062f, 0.063f,
                   0.065f, 0.07f,  0.076f, 0.079f, 0.081f, 0.084f, 0.091f, 0.103f, 0.119f, 0.134f, 0.143f, 0.147f,
                   0.151f, 0.158f, 0.168f, 0.179f, 0.188f, 0.19f,  0.186f, 0.181f, 0.182f, 0.187f, 0.196f, 0.209f},
                  {11.145, 10.077, 6.805, 14.715, 11.221, 2.245, 11.802, 10.332, 5.167}},
                 {"red",
                  {0.05f,  0.049f, 0.048f, 0.047f, 0.047f, 0.047f, 0.047f, 0.047f, 0.046f, 0.045f, 0.044f, 0.044f,
                   0.045f, 0.046f, 0.047f, 0.048f, 0.049f, 0.05f,  0.054f, 0.06f,  0.072f, 0.104f, 0.178f, 0.312f,
                   0.467f, 0.581f, 0.644f, 0.675f, 0.69f,  0.698f, 0.706f, 0.715f, 0.724f, 0.73f,  0.734f, 0.738f},
                  {19.615, 11.751, 5.027, 31.199, 16.397, 1.642, 22.002, 12.747, 3.806}},
                 {"green",
                  {0.052f, 0.053f, 0.054f, 0.055f, 0.057f, 0.059f, 0.061f, 0.066f, 0.075f, 0.093f, 0.125f, 0.178f,
                   0.246f, 0.307f, 0.337f, 0.334f, 0.317f, 0.293f, 0.262f, 0.23f,  0.198f, 0.165f, 0.135f, 0.115f,
                   0.104f, 0.098f, 0.094f, 0.092f, 0.093f, 0.097f, 0.102f, 0.108f, 0.113f, 0.115f, 0.114f, 0.114f},
                  {14.670, 23.405, 9.908, 16.670, 21.396, 3.774, 15.019, 23.048, 7.830}},
                 {"blue",
                  {0.066f, 0.079f, 0.102f, 0.146f, 0.2f,   0.244f, 0.282f, 0.309f, 0.308f, 0.278f, 0.231f, 0.178f,
                   0.13f,  0.094f, 0.07f,  0.054f, 0.046f, 0.042f, 0.039f, 0.038f, 0.038f, 0.038f, 0.038f, 0.039f,
                   0.039f, 0.04f,  0.041f, 0.042f, 0.044f, 0.045f, 0.046f, 0.046f, 0.048f, 0.052f, 0.057f, 0.065f},
                  {7.966, 6.140, 28.217, 5.627, 5.023, 8.883, 6.954, 5.817, 21.287}},
                 {"yellow",
                  {0.058f, 0.054f, 0.052f, 0.052f, 0.053f, 0.054f, 0.056f, 0.059f, 0.067f, 0.081f, 0.107f, 0.152f,
                   0.225f, 0.336f, 0.462f, 0.559f, 0.616f, 0.65f,  0.672f, 0.694f, 0.71f,  0.723f, 0.731f, 0.739f,
                   0.746f, 0.752f, 0.758f, 0.764f, 0.769f, 0.771f, 0.776f, 0.782f, 0.79f,  0.796f, 0.799f, 0.804f},
                  {56.025, 59.363, 9.324, 75.903, 64.733, 3.723, 60.284, 60.752, 7.438}},
                 {"neutral_5",
                  {0.105f, 0.131f, 0.163f, 0.18f,  0.186f, 0.19f,  0.193f, 0.194f, 0.194f, 0.192f, 0.191f, 0.191f,
                   0.191f, 0.192f, 0.192f, 0.192f, 0.192f, 0.192f, 0.192f, 0.193f, 0.192f, 0.192f, 0.191f, 0.189f,
                   0.188f, 0.186f, 0.184f, 0.182f, 0.181f, 0.179f, 0.178f, 0.176f, 0.174f, 0.173f, 0.172f, 0.171f},
                  {18.069, 19.128, 20.868, 20.773, 19.073, 6.829, 18.308, 19.116, 15.827}}};
  std::vector<float> wavelengths;
  for (int l = 380; l <= 730; l += 10) wavelengths.push_back(float(l));
  // The numbers' white is that of the measured range alone.
  const Color white = table_spectrum({380, 730}, {1, 1});
  for (const auto& patch : patches) {
    const Color paint = table_spectrum(wavelengths, patch.reflectance);
    size_t i = 0;
    for (const char* light : {"D65", "A", "D50"}) {
      const Color illuminant = illuminant_spectrum(light);
      const double scale = 100 / to_xyz(*white, ColorUse::reflectance, illuminant.get()).y;
      const Xyz c = scale * to_xyz(*paint, ColorUse::reflectance, illuminant.get());
      for (const double value : {c.x, c.y, c.z}) EXPECT_NEAR(value, patch.xyz[i++], 6e-4) << patch.name << " under " << light;
    }
  }
}

// ---- hair -------------------------------------------------------------------------------------------------------------------

// What a fibre absorbs: rays followed through a cylinder of radius 1 in three dimensions, by Snell's law with vectors.
TEST(HairNumbers, AttenuationIsThatOfRaysThroughACylinder) {
  constexpr float eta = 1.55f;
  const HairFibre fibre(0.3f, 0.3f, 0, eta);
  for (const double theta : {0.0, 0.5, 1.1, -0.9})
    for (const double h : {-0.8, 0.0, 0.35, 0.95}) {
      const float sigma = 0.4f;
      const auto s = fibre.section(float(std::sin(theta)), float(std::cos(theta)), float(h), Spectrum(sigma));
      // The ray comes along d and meets the cylinder about x where the offset is h.
      const double n[3] = {0, h, std::sqrt(1 - h * h)}, d[3] = {-std::sin(theta), 0, -std::cos(theta)};
      const double c = -(d[1] * n[1] + d[2] * n[2]), b = std::sqrt(1 - (1 - c * c) / double(eta * eta));
      double t[3];
      for (int i = 0; i < 3; ++i) t[i] = d[i] / double(eta) + (c / double(eta) - b) * n[i];
      // Until it meets the cylinder again: |n + l t| = 1 across the axis.
      const double a = t[1] * t[1] + t[2] * t[2], length = -2 * (n[1] * t[1] + n[2] * t[2]) / a;
      const double T = std::exp(-double(sigma) * length), F = double(fresnel_dielectric(float(c), eta));
      EXPECT_NEAR(double(s.attenuation[0][0]), F, 1e-5);
      EXPECT_NEAR(double(s.attenuation[1][0]), (1 - F) * (1 - F) * T, 2e-5) << theta << " " << h;
      EXPECT_NEAR(double(s.attenuation[2][0]), (1 - F) * (1 - F) * T * F * T, 2e-5) << theta << " " << h;
      double rest = 0;
      for (int k = 3; k < 60; ++k) rest += (1 - F) * (1 - F) * T * std::pow(F * T, k - 1);
      EXPECT_NEAR(double(s.attenuation[3][0]), rest, 2e-5) << theta << " " << h;
    }
}

// Chiang et al. 2016, equations 7 and 8: variances of the longitudinal lobes, which M spreads sin(theta) by, and the scale of
// the azimuthal ones. M: d'Eon et al. 2011, here without logarithms and with the integral form of I0.
TEST(HairNumbers, LobesHaveTheWidthsOfThePaper) {
  for (const double beta : {0.3, 0.6, 0.9})
    for (const double tilt : {0.0, 0.05}) {
      const HairFibre fibre(float(beta), float(beta), float(tilt), 1.55f);
      const double v0 = std::pow(0.726 * beta + 0.812 * beta * beta + 3.7 * std::pow(beta, 20), 2);
      const double v[] = {v0, v0 / 4, 4 * v0, 4 * v0}, angle[] = {-2 * tilt, tilt, 4 * tilt, 0};
      for (int p = 0; p < 4; ++p)
        for (const double out : {-0.4, 0.1, 0.9})
          for (const double in : {-0.8, 0.0, 0.45}) {
            const double moved = out + angle[p], k = 1 / v[p], x = k * std::cos(in) * std::cos(moved);
            double bessel = 0;  // of e^-x I0(x)
            for (int i = 0; i < 400; ++i) bessel += std::exp(x * (std::cos(M_PI * (i + 0.5) / 400) - 1)) / 400;
            const double M = bessel * std::exp(x - k * std::sin(in) * std::sin(moved) - k) * k / (1 - std::exp(-2 * k));
            EXPECT_NEAR(double(fibre.longitudinal(p, float(std::sin(out)), float(std::cos(out)), float(std::sin(in)),
                                                  float(std::cos(in)))),
                        M, 1e-3 * M + 1e-6)
                << beta << " " << p << " " << out << " " << in;
          }
      // N falls off as a logistic density of scale s; at its middle it is 1 / (4 s) over its mass within half a turn.
      const double s = std::sqrt(M_PI / 8) * (0.265 * beta + 1.194 * beta * beta + 5.372 * std::pow(beta, 22));
      const auto section = fibre.section(0, 1, 0, Spectrum());
      const double mass = std::tanh(M_PI / (2 * s));
      EXPECT_NEAR(double(fibre.azimuthal(0, section, 0)), 1 / (4 * s * mass), 1e-4 / s) << beta;
      EXPECT_NEAR(double(fibre.azimuthal(1, section, float(M_PI))), 1 / (4 * s * mass), 1e-4 / s) << beta;
      const double e = std::exp(-0.3 / s);
      EXPECT_NEAR(double(fibre.azimuthal(0, section, 0.3f)), e / (s * (1 + e) * (1 + e) * mass), 1e-4 / s) << beta;
    }
}

// Chiang et al. 2016, equation 9: sigma_a = (ln C / (5.969 - 0.215 b + 2.532 b^2 - 10.73 b^3 + 5.574 b^4 + 0.245 b^5))^2.
TEST(HairNumbers, AbsorptionOfAColor) {
  for (const double b : {0.2, 0.5, 0.8, 1.0}) {
    const HairFibre fibre(0.3f, float(b), 0, 1.55f);
    const double fit = 5.969 - 0.215 * b + 2.532 * b * b - 10.73 * b * b * b + 5.574 * std::pow(b, 4) + 0.245 * std::pow(b, 5);
    for (const double c : {0.02, 0.3, 0.85}) {
      const double expected = std::pow(std::log(c) / fit, 2);
      EXPECT_NEAR(double(fibre.absorption_of(Spectrum(float(c)))[0]), expected, 1e-4 * expected) << b << " " << c;
    }
  }
}

// d'Eon et al. 2011 (as pbrt has it): eumelanin absorbs (0.419, 0.697, 1.37) and pheomelanin (0.187, 0.4, 1.05) of red, green
// and blue. The spectra are power laws, which meet green exactly and the others within 3 %. Read back from the light that goes
// straight through the middle of a wide flat lobe: A1 / A1 without pigment is exp(-2 sigma).
TEST(HairNumbers, Melanin) {
  const auto absorbed = [](double black, double red, float wavelength) {
    const auto through = [&](double e, double p) {
      const Ref<Shader> shader = test::create<Shader>("HairShader", {{"eumelanin", e},
                                                                     {"pheomelanin", p},
                                                                     {"tilt", 0.0},
                                                                     {"longitudinal_roughness", 0.05},
                                                                     {"azimuthal_roughness", 0.05}});
      SurfacePoint point = test::surface_point({0, 0, 1});
      point.dpdu = {1, 0, 0};
      point.uv = {0.3f, 0.5f};
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, wavelength, 1);
      Arena arena;
      return double(shader->bind(point, w, arena)->evaluate({0, 0, 1}, {0, 0, -1})[0]);
    };
    return -0.5 * std::log(through(black, red) / through(0, 0));
  };
  EXPECT_NEAR(absorbed(1, 0, 550), 0.697, 2e-3);
  EXPECT_NEAR(absorbed(0, 1, 550), 0.4, 2e-3);
  EXPECT_NEAR(absorbed(1, 0, 645), 0.419, 0.03 * 0.419);
  EXPECT_NEAR(absorbed(1, 0, 450), 1.37, 0.03 * 1.37);
  EXPECT_NEAR(absorbed(0, 1, 645), 0.187, 0.03 * 0.187);
  EXPECT_NEAR(absorbed(0, 1, 450), 1.05, 0.03 * 1.05);
  // Donner & Jensen 2006: the laws' exponents.
  EXPECT_NEAR(std::log(absorbed(1, 0, 420) / absorbed(1, 0, 680)) / std::log(680 / 420.0), 3.33, 0.01);
  EXPECT_NEAR(std::log(absorbed(0, 1, 420) / absorbed(0, 1, 680)) / std::log(680 / 420.0), 4.75, 0.01);
  EXPECT_NEAR(absorbed(0.5, 0.25, 550), 0.5 * 0.697 + 0.25 * 0.4, 2e-3);
}

// ---- translucent bodies
// -------------------------------------------------------------------------------------------------------

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
    // The paper's distribution function, 1 - e^-x / 4 - 3/4 e^(-x/3), is what radii are drawn by.
    for (const float u : {0.05f, 0.3f, 0.6f, 0.9f, 0.99f}) {
      const double x = double(profile.sample(u)) * s / l;
      const double cdf = 1 - std::exp(-x) / 4 - 0.75 * std::exp(-x / 3);
      const double narrow = 1 - std::exp(-x), wide = 1 - std::exp(-x / 3);
      // One of both exponentials is inverted: a quarter of the numbers is the narrow one's.
      EXPECT_TRUE(std::abs(u < 0.25f ? narrow - u / 0.25 : wide - (u - 0.25) / 0.75) < 2e-3) << u << " " << cdf;
      EXPECT_NEAR(double(profile.within(profile.sample(u))), cdf, 5e-4);
    }
  }
}

// Under a boundary that sends back F, what is seen, A, is A0 (1 - F) / (1 - A0 F), and light makes 1 / (1 - A0 F) rounds.
TEST(DiffusionNumbers, RoundsBelowABoundary) {
  for (const double F : {0.3, 0.6})
    for (const double A0 : {0.3, 0.7, 0.9}) {
      const double A = A0 * (1 - F) / (1 - A0 * F), s = 1.9 - A0 + 3.5 * (A0 - 0.8) * (A0 - 0.8);
      EXPECT_NEAR(double(DiffusionProfile::scale(float(A), 1, float(F))), 1 / s / (1 - A0 * F), 1e-4) << F << " " << A0;
    }
}

// Light leaves a body by what its boundary lets out, normalized so that nothing is lost: (1 - F(c)) / (pi times its own mean).
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
