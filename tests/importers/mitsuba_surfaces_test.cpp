// The meaning of Mitsuba's surfaces: each is tested with a number that follows from its documentation, or that was measured
// with Mitsuba.

#include "etendue/describe/color.h"
#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

TEST(MitsubaSurface, TheTwoSidesOfTwosided) {
  const auto grey = [](const char* value) {
    return std::string("<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"") + value + "\"/></bsdf>";
  };
  for (const auto& [turn, expected] : {std::pair("0", 0.8), std::pair("180", 0.2)}) {
    const std::string shape = std::string("<shape type=\"rectangle\"><transform name=\"to_world\"><rotate y=\"1\" angle=\"") +
                              turn + "\"/><translate z=\"5\"/></transform><bsdf type=\"twosided\">" + grey("0.2") +
                              grey("0.8") + "</bsdf></shape><emitter type=\"constant\"/>";
    EXPECT_NEAR(seen(import_text(scene(sensor() + integrator() + shape))).y, expected, 3e-3) << turn;
  }
}

// Seen from its back, or with reversed normals, a two-sided surface shows its other BSDF: in blends and masks as well, and in
// mirrored meshes.
TEST(MitsubaSurface, NormalsThatAreTurnedRoundExchangeTheSides) {
  const auto both = "<bsdf type=\"twosided\">" + diffuse("0.8") + diffuse("0.2") + "</bsdf>";
  const std::string flip = "<boolean name=\"flip_normals\" value=\"true\"/>";
  const auto shown = [&](const std::string& inside) {
    return seen(import_text(
                    seen_scene(wall(inside) + "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>")),
                4096)
        .y;
  };
  EXPECT_NEAR(shown(both), 0.8, 0.01);
  EXPECT_NEAR(shown(both + flip), 0.2, 0.005);
  EXPECT_NEAR(shown("<bsdf type=\"blendbsdf\"><float name=\"weight\" value=\"0.5\"/>" + both + "<bsdf type=\"twosided\">" +
                    diffuse("0.4") + "</bsdf></bsdf>" + flip),
              0.3, 0.006);
  EXPECT_NEAR(shown("<bsdf type=\"mask\"><float name=\"opacity\" value=\"1\"/>" + both + "</bsdf>" + flip), 0.2, 0.005);
  const Imported glass =
      import_text(scene("<shape type=\"sphere\"><bsdf type=\"dielectric\"><float name=\"int_ior\" "
                        "value=\"1.5\"/><float name=\"ext_ior\" value=\"1\"/></bsdf>" +
                        flip + "</shape><shape type=\"sphere\"/>"));
  const Value inside = get(part(glass.object(0), "shader"), "ior"), outside = get(part(glass.object(0), "shader"), "exterior");
  EXPECT_NEAR((*inside.as<Color>())->at(550, ColorUse::coefficient), 1, 1e-6);
  EXPECT_NEAR((*outside.as<Color>())->at(550, ColorUse::coefficient), 1.5, 1e-6);
}

// Rough metal seen 8 degrees above its plane in a uniform environment: as measured in Mitsuba 3.9.1, with an error of 0.1 %.
// With height-correlated masking and shadowing it would be 8 % brighter.
TEST(MitsubaSurface, RoughMetalAtASlant) {
  const std::string camera =
      "<sensor type=\"orthographic\"><transform name=\"to_world\"><scale x=\"0.01\" y=\"0.01\"/><lookat origin=\"0, 1, 7\" "
      "target=\"0, 0, 0\" up=\"0, 1, 0\"/></transform><film type=\"hdrfilm\"><integer name=\"width\" value=\"1\"/><integer "
      "name=\"height\" value=\"1\"/><rfilter type=\"box\"/></film></sensor>";
  for (const auto& [distribution, expected] : {std::pair("ggx", 0.4746), {"beckmann", 0.5718}}) {
    const std::string metal = std::string(
                                  "<bsdf type=\"roughconductor\"><float name=\"alpha\" value=\"0.45\"/><string "
                                  "name=\"distribution\" value=\"") +
                              distribution +
                              "\"/><spectrum name=\"eta\" value=\"1.3\"/><spectrum name=\"k\" value=\"2.8\"/></bsdf>";
    const Xyz found = seen(import_text(scene(camera + integrator(2) +
                                             "<shape type=\"rectangle\"><transform name=\"to_world\"><rotate x=\"1\" "
                                             "angle=\"-90\"/><scale value=\"50\"/></transform>" +
                                             metal +
                                             "</shape><emitter type=\"constant\"><spectrum name=\"radiance\" "
                                             "value=\"1\"/></emitter>")),
                           1 << 15);
    EXPECT_NEAR(found.y, expected, 0.006 * expected) << distribution;
  }
}

TEST(MitsubaSurface, IndicesByName) {
  const Imported i = import_text(scene(sensor() + integrator() +
                                       wall("<bsdf type=\"dielectric\"><string name=\"int_ior\" value=\"diamond\"/></bsdf>") +
                                       wall("<bsdf type=\"dielectric\"/>") + wall("<bsdf type=\"plastic\"/>")));
  EXPECT_EQ(i.told(), "");
  const auto index = [&](size_t n, const char* member) {
    const Value v = get(part(i.object(n), "shader"), member);
    if (const Color* c = v.as<Color>()) return double((*c)->at(550, ColorUse::coefficient));
    return v.as<Number>()->value;
  };
  EXPECT_NEAR(index(0, "ior"), 2.419, 1e-4);
  EXPECT_NEAR(index(0, "exterior"), 1.000277, 1e-6);
  EXPECT_NEAR(index(1, "ior"), 1.5046, 1e-4);
  EXPECT_NEAR(index(2, "ior"), 1.49 / 1.000277, 1e-4);  // Mitsuba 3.9 prints 1.48959
}

TEST(MitsubaSurface, AMetalOfNoMaterialReflectsAllLight) {
  for (const char* metal : {"<bsdf type=\"roughconductor\">", "<bsdf type=\"conductor\"><float name=\"k\" value=\"1\"/>"}) {
    const std::string shape = wall(metal + std::string("<float name=\"alpha\" value=\"0.01\"/></bsdf>"));
    const Imported i = import_text(scene(sensor() + integrator() + shape + "<emitter type=\"constant\"/>"));
    ASSERT_TRUE(i.job) << i.told();
    EXPECT_NEAR(test::measure(i.job).mean.y, 1, 0.005) << metal;
  }
}

}  // namespace
}  // namespace etendue::mitsuba_test
