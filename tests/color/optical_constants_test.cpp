// Metals and glasses by name: each name exists and has the published numbers.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>

#include "components/shaders/fresnel.h"
#include "etendue/core/error.h"
#include "etendue/describe/color.h"

namespace etendue {
namespace {

double real_part(const Color& c, double wavelength) { return double(c->at(float(wavelength), ColorUse::coefficient)); }
double imaginary_part(const Color& c, double wavelength) { return real_part(c->imaginary(), wavelength); }
double reflectance(const Color& c, double wavelength) {
  return double(fresnel_conductor(1, float(real_part(c, wavelength)), float(imaginary_part(c, wavelength))));
}

// The row next to 560 nm of each source.
TEST(OpticalConstants, ARowOfEachMetal) {
  const struct {
    std::string name;
    double wavelength, n, k;
  } rows[] = {{"Au", 563.564453, 0.306, 2.88},
              {"Ag", 563.564453, 0.12, 3.45},
              {"Al", 563.564453, 1.02, 6.85},
              {"Cu", 563.564453, 0.826, 2.599},
              {"Cr", 558.468018, 3.18, 4.41},
              {"Cu_palik", 563.545044, 0.826, 2.6},
              {"Li", 551, 0.205, 2.48},
              {"Na", 545.945, 0.058647, 2.233705},
              {"K", 545.945, 0.04921, 1.432628},
              {"Rb", 545.945, 0.099933, 1.205814},
              {"Cs", 556.982, 0.262607, 0.984359},
              {"Be", 563.5, 3.39, 3.17},
              {"Mg", 567.470032, 0.840093, 5.077888},
              {"Ca", 563.56, 0.28656, 2.42531},
              {"Zn", 560, 13.908, 3.973},
              {"Hg", 563.56, 1.62088, 4.7505},
              {"In", 563.56, 1.09481, 5.06938},
              {"Pb", 563.56, 2.56955, 4.18361},
              {"Bi", 619.9, 2.244, 3.1},
              {"Ti", 549, 2.54, 3.43},
              {"V", 563.545044, 3.68, 2.98},
              {"Mn", 549, 2.39, 3.33},
              {"Fe", 560, 2.219, 3.19},
              {"Co", 549, 2.05, 3.82},
              {"Ni", 563.545044, 1.8, 3.33},
              {"Zr", 560, 2.593, 3.401},
              {"Nb", 551.022034, 2.93, 2.87},
              {"Mo", 563.545044, 3.76, 3.41},
              {"Rh", 563.6, 2, 5.11},
              {"Pd", 549, 1.64, 3.84},
              {"Ta", 563.545044, 2.36, 1.81},
              {"W", 563.545044, 3.49, 2.75},
              {"Ir", 563.545044, 2.29, 4.38},
              {"Os", 550, 5.86, 2.99},
              {"Pt", 591.49, 2.2002, 3.9364},
              {"CuZn", 560, 0.505, 2.86},
              {"CuZn15", 560, 0.468, 2.427},
              {"CuZn10", 560, 0.457, 2.516},
              {"AuAg", 553, 0.30765, 3.14023},
              {"stainless steel", 560, 2.0807, 3.7298},
              {"a-C", 563.6, 2.38, 0.82},
              {"d-C", 546.047058, 2.4235, 0},
              {"graphite", 564.63, 2.7375, 1.507},
              {"Si", 560, 4.045, 0.025758},
              {"Ge", 555, 5.26, 2.056},
              {"Se", 563.545044, 3.07, 0.73},
              {"Se-e", 563.545044, 4.49, 1.19},
              {"Te", 561.249023, 5.01, 3.57},
              {"Te-e", 561.249023, 4.91, 5.2},
              {"GaAs", 565, 4.009, 0.248},
              {"AlAs", 563.545044, 3.225, 4e-05},
              {"AlSb", 563.545044, 4.2, 0.01},
              {"HgTe", 562.268005, 3.454, 1.677},
              {"SnTe", 558.21698, 2.442, 0},
              {"SiC", 567.934021, 2.6557, 0},
              {"TiC", 619.9, 3.05, 2.67},
              {"TiN", 619.9, 1.32, 2.69},
              {"VC", 619.9, 3.01, 2.51},
              {"VN", 619.9, 2.35, 2.47},
              {"Cu2O", 549.799988, 3.1, 0.19},
              {"CuO", 549.799988, 2.58, 0.59},
              {"MgO", 546.166992, 1.74077, 0},
              {"TiO2", 559.981995, 2.94, 0},
              {"TiO2-e", 559.981995, 2.64, 0},
              {"ThF4", 559.981995, 1.521, 0},
              {"CsI", 559.981995, 1.7925, 0}};
  std::set<std::string> names;
  for (const auto& r : rows) {
    const Color metal = metal_index(r.name);
    EXPECT_EQ(metal->expression(), "metal(\"" + r.name + "\")");
    EXPECT_NEAR(real_part(metal, r.wavelength), r.n, 2e-4 * r.n) << r.name;
    EXPECT_NEAR(imaginary_part(metal, r.wavelength), r.k, 2e-4 * r.k + 1e-9) << r.name;
    names.insert(r.name);
  }
  const std::vector<std::string> known = metal_names();
  EXPECT_EQ(known.size(), names.size()) << "a metal without a row here, or named twice";
  for (const std::string& name : known) EXPECT_TRUE(names.contains(name)) << name;
}

// Every index is defined at all visible wavelengths: outside a table it would be 0, and all light would be reflected.
TEST(OpticalConstants, TablesCoverAllThatIsVisible) {
  for (const std::string& name : metal_names()) {
    const Color metal = metal_index(name);
    for (double l = 360; l <= 830; l += 2) {
      EXPECT_GT(real_part(metal, l), 0.03) << name << " at " << l;
      EXPECT_GE(imaginary_part(metal, l), 0) << name << " at " << l;
      if (name != "SnTe") EXPECT_GT(reflectance(metal, l), 0.03) << name << " at " << l;  // the table of SnTe lacks k
      EXPECT_LT(reflectance(metal, l), 0.995) << name << " at " << l;
    }
  }
  const struct {
    const char* name;
    double end;
  } ends[] = {{"AlSb", 590.381}, {"d-C", 656.257}, {"Se", 688.778}, {"MgO", 767.678}};
  for (const auto& e : ends)
    for (const double l : {e.end + 5, 800.0, 830.0})
      EXPECT_NEAR(real_part(metal_index(e.name), l), real_part(metal_index(e.name), e.end), 1e-3) << e.name << " at " << l;
}

// Reflectances at normal incidence that others have measured or computed, rounded: brass, bronze, carbon, iron and steel, and
// some more from section 12 of the CRC Handbook and from the papers.
TEST(OpticalConstants, Reflectances) {
  const struct {
    const char* name;
    double wavelength, reflectance, tolerance;
  } rows[] = {
      {"a-C", 550, 0.21, 0.01},      {"brass", 450, 0.43, 0.03},   {"brass", 600, 0.87, 0.02}, {"iron", 550, 0.56, 0.02},
      {"steel", 550, 0.64, 0.02},    {"nickel", 550, 0.61, 0.02},  {"Pt", 550, 0.64, 0.02},    {"W", 550, 0.5, 0.02},
      {"titanium", 550, 0.57, 0.02}, {"mercury", 550, 0.78, 0.01}, {"Si", 550, 0.37, 0.01},    {"Rh", 550, 0.77, 0.02},
      {"cobalt", 550, 0.66, 0.02},   {"Pd", 550, 0.70, 0.02},      {"Na", 550, 0.96, 0.01},    {"lead", 550, 0.66, 0.03}};
  for (const auto& r : rows)
    EXPECT_NEAR(reflectance(metal_index(r.name), r.wavelength), r.reflectance, r.tolerance) << r.name << " " << r.wavelength;
}

TEST(OpticalConstants, OtherNames) {
  const std::pair<const char*, const char*> metals[] = {{"Iron", "Fe"},     {"BRASS", "CuZn"},   {"steel", "stainless steel"},
                                                        {"chrome", "Cr"},   {"A-c", "a-C"},      {"cesium", "Cs"},
                                                        {"platinum", "Pt"}, {"electrum", "AuAg"}};
  for (const auto& [other, name] : metals) EXPECT_EQ(metal_index(other)->expression(), "metal(\"" + std::string(name) + "\")");
  const std::pair<const char*, const char*> glasses[] = {{"Pyrex", "borosilicate glass"},
                                                         {"acrylic glass", "PMMA"},
                                                         {"water ice", "ice"},
                                                         {"SF10", "N-SF10"},
                                                         {"CCl4", "carbon tetrachloride"}};
  for (const auto& [other, name] : glasses) EXPECT_EQ(glass_index(other)->expression(), "glass(\"" + std::string(name) + "\")");
  try {
    metal_index("bras");
    ADD_FAILURE() << "there is no such metal";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("did you mean 'brass'?"), std::string::npos) << e.what();
  }
  // No name stands for two materials, even if case is ignored.
  for (const std::string& name : metal_names()) EXPECT_EQ(metal_index(name)->expression(), "metal(\"" + name + "\")");
  for (const std::string& name : glass_names()) EXPECT_EQ(glass_index(name)->expression(), "glass(\"" + name + "\")");
}

// Indices n_d and Abbe numbers of SCHOTT's data sheets; for the others n_D as handbooks have it, rounded.
TEST(OpticalConstants, IndicesOfGlasses) {
  const struct {
    const char* name;
    double n, tolerance, abbe = 0;
  } rows[] = {{"N-BK7", 1.5168, 1e-5, 64.17},
              {"N-SF11", 1.78472, 1e-5, 25.68},
              {"F2", 1.62004, 1e-5, 36.37},
              {"N-BAF10", 1.67003, 1e-5, 47.11},
              {"N-FK51A", 1.48656, 1e-5, 84.47},
              {"N-LASF9", 1.85025, 1e-5, 32.17},
              {"N-SF5", 1.67271, 1e-5, 32.25},
              {"N-SF10", 1.72828, 1e-5, 28.53},
              {"N-K5", 1.52249, 1e-5, 59.48},
              {"N-PK52A", 1.497, 1e-5, 81.61},
              {"N-BAK4", 1.56883, 1e-5, 55.98},
              {"N-SK16", 1.62041, 1e-5, 60.32},
              {"N-LAK9", 1.691, 1e-5, 54.71},
              {"N-LASF31A", 1.883, 1e-5, 40.76},
              {"N-KZFS4", 1.61336, 1e-5, 44.49},
              {"LLF1", 1.54814, 1e-5, 45.75},
              {"N-SF6", 1.80518, 1e-5, 25.36},
              {"N-SF57", 1.84666, 1e-5, 23.78},
              {"N-SF66", 1.92286, 1e-5, 20.88},
              {"fused silica", 1.4585, 1e-4, 67.8},
              {"diamond", 2.4175, 2e-3, 55.3},
              {"water", 1.3334, 1e-4, 55.8},
              {"soda-lime glass", 1.523, 1e-3},
              {"borosilicate glass", 1.4714, 2e-4, 65.4},
              {"sapphire", 1.768, 1e-3, 72.2},
              {"quartz", 1.5443, 2e-4, 69.9},
              {"calcite", 1.6584, 3e-4, 49.3},
              {"fluorite", 1.4338, 2e-4, 95},
              {"magnesium fluoride", 1.3778, 2e-4, 106.2},
              {"spinel", 1.716, 3e-3},
              {"YAG", 1.833, 1e-3, 52.3},
              {"cubic zirconia", 2.16, 0.01, 33.5},
              {"strontium titanate", 2.41, 2e-3},
              {"moissanite", 2.648, 2e-3},
              {"rutile", 2.613, 5e-3, 9.9},
              {"zinc selenide", 2.62, 0.02},
              {"sodium chloride", 1.5443, 3e-4, 42.8},
              {"PMMA", 1.4917, 1.5e-3, 58},
              {"polycarbonate", 1.585, 1e-3, 29},
              {"polystyrene", 1.591, 1e-3, 30.5},
              {"PET", 1.57, 0.01},
              {"PDMS", 1.41, 3e-3},
              {"ice", 1.3098, 3e-4},
              {"ethanol", 1.3614, 5e-4},
              {"acetone", 1.3590, 5e-4},
              {"glycerol", 1.4722, 1.5e-3},
              {"benzene", 1.4979, 3e-3, 30},
              {"carbon tetrachloride", 1.4601, 5e-4},
              {"air", 1.000277, 2e-6}};
  EXPECT_EQ(glass_names().size(), std::size(rows));
  for (const auto& r : rows) {
    const Color glass = glass_index(r.name);
    const double n = real_part(glass, 587.5618);
    EXPECT_NEAR(n, r.n, r.tolerance) << r.name;
    if (r.abbe > 0)
      EXPECT_NEAR((n - 1) / (real_part(glass, 486.1327) - real_part(glass, 656.2725)), r.abbe, 0.05 * r.abbe) << r.name;
    // The index decreases smoothly towards red.
    for (double l = 360; l < 830; l += 10) EXPECT_GT(real_part(glass, l), real_part(glass, l + 10) - 1e-7) << r.name << l;
  }
}

// docs/optical-constants.md is generated together with the tables.
TEST(OpticalConstants, ThePageListsAllNames) {
  std::ifstream file(ETENDUE_SOURCE_DIR "/docs/optical-constants.md");
  std::stringstream text;
  text << file.rdbuf();
  for (const auto& names : {metal_names(), glass_names()})
    for (const std::string& name : names) EXPECT_NE(text.str().find("\n| `" + name + "`"), std::string::npos) << name;
}

}  // namespace
}  // namespace etendue
