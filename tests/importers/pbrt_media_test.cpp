// Heterogeneous media of pbrt, each tested with a number.

#include <fmt/format.h>

#include <filesystem>

#include "color/planck.h"
#include "etendue/describe/color.h"
#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

const std::string sphere =
    "AttributeBegin\nMaterial \"interface\" MediumInterface \"m\" \"\" Translate 0 0 5 Shape \"sphere\"\nAttributeEnd\n";
const std::string box = "\"integer nx\" 4 \"integer ny\" 4 \"integer nz\" 4 \"point3 p0\" [-1 -1 4] \"point3 p1\" [1 1 6] ";
const std::string flat_nothing = "\"spectrum sigma_s\" [300 0 900 0] ";

std::string cells(const std::string& value) {
  std::string all = "[";
  for (int i = 0; i < 64; ++i) all += value + " ";
  return all + "] ";
}
Imported medium(const std::string& text, const std::string& before = "") {
  return import_text(v4(before + "MakeNamedMedium \"m\" " + text + "\n" + sphere));
}

/// The density of a grid of ones, 4 cells along 2 m, at a distance: at its borders it falls to a half.
double ones(double x) { return std::min({1.0, 0.5 + 2 * x, 0.5 + 2 * (2 - x)}); }

/// The radiance of a medium along the 2 m through its middle: int s(x) L(x) exp(-int_0^x s) dx.
template <class Absorption, class Light>
double along(const Absorption& absorption, const Light& light) {
  constexpr int points = 4000;
  double depth = 0, sum = 0;
  for (int i = 0; i < points; ++i) {
    const double x = 2 * (i + 0.5) / points, s = absorption(x) * 2 / points;
    sum += light(x) * s * std::exp(-depth - s / 2);
    depth += s;
  }
  return sum;
}

TEST(PbrtMedium, GridsOfRgbAbsorbAndShine) {
  const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
  const std::string grid = "\"string type\" \"rgbgrid\" " + box + "\"rgb sigma_a\" " + cells(".25 .25 .25") +
                           "\"rgb sigma_s\" " + cells("0 0 0") + "\"float scale\" 2 ";
  EXPECT_NEAR(seen(medium(grid, sky), 65536).y, std::exp(-0.9375), 0.01);
  const Imported shining = medium(grid + "\"rgb Le\" " + cells("1 1 1") + "\"float Lescale\" 3");
  EXPECT_EQ(shining.told(), "");
  // pbrt divides the spectra of lights by the luminance of a spectrum of 1, which is 106.856917 there, but not media's.
  const double light = 106.856917 * along([](double x) { return 0.5 * ones(x); }, [](double x) { return 3 * ones(x); });
  EXPECT_NEAR(seen(shining, 65536).y, light, 0.01 * light);
  // Either absorption or scattering may be left out: it is 1 then, within the box alone.
  const Imported one = medium("\"string type\" \"rgbgrid\" " + box + "\"rgb sigma_s\" " + cells("1 2 3"));
  EXPECT_EQ(number(part(object(one, 0), "interior"), "absorption"), 1);
  EXPECT_NE(medium("\"string type\" \"rgbgrid\" " + box + "\"rgb sigma_s\" " + cells("1 2 3") + "\"rgb Le\" " + cells("1 1 1"))
                .told()
                .find("needs 'sigma_a'"),
            std::string::npos);
  EXPECT_NE(medium("\"string type\" \"rgbgrid\" " + box + "\"rgb sigma_s\" [1 2 3]").told().find("cannot have 1 values"),
            std::string::npos);
}

TEST(PbrtMedium, ShinesByAGridOfItsOwn) {
  const std::string grid = "\"string type\" \"uniformgrid\" " + box + "\"spectrum sigma_a\" [300 .5 900 .5] " + flat_nothing +
                           "\"float density\" " + cells("1");
  const Imported scaled = medium(grid + "\"rgb Le\" [2 2 2] \"float Lescale\" " + cells("3"));
  EXPECT_EQ(scaled.told(), "");
  EXPECT_NEAR(seen(scaled, 65536).y, along([](double x) { return 0.5 * ones(x); }, [](double x) { return 6 * ones(x); }), 0.03);
}

// pbrt's black bodies have a maximum of 1 at all temperatures; the picture shows their luminance.
TEST(PbrtMedium, ShinesByTemperature) {
  const auto luminance = [](double kelvin) {
    double sum = 0;
    for (int nm = 360; nm <= 830; ++nm) sum += double(observer(float(nm)).y) * planck(nm, kelvin) / highest_planck(kelvin);
    return sum;  // pbrt does not divide it, as in GridsOfRgbAbsorbAndShine
  };
  const Imported hot = medium("\"string type\" \"uniformgrid\" " + box + "\"spectrum sigma_a\" [300 .5 900 .5] " +
                              flat_nothing + "\"float density\" " + cells("1") + "\"float temperature\" " + cells("30") +
                              "\"float temperatureoffset\" 5 \"float temperaturescale\" 160 \"float Lescale\" 2");
  EXPECT_EQ(hot.told(), "");
  const double expected =
      along([](double x) { return 0.5 * ones(x); }, [&](double x) { return 2 * luminance((30 * ones(x) - 5) * 160); });
  EXPECT_NEAR(seen(hot, 65536).y, expected, 0.02 * expected);
  EXPECT_NE(medium("\"string type\" \"uniformgrid\" " + box + "\"float density\" " + cells("1") + "\"float temperature\" " +
                   cells("30") + "\"rgb Le\" [1 1 1]")
                .told()
                .find("either 'Le' or a grid"),
            std::string::npos);
}

