// Names of other programs: the message gives the name used here, and that name exists.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "describe/words.h"
#include "etendue/render/job.h"
#include "support/language_test_support.h"
#include "support/process.h"

namespace etendue::language_test {
namespace {

/// The texts between single quotes.
std::vector<std::string> quoted(std::string_view text) {
  std::vector<std::string> found;
  for (size_t at = text.find('\''); at != std::string_view::npos; at = text.find('\'', at + 1)) {
    const size_t end = text.find('\'', at + 1);
    if (end == std::string_view::npos) return {"an open quote"};
    found.emplace_back(text.substr(at + 1, end - at - 1));
    at = end;
  }
  return found;
}

bool capital(const std::string& name) { return std::isupper(static_cast<unsigned char>(name.front())); }

/// Checks all quoted names of an entry: they are classes, or members of one of these classes or of the class to which the
/// foreign word belongs.
void expect_all_there(const ForeignWord& entry) {
  std::vector<const ClassInfo*> classes;
  if (!entry.where.empty() && entry.where != "Component") {
    classes.push_back(Registry::instance().find(entry.where));
    ASSERT_TRUE(classes[0]) << entry.where;
    EXPECT_FALSE(classes[0]->find(entry.word)) << entry.where << " has '" << entry.word << "'";
  }
  const std::vector<std::string> names = quoted(entry.here);
  EXPECT_FALSE(names.empty() && entry.here.find("nothing") == std::string_view::npos) << entry.word;
  for (const std::string& name : names)
    if (capital(name)) {
      classes.push_back(Registry::instance().find(name));
      ASSERT_TRUE(classes.back()) << entry.word << ": there is no class '" << name << "'";
    }
  if (classes.empty()) classes = Registry::instance().all();
  if (classes.size() == 1 && classes[0]->abstract()) classes = Registry::instance().subclasses(*classes[0]);
  for (const std::string& name : names) {
    const auto has = [&](const ClassInfo* info) { return info->find(name) != nullptr; };
    if (!capital(name))
      EXPECT_TRUE(std::ranges::any_of(classes, has))
          << entry.where << " " << entry.word << ": there is no member '" << name << "'";
  }
}

TEST(Words, EveryNameTheyAreToldExists) {
  for (const ForeignWord& entry : foreign_classes()) {
    expect_all_there(entry);
    EXPECT_FALSE(Registry::instance().find(entry.word)) << entry.word;
  }
  for (const ForeignWord& entry : foreign_members()) expect_all_there(entry);
  EXPECT_GE(foreign_classes().size() + foreign_members().size(), 300u);
}

TEST(Words, AreFoundByTheirSpellingAndStandOnce) {
  for (const auto& table :
       {foreign_classes(), foreign_members(), foreign_choices(), foreign_units(), foreign_functions(), foreign_options()}) {
    std::set<std::pair<std::string_view, std::string_view>> seen;
    for (const ForeignWord& entry : table) {
      EXPECT_TRUE(seen.emplace(entry.where, entry.word).second) << entry.where << " " << entry.word;
      EXPECT_TRUE(std::ranges::all_of(entry.word, [](char c) { return std::islower(c) || std::isdigit(c); })) << entry.word;
      EXPECT_NE(translation(entry.word, table), "") << entry.word;
    }
  }
  // The suggestions for units and functions can be parsed.
  for (const ForeignWord& entry : foreign_units()) {
    const bool number = std::isdigit(static_cast<unsigned char>(entry.here.front()));
    EXPECT_NO_THROW(parse_value((number ? "" : "1 ") + std::string(entry.here))) << entry.word;
  }
}

TEST(Words, OfClasses) {
  const auto said = [](const std::string& name) { return part_errors(name + " {}"); };
  EXPECT_EQ(said("RoughConductor"),
            "1:1: there is no class 'RoughConductor' (Mitsuba's word; here it is 'Conductor' with 'roughness')");
  EXPECT_NE(said("roughconductor").find(" (Mitsuba's word; here it is 'Conductor' with 'roughness')"), std::string::npos);
  EXPECT_EQ(said("dielectric"), "1:1: there is no class 'dielectric' (did you mean 'Dielectric'?)");
  EXPECT_EQ(said("principled"), "1:1: there is no class 'principled' (did you mean 'Principled'?)");
  EXPECT_EQ(said("thin_dielectric"), "1:1: there is no class 'thin_dielectric' (did you mean 'ThinDielectric'?)");
  EXPECT_EQ(said("Path"), "1:1: there is no class 'Path' (here it is 'PathTracer')");
  EXPECT_EQ(said("Principled_BSDF"), "1:1: there is no class 'Principled_BSDF' (Blender's word; here it is 'Principled')");
  EXPECT_EQ(part_errors("LanguagePart { child: Principled BSDF {} }"),
            "1:23: there is no class 'Principled BSDF' (Blender's word; here it is 'Principled')");
  for (const char* word :
       {"Cube",     "diffuse",    "bitmap",   "conductor",  "plastic",      "area",         "envmap",    "infinite",
        "constant", "bdpt",       "volpath",  "shapegroup", "trianglemesh", "plymesh",      "imagemap",  "film",
        "sensor",   "integrator", "Emission", "Sun",        "sampler",      "sphere",       "Glass",     "Mirror",
        "matte",    "HDRI",       "Light",    "Pathtracer", "Spheres",      "SphereObject", "BvhScenes", "Lambertain"})
    EXPECT_TRUE(said(word).find("here it is") != std::string::npos || said(word).find("did you mean") != std::string::npos ||
                said(word).find("is an interface") != std::string::npos)
        << said(word);
}

TEST(Words, OfMembers) {
  const auto said = [](const std::string& text) { return part_errors("x = " + text + "\nLanguagePart {}").substr(5); };
  EXPECT_EQ(said("Lambertian { reflectance: 1 }"), " Lambertian has no member 'reflectance' (here it is 'color')");
  EXPECT_EQ(said("Principled { metallic: 1 }"), " Principled has no member 'metallic' (here it is 'base_metalness')");
  EXPECT_EQ(said("Sphere { toWorld: 1 }"), " Sphere has no member 'toWorld' (Mitsuba's word; here it is 'transform')");
  EXPECT_EQ(said("Sphere { to_world: 1 }"), " Sphere has no member 'to_world' (Mitsuba's word; here it is 'transform')");
  EXPECT_EQ(said("Sphere { radus: 1 }"), " Sphere has no member 'radus' (did you mean 'radius'?)");
  // Members that once had other names.
  EXPECT_EQ(said("Sphere { center: [0, 0, 0] }"), " Sphere has no member 'center' (here it is 'centre')");
  EXPECT_EQ(said("Metaballs { centers: [[0, 0, 0]] }"), " Metaballs has no member 'centers' (here it is 'centres')");
  EXPECT_EQ(said("Conductor { roughness_y: 0.1 }"), " Conductor has no member 'roughness_y' (here it is 'roughness_v')");
  EXPECT_EQ(said("SpotEmission { edge: linear }"),
            " SpotEmission has no member 'edge' (here it is 'ForeignSpotEmission' with 'edge', unless it is smooth)");
  EXPECT_EQ(said("PathTracer { spp: 1 }"), " PathTracer has no member 'spp' (here it is 'samples')");
  EXPECT_EQ(said("PathTracer { maxDepth: 1 }"), " PathTracer has no member 'maxDepth' (did you mean 'max_depth'?)");
  EXPECT_EQ(said("PathTracer { rr_depth: 1 }"),
            " PathTracer has no member 'rr_depth' (Mitsuba's word; here it is 'roulette_depth')");
  EXPECT_EQ(said("Conductor { eta: 1 }"),
            " Conductor has no member 'eta' (here it is 'ior', such as metal(\"Au\") or complex(n, k))");
  EXPECT_EQ(said("Dielectric { intIOR: 1.5 }"), " Dielectric has no member 'intIOR' (Mitsuba's word; here it is 'ior')");
  EXPECT_EQ(said("Dielectric { alpha: 0.1 }"), " Dielectric has no member 'alpha' (here it is 'roughness')");
  EXPECT_EQ(said("PathTracer { depth: 1 }"), " PathTracer has no member 'depth' (did you mean 'max_depth'?)");
  EXPECT_NE(job_errors(job_with("integrator: 1")).find("Job has no member 'integrator' (here it is 'renderer')"),
            std::string::npos);
  // Paths of --set give the same message.
  const Ref<Job> job = load_job_text(job_with("renderer: PathTracer {}"), "text");
  EXPECT_EQ(errors_of([&] { set_path(*job, "renderer.spp", "4"); }),
            "1:10: PathTracer has no member 'spp' (here it is 'samples')");
}

// Each suggestion is given where it is of use: some member has the suggested choice, and does not have the foreign word itself.
TEST(Words, EveryChoiceTheyAreToldExists) {
  std::vector<Member> all;
  for (const ClassInfo* info : Registry::instance().all())
    for (const Member& m : info->members)
      if (m.kind == Kind::choice) all.push_back(m);
  ASSERT_GT(all.size(), 30u);
  for (const ForeignWord& entry : foreign_choices()) {
    std::vector<std::string> names = quoted(entry.here);
    const std::string meant = names.at(0);
    const auto told = [&](const Member& m) {
      return std::ranges::find(m.choices, std::string(entry.word)) == m.choices.end() &&
             meant_choice(std::string(entry.word), m).find("here it is '" + meant + "'") != std::string::npos &&
             std::ranges::find(m.choices, meant) != m.choices.end();
    };
    EXPECT_TRUE(std::ranges::any_of(all, told)) << entry.where << " " << entry.word << ": " << meant;
    if (!entry.where.empty()) {
      const auto of = [&](const Member& m) { return m.name == entry.where && told(m); };
      EXPECT_TRUE(std::ranges::any_of(all, of)) << entry.where << " " << entry.word << ": " << meant;
    }
    if (names.size() == 3) {  // a member of a class
      const ClassInfo* info = Registry::instance().find(names[2]);
      EXPECT_TRUE(info && info->find(names[1])) << entry.here;
    }
  }
}

TEST(Words, OfChoices) {
  const auto said = [](const std::string& text) {
    const std::string all = part_errors("x = " + text + "\nLanguagePart {}");
    const size_t begin = all.find("has no choice");
    return begin == std::string::npos ? all : all.substr(begin, all.find("; known are") - begin);
  };
  EXPECT_EQ(said("Dielectric { distribution: \"GGX\" }"), "has no choice 'GGX' (did you mean 'ggx'?)");
  EXPECT_EQ(said("Dielectric { distribution: Beckman }"), "has no choice 'Beckman' (did you mean 'beckmann'?)");
  EXPECT_EQ(said("Conductor { distribution: \"trowbridge-reitz\" }"),
            "has no choice 'trowbridge-reitz' (pbrt's word; here it is 'ggx')");
  EXPECT_EQ(said("ImageMap { file: \"x.png\", interpolation: none }"), "has no choice 'none' (here it is 'nearest')");
  EXPECT_NO_THROW(parse_component(
      "SubdivisionSurface { positions: [[0, 0, 0], [1, 0, 0], [0, 1, 0]], indices: [0, 1, 2], boundary: none }"));
  EXPECT_EQ(said("Sphere { sides: double_sided }"), "has no choice 'double_sided' (here it is 'both')");
  EXPECT_EQ(said("Sphere { sides: inside }"), "has no choice 'inside' (here it is 'back')");
  EXPECT_EQ(said("ImageMap { file: \"x.png\", interpolation: Closest }"),
            "has no choice 'Closest' (Blender's word; here it is 'nearest')");
  EXPECT_EQ(said("ImageMap { file: \"x.png\", interpolation: linear }"), "has no choice 'linear' (here it is 'bilinear')");
  EXPECT_EQ(said("ImageMap { file: \"x.png\", wrap: EXTEND }"), "has no choice 'EXTEND' (Blender's word; here it is 'clamp')");
  EXPECT_EQ(said("RampMap { interpolation: constant }"), "has no choice 'constant' (Blender's word; here it is 'step')");
  EXPECT_EQ(said("Curve { basis: bspline }"), "has no choice 'bspline' (did you mean 'b_spline'?)");
  EXPECT_EQ(said("FeatureRenderer { feature: sh_normal }"),
            "has no choice 'sh_normal' (Mitsuba's word; here it is 'shading_normal')");
  EXPECT_EQ(said("FeatureRenderer { feature: nonsense }"), "has no choice 'nonsense'");
  // A word suggested for one member is not suggested for another.
  EXPECT_EQ(said("NurbsSurface { keep: clamped }"), "has no choice 'clamped'");
  // Nor is it suggested where the other member has the choice that it stands for: 'both' of sides, 'bilinear' of ways to
  // subdivide faces.
  EXPECT_EQ(said("DirectRenderer { strategy: double_sided }"), "has no choice 'double_sided'");
  EXPECT_EQ(said("ImageMap { file: \"x.png\", interpolation: simple }"), "has no choice 'simple'");
}

TEST(Words, OfUnitsAndCalls) {
  EXPECT_EQ(value_errors("3 meters"), "1:3: unknown unit 'meters' (here it is m)");
  EXPECT_EQ(value_errors("3 inches"), "1:3: unknown unit 'inches' (here it is 25.4 mm)");
  EXPECT_EQ(value_errors("3 degree"), "1:3: unknown unit 'degree' (here it is deg)");
  EXPECT_EQ(value_errors("3 xyz"),
            "1:3: unknown unit 'xyz'; known are m, cm, mm, km, um, nm, rad, deg, K, W, mW, kW, lm, cd, lx, s, ms");
  EXPECT_EQ(value_errors("lookAt([0,0,1],[0,0,0],[0,1,0])"),
            "1:1: there is no function 'lookAt' (here it is look_at(from, to, up))");
  EXPECT_EQ(value_errors("bitmap(\"x.png\")"),
            "1:1: there is no function 'bitmap' (Mitsuba's word; here it is 'ImageMap' with 'file'), which is a class");
}

TEST(Words, OfTheCommandLine) {
  const TemporaryFolder folder;
  const auto said = [&](const std::vector<std::string>& arguments) {
    Process process(ETENDUE_BINARY_DIR "/etendue", arguments, folder, folder.path());
    EXPECT_EQ(process.wait(), 2);
    return process.err();
  };
  EXPECT_NE(said({"render", "x.etd", "--spp", "4"}).find("there is no option '--spp' (here it is --samples)"),
            std::string::npos);
  EXPECT_NE(said({"render", "x.etd", "--sample_count", "4"}).find("there is no option"), std::string::npos);
  EXPECT_NE(said({"classes", "cube"}).find("there is no class 'cube' (Mitsuba's word; here it is 'Box')"), std::string::npos);
}

TEST(Words, AClassAloneIsEnoughForSet) {
  const Ref<Job> job = load_job_text(job_with("renderer: PathTracer {}"), "text");
  set_path(*job, "renderer", "BidirectionalPathTracer");
  EXPECT_EQ(job->renderer->class_info().name, "BidirectionalPathTracer");
  set_path(*job, "outputs", "PngOutput");
  ASSERT_EQ(job->outputs.size(), 1u);
  set_path(*job, "outputs[0]", " ExrOutput ");
  EXPECT_EQ(job->outputs[0]->class_info().name, "ExrOutput");
  EXPECT_EQ(errors_of([&] { set_path(*job, "renderer", "Sphere"); }), "1:10: Job.renderer expects a Renderer, not a Sphere");
  EXPECT_EQ(errors_of([&] { set_path(*job, "renderer", "path"); }), "1:10: there is no class 'path' (here it is 'PathTracer')");
  set_path(*job, "wavelengths", "none");
  EXPECT_FALSE(job->wavelengths);
  // In a file a component keeps its braces: there is one way to write it, and the error gives it.
  EXPECT_EQ(part_errors("LanguagePart { child: LanguageConstant }"),
            "1:23: 'LanguageConstant' is a class: write LanguageConstant {}");
}

}  // namespace
}  // namespace etendue::language_test
