// Measured data, their integrals, and how spectra are written.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"

namespace etendue {
namespace {

const std::string shared_spectra = std::string(ETENDUE_SOURCE_DIR) + "/../shared/validation/spectra/";

Xyz light_color(const Color& c) { return to_xyz(*c, ColorUse::radiance); }
std::array<double, 2> chromaticity(const Xyz& c) { return {c.x / (c.x + c.y + c.z), c.y / (c.x + c.y + c.z)}; }
std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}
bool contains(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }
#define EXPECT_MESSAGE(part, ...)                                      \
  do {                                                                 \
    const std::string message_ = message_of([&] { __VA_ARGS__; });     \
    EXPECT_TRUE(contains(message_, part)) << message_ << "\n" << part; \
  } while (false)

/// A file in the folder for temporary files, removed at the end.
class TemporaryFile {
 public:
  TemporaryFile(const std::string& name, const std::string& text) : path_(testing::TempDir() + "etendue_color_test_" + name) {
    std::ofstream(path_, std::ios::binary) << text;
  }
  ~TemporaryFile() { std::filesystem::remove(path_); }
  FilePath path() const { return {path_, {}}; }

 private:
  std::string path_;
};

TEST(Observer, IntegralAndPeak) {
  EXPECT_NEAR(observer_y_integral(), 106.856917, 1e-6);
  EXPECT_NEAR(observer(555).y, 1, 1e-4);
  EXPECT_NEAR(observer(555.5f).y, (observer(555).y + observer(556).y) / 2, 1e-12);
  EXPECT_EQ(observer(359.9f), Xyz{});
  EXPECT_EQ(observer(830.1f), Xyz{});
  EXPECT_EQ(observer(NAN), Xyz{});
}

TEST(Illuminant, WhitePoints) {
  struct {
    const char* name;
    double x, z;
  } whites[] = {{"A", 1.09849, 0.35591}, {"D50", 0.96424, 0.82513}, {"D65", 0.95047, 1.08883},
                {"E", 1.00008, 1.00033}, {"F2", 0.99146, 0.67315},  {"F11", 1.00900, 0.64264}};
  for (const auto& w : whites) {
    const Xyz c = light_color(illuminant_spectrum(w.name));
    EXPECT_NEAR(c.x, w.x, 1.1e-5) << w.name;
    EXPECT_NEAR(c.y, 1, 1e-7) << w.name;
    EXPECT_NEAR(c.z, w.z, 1.1e-5) << w.name;
  }
  EXPECT_EQ(illuminant_names().size(), std::size(whites));
  EXPECT_EQ(illuminant_spectrum("FL11")->expression(), "illuminant(\"F11\")");
  EXPECT_MESSAGE("did you mean 'D65'", illuminant_spectrum("D66"));
}

TEST(Blackbody, RadianceAndChromaticity) {
  const Color sun = blackbody_spectrum(5000);
  EXPECT_NEAR(double(sun->at(456, ColorUse::radiance)), 10997.9, 0.06);
  EXPECT_NEAR(double(sun->at(700, ColorUse::radiance)), 11812.0, 0.06);
  const auto warm = chromaticity(light_color(blackbody_spectrum(2855.5)));
  EXPECT_NEAR(warm[0], 0.44757, 1e-5);
  EXPECT_NEAR(warm[1], 0.40744, 1e-5);
  const auto cold = chromaticity(light_color(blackbody_spectrum(6500)));
  EXPECT_NEAR(cold[0], 0.31353, 1e-5);
  EXPECT_NEAR(cold[1], 0.32363, 1e-5);
  for (const double bad : {0.0, -1.0, std::nan(""), double(INFINITY)}) EXPECT_MESSAGE("above 0 K", blackbody_spectrum(bad));
}

TEST(Reflectance, ColorCheckerUnderThreeLights) {
  const std::string colorimetry = shared_spectra + "colorchecker24_colorimetry.csv";
  // Six of the patches are also tested in published_numbers_test.
  if (!std::filesystem::exists(colorimetry)) GTEST_SKIP() << "no validation data";
  std::ifstream file(colorimetry);
  int patches = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("#") || line.starts_with("patch")) continue;
    std::istringstream fields(line);
    std::string patch, text;
    std::getline(fields, patch, ',');
    const Color paint = file_spectrum({shared_spectra + "colorchecker24_babelcolor_10nm.csv", {}}, patch);
    // The published white (Y = 100) covers the table's measured range alone, 380 to 730 nm.
    const Color white = table_spectrum({380, 730}, {1, 1});
    for (const char* light : {"D65", "A", "D50"}) {
      const Color illuminant = illuminant_spectrum(light);
      const double scale = 100 / to_xyz(*white, ColorUse::reflectance, illuminant.get()).y;
      const Xyz c = scale * to_xyz(*paint, ColorUse::reflectance, illuminant.get());
      for (const double value : {c.x, c.y, c.z}) {
        std::getline(fields, text, ',');
        EXPECT_NEAR(value, std::stod(text), 6e-4) << patch << " under " << light;
      }
    }
    ++patches;
  }
  EXPECT_EQ(patches, 24);
}

