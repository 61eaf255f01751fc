// Less common plugins of Mitsuba: their import is tested with numbers of Mitsuba 3.9.1 where these do not follow from the
// scene.

#include <cmath>

#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

const std::string sky = "<emitter type=\"constant\"><spectrum name=\"radiance\" value=\"1\"/></emitter>";
const std::string volumetric = sensor() + integrator(-1, "volpath");

std::string ball(const std::string& inside) {  // two units thick
  return "<shape type=\"sphere\"><point name=\"center\" x=\"0\" y=\"0\" z=\"5\"/><bsdf type=\"null\"/>" + inside + "</shape>";
}
std::string before_sky(const std::string& bsdf) {
  return sky + "<shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"10\"/><translate z=\"5\"/></transform>" +
         bsdf + "</shape>";
}
/// The mean Y of a picture; `word` must be in the messages of the import.
double brightness(const Imported& imported, const std::string& word) {
  EXPECT_NE(imported.told().find(word), std::string::npos) << imported.told();
  if (!imported.job) return -1;
  imported.job->outputs.clear();
  return test::measure(imported.job).mean.y;
}

TEST(MitsubaMotion, InstancesFollowTheirAnimationInWhateverOrder) {
  const auto key = [](const char* time, const char* x) {
    return std::string("<transform time=\"") + time + "\"><translate x=\"" + x + "\"/></transform>";
  };
  const auto instance = [&](const std::string& keys) {
    return import_text(scene(sensor() + integrator() + sky +
                             "<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"/></shape><shape type=\"instance\">"
                             "<ref id=\"g\"/><animation name=\"animation\">" +
                             keys + "</animation></shape>"));
  };
  const Imported read = instance(key("1", "4") + key("0", "0") + key("0.5", "1"));
  ASSERT_EQ(read.told(), "");
  const Value transform = get(read.object(1), "transform");
  const auto* moves = transform.as<AnimatedTransform>();
  ASSERT_TRUE(moves);
  for (const auto& [time, x] : {std::pair(0.f, 0.), {0.25f, 0.5}, {0.75f, 2.5}, {1.f, 4.}})
    EXPECT_NEAR(moves->written(time)(DoublePoint3{0, 0, 0}).x, x, 1e-6);
  EXPECT_NE(instance(key("1", "4") + key("1", "0")).told().find("same time"), std::string::npos);
}

TEST(MitsubaSensor, WithoutAnUpItHasMitsubasOwn) {
  const Imported read =
      import_text(scene(sensor("<transform name=\"to_world\"><look_at origin=\"0, 0, 0\" target=\"2, -1, 2\"/></transform>") +
                        integrator() + sky));
  const Value up = get(*read.job->camera, "up");
  ASSERT_TRUE(up.as<Numbers>());
  // The up vector for n = (2, -1, 2) / 3: 1 - n.x^2 / (1 + n.z), - n.x n.y / (1 + n.z), -n.x.
  const double expected[] = {1 - 4. / 9 / (5. / 3), 2. / 9 / (5. / 3), -2. / 3};
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(up.as<Numbers>()->values[i], expected[i], 1e-6);
}

TEST(MitsubaMedium, AnEvenHeterogeneousOneEndsWithTheBoxOfItsVolume) {
  const auto seen_through = [](const std::string& sigma_t) {
    return seen(import_text(scene(volumetric + sky +
                                  ball("<medium type=\"heterogeneous\" name=\"interior\"><float name=\"albedo\" value=\"0\"/>" +
                                       sigma_t + "</medium>"))),
                16384)
        .y;
  };
  const std::string here = "<transform name=\"to_world\"><translate x=\"-0.5\" y=\"-0.5\" z=\"4.5\"/></transform>";
  const auto volume = [](const std::string& more) {
    return "<volume type=\"constvolume\" name=\"sigma_t\"><float name=\"value\" value=\"1\"/>" + more + "</volume>";
  };
  EXPECT_NEAR(seen_through(volume(here)), std::exp(-1.), 0.012);
  EXPECT_NEAR(seen_through(volume("")), 1, 1e-3);  // the unit cube at the origin
  EXPECT_NEAR(seen_through("<float name=\"sigma_t\" value=\"1\"/>"), 1, 1e-3);
}

TEST(MitsubaMedium, AVolumelightIsWhatItsMediumAddsPerDistance) {
  const auto shining = [](const std::string& medium) {
    return seen(import_text(
                    scene(volumetric + ball(medium + "<emitter type=\"volumelight\"><rgb name=\"radiance\" value=\"0.3\"/>"
                                                     "</emitter>"))),
                16384)
        .y;
  };
  const std::string albedo = "<float name=\"albedo\" value=\"0\"/>";
  EXPECT_NEAR(shining("<medium type=\"homogeneous\" name=\"interior\"><float name=\"sigma_t\" value=\"0\"/></medium>"), 0.6,
              0.01);
  EXPECT_NEAR(
      shining("<medium type=\"homogeneous\" name=\"interior\"><float name=\"sigma_t\" value=\"0.5\"/>" + albedo + "</medium>"),
      0.3 * (1 - std::exp(-1.)) / 0.5, 0.01);
  // A medium that ends with its box emits only within it.
  EXPECT_NEAR(shining("<medium type=\"heterogeneous\" name=\"interior\">" + albedo +
                      "<float name=\"scale\" value=\"3\"/><volume type=\"constvolume\" name=\"sigma_t\"><float name=\"value\" "
                      "value=\"0\"/><transform name=\"to_world\"><scale value=\"8\"/><translate x=\"-4\" y=\"-4\" z=\"-3\"/>"
                      "</transform></volume></medium>"),
              0.3, 0.01);
  const Imported none = import_text(scene(volumetric + sky + ball("<emitter type=\"volumelight\"/>")));
  EXPECT_NE(none.told().find("its shape has none"), std::string::npos);
}

