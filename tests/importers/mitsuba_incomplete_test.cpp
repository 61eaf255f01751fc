// What a scene of Mitsuba leaves out, states twice, or states in its own terms: the replacement is reported, once for each
// cause.

#include <cmath>

#include "etendue/scene.h"
#include "mitsuba_support.h"
#include "support/image_file.h"

namespace etendue::mitsuba_test {
namespace {

const std::string lamp = "<emitter type=\"constant\"/>\n";

Imported with_integrator(const std::string& integrator, const char* version = "0.6.0") {
  return import_text(scene(sensor() + lamp + integrator, version));
}
std::string word(const Component& of, const std::string& member) {
  const Value value = get(of, member);
  const auto* found = value.as<std::string>();
  return found ? *found : "";
}
void expect_told(const Imported& imported, const std::string& all) {
  EXPECT_EQ(imported.told(), all);
  EXPECT_TRUE(imported.job);
}

TEST(MitsubaIncomplete, WhatAnIntegratorAroundAnotherAddsIsTold) {
  const std::string path = "<integrator type=\"path\"/></integrator>";
  const auto around = [&](const char* type, const std::string& inner) {
    return with_integrator(std::string("<integrator type=\"") + type + "\"><float name=\"maxError\" value=\"1\"/>" + inner);
  };
  expect_told(around("moment", path), "4:2: the channels that 'moment' adds are not written\n");
  expect_told(around("stokes", path), "4:2: the channels that 'stokes' adds are not written\n");
  expect_told(around("irrcache", path),
              "4:2: 'irrcache' is left out: irradiance is computed for each point by itself, without its bias\n");
  expect_told(around("irrcache", "<integrator type=\"direct\"/></integrator>"),
              "4:2: light that 'irrcache' adds to 'direct' is left out: 'path' has it\n");
  const Imported adaptive = around("adaptive", path);
  expect_told(adaptive, "4:2: 'adaptive' becomes AdaptiveSampling: samples are the mean over all pixels, whatever the error\n");
  EXPECT_EQ(adaptive.job->renderer->class_info().name, "AdaptiveSampling");
  EXPECT_EQ(part(*adaptive.job->renderer, "inner").class_info().name, "PathTracer");
  EXPECT_EQ(number(*adaptive.job->renderer, "samples"), 4096);
  const std::string cached = "<integrator type=\"irrcache\">" + path + "</integrator>";
  EXPECT_EQ(part(*around("adaptive", cached).job->renderer, "inner").class_info().name, "PathTracer");
  EXPECT_EQ(around("adaptive", "<integrator type=\"bdpt\"/></integrator>").job->renderer->class_info().name,
            "BidirectionalPathTracer");
}

TEST(MitsubaIncomplete, FieldsAreFeatures) {
  const auto feature = [](const std::string& integrator, const char* version) {
    const Imported i = with_integrator(integrator, version);
    EXPECT_TRUE(i.job) << i.told();
    EXPECT_EQ(i.job->renderer->class_info().name, "FeatureRenderer");
    return word(*i.job->renderer, "feature");
  };
  const auto field = [&](const char* name) {
    return feature(std::string("<integrator type=\"field\"><string name=\"field\" value=\"") + name + "\"/></integrator>",
                   "0.6.0");
  };
  EXPECT_EQ(field("distance"), "depth");
  EXPECT_EQ(field("geoNormal"), "normal");
  EXPECT_EQ(field("shNormal"), "shading_normal");
  EXPECT_EQ(field("primIndex"), "primitive");
  EXPECT_EQ(feature("<integrator type=\"aov\"><string name=\"aovs\" value=\"a:uv, dd:depth\"/></integrator>", "3.0.0"), "uv");
  expect_told(with_integrator("<integrator type=\"field\"><string name=\"field\" value=\"distance\"/></integrator>"), "");
}

TEST(MitsubaIncomplete, OneCauseIsToldOnce) {
  expect_told(with_integrator("<integrator type=\"photonmapper\"><integer name=\"globalPhotons\" value=\"1\"/><float "
                              "name=\"causticLookupRadius\" value=\"1\"/></integrator>"),
              "4:2: integrator 'photonmapper' becomes PhotonMapper, whose other settings are its defaults\n");
  const std::string shape =
      "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture type=\"gridtexture\" name=\"reflectance\"><float "
      "name=\"lineWidth\" value=\"0.1\"/></texture></bsdf></shape>\n";
  expect_told(with_integrator("<integrator type=\"path\"/>" + shape + shape),
              "4:69: texture 'gridtexture' has no counterpart here: 0.5 stands for it (and at 1 more place)\n");
  // Of several places the first in the file is reported.
  const std::string wide = "<shape type=\"sphere\"><bsdf type=\"diffuse\"><float name=\"width\" value=\"1\"/></bsdf></shape>\n";
  expect_told(with_integrator("<integrator type=\"path\"/>\n" + wide + wide),
              "5:44: 'width' of bsdf 'diffuse' is not used (and at 1 more place)\n");
}

TEST(MitsubaIncomplete, FilmsAndSamplersMayBeReferredTo) {
  expect_told(import_text(scene("<film type=\"hdrfilm\" id=\"f\"/><sampler type=\"independent\" id=\"s\"/><integrator "
                                "type=\"path\"/><sensor type=\"perspective\"><ref id=\"f\"/><ref id=\"s\"/></sensor>" +
                                lamp)),
              "");
}

TEST(MitsubaIncomplete, WhatIsMissingIsAsInVersion0) {
  const Imported i =
      import_text(scene("<shape type=\"sphere\"><point name=\"center\" x=\"3\" y=\"0\" z=\"2\"/></shape>", "0.6.0"));
  for (const char* words : {"no sensor", "no integrator: direct light", "no emitter: sky and sun"})
    EXPECT_NE(i.told().find(words), std::string::npos) << i.told();
  EXPECT_EQ(i.job->renderer->class_info().name, "DirectRenderer");
  const std::vector<double> from = get(*i.job->camera, "from").as<Numbers>()->values;
  EXPECT_NEAR(from[0], 3, 1e-5);
  EXPECT_NEAR(from[2], 1 - 2 / (2 * std::tan(M_PI / 8)), 1e-4);
  EXPECT_EQ(part(i.object(1), "emission").class_info().name, "SkyEmission");
  const Imported three = import_text(scene(sensor() + "<shape type=\"sphere\"/>"));
  EXPECT_EQ(three.told(), "1:1: the scene has no integrator: paths are traced\n");
}

TEST(MitsubaIncomplete, UnknownPluginsHaveStandIns) {
  const Imported i = import_text(
      scene("<sensor type=\"fisheye\"><float name=\"power\" value=\"1\"/><film type=\"myfilm\"><rfilter type=\"hann\"/></film>"
            "<sampler type=\"myown\"/></sensor><integrator type=\"pth\"/>" +
            lamp +
            "<shape type=\"sphere\"><bsdf type=\"clay\"><rgb name=\"reflectance\" value=\"0.5 0.2 0.1\"/><float "
            "name=\"softness\" value=\"1\"/></bsdf></shape><shape type=\"sphere\"><bsdf type=\"difuse\"/></shape>"));
  ASSERT_TRUE(i.job) << i.told();
  for (const char* words : {"there is no sensor 'fisheye' in Mitsuba: a perspective",
                            "no film 'myfilm' in Mitsuba (did you mean 'mfilm'?): it is taken for 'hdrfilm'",
                            "no rfilter 'hann' in Mitsuba: a Gaussian", "no sampler 'myown'",
                            "no integrator 'pth' in Mitsuba (did you mean 'path'?): paths",
                            "no bsdf 'clay' in Mitsuba: a matt surface of its colour",
                            "no bsdf 'difuse' in Mitsuba (did you mean 'diffuse'?): a matt grey"})
    EXPECT_NE(i.told().find(words), std::string::npos) << words << "\n" << i.told();
  EXPECT_EQ(i.told().find("not used"), std::string::npos) << i.told();
  EXPECT_EQ(i.notes.size(), 7u) << i.told();
}

TEST(MitsubaIncomplete, APropertyThatIsGivenTwiceCountsTheSecondTimeInVersion0) {
  const std::string twice =
      "<shape type=\"sphere\"><float name=\"radius\" value=\"2\"/><float name=\"radius\" value=\"3\"/></shape>";
  const Imported old = import_text(scene(sensor() + integrator() + lamp + twice, "0.6.0"));
  EXPECT_EQ(old.told(), "5:55: 'radius' is given twice: the last counts, as in Mitsuba 0.x\n");
  EXPECT_EQ(number(old.object(1), "radius"), 3);
  EXPECT_NE(import_text(scene(sensor() + integrator() + lamp + twice)).told().find("'radius' is given twice; the first is in"),
            std::string::npos);
}

TEST(MitsubaIncomplete, ASceneWithCamerasAndLuminairesIsOld) {
  const TemporaryFolder folder;
  test::write_image(folder.write("map.exr", ""), {2, 1, 3, NumberType::single}, std::vector<float>(6, 1.0f));
  const Imported i = import_text(
      folder,
      "<scene><integrator type=\"path\"/><camera type=\"perspective\"/><luminaire type=\"envmap\"><string name=\"filename\" "
      "value=\"map.exr\"/><float name=\"intensityScale\" value=\"3\"/></luminaire></scene>");
  EXPECT_EQ(i.told(),
            "1:2: <scene> does not say which version of Mitsuba it is for: it is read as for version 0.3, whose tags "
            "it has\n");
  EXPECT_EQ(number(part(i.object(0), "emission"), "scale"), 3);
}

TEST(MitsubaIncomplete, OlderWaysToSayColors) {
  const auto colored = [](const std::string& reflectance, const char* version) {
    const Imported i = import_text(
        seen_scene(lamp + "<shape type=\"sphere\"><bsdf type=\"diffuse\">" + reflectance + "</bsdf></shape>", 2, version));
    EXPECT_EQ(i.told(), "");
    return *get(part(part(i.object(1), "shader"), "color"), "value").as<Color>();
  };
  const Color grey = colored("<xyz name=\"reflectance\" value=\"0.4752 0.5 0.5444\"/>", "0.6.0");  // of D65
  for (const float nm : {450.f, 550.f, 650.f}) EXPECT_NEAR(grey->at(nm, ColorUse::reflectance), 0.5, 2e-3);
  const Color table = colored(
      "<texture type=\"regular\" name=\"reflectance\"><string name=\"values\" value=\"0.2, 0.6\"/><float "
      "name=\"lambda_min\" value=\"500\"/><float name=\"lambda_max\" value=\"600\"/></texture>",
      "2.0.0");
  EXPECT_NEAR(table->at(550, ColorUse::reflectance), 0.4, 1e-6);
  EXPECT_NEAR(table->at(575, ColorUse::reflectance), 0.5, 1e-6);
}

}  // namespace
}  // namespace etendue::mitsuba_test
