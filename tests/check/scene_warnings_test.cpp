// Warnings about scenes whose picture will be black and about parts that have no effect; sound scenes give no warnings.

#include "check/warnings/scene_warnings.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/image_file.h"
#include "support/render_support.h"

namespace etendue::test {
namespace {

const std::string camera = "PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 0], fov: 40 deg }";
const std::string sky = "Environment { emission: EnvironmentEmission { radiance: 1 } }\n";
const std::string diffuse = "shader: Lambertian {}";

std::vector<SceneWarning> said(const std::string& objects, const std::string& from = camera,
                               const std::string& renderer = "PathTracer { samples: 1 }") {
  const Ref<Job> job = load_job_text(job_text(renderer, from, 8, objects), "scene.etd");
  prepare_tree(*job);
  return scene_warnings(*job);
}

/// Expects exactly one warning, of a kind, which contains all of `words`, at the place where `there` begins in the job's text.
void expect(const std::string& objects, const std::string& kind, const std::vector<std::string>& words,
            const std::string& there, const std::string& from = camera) {
  const std::vector<SceneWarning> list = said(objects, from);
  ASSERT_EQ(list.size(), 1u) << objects << (list.size() > 1 ? "\n" + list[0].text + "\n" + list[1].text : "");
  EXPECT_EQ(list[0].kind, kind);
  for (const std::string& word : words)
    EXPECT_NE(list[0].text.find(word), std::string::npos) << word << " in: " << list[0].text;
  const std::string text = job_text("PathTracer { samples: 1 }", from, 8, objects);
  const size_t at = text.find(there), line = text.rfind('\n', at);
  ASSERT_NE(at, std::string::npos);
  EXPECT_EQ(list[0].at.line, std::count(text.begin(), text.begin() + std::ptrdiff_t(at), '\n') + 1) << list[0].text;
  EXPECT_EQ(list[0].at.column, int(at - line)) << list[0].text;
}

TEST(SceneWarnings, SoundScenesAreSilent) {
  for (const char* object :
       {"Sphere { shader: Lambertian {} }\n",
        "Sphere { shader: Dielectric {}, interior: HomogeneousVolume { absorption: 1 } }\n",
        "Sphere { shader: ThinDielectric {}, interior: HomogeneousVolume { absorption: 1 } }\n",
        "Sphere { shader: PassThrough {}, interior: HomogeneousVolume { scattering: 1 } }\n",
        "Sphere { radius: 0.1, emission: DiffuseEmission {} }\n", "Rectangle { shader: ThinDielectric {} }\n",
        "Rectangle { shader: Lambertian { color: AddMap { first: 0.2, second: 0.3 } }, sides: front }\n",
        "Sphere { shader: Dielectric {}, priority: 2 }\n", "Point { emission: DiffuseEmission {} }\n"})
    for (const SceneWarning& w : said(object + sky)) ADD_FAILURE() << object << w.text;
}

TEST(SceneWarnings, NothingEmits) {
  const std::vector<SceneWarning> list = said("Sphere { " + diffuse + " }\n");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].kind, "dark");
  EXPECT_TRUE(said("Sphere { " + diffuse + " }\n", camera, "FeatureRenderer {}").empty());
  EXPECT_TRUE(said("Sphere {}\n", camera, "AmbientOcclusionRenderer {}").empty());
}

// Bands between the wavelengths of a grid. With 10 nm on both sides each band has one.
TEST(SceneWarnings, BandsWithoutWavelengths) {
  const auto of = [](const std::string& wavelengths, const std::string& bands, const std::string& renderer = "PathTracer") {
    const Ref<Job> job = load_job_text("Job { renderer: " + renderer + " {}\n camera: " + camera +
                                           "\n wavelengths: " + wavelengths + "\n image: SpectralFilm { width: 8, height: 8, " +
                                           bands + " }\n scene: BruteForceScene { objects: [" + sky + "] } }",
                                       "scene.etd");
    prepare_tree(*job);
    return scene_warnings(*job);
  };
  EXPECT_TRUE(of("GridWavelengths { count: 47 }", "bands: 47").empty());
  EXPECT_TRUE(of("GridWavelengths { count: 40 }", "bands: 8").empty());
  EXPECT_TRUE(of("HeroWavelengths {}", "bands: 3000").empty());
  EXPECT_TRUE(of("GridWavelengths { count: 40 }", "responses: [illuminant(\"A\")]").empty());
  // 94 bands of 5 nm, 47 wavelengths 10 nm apart at their edges: a band contains its lower one, so every other one is dark.
  const std::vector<SceneWarning> list = of("GridWavelengths { count: 47 }", "bands: 94");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].kind, "dark bands");
  EXPECT_EQ(list[0].at.line, 3);
  EXPECT_NE(list[0].text.find("47 of the 94 bands, the first from 360 to 365 nm"), std::string::npos) << list[0].text;
  EXPECT_EQ(of("GridWavelengths { count: 40, low: 400 nm, high: 700 nm }", "bands: 47").size(), 1u);
}

