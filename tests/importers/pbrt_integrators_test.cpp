// pbrt's integrators, tested with pictures that follow from their definitions.

#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const std::string diffuse = "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n",
                  mirror = "Material \"mirror\" \"rgb Kr\" [.9 .9 .9]\n";

std::string ball(double z) { return "AttributeBegin Translate 0 0 " + std::to_string(z) + " Shape \"sphere\" AttributeEnd\n"; }
/// A triangle perpendicular to the z axis, of about this size.
std::string plate(double z, double size) {
  const std::string s = std::to_string(size), at = std::to_string(z);
  return "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-" + s + " -" + s + " " + at + " " + s + " -" + s +
         " " + at + " 0 " + s + " " + at + "]\n";
}

Imported by(const std::string& integrator, const std::string& world) {
  return import_text(v3(world, "\"float fov\" 1", "Integrator " + integrator + "\n"));
}
double brightness(const std::string& integrator, const std::string& world) {
  const Imported i = by(integrator, world);
  EXPECT_EQ(i.told(), "");
  return seen(i, 1024).y;
}

// Both integrators of version 3 compute the direct light of all luminaires, delta lights included: with the albedo 0.5 under a
// white sky half of the light is reflected, from a point of intensity 10 at distance 5 along the normal 10 / 25 * 0.5 / pi.
TEST(PbrtIntegrators, WhittedAndDirectLightingSeeAllLuminaires) {
  for (const std::string integrator : {"\"whitted\"", "\"directlighting\"", "\"directlighting\" \"string strategy\" \"one\""}) {
    EXPECT_NEAR(brightness(integrator, sky + diffuse + ball(5)), 0.5, 0.005) << integrator;
    EXPECT_NEAR(brightness(integrator, "LightSource \"point\" \"rgb I\" [10 10 10]\n" + diffuse + plate(5, 1)),
                10.0 / 25 * 0.5 / M_PI, 0.001)
        << integrator;
    // A luminous sphere around the scene.
    EXPECT_NEAR(brightness(integrator,
                           "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] ReverseOrientation Shape \"sphere\" "
                           "\"float radius\" 50 AttributeEnd\n" +
                               diffuse + ball(5)),
                0.5, 0.005)
        << integrator;
  }
}

// The depth counts surfaces along the path: at depth 1 a mirror is black, and at depth 2 glass shows its first reflection only.
TEST(PbrtIntegrators, MirrorsAndGlassAreFollowed) {
  const std::string behind = sky + diffuse + plate(-5, 5) + mirror + plate(5, 0.2);
  const std::string glass = sky + "Material \"glass\" \"float eta\" 1.5\n" + ball(5);
  for (const std::string integrator : {"\"whitted\"", "\"directlighting\""}) {
    EXPECT_NEAR(brightness(integrator, behind), 0.9 * 0.5, 0.005) << integrator;
    EXPECT_NEAR(brightness(integrator + " \"integer maxdepth\" 2", behind), 0.9 * 0.5, 0.005) << integrator;
    EXPECT_EQ(brightness(integrator + " \"integer maxdepth\" 1", behind), 0) << integrator;
    EXPECT_NEAR(brightness(integrator + " \"integer maxdepth\" 2", glass), 0.04, 0.001) << integrator;
    EXPECT_NEAR(brightness(integrator + " \"integer maxdepth\" 3", glass), 0.04 + 0.96 * 0.96, 0.002) << integrator;
    EXPECT_NEAR(brightness(integrator, glass), 1, 0.002) << integrator;
  }
  // Light reflected between surfaces is not found.
  EXPECT_EQ(brightness("\"whitted\"", "LightSource \"point\" \"rgb I\" [1 1 1] \"point from\" [0 9 0]\n" + diffuse +
                                          plate(5, 1) + "Translate 0 9 0\n" + ball(0)),
            0);
}

// Version 3 does not divide by pi; pixels without a hit are black.
TEST(PbrtIntegrators, AmbientOcclusion) {
  EXPECT_NEAR(brightness("\"ambientocclusion\"", ball(5)), M_PI, 0.01);
  EXPECT_EQ(brightness("\"ambientocclusion\"", ""), 0);
  const auto v4_seen = [](const std::string& world) {
    return seen(import_text(v4(world, "", "\"float fov\" 1", "Integrator \"ambientocclusion\"\n")), 256).y;
  };
  EXPECT_NEAR(v4_seen(ball(5)), 1, 0.005);
  EXPECT_EQ(v4_seen(""), 0);
}

// Multiplexed Metropolis (pbrt-v3, MLTIntegrator), with a shutter that is open for some time, as it is in pbrt by default.
TEST(PbrtIntegrators, MetropolisIsTheSame) {
  const Imported i =
      by("\"mlt\" \"integer maxdepth\" 4 \"float largestepprobability\" .4 \"float sigma\" .02 \"integer chains\" 64 "
         "\"integer bootstrapsamples\" 1000 \"integer mutationsperpixel\" 10",
         sky + diffuse + ball(5));
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_EQ(i.told(), "");
  const Component& r = *i.job->renderer;
  EXPECT_EQ(r.class_info().name, "MultiplexedMetropolis");
  EXPECT_EQ(number(r, "max_depth"), 5);
  EXPECT_NEAR(number(r, "large_steps"), 0.4, 1e-6);
  EXPECT_NEAR(number(r, "deviation"), 0.02, 1e-6);
  EXPECT_EQ(number(r, "chains"), 64);
  EXPECT_EQ(number(r, "samples") * number(r, "mutations_per_sample"), 12);  // at least 10
  EXPECT_NE(by("\"mlt\" \"float largestepprobability\" 0", ball(5)).told().find("'largestepprobability' becomes 0.01, not 0"),
            std::string::npos);
  const double seen_by_paths = brightness("\"path\"", sky + diffuse + ball(5));
  EXPECT_NEAR(brightness("\"mlt\" \"integer mutationsperpixel\" 4000", sky + diffuse + ball(5)), seen_by_paths,
              0.02 * seen_by_paths);
}

TEST(PbrtIntegrators, DifferencesAreTold) {
  const auto told = [](const std::string& integrator, const std::string& world) {
    return import_text(v4(world, "", "\"float fov\" 1", "Integrator " + integrator + "\n")).told();
  };
  const std::string glass = "Material \"dielectric\"\n" + ball(5), rough = "Material \"dielectric\" \"float roughness\" .1\n";
  EXPECT_NE(told("\"randomwalk\"", glass).find("1:1: the integrator 'randomwalk' tries all directions alike"),
            std::string::npos);
  EXPECT_NE(told("\"simplepath\" \"bool samplebsdf\" false", glass).find("tries all directions alike"), std::string::npos);
  EXPECT_EQ(told("\"simplepath\"", glass), "");
  EXPECT_EQ(told("\"randomwalk\"", rough + ball(5)), "");
  const std::string medium = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\"\nMediumInterface \"m\" \"\"\n" + glass;
  EXPECT_NE(told("\"path\"", medium).find("the integrator 'path' leaves media out in pbrt"), std::string::npos);
  EXPECT_EQ(told("\"volpath\"", medium).find("leaves media out"), std::string::npos);
}

}  // namespace
}  // namespace etendue::pbrt_test