TEST(MitsubaLight, AProjectorOfOneColourIsASquareOfItsFieldOfView) {
  const auto lit = [](const std::string& projector, const char* x) {
    const std::string look = std::string("<transform name=\"to_world\"><lookat origin=\"0, 0, 0\" target=\"") + x +
                             ", 0, 5\" up=\"0, 1, 0\"/></transform>";
    return seen(import_text(
                    scene(sensor("<float name=\"fov\" value=\"0.5\"/>" + look) + integrator() + "<emitter type=\"projector\">" +
                          projector +
                          "</emitter><shape type=\"rectangle\"><transform name=\"to_world\"><scale value=\"10\"/><rotate "
                          "y=\"1\" angle=\"180\"/><translate z=\"5\"/></transform></shape>")),
                64)
        .y;
  };
  const std::string red = "<rgb name=\"irradiance\" value=\"2\"/>", narrow = "<float name=\"fov\" value=\"45\"/>";
  const double middle = lit(red + narrow, "0");
  EXPECT_NEAR(middle, 2 * 0.5 / 25, 2e-3);
  EXPECT_NEAR(lit(red + narrow, "2.0"), middle, 2e-3);  // the edge is at 5 tan(22.5 deg) = 2.07
  EXPECT_EQ(lit(red + narrow, "2.15"), 0);
  // 50 mm: half the diagonal is 5 * 43.267 / 100 = 2.163, half the width of a square 1.530.
  EXPECT_GT(lit(red, "1.5"), 0.03);
  EXPECT_EQ(lit(red, "1.56"), 0);
  EXPECT_EQ(lit(red + "<string name=\"focal_length\" value=\"100mm\"/>", "0.8"), 0);
}

// Mitsuba 3.9.1's own numbers: its x is south, its y is west.
TEST(MitsubaLight, TheSunStandsWhereItDoesAtAPlaceAndTime) {
  struct Row {
    const char* more;
    double x, y, z;
  };
  const Row rows[] = {
      {"", 0.0513854, 0.691748, 0.720308},
      {"<float name=\"hour\" value=\"9\"/>", 0.0956952, -0.614786, 0.782867},
      {"<float name=\"hour\" value=\"12\"/><float name=\"latitude\" value=\"48\"/><float name=\"longitude\" "
       "value=\"11\"/><float "
       "name=\"timezone\" value=\"1\"/><integer name=\"year\" value=\"2024\"/><integer name=\"month\" value=\"3\"/><integer "
       "name=\"day\" value=\"20\"/>",
       0.737596, -0.10154, 0.667564}};
  for (const Row& row : rows) {
    const Imported read =
        import_text(scene(sensor() + integrator() + "<emitter type=\"sunsky\">" + std::string(row.more) + "</emitter>"));
    ASSERT_TRUE(read.job) << read.told();
    const Value sun = get(part(read.object(0), "emission"), "sun_direction");
    ASSERT_TRUE(sun.as<Numbers>());
    const std::vector<double>& v = sun.as<Numbers>()->values;  // here y is up
    EXPECT_NEAR(v[0], row.x, 1e-3);
    EXPECT_NEAR(v[1], row.z, 1e-3);
    EXPECT_NEAR(v[2], -row.y, 1e-3);
  }
  const Imported sky_alone = import_text(scene(
      sensor() + integrator() +
      "<emitter type=\"sunsky\"><float name=\"sun_scale\" value=\"0\"/><float name=\"sky_scale\" value=\"3\"/></emitter>"));
  const Component& emission = part(sky_alone.object(0), "emission");
  EXPECT_EQ(*get(emission, "sun").as<bool>(), false);
  EXPECT_EQ(number(emission, "scale"), 3);
}

TEST(MitsubaSurface, WhatFiltersPolarizationLetsHalfThrough) {
  struct Case {
    const char* bsdf;
    double expected;
    const char *told, *description;
  };
  for (const Case& c :
       {Case{"<bsdf type=\"polarizer\"><float name=\"theta\" value=\"30\"/></bsdf>", 0.5, "", "LinearPolarizer { angle: -30"},
        Case{"<bsdf type=\"retarder\"><float name=\"theta\" value=\"20\"/><float name=\"delta\" value=\"180\"/></bsdf>", 1, "",
             "Retarder { angle: 20 deg, retardance: 0.5"},
        Case{"<bsdf type=\"circular\"><float name=\"transmittance\" value=\"0.6\"/></bsdf>", 0.3, "without polarization",
             "MaskShader"}}) {
    const Imported read = import_text(scene(sensor() + integrator(4) + before_sky(c.bsdf)));
    EXPECT_NEAR(brightness(read, c.told), c.expected, 0.02) << c.bsdf;
    ASSERT_TRUE(read.job);
    EXPECT_NE(write_description(*read.job).find(c.description), std::string::npos) << write_description(*read.job);
  }
}

