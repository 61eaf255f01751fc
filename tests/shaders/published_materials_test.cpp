// Published numbers of materials, typed from their sources: metals, glasses, paints. Tables are checked against some of their
// rows, as in published_numbers_test.cpp.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "components/shaders/fresnel.h"
#include "etendue/describe/color.h"
#include "support/component_test_support.h"

namespace etendue {
namespace {

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
  // Curves of metals are smooth: no row departs far from the mean of its neighbours. Semiconductors have edges.
  const std::set<std::string> with_edges = {"Si", "Ge", "GaAs", "Se", "Se-e", "AlSb", "SnTe"};
  for (const std::string& name : metal_names()) {
    if (with_edges.contains(name)) continue;
    const Color metal = metal_index(name);
    for (double l = 410; l < 760; l += 5)
      for (const Color& part : {metal, metal->imaginary()}) {
        const auto at = [&](double x) { return double(part->at(float(x), ColorUse::coefficient)); };
        EXPECT_NEAR(at(l), (at(l - 25) + at(l + 25)) / 2, 0.07 * at(l) + 0.07) << name << " at " << l;
      }
  }
}

// Numbers by others: the reflectance of mirrors at normal incidence, from handbooks (CRC Handbook, section 12, at about 550 and
// 650 nm; rounded, and of films of several makes).
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

// Indices at g, F, e, d, C and r from the makers' data sheets, and from the papers that published the formulas.
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
  // The published white (Y = 100) covers the measured range alone, 380 to 730 nm.
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

}  // namespace
}  // namespace etendue