TEST(SceneWarnings, NoShader) { expect("Sphere {}\n" + sky, "no shader", {"black", "Lambertian"}, "Sphere"); }

TEST(SceneWarnings, ADarkEnvironment) { expect("Environment {}\n" + sky, "dark luminaire", {"no emission"}, "Environment {}"); }

TEST(SceneWarnings, InteriorsThatNothingEnters) {
  const std::string medium = "interior: HomogeneousVolume { absorption: 1 }";
  expect("Sphere { " + diffuse + ", " + medium + " }\n" + sky, "interior", {"Lambertian", "PassThrough"}, "HomogeneousVolume");
  expect("Sphere { emission: DiffuseEmission {}, " + medium + " }\n" + sky, "interior", {"no shader"}, "HomogeneousVolume");
  expect("Rectangle { shader: PassThrough {}, " + medium + " }\n" + sky, "interior", {"not closed"}, "HomogeneousVolume");
  expect("Sphere { shader: Dielectric {}, sides: front, " + medium + " }\n" + sky, "interior", {"sides"}, "HomogeneousVolume");
}

TEST(SceneWarnings, MembersWithoutEffect) {
  expect("Sphere { " + diffuse + ", priority: 3 }\n" + sky, "without effect", {"priority"}, "3 }");
  expect("Sphere { emission: DiffuseEmission {}, sides: front }\n" + sky, "without effect", {"sides"}, "front");
  expect("Rectangle { shader: PassThrough {}, sides: front }\n" + sky, "without effect", {"sides"}, "front");
  expect("Environment { shader: Lambertian {}, emission: EnvironmentEmission {} }\n", "without effect", {"shader"},
         "Lambertian");
  expect("Instance { sides: front, scene: BruteForceScene { objects: [ Sphere { " + diffuse + " } ] } }\n" + sky,
         "without effect", {"instance", "sides"}, "front");
  expect("BruteForceScene { shader: Lambertian {}, objects: [ Sphere { " + diffuse + " } ] }\n" + sky, "without effect",
         {"nested scene", "shader"}, "Lambertian");
  expect("Instance { scene: BruteForceScene { transform: scale(3), objects: [ Sphere { " + diffuse + " } ] } }\n" + sky,
         "without effect", {"an instance's scene", "transform"}, "scale");
  expect("Instance { shading_normals: clipped, scene: BruteForceScene { objects: [ Sphere { " + diffuse + " } ] } }\n" + sky,
         "without effect", {"instance", "shading_normals"}, "clipped");
  expect("Point { emission: DiffuseEmission { sides: back } }\n" + sky, "without effect", {"no surface", "sides"}, "back");
  expect("Environment { transform: translate(1, 0, 0), emission: EnvironmentEmission {} }\n", "without effect",
         {"infinitely far", "transform"}, "translate");
}

TEST(SceneWarnings, MembersOfTheJobsOwnScene) {
  const Ref<Job> job = load_job_text(R"(Job { renderer: PathTracer { samples: 1 }
    camera: PerspectiveCamera { from: [0, 0, 3], to: [0, 0, 0] }
    image: ImageBuffer { width: 4, height: 4 }
    scene: BruteForceScene { transform: scale(3), objects: [
      Environment { emission: EnvironmentEmission {} }, Sphere { shader: Lambertian {} } ] } })",
                                     "scene.etd");
  prepare_tree(*job);
  const std::vector<SceneWarning> list = scene_warnings(*job);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].at.line, 4);
  EXPECT_NE(list[0].text.find("'transform' has no effect: only the objects of the job's scene"), std::string::npos)
      << list[0].text;
}

