// The conformance kit: correct parts pass, and each of the deliberately wrong ones in conform_faults/ fails the check that is
// meant to find its fault.

#include "check/conform/conformance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

#include "check/conform/draw.h"
#include "check/conform/fixtures/fixtures.h"
#include "check/conform/object_trial.h"
#include "check/conform/shader_trial.h"
#include "check/conform/sphere_cells.h"
#include "check/conform/statistics.h"
#include "etendue/core/warp.h"
#include "etendue/language/language.h"
#include "support/process.h"

namespace etendue::conform {
namespace {

std::vector<Outcome> outcomes_of(const std::string& name, int drawn = 1, std::uint64_t seed = 1) {
  return conform({{name}, Effort::quick, drawn, seed, 0, {}});
}

std::string failures(const std::vector<Outcome>& outcomes) {
  std::string all;
  for (const Outcome& o : outcomes)
    if (o.result == Result::failed) all += "  " + o.class_name + ": " + o.check + ": " + o.detail + "\n    of " + o.part + "\n";
  return all;
}

/// The built-in classes: those whose interface has checks, or all others.
std::vector<std::string> built_in(bool with_checks) {
  const Registry& registry = Registry::instance();
  std::vector<std::string> names;
  for (const ClassInfo* info : registry.all()) {
    if (info->abstract() || !info->provider.empty()) continue;
    // Excludes classes that other tests register.
    if (!std::filesystem::exists(ETENDUE_SOURCE_DIR "/docs/manual/" + info->name + ".md")) continue;
    bool checked = false;
    for (const std::string& interface : checked_interfaces()) checked = checked || info->is_a(*registry.find(interface));
    if (checked == with_checks) names.push_back(info->name);
  }
  return names;
}

/// Checks that are expected not to be tried. Any other check that is not tried means missing data or a broken part.
const std::multimap<std::string, std::string> never_tried = {
    {"AmbientOcclusionRenderer", "pictures of known value"},
    {"AdaptiveSampling", "pictures of known value"},  // the inner renderers that were drawn splat
    {"Automatic", "pictures of known value"},         // members were drawn that its candidates must not set
    {"FeatureRenderer", "pictures of known value"},
    {"DirectRenderer", "pictures of known value"},
    {"WhittedRenderer", "pictures of known value"},
    {"BidirectionalPathTracer", "pictures of known value"},  // members were drawn that leave strategies out
    {"ManyLights", "pictures of known value"},               // drawn without compensation
    {"PhotonMapper", "pictures of known value"},
    {"PrimarySampleMetropolis", "pictures of known value"},  // the inner renderers that were drawn learn
    // The numbers of photons that were drawn are small, so the noise is too large.
    {"ProgressivePhotonMapper", "the value of a plane under an environment is the known one"},
    {"ProgressivePhotonMapper", "the value of a plane under a distant light is the known one"},
    {"VertexConnectionMerging", "the value of a plane under an environment is the known one"},
    {"VertexConnectionMerging", "the value of a plane under a distant light is the known one"},
    {"LightTracer", "the value of a plane under a distant light is the known one"},  // too much noise with few samples
    {"TriangleMesh", "reads a sample file as motion_files"}};

std::string untried(const std::vector<Outcome>& outcomes) {
  std::string all;
  for (const Outcome& o : outcomes) {
    const auto [begin, end] = never_tried.equal_range(o.class_name);
    const bool known = std::any_of(begin, end, [&](const auto& row) { return row.second == o.check; });
    if (o.result == Result::not_tried && !known) all += "  " + o.class_name + ": " + o.check + ": " + o.detail + "\n";
  }
  return all;
}

/// The number of checks of a class that passed.
long passed(const std::vector<Outcome>& outcomes, const std::string& name) {
  return std::count_if(outcomes.begin(), outcomes.end(),
                       [&](const Outcome& o) { return o.class_name == name && o.result == Result::passed; });
}

// With an empty or incomplete list of classes, the following tests would pass without testing anything.
TEST(Conform, AllBuiltInClassesAreTried) {
  std::set<std::string> tried;
  for (const bool with_checks : {true, false})
    for (const std::string& name : built_in(with_checks)) tried.insert(name);
  const TemporaryFolder folder;
  Process program(ETENDUE_BINARY_DIR "/etendue", {"classes", "--json"}, folder);  // without the classes that tests register
  ASSERT_EQ(program.wait(), 0) << program.err();
  int all = 0;
  for (const auto& info : nlohmann::json::parse(program.out())) {
    if (info["abstract"]) continue;
    ++all;
    EXPECT_TRUE(tried.contains(info["name"])) << info["name"] << " has no page in docs/manual";
  }
  EXPECT_GT(all, 140);
}

class BuiltIn : public ::testing::TestWithParam<std::string> {};
TEST_P(BuiltIn, PartsConform) {
  const std::vector<Outcome> outcomes = outcomes_of(GetParam());
  EXPECT_EQ(failures(outcomes), "");
  EXPECT_EQ(untried(outcomes), "");
  EXPECT_GE(passed(outcomes, GetParam()), 10);
}
INSTANTIATE_TEST_SUITE_P(Conform, BuiltIn, ::testing::ValuesIn(built_in(true)), [](const auto& each) { return each.param; });

/// Classes whose drawn members do not lead to hours of work: for renderers the number of rays per split is drawn as well.
std::vector<std::string> quick_to_draw() {
  std::vector<std::string> names = built_in(true);
  const ClassInfo& renderer = *Registry::instance().find("Renderer");
  std::erase_if(names, [&](const std::string& name) { return Registry::instance().find(name)->is_a(renderer); });
  return names;
}

// The parts and samples drawn with one seed may hide faults that another seed shows.
class BuiltInAgain : public ::testing::TestWithParam<std::string> {};
TEST_P(BuiltInAgain, PartsOfAnotherSeedConform) { EXPECT_EQ(failures(outcomes_of(GetParam(), 1, 2)), ""); }
INSTANTIATE_TEST_SUITE_P(Conform, BuiltInAgain, ::testing::ValuesIn(quick_to_draw()),
                         [](const auto& each) { return each.param; });

// One seed may hide faults that others show. This takes half an hour, so it is run on request only: ETENDUE_CONFORM_SEEDS=3
// tries all classes with the seeds 1 to 3, as `etendue conform --quick --seed N` does.
TEST(Conform, PartsOfManySeedsConform) {
  const char* asked = std::getenv("ETENDUE_CONFORM_SEEDS");
  if (!asked) GTEST_SKIP() << "ETENDUE_CONFORM_SEEDS says with how many seeds";
  std::vector<std::string> names = built_in(true);
  for (const std::string& name : built_in(false)) names.push_back(name);
  for (int seed = 1; seed <= std::atoi(asked); ++seed)
    EXPECT_EQ(failures(conform({names, Effort::quick, 3, std::uint64_t(seed), 0, {}})), "") << "seed " << seed;
}

TEST(Conform, AllOtherClassesConformAsComponents) {
  const std::vector<std::string> names = built_in(false);
  ASSERT_FALSE(names.empty());  // an empty list would mean all classes
  const std::vector<Outcome> outcomes = conform({names, Effort::quick, 3, 1, 0, {}});
  EXPECT_EQ(failures(outcomes), "");
  EXPECT_EQ(untried(outcomes), "");
  for (const std::string& name : names) EXPECT_GE(passed(outcomes, name), 10) << name;
}

/// A class of the plugin, and the check that must find its fault.
struct Fault {
  const char *class_name, *check;
};
void PrintTo(const Fault& f, std::ostream* out) { *out << f.class_name; }

class Faulty : public ::testing::TestWithParam<Fault> {};
TEST_P(Faulty, PartsAreFound) {
  Registry::instance().load_plugin(ETENDUE_CONFORM_FAULTS_LIBRARY);
  const std::vector<Outcome> outcomes = outcomes_of(GetParam().class_name);
  bool found = false;
  for (const Outcome& o : outcomes) found = found || (o.check == GetParam().check && o.result == Result::failed);
  EXPECT_TRUE(found) << "'" << GetParam().check << "' did not fail; these did:\n" << failures(outcomes);
}
INSTANTIATE_TEST_SUITE_P(
    Conform, Faulty,
    ::testing::Values(Fault{"WrongDensityShader", "samples follow the density"},
                      Fault{"GainingShader", "no more light leaves than arrives"},
                      Fault{"DimAlbedoShader", "the albedo is that of the samples"},
                      Fault{"WildAlbedoShader", "the albedo is that of the samples"},
                      Fault{"BoundlessAlbedoShader", "the error of the albedo is bounded"},
                      Fault{"OneWayShader", "f is reciprocal"}, Fault{"HeroIndexShader", "f is reciprocal"},
                      Fault{"WrongWeightShader", "a sample's weight is value over density"},
                      Fault{"MaskIgnoringShader", "samples follow the density"},
                      Fault{"GrazingShader", "values and densities are finite and not negative, at grazing angles too"},
                      Fault{"EndlessFilter", "weights are zero beyond the radius"},
                      Fault{"WrongPhaseVolume", "the phase function integrates to 1"},
                      Fault{"BackwardPhase", "drawn angles follow the phase function"},
                      Fault{"WrongPowerEmission", "power is the integral of radiance, on a Rectangle"},
                      Fault{"WrongDirectionsEmission", "sampled directions follow the density"},
                      Fault{"WrongAreaSquare", "the area is that which lines find"},
                      Fault{"WrongVisibleSquare", "points sampled to be seen have densities of the solid angle seen"},
                      Fault{"MissWritingSquare", "a miss leaves the hit unchanged"},
                      Fault{"InwardSquare", "normals of a closed object point outwards"},
                      Fault{"WrongTangentsSquare", "tangents are the change of position with surface coordinates"},
                      Fault{"LostTangentsSquare", "tangents are found again for a point without them"},
                      Fault{"SecretLensCamera", "without a lens rays do not depend on the lens point"},
                      Fault{"UnboundedMap", "reflectances are in [0, 1]"},
                      Fault{"CameraSpaceMap", "a value does not depend on the origin of rendering space"},
                      Fault{"OneSpaceMap", "in the object's own space a value moves with the object"},
                      Fault{"OtherSpaceMap", "in world space a value does not depend on the object's own coordinates"},
                      Fault{"WithoutTangentsMap", "a value is the same for a point with and without tangents"},
                      Fault{"DimRenderer", "the value of a furnace is the known one"},
                      Fault{"ForgetfulFilter", "preparing leaves the members as they were written"},
                      Fault{"GlowingToneMap", "a black picture stays black"},
                      Fault{"SolarizingToneMap", "what is brighter is not shown darker"},
                      Fault{"HalfExposedToneMap", "an exposure of one stop less halves what goes in"},
                      Fault{"PlaceToneMap", "equal pixels are shown equal by a map that is not local"},
                      Fault{"UnclippedToneMap", "what is shown of a right picture is finite, and in [0, 1] if the map clips"},
                      Fault{"AlwaysPaintedShader", "what does not matter changes nothing"},
                      Fault{"MisreadShader", "colours are asked for what they are said to be read as"},
                      Fault{"StandingOutput", "what is read back is what was written"},
                      Fault{"HastyOutput", "the file is written beside and put in place when it is whole"},
                      Fault{"LitteringOutput", "nothing is left beside the file"},
                      Fault{"SilentOutput", "an Error names the path that cannot be written"},
                      Fault{"ClosedSampler", "numbers lie in [0, 1)"}, Fault{"SkewedSampler", "numbers are uniform"},
                      Fault{"DrawingSampler", "the same arguments give the same numbers"},
                      Fault{"OneSeedSampler", "dimensions, pixels and seeds are independent"},
                      Fault{"ClumpedSampler", "samples of a pixel are spread no worse than random ones"},
                      Fault{"UnshuffledSampler", "samples of a pixel are independent between dimensions"},
                      Fault{"HastySampler", "two pairs at once are those of two calls"},
                      Fault{"UltravioletWavelengths", "wavelengths lie in [360, 830] nm"},
                      Fault{"OverstatedWavelengths", "densities integrate to 1"},
                      Fault{"OverstatedWavelengths", "the mean colour of a constant spectrum is its colour"},
                      Fault{"ReddishWavelengths", "wavelengths follow the density"},
                      Fault{"ThrowingImporter", "a file that cannot be read is an Error, and nothing else is thrown"},
                      Fault{"NamelessImporter", "an Error names the file"},
                      Fault{"FickleImporter", "the same file gives the same components, or the same error"},
                      Fault{"LooseKnob", "a knob turns back as far as it turned"}),
    [](const auto& each) { return std::string(each.param.class_name) + "_" + std::to_string(each.index); });

// Each side of a boundary may have its own index at each wavelength.
TEST(Conform, ReciprocityIsThatOfEachWavelength) {
  const Fixtures fixtures;
  for (const char* text :
       {"Dielectric { exterior: rgb(0.747, 0.793, 0.538), roughness: 0.6 }",
        "Dielectric { ior: glass(\"N-BK7\"), exterior: rgb(1.1, 1.4, 1.2), roughness: 0.3, transmission_tint: 0.5 }"}) {
    const Ref<Shader> shader = ref_cast<Shader>(parse_component(text));
    prepare_tree(*shader);
    Trial trial(*shader, text, false, fixtures, Effort::standard, 1);
    const BoundShader bound(*shader, carrier_of(*shader), {0.3f, 0.7f}, 480, 0, 0);
    check_shader_reversal(trial, bound, bound);
    EXPECT_EQ(failures(trial.outcomes()), "");
    const auto reciprocal = std::ranges::count(trial.outcomes(), "f is reciprocal", &Outcome::check);
    EXPECT_EQ(reciprocal, 1);
  }
}

// The poles of a long ellipsoid lie on its flat sides. A twentieth of its points are so near to a pole that a step of a
// thousandth of its length is not small.
TEST(Conform, StepsNearPolesAreSmall) {
  const Fixtures fixtures;
  for (const char* transform :
       {"translate(0, 0, 0)", "matrix([[1.26, 0.99, -0.69, -0.17], [-1.05, 1.38, 0.05, -0.36], [0.57, 0.38, 1.6, -1.44]])"}) {
    const std::string text = std::string("Ellipsoid { radii: [2.18, 0.34, 0.26] m, transform: ") + transform + " }";
    const Ref<SceneObject> object = ref_cast<SceneObject>(parse_component(text));
    prepare_tree(*object);
    Trial trial(*object, text, false, fixtures, Effort::standard, 1);
    check_tangents(ObjectTrial(trial, *object));
    EXPECT_EQ(failures(trial.outcomes()), "");
    EXPECT_EQ(trial.outcomes().size(), 3u);
  }
}

TEST(Conform, EveryInterfaceHasAWayToBeTried) {
  Registry::instance().load_plugin(ETENDUE_CONFORM_FAULTS_LIBRARY);
  const std::vector<std::string> checked = checked_interfaces();
  const auto has = [&](const std::string& name) { return std::ranges::find(checked, name) != checked.end(); };
  for (const char* name :
       {"Shader", "VolumeShader", "PhaseFunction", "Camera", "Filter", "Sampler", "EmissionShader", "ObjectMap", "SceneObject",
        "LightSampler", "Renderer", "ToneMap", "Output", "WavelengthSampler", "Importer", "Exporter", "Knob", "Denoiser"})
    EXPECT_TRUE(has(name)) << name;
}

TEST(Conform, OutcomesDependOnTheSeedAlone) {
  const auto text = [](int threads, std::uint64_t seed) {
    std::string all;
    for (const Outcome& o : conform({{"PhongShader", "Filter"}, Effort::quick, 2, seed, threads, {}}))
      all += o.check + o.part + o.detail + (o.result == Result::passed ? "+" : "-") + "\n";
    return std::regex_replace(all, std::regex("etendue-conform-\\w{6}"), "folder");
  };
  EXPECT_EQ(text(1, 3), text(2, 3));
  EXPECT_NE(text(1, 3), text(1, 4));  // other parts are drawn
}

TEST(Conform, DrawnPartsCanBeMadeAgain) {
  const Fixtures fixtures;
  std::mt19937_64 random(5);
  for (const char* name : {"PhongShader", "PerspectiveCamera", "TriangleMesh", "HomogeneousVolume", "CheckerMap"}) {
    int different = 0;
    std::string last;
    for (int i = 0; i < 10; ++i) {
      const Drawn drawn = draw_part(*Registry::instance().find(name), fixtures, random);
      ASSERT_TRUE(drawn.part) << name << ": " << drawn.refused;
      const Ref<Component> again = parse_component(drawn.text);
      EXPECT_EQ(write_description(*again), drawn.text);
      EXPECT_TRUE(equal(Value(again), Value(drawn.part))) << drawn.text;
      different += drawn.text != last;
      last = drawn.text;
    }
    EXPECT_GT(different, 5) << name;
  }
}

TEST(Conform, UnknownClassesAreNamed) {
  try {
    conform({{"PhongShadr"}, Effort::quick, 0, 1, 0, {}});
    FAIL() << "nothing was thrown";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("PhongShader"), std::string::npos) << error.what();
  }
}

// The cells integrate lobes as narrow as a thousandth of a radian, near the pole and near the horizon, and wide lobes.
TEST(SphereCells, IntegrateSharpLobes) {
  std::mt19937 random(2);
  const auto uniform = [&] { return to_unit_float(std::uint32_t(random())); };
  for (const float exponent : {1.0f, 100.0f, 1e4f, 1e6f})
    for (const Vector3& peak :
         {Vector3{0, 0, 1}, Vector3{0.3f, 0.1f, 0.9f}, Vector3{1, 0.2f, 0.3f}, Vector3{0.3f, -0.8f, -0.02f}}) {
      const Frame around{Normal3(normalize(peak))};
      std::vector<Vector3> samples;
      for (int i = 0; i < 4000; ++i) {
        const float x = uniform();
        samples.push_back(around.to_world(warp::power_cosine({x, uniform()}, exponent)));
      }
      const SphereCells cells(samples, 96);
      EXPECT_GT(cells.size(), 50u);
      double sum = 0, solid_angle = 0;
      for (const auto& [p] : cells.integrate<1>([&](const Vector3& v) -> std::array<double, 1> {
             // cos(alpha) from the distance of the two unit vectors: exact for sharp lobes.
             const float h = length_squared(v - Vector3(around.n)) / 2;
             return {h < 1 ? double((exponent + 1) / (2 * pi) * std::exp(exponent * std::log1p(-h))) : 0};
           }))
        sum += p;
      EXPECT_NEAR(sum, 1, 2e-3) << exponent << " around " << peak.x << ", " << peak.y << ", " << peak.z;
      std::vector<double> counts(cells.size());
      for (size_t i = 0; i < cells.size(); ++i) {
        solid_angle += cells.solid_angle(i);
        EXPECT_EQ(cells.cell_of(cells.middle(i)), i);
      }
      EXPECT_NEAR(solid_angle, 4 * M_PI, 1e-9);
    }
}

TEST(Conform, TheCommandReportsFaults) {
  const TemporaryFolder folder;
  const std::string report = folder / "report.html";
  Process wrong(ETENDUE_BINARY_DIR "/etendue",
                {"conform", "WrongWeightShader", "--plugin", ETENDUE_CONFORM_FAULTS_LIBRARY, "--quick", "--report", report},
                folder);
  EXPECT_EQ(wrong.wait(), 1) << wrong.err();
  EXPECT_NE(wrong.out().find("FAILED: a sample's weight"), std::string::npos) << wrong.out();
  const std::string html = file_text(report);
  EXPECT_NE(html.find("WrongWeightShader"), std::string::npos);
  EXPECT_NE(html.find("FAILED"), std::string::npos);
  Process right(ETENDUE_BINARY_DIR "/etendue", {"conform", "Lambertian", "--quick", "--drawn", "0"}, folder);
  EXPECT_EQ(right.wait(), 0) << right.out() << right.err();
}

}  // namespace
}  // namespace etendue::conform