TEST(Glass, IndexAtFraunhoferLines) {
  constexpr float lines[] = {486.1327f, 546.074f, 587.5618f, 656.2725f};  // F, e, d, C
  struct {
    const char* name;
    double n[4];
  } glasses[] = {
      {"N-BK7", {1.522376, 1.518722, 1.516800, 1.514322}},   {"N-SF11", {1.806513, 1.791918, 1.784720, 1.775955}},
      {"F2", {1.632081, 1.624080, 1.620040, 1.615032}},      {"fused silica", {1.463126, 1.460078, 1.458464, 1.456367}},
      {"diamond", {2.435538, 2.423592, 2.417486, 2.409906}}, {"water", {1.337492, 1.334830, 1.333403, 1.331513}}};
  for (const auto& glass : glasses) {
    const Color index = glass_index(glass.name);
    EXPECT_TRUE(index->varies());
    EXPECT_FALSE(index->imaginary());
    for (int line = 0; line < 4; ++line) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, lines[line], 1);
      EXPECT_NEAR(double(index->at(lines[line], ColorUse::coefficient)), glass.n[line], 1e-6) << glass.name;
      EXPECT_NEAR(double(index->evaluate(w, ColorUse::coefficient)[spectrum_size - 1]), glass.n[line], 1e-6) << glass.name;
    }
  }
  EXPECT_EQ(glass_index("bk7")->expression(), "glass(\"N-BK7\")");
  EXPECT_MESSAGE("did you mean 'N-BK7'", glass_index("N-BK8"));
}

TEST(Metal, IndexIsComplex) {
  const Color gold = metal_index("Au");
  ASSERT_TRUE(gold->imaginary());
  EXPECT_FLOAT_EQ(gold->at(495.936707f, ColorUse::coefficient), 0.916f);
  EXPECT_FLOAT_EQ(gold->imaginary()->at(495.936707f, ColorUse::coefficient), 1.84f);
  EXPECT_EQ(metal_index("Gold")->expression(), "metal(\"Au\")");
  EXPECT_MESSAGE("unknown metal 'Xx'", metal_index("Xx"));
  EXPECT_MESSAGE("must be real", complex_index(metal_index("Au"), flat_spectrum(1)));
}

// All rows of the files; some of them are also tested in published_numbers_test.
TEST(Metal, IsThatOfTheFiles) {
  if (!std::filesystem::exists(shared_spectra)) GTEST_SKIP() << "no validation data";
  for (const std::string name : {"Au", "Ag", "Al", "Cu", "Cr"}) {
    const Color metal = metal_index(name);
    const Color n = file_spectrum({shared_spectra + "nk_" + name + ".csv", {}}, "n");
    const Color k = file_spectrum({shared_spectra + "nk_" + name + ".csv", {}}, "k");
    for (float w = wavelength_low; w <= wavelength_high; w += 0.7f) {
      EXPECT_EQ(metal->at(w, ColorUse::coefficient), n->at(w, ColorUse::coefficient)) << name << w;
      EXPECT_EQ(metal->imaginary()->at(w, ColorUse::coefficient), k->at(w, ColorUse::coefficient)) << name << w;
    }
  }
}