const std::string tetrahedron = "positions: [[0,0,0], [1,0,0], [0,1,0], [0,0,1]], triangles: [[0,2,1], [0,1,3], [0,3,2], ";

TEST(SceneWarnings, GlassThatIsNotClosed) {
  expect("TriangleMesh { " + tetrahedron + "], shader: Dielectric {} }\n" + sky, "open body", {"3 edges", "ThinDielectric"},
         "Dielectric");
  EXPECT_TRUE(said("TriangleMesh { " + tetrahedron + "[1,2,3]], shader: Dielectric {} }\n" + sky).empty());
  // One triangle with reversed orientation: no edge is open, but the mesh has no inside.
  const auto list = said("TriangleMesh { " + tetrahedron + "[1,3,2]], shader: Dielectric {} }\n" + sky);
  ASSERT_EQ(list.size(), 1u);
  EXPECT_NE(list[0].text.find("not consistently oriented"), std::string::npos);
  expect("Disc { shader: Dielectric {} }\n" + sky, "open body", {"not closed"}, "Dielectric");
}

TEST(SceneWarnings, MediaInMeshesThatAreInsideOut) {
  const std::string medium = "shader: Dielectric {}, interior: HomogeneousVolume { absorption: 1 } }\n" + sky;
  expect("TriangleMesh { positions: [[0,0,0], [1,0,0], [0,1,0], [0,0,1]], triangles: [[0,1,2], [0,3,1], [0,2,3], [1,3,2]], " +
             medium,
         "interior", {"never entered", "point inwards"}, "HomogeneousVolume");
  EXPECT_TRUE(said("TriangleMesh { " + tetrahedron + "[1,2,3]], " + medium).empty());
}

TEST(SceneWarnings, ImagesWithoutCoordinates) {
  const ImageFile image("card.exr", 2, 2, std::vector<float>(12, 0.5f));
  const std::string map = "ImageMap { file: \"" + image.path + "\" }", mesh = "TriangleMesh { " + tetrahedron + "[1,2,3]], ";
  const std::string shader = "shader: Lambertian { color: ";
  expect(mesh + shader + map + " } }\n" + sky, "no uv", {"surface coordinates", "PlanarMap"}, "ImageMap");
  EXPECT_TRUE(said(mesh + shader + "PlanarMap { map: " + map + " } } }\n" + sky).empty());
  EXPECT_TRUE(said(mesh + "uvs: [[0,0], [1,0], [0,1], [1,1]], " + shader + map + " } }\n" + sky).empty());
  EXPECT_TRUE(said("Sphere { " + shader + map + " } }\n" + sky).empty());
}

struct TextFile {
  std::string path;
  TextFile(const std::string& name, const std::string& text) : path(testing::TempDir() + name) { std::ofstream(path) << text; }
  ~TextFile() { std::filesystem::remove(path); }
};

TEST(SceneWarnings, MaterialsOfFiles) {
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";
  const TextFile one("one.obj", "mtllib x.mtl\n" + points + "usemtl wood\nf 1 2 3\nf 2 4 3\n"),
      two("two.obj", "mtllib x.mtl\n" + points + "usemtl wood\nf 1 2 3\nusemtl dark iron\nf 2 4 3\n");
  const auto mesh = [](const TextFile& file, const std::string& more) {
    return "TriangleMesh { file: \"" + file.path + "\"" + more + " }\n";
  };
  expect(mesh(two, ", " + diffuse) + sky, "materials", {"2 materials", "'wood'", "'dark iron'"}, "\"" + two.path);
  EXPECT_TRUE(said(mesh(one, ", " + diffuse) + sky).empty());  // the file has a single material, which the one shader replaces
  expect(mesh(one, "") + sky, "no shader", {"'wood'", "not read"}, "TriangleMesh");
}

TEST(SceneWarnings, ColoursOfVertices) {
  const TextFile ply(
      "colours.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
      "red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n"
      "end_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n");
  const std::string mesh = "TriangleMesh { file: \"" + ply.path + "\", shader: Lambertian { ";
  expect(mesh + "} }\n" + sky, "vertex colours", {"AttributeMap"}, "\"" + ply.path);
  EXPECT_TRUE(said(mesh + "color: AttributeMap { name: \"color\" } } }\n" + sky).empty());
}