TEST(MitsubaSurface, OwnTablesOfMetalsAreExact) {
  const auto told = [](const std::string& metal) {
    return import_text(scene(sensor() + integrator() +
                             before_sky("<bsdf type=\"conductor\"><string name=\"material\" value=\"" + metal + "\"/></bsdf>")))
        .told();
  };
  for (const char* metal : {"a-C",      "Na_palik",  "Ag",         "Al",         "Au",         "Be",           "Be_palik",
                            "Cr",       "CsI",       "CsI_palik",  "Cu",         "Cu_palik",   "Cu2O",         "Cu2O_palik",
                            "CuO",      "CuO_palik", "Hg",         "Hg_palik",   "HgTe",       "HgTe_palik",   "Ir",
                            "Ir_palik", "K",         "K_palik",    "Li",         "Li_palik",   "MgO",          "MgO_palik",
                            "Mo",       "Mo_palik",  "Nb",         "Nb_palik",   "Ni_palik",   "Rh",           "Rh_palik",
                            "SiC",      "SiC_palik", "SnTe",       "SnTe_palik", "Ta",         "Ta_palik",     "Te",
                            "Te_palik", "Te-e",      "Te-e_palik", "ThF4",       "ThF4_palik", "TiC",          "TiC_palik",
                            "TiN",      "TiN_palik", "TiO2",       "TiO2_palik", "TiO2-e",     "TiO2-e_palik", "VC",
                            "VC_palik", "V_palik",   "VN",         "VN_palik",   "W",          "none"})
    EXPECT_EQ(told(metal), "") << metal;
  // Beyond a table that ends within the visible range, Mitsuba's metal is a perfect mirror.
  for (const char* metal : {"AlSb", "AlSb_palik", "d-C", "d-C_palik", "Se", "Se_palik", "Se-e", "Se-e_palik"})
    EXPECT_NE(told(metal).find("here the last n and k go on"), std::string::npos) << metal;
  for (const char* metal : {"AlAs", "AlAs_palik"}) EXPECT_NE(told(metal).find("n = 0 from 394"), std::string::npos) << metal;
}

TEST(MitsubaSurface, UnknownMetalsAreTold) {
  const Imported i = import_text(scene(
      sensor() + integrator() + before_sky("<bsdf type=\"roughconductor\"><string name=\"material\" value=\"Moo\"/></bsdf>")));
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_NE(i.told().find("'Moo' are not known here (did you mean 'Mo'?): those of chromium stand for them; known are 'Au',"),
            std::string::npos)
      << i.told();
}

// The luminous reflectance that follows from Mitsuba's own files for amorphous carbon: not chromium's 0.66.
TEST(MitsubaSurface, AmorphousCarbonIsDark) {
  const std::string carbon = "<bsdf type=\"conductor\"><string name=\"material\" value=\"a-C\"/></bsdf>";
  const Imported i = import_text(scene(sensor() + integrator() + before_sky("<bsdf type=\"twosided\">" + carbon + "</bsdf>")));
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_NEAR(seen(i).y, 0.2111, 0.003);
}

TEST(MitsubaTexture, AVolumeOfOneColourIsThatColour) {
  const std::string bsdf =
      "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"volume\"><volume name=\"volume\" "
      "type=\"constvolume\"><float name=\"value\" value=\"0.25\"/></volume></texture></bsdf></bsdf>";
  EXPECT_NEAR(seen(import_text(scene(sensor() + integrator() + before_sky(bsdf)))).y, 0.25, 0.01);
}

TEST(MitsubaSensor, ABatchIsItsFirstSensor) {
  std::string batch = sensor();
  batch = "<sensor type=\"batch\"><sensor type=\"perspective\"><float name=\"fov\" value=\"33\"/></sensor>" +
          batch.substr(batch.find("<film"));
  const Imported read = import_text(scene(batch + integrator() + sky));
  EXPECT_NE(read.told().find("batch"), std::string::npos);
  ASSERT_TRUE(read.job) << read.told();
  EXPECT_NEAR(number(*read.job->camera, "fov"), 33 * M_PI / 180, 1e-6);
}

// On file systems that ignore case, files of such a type work in Mitsuba.
TEST(MitsubaNames, TypesMayHaveCapitals) {
  const Imported read = import_text(scene(sensor() + integrator() + sky + "<shape type=\"Rectangle\"/>"));
  EXPECT_EQ(read.told(), "");
  EXPECT_EQ(read.object(1).class_info().name, "Rectangle");
}

}  // namespace
}  // namespace etendue::mitsuba_test