TEST(Table, LinearBetweenZeroOutside) {
  const Color table = table_spectrum({400, 500, 600}, {1, 3, 2});
  const auto at = [&](float w) { return table->at(w, ColorUse::radiance); };
  EXPECT_FLOAT_EQ(at(450), 2);
  EXPECT_FLOAT_EQ(at(575), 2.25f);
  EXPECT_FLOAT_EQ(at(600), 2);
  EXPECT_EQ(at(399.9f), 0);
  EXPECT_EQ(at(600.1f), 0);
  for (float w = 400; w <= 600; w += 0.37f) {
    Wavelengths lambda;
    for (int i = 0; i < spectrum_size; ++i) lambda.place(i, w, 1);
    for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(table->evaluate(lambda, ColorUse::radiance)[i], at(w), 2e-5f);
  }
  EXPECT_MESSAGE("must increase", table_spectrum({400, 400}, {1, 1}));
  EXPECT_MESSAGE("as many values", table_spectrum({400, 500}, {1}));
  EXPECT_MESSAGE("not a finite number", table_spectrum({400, 500}, {1, NAN}));
  EXPECT_MESSAGE("expected in nm", table_spectrum({0.4f, 0.7f}, {1, 1}));
}

TEST(Table, FineLinesKeepTheirPower) {
  // A triangle of height 10 and half width 0.2 nm between two entries of the 1 nm table: area 2 nm.
  const Color line = table_spectrum({550.2f, 550.4f, 550.6f}, {0, 10, 0});
  EXPECT_NEAR(line->at(550.3f, ColorUse::coefficient), 5, 0.01f);  // 550.3 is rounded to float
  EXPECT_NEAR(line->at(550, ColorUse::radiance), 2 * 0.6, 1e-3f);  // as light it is seen through a slit of 2 nm
  EXPECT_NEAR(light_color(line).y, 2 * observer(550.4f).y / observer_y_integral(), 2e-6);
}

TEST(File, ReadsWhatPeopleWrite) {
  const auto at = [](const TemporaryFile& f, const std::string& column, float w) {
    return file_spectrum(f.path(), column)->at(w, ColorUse::radiance);
  };
  const TemporaryFile csv("a.csv", "\xef\xbb\xbf# comment\r\nnm, n ,\"k\"\r\n400,1,5\r\n\r\n500,2,6\r\n");
  EXPECT_FLOAT_EQ(at(csv, "", 450), 1.5f);
  EXPECT_FLOAT_EQ(at(csv, "n", 450), 1.5f);
  EXPECT_FLOAT_EQ(at(csv, "k", 450), 5.5f);
  EXPECT_FLOAT_EQ(at(csv, "3", 450), 5.5f);
  EXPECT_EQ(file_spectrum(csv.path(), "k")->expression(), "spectrum(\"" + csv.path().text + "\", \"k\")");
  EXPECT_FLOAT_EQ(at(TemporaryFile("b.spd", "400 1\n  500   +2e0\n"), "", 450), 1.5f);
  EXPECT_FLOAT_EQ(at(TemporaryFile("c.csv", "400;1\n500;2"), "", 450), 1.5f);
  EXPECT_FLOAT_EQ(at(TemporaryFile("d.tsv", "w\tv\n400\t1\n500\t2\n"), "v", 450), 1.5f);
}

TEST(File, Errors) {
  EXPECT_MESSAGE("missing_file.csv': No such file", file_spectrum({"missing_file.csv", {}}));
  const auto bad = [](const std::string& text, const std::string& column = {}) {
    return message_of([&] { file_spectrum(TemporaryFile("bad.csv", text).path(), column); });
  };
  const auto expect = [&](const std::string& part, const std::string& text, const std::string& column = {}) {
    const std::string message = bad(text, column);
    EXPECT_TRUE(contains(message, "bad.csv'") && contains(message, part)) << message << "\n" << part;
  };
  expect("no numbers", "");
  expect("no numbers", "# only a comment\nnm,value\n");
  expect("line 3: wavelengths must increase", "nm,v\n400,1\n400,2\n");
  expect("line 2: 'x' is not a number", "400,1\n500,x\n");
  expect("line 2: 'nan' is not a finite number", "400,1\n500,nan\n");
  expect("line 2: '1e99' is not a finite number", "400,1\n500,1e99\n");
  expect("line 2: a number is missing", "400,1\n500,\n");
  expect("line 2: it has 1 columns where 2 are needed", "400,1\n500\n");
  expect("line 1: '0,5' is not a number", "400;0,5\n500;1\n");
  expect("in nm", "0.4,1\n0.7,2\n");
  expect("at least two", "400,1\n");
  expect("line 1: there is no column 'kk' (did you mean 'k'?)", "nm,n,k\n400,1,2\n500,1,2\n", "kk");
  expect("line 1: there is no column 4, only 3", "nm,n,k\n400,1,2\n500,1,2\n", "4");
  expect("no header", "400,1\n500,1\n", "n");
}