TEST(SceneWarnings, WhatTheCameraSees) {
  expect("Sphere { " + diffuse + " }\n" + sky, "sees nothing", {"looks from", "'to'"}, "[0, 0, 9]",
         "PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 9], fov: 40 deg }");
  EXPECT_TRUE(said(sky, "PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 9], fov: 40 deg }").empty());
  EXPECT_TRUE(said("Sphere { centre: [0, 0, 1000], radius: 0.01, " + diffuse + " }\n" + sky,
                   "PerspectiveCamera { from: [0, 0, 5], to: [0, 0, 9], fov: 40 deg }")
                  .empty());
}

// Of a model from another program, whose camera may be meant for another unit of length.
TEST(SceneWarnings, CamerasThatSeeLittleOfAModel) {
  const auto told = [](const std::string& radius) {
    const TextFile file("little.pbrt",
                        "LookAt 0 0 -5  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 40\nFilm \"rgb\"\nWorldBegin\n"
                        "LightSource \"infinite\"\nShape \"sphere\" \"float radius\" " +
                            radius + "\n");
    const Ref<Job> job = load_job(file.path);
    prepare_tree(*job);
    return scene_warnings(*job);
  };
  EXPECT_TRUE(told("1").empty());
  const std::vector<SceneWarning> list = told("0.1");
  ASSERT_EQ(list.size(), 1u);
  EXPECT_EQ(list[0].kind, "sees little");
  EXPECT_TRUE(said("Sphere { radius: 0.1, " + diffuse + " }\n" + sky).empty());
}

TEST(SceneWarnings, ACameraInTheDark) {
  const std::string inside = "PerspectiveCamera { from: [0, 0, 0], to: [0, 0, 1], fov: 40 deg }";
  expect("Box { size: [2, 2, 2], " + diffuse + " }\n" + sky, "in the dark", {"Box", "does not transmit light"}, "[0, 0, 0]",
         inside);
  EXPECT_TRUE(
      said("Box { size: [2, 2, 2], " + diffuse + " }\nPoint { position: [0, 0.9, 0], emission: DiffuseEmission {} }\n", inside)
          .empty());
  EXPECT_TRUE(said("Box { size: [2, 2, 2], shader: Dielectric {} }\n" + sky, inside).empty());
  EXPECT_TRUE(said("Sphere { shader: Lambertian {}, emission: DiffuseEmission { sides: back } }\n", inside).empty());
}

TEST(SceneWarnings, AFewOfAKindAndHowManyMore) {
  std::string objects;
  for (int i = 0; i < 9; ++i) objects += fmt::format("Sphere {{ centre: [{}, 0, 0], radius: 0.1 }}\n", 0.2 * i);
  const std::vector<SceneWarning> list = said(objects + sky);
  EXPECT_EQ(list.size(), 9u);
  testing::internal::CaptureStderr();
  show_warnings(list);
  const std::string shown = testing::internal::GetCapturedStderr();
  EXPECT_EQ(std::count(shown.begin(), shown.end(), '\n'), 3) << shown;
  EXPECT_NE(shown.find("scene.etd:6:1: warning: "), std::string::npos) << shown;
  EXPECT_NE(shown.find("(and 6 more like this)"), std::string::npos) << shown;
}

TEST(SceneWarnings, MembersThatDoNotMatter) {
  const std::string kind = "does not matter";
  expect("Sphere { shader: HairShader {\n color: 0.1 } }\n" + sky, kind, {"HairShader.color", "'pigment' is color"}, "0.1 }");
  expect("Sphere { shader: Conductor { rotation: 0.2 } }\n" + sky, kind, {"Conductor.rotation", "'roughness_v' is not 0"},
         "0.2 }");
  expect("Sphere { shader: Principled { coat_roughness: 0.4 } }\n" + sky, kind, {"'coat_weight' is not 0"}, "0.4 }");
  expect("Environment { emission: SkyEmission { time: \"2024-06-21T12:00:00Z\", sun_direction: [1, 2, 0] } }\n", kind,
         {"'time' is not given"}, "[1, 2, 0]");
  expect("Sphere { emission: DiffuseEmission { distance: 2 } }\n", kind, {"'illuminance' is not 0"}, "2 } }");
  // In nested maps; a part that is used twice is reported once.
  expect("Sphere { shader: Lambertian { color: AddMap { first: RampMap { input: 0.5 } } } }\n" + sky, kind,
         {"RampMap.input", "'along' is input"}, "0.5 }");
  expect("Sphere {" + diffuse + "}\n" + sky, kind, {"'lens_radius' is not 0"}, "3 }",
         "PerspectiveCamera { from: [0, 0, 5], focus_distance: 3 }");
}