// v4 sorts the corners of a box, v3 mirrors what lies between them.
TEST(PbrtMedium, CornersOfBoxes) {
  const auto placed = [](bool v4_file) {
    const std::string text =
        std::string("MakeNamedMedium \"m\" \"string type\" \"") + (v4_file ? "uniformgrid" : "heterogeneous") +
        "\" \"float density\" [1 2] \"integer nx\" 2 \"point p0\" [1 0 0] \"point p1\" [-1 1 1]\nMediumInterface \"m\" \"\" "
        "Shape \"sphere\"\n";
    const Imported i = import_text(v4_file ? v4(text) : v3(text));
    if (!i.job) ADD_FAILURE() << i.told();
    const Value placement = get(part(object(i, 0), "interior"), "placement");
    const Transform* still = placement.as<Transform>();
    return (still ? *still : placement.as<AnimatedTransform>()->still())(DoublePoint3{0.25, 0, 0}).x;
  };
  EXPECT_NEAR(placed(true), -0.5, 1e-6);
  EXPECT_NEAR(placed(false), 0.5, 1e-6);
}

// The coefficients of a homogeneous medium by default, and by the name of a preset.
TEST(PbrtMedium, DefaultsAndPresets) {
  const auto absorbs = [](bool v4_file, const std::string& text) {
    const std::string world =
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" " + text + "\nMediumInterface \"m\" \"\" Shape \"sphere\"\n";
    return number(part(object(import_text(v4_file ? v4(world) : v3(world)), 0), "interior"), "absorption");
  };
  EXPECT_NEAR(absorbs(true, ""), 1, 1e-6);
  EXPECT_NEAR(absorbs(false, ""), 0.0024, 5e-4);  // green, at 550 nm
  EXPECT_NEAR(absorbs(true, "\"string preset\" \"Lowfat Milk\""), 0.00575, 2e-3);
  EXPECT_NEAR(absorbs(true, "\"string preset\" \"Espresso\" \"spectrum sigma_a\" [300 2 900 2]"), 6.6, 0.4);
  EXPECT_NEAR(absorbs(false, "\"string preset\" \"Espresso\" \"spectrum sigma_a\" [300 2 900 2]"), 2, 1e-4);
}

// Below its base, towards -y of the directive's coordinate system, a cloud is solid; only within its box.
TEST(PbrtMedium, CloudsAreSolidBelow) {
  const auto through = [](const char* place) {
    const Imported cloud =
        import_text(v4("LightSource \"infinite\" \"rgb L\" [1 1 1]\nAttributeBegin Translate " + std::string(place) +
                       " MakeNamedMedium \"m\" \"string type\" \"cloud\" \"spectrum sigma_a\" [300 .7 900 .7] " + flat_nothing +
                       "\"point3 p0\" [-1 -3 -.5] \"point3 p1\" [1 3 .5]\nAttributeEnd\n" + sphere));
    EXPECT_NE(cloud.told().find("another one of the same kind"), std::string::npos) << cloud.told();
    return seen(cloud, 65536).y;
  };
  EXPECT_NEAR(through("0 1 5"), std::exp(-0.7), 0.01);
  EXPECT_NEAR(through("0 -2 5"), 1, 0.01);
}

// The file's density is 7.5 in eight cells along z, each half a metre wide; the outermost half cell at either end, where it
// falls to a half, counts as 3/8 of a cell.
TEST(PbrtMedium, NanoVdbIsTakenFromItsFile) {
  const TemporaryFolder folder;
  std::filesystem::copy_file(ETENDUE_SOURCE_DIR "/tests/volumes/three_grids.nvdb", folder / "three_grids.nvdb");
  const auto through = [&](const std::string& file, const std::string& more) {
    return import_text(folder, v4("LightSource \"infinite\" \"rgb L\" [1 1 1]\nAttributeBegin\nTranslate -11 -4 1 "
                                  "MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"" +
                                  file + "\" " + flat_nothing + more +
                                  "\nAttributeEnd\nAttributeBegin\nMaterial \"interface\" MediumInterface \"m\" \"\" "
                                  "Translate 0 0 5.5 Scale 10 10 4 Shape \"sphere\"\nAttributeEnd\n"));
  };
  const double depth = 7.5 * 0.5 * (7 + 2 * 0.375);
  const std::string absorption = "\"spectrum sigma_a\" [300 .02 900 .02] \"float scale\" 2 ";
  const Imported cold = through("three_grids.nvdb", absorption + "\"float Lescale\" 0"),
                 hot = through("three_grids.nvdb", absorption + "\"float Lescale\" 3 \"float temperaturescale\" 5");
  EXPECT_EQ(cold.told() + hot.told(), "");
  EXPECT_EQ(part(object(cold, 1), "interior").class_info().name, "GridVolume");
  EXPECT_NEAR(seen(cold, 65536).y, std::exp(-0.04 * depth), 0.01);
  EXPECT_NEAR(seen(hot, 65536).y, std::exp(-0.04 * depth), 0.01);
  const Component& glow = part(part(object(hot, 1), "interior"), "glow");
  EXPECT_NEAR(number(glow, "factor"), 3 * 106.856917, 1e-3);  // as in GridsOfRgbAbsorbAndShine
  EXPECT_EQ(part(glow, "temperature").class_info().name, "RemapMap");
  EXPECT_NE(through("none.nvdb", "").told().find("none.nvdb"), std::string::npos);
}

}  // namespace
}  // namespace etendue::pbrt_test