TEST(Expression, IsTheLanguagesText) {
  EXPECT_EQ(flat_spectrum(0.1f)->expression(), "0.1");
  EXPECT_FALSE(flat_spectrum(0.1f)->varies());
  EXPECT_EQ(rgb_color("srgb", 0.5, 0.2, 0.1)->expression(), "rgb(0.5, 0.2, 0.1)");
  EXPECT_EQ(rgb_color("Rec2020", 0.5, 0.2, 1.0 / 3)->expression(), "rgb(\"rec2020\", 0.5, 0.2, 0.3333333333333333)");
  EXPECT_EQ(srgb_color(1, 0.5, 0)->expression(), "srgb(1, 0.5, 0)");
  EXPECT_EQ(xyz_color(0.3, 0.4, 0.5)->expression(), "xyz(0.3, 0.4, 0.5)");
  EXPECT_EQ(blackbody_spectrum(2856)->expression(), "blackbody(2856 K)");
  EXPECT_EQ(table_spectrum({400, 500}, {0.1f, 0.2f})->expression(), "spectrum([400, 500], [0.1, 0.2])");
  EXPECT_EQ(complex_index(flat_spectrum(0.2f), flat_spectrum(3))->expression(), "complex(0.2, 3)");
  EXPECT_EQ(scaled_spectrum(2.5, illuminant_spectrum("D65"))->expression(), "2.5 * illuminant(\"D65\")");
  EXPECT_EQ(scaled_spectrum(2, scaled_spectrum(3, glass_index("F2")))->expression(), "6 * glass(\"F2\")");
  EXPECT_EQ(scaled_spectrum(2, flat_spectrum(0.25f))->expression(), "0.5");
}

TEST(Scaled, MultipliesBothParts) {
  const Color metal = metal_index("Al"), twice = scaled_spectrum(2, metal);
  EXPECT_FLOAT_EQ(twice->at(550, ColorUse::coefficient), 2 * metal->at(550, ColorUse::coefficient));
  ASSERT_TRUE(twice->imaginary());
  EXPECT_FLOAT_EQ(twice->imaginary()->at(550, ColorUse::coefficient), 2 * metal->imaginary()->at(550, ColorUse::coefficient));
  EXPECT_MESSAGE("cannot be scaled", scaled_spectrum(std::nan(""), metal));
}

TEST(Transfer, RoundTripsAndKnownValues) {
  for (const std::string& name : transfer_names())
    for (double x = 0; x <= 1; x += 1.0 / 4096) {
      EXPECT_NEAR(decode_transfer(name, encode_transfer(name, x)), x, 1e-7) << name;
      EXPECT_NEAR(encode_transfer(name, decode_transfer(name, x)), x, 1e-7) << name;
    }
  EXPECT_NEAR(decode_transfer("srgb", 0.5), 0.214041, 1e-6);
  EXPECT_NEAR(encode_transfer("rec709", 0.5), 0.705436, 1e-6);
  EXPECT_NEAR(encode_transfer("gamma2.2", 0.5), 0.729740, 1e-6);
  EXPECT_NEAR(decode_transfer("srgb", -0.5), -0.214041, 1e-6);
  EXPECT_MESSAGE("unknown transfer function 'sgrb' (did you mean 'srgb'?)", encode_transfer("sgrb", 0.5));
}

}  // namespace
}  // namespace etendue