TEST(SceneWarnings, MembersThatMatterOrAreAsByDefault) {
  for (const char* object :
       {"Sphere { shader: HairShader { pigment: color, color: 0.1 } }\n",
        "Sphere { shader: Conductor { rotation: 0.2, roughness_v: 0.4 } }\n", "Sphere { shader: Conductor { rotation: 0 } }\n",
        "Sphere { shader: Principled { coat_weight: CheckerMap { first: 0, second: 0.1 }, coat_roughness: 0.4 } }\n",
        "Sphere { shader: Principled { coat_roughness: 0 } }\n",
        "Sphere { emission: DiffuseEmission { illuminance: 10, distance: 2 } }\n",
        "Sphere { emission: DiffuseEmission { power: 10, distance: 1 } }\n"})
    for (const SceneWarning& w : said(object + sky)) ADD_FAILURE() << object << w.text;
}

TEST(SceneWarnings, ReflectancesAboveOne) {
  const ImageFile bright("bright.exr", 2, 1, {0.2f, 0.2f, 0.2f, 0.5f, 3.5f, 0.5f});
  const ImageFile sound("sound.exr", 2, 1, {0.2f, 0.2f, 0.2f, 0.5f, 1, 0.5f});
  const auto told = [](const std::string& color) {
    testing::internal::CaptureStderr();
    prepare_tree(*load_job_text(
        job_text("PathTracer {}", camera, 8, "Sphere { shader: Lambertian { color: " + color + " } }\n" + sky), "bright.etd"));
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(told("ImageMap { file: \"" + sound.path + "\" }"), "");
  EXPECT_EQ(told("rgb(1, 1, 0.2)"), "");
  const std::string image = told("ImageMap { file: \"" + bright.path + "\" }");
  EXPECT_NE(image.find("bright.etd:6:38: warning: Lambertian.color: "), std::string::npos) << image;
  EXPECT_NE(image.find("3.5"), std::string::npos) << image;
  const std::string nested = told("UvTransformMap { map: ImageMap { file: \"" + bright.path + "\" } }");
  EXPECT_NE(nested.find("warning: Lambertian.color: "), std::string::npos) << nested;
  const std::string rgb = told("rgb(1.5, 0.2, 0.1)");
  EXPECT_NE(rgb.find("bright.etd:6:38: warning: Lambertian.color: "), std::string::npos) << rgb;
  EXPECT_NE(rgb.find("1.5"), std::string::npos) << rgb;
}

TEST(SceneWarnings, ReflectancesThatTogetherAreMoreThanArrives) {
  const auto told = [](const std::string& shader) {
    testing::internal::CaptureStderr();
    prepare_tree(*load_job_text(job_text("PathTracer {}", camera, 8, "Sphere { shader: " + shader + " }\n" + sky), "sum.etd"));
    return testing::internal::GetCapturedStderr();
  };
  for (const char* shader : {"PhongShader { color: 0.8, specular: 0.5 }", "WardShader { color: 0.8, specular: 0.5 }",
                             "DiffuseTransmitter { reflectance: 0.8, transmittance: 0.5 }"})
    EXPECT_NE(told(shader).find("together are 1.3"), std::string::npos) << shader;
  EXPECT_EQ(told("PhongShader { color: 0.5, specular: 0.5 }"), "");
}

// Warnings after rendering.
TEST(PictureWarnings, TooDarkOrTooBrightByHowMuch) {
  const auto after = [](double radiance, const std::string& tone = "ExposureToneMap {}") {
    const Ref<Job> job =
        load_job_text(fmt::format("Job {{ renderer: PathTracer {{ samples: 1 }}\n camera: {}\n image: "
                                  "ImageBuffer {{ width: 8, height: 8, filter: BoxFilter {{}} }}\n tone_map: {}\n "
                                  "outputs: [ PngOutput {{}} ]\n scene: BruteForceScene {{ objects: [ "
                                  "Environment {{ emission: EnvironmentEmission {{ "
                                  "radiance: {} }} }} ] }} }}\n",
                                  camera, tone, radiance),
                      "tone.etd");
    return picture_warnings(*job, job->outputs, rendered(job)->picture());
  };
  EXPECT_TRUE(after(0.18).empty());
  EXPECT_TRUE(after(0.9).empty());
  EXPECT_TRUE(after(0.01).empty());
  const auto bright = after(180);
  ASSERT_EQ(bright.size(), 1u);
  for (const char* word : {"100 %", "white", "1e+03 times", "stops: -10.0"})
    EXPECT_NE(bright[0].text.find(word), std::string::npos) << word << " in: " << bright[0].text;
  EXPECT_EQ(bright[0].at.line, 4);
  const auto dark = after(0.18 / 4096);
  ASSERT_EQ(dark.size(), 1u);
  for (const char* word : {"black", "stops: 12.0"}) EXPECT_NE(dark[0].text.find(word), std::string::npos) << dark[0].text;
  EXPECT_EQ(dark[0].kind, "black picture");  // no pixel reaches 1/255
  EXPECT_TRUE(after(0.18 / 4096, "ExposureToneMap { stops: 12 }").empty());
  const auto nearly = after(0.18 / 512);
  ASSERT_EQ(nearly.size(), 1u);
  EXPECT_EQ(nearly[0].kind, "tone");
  EXPECT_TRUE(after(180, "ExposureToneMap { stops: -10 }").empty());
  const auto none = after(0);
  ASSERT_EQ(none.size(), 1u);
  EXPECT_EQ(none[0].kind, "black picture");
}

// A lamp that emits in all directions, on surfaces of which only one side emits.
TEST(SceneWarnings, LightBehindSurfaces) {
  const std::string path = (std::filesystem::temp_directory_path() / "etendue-warnings-test.ies").string();
  std::ofstream(path) << "IESNA:LM-63-2002\nTILT=NONE\n1 100 1 3 1 1 2 0 0 0\n1 1 10\n0 90 180\n0\n8 8 8\n";
  const auto lamp = [&](const std::string& object, const std::string& more) {
    return object + " { emission: IesEmission { file: \"" + path + "\"" + more + " } }\n";
  };
  expect(lamp("Rectangle", ""), "lost light", {"the Rectangle: 50 %", "behind the surface", "sides: both"}, "IesEmission");
  expect(lamp("Sphere", ""), "lost light", {"the Sphere: 50 %"}, "IesEmission");
  for (const std::string& fine :
       {lamp("Rectangle", ", sides: both"), lamp("Rectangle", ", sides: front"), lamp("Rectangle", ", luminous_flux: 100 lm"),
        lamp("Point", ""), std::string("Rectangle { emission: DiffuseEmission {} }\n"),
        std::string("Rectangle { emission: SpotEmission { axis: [0, 0, 1] } }\n")})
    for (const SceneWarning& w : said(fine)) ADD_FAILURE() << fine << w.text;
  expect("Rectangle { emission: SpotEmission { axis: [0, 0, -1] } }\n", "lost light", {"100 %"}, "SpotEmission");
  std::filesystem::remove(path);
}

// No false alarms: all scenes that come with the program give no warnings.
TEST(SceneWarnings, OurOwnScenesAreSilent) {
  namespace fs = std::filesystem;
  int count = 0;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(ETENDUE_SOURCE_DIR "/scenes")) {
    if (entry.path().extension() != ".etd") continue;
    const std::string name = entry.path().string();
    // These scenes need files that a script makes, or are parts of other scenes.
    if (name.find("million_triangles") != name.npos || name.find("highland_cow") != name.npos ||
        name.find("/forest/") != name.npos || name.find("/teapot/") != name.npos || name.ends_with("/forest.etd"))
      continue;
    SCOPED_TRACE(name);
    Ref<Job> job;
    testing::internal::CaptureStderr();
    std::string told;
    try {
      job = load_job(name);
      prepare_tree(*job);
      told = testing::internal::GetCapturedStderr();
    } catch (const std::runtime_error&) {
      testing::internal::GetCapturedStderr();
      continue;  // a part of another scene
    }
    ++count;
    EXPECT_EQ(told, "");
    for (const SceneWarning& w : scene_warnings(*job)) ADD_FAILURE() << show(Error(w.text, w.at));
  }
  EXPECT_GT(count, 20);
}

}  // namespace
}  // namespace etendue::test
