// Images that another program would read differently are exported as they are read here: their channels, their encoding, and
// the numbers that stand for colours.

#include "etendue/exporter.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "mitsuba_support.h"
#include "support/image_file.h"

namespace etendue::mitsuba_test {
namespace {

constexpr float red = 0.9f, green = 0.2f, blue = 0.5f;
const double mean = (0.9 + 0.2 + 0.5) / 3, luminance = 0.212671 * 0.9 + 0.715160 * 0.2 + 0.072169 * 0.5;

/// An image of one colour, whose numbers in the file are `rgb`.
std::string picture(const TemporaryFolder& folder, const std::string& name, NumberType type,
                    const std::vector<float>& rgb = {red, green, blue}) {
  std::vector<float> texels;
  for (int i = 0; i < 4; ++i) texels.insert(texels.end(), rgb.begin(), rgb.end());
  test::write_image(folder / name, {2, 2, 3, type}, texels);
  return folder / name;
}

/// A square that fills the view, in a uniform environment of radiance 1.
std::string square(const std::string& shader) {
  return "Job { renderer: PathTracer { samples: 256, max_depth: 2 }\n image: ImageBuffer { width: 4, height: 4, filter: "
         "BoxFilter "
         "{} }\n camera: PerspectiveCamera { from: [0, 0, 4] m, to: [0, 0, 0] m, fov: 2 deg }\n scene: BvhScene { "
         "objects: [ Environment { emission: DiffuseEmission { radiance: rgb(1, 1, 1) } }, Rectangle { shader: " +
         shader + " } ] } }\n";
}

/// A square whose reflectance is the number that an image is evaluated to, between black and white.
std::string mixed(const std::string& image) {
  return square("MixShader { first: Lambertian { color: 0 }, second: Lambertian { color: 1 }, amount: ImageMap { " + image +
                " } }");
}

struct Exported {
  Xyz mean;
  std::string text;
};
Exported exported(const std::string& job, const char* name) {
  const TemporaryFolder folder;
  const Ref<Job> described = load_job_text(job, "test.etd");
  const std::string path = folder / name;
  Exporting exporting(path);
  Exported result;
  result.text = exporter_of(path)->write(*described, exporting);
  exporting.write_files();
  for (const Error& note : exporting.notes())
    if (std::string(note.what()) != "pbrt's pictures are not tone mapped") ADD_FAILURE() << note.what();
  folder.write(name, result.text);
  // The export can be repeated over the same files: files written beside the scene are not noted as inputs.
  for (const auto& file : std::filesystem::directory_iterator(folder.path()))
    EXPECT_EQ(input_at(file.path().string()), "") << file.path();
  const Imported back = import_file(path);
  if (!back.job) {
    ADD_FAILURE() << back.told();
    return result;
  }
  back.job->outputs.clear();
  back.job->image = described->image;
  result.mean = test::measure(back.job).mean;
  return result;
}

// Mitsuba 3 takes the luminance: its `bitmap` of (0.500588, 0.429608, 0.468627) evaluates to 0.447519 (3.9.1, eval_1). Version
// 0.6 takes the average (its microfacets and blendbsdf).
TEST(ImagesOfNumbers, AreOfMitsubasVersion) {
  const TemporaryFolder folder;
  picture(folder, "a.exr", NumberType::single);
  const std::string shape =
      "<emitter type=\"constant\"/><shape type=\"rectangle\"><bsdf type=\"blendbsdf\"><texture type=\"bitmap\" name=\"weight\">"
      "<string name=\"filename\" value=\"a.exr\"/><boolean name=\"raw\" value=\"true\"/></texture>"
      "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"0\"/></bsdf>"
      "<bsdf type=\"diffuse\"><spectrum name=\"reflectance\" value=\"1\"/></bsdf></bsdf></shape>";
  const std::string view = sensor(
      "<float name=\"fov\" value=\"0.1\"/><transform name=\"to_world\"><lookat origin=\"0 0 4\" target=\"0 0 0\" up=\"0 1 "
      "0\"/></transform>");
  for (const auto& [version, expected] : {std::pair("3.0.0", luminance), std::pair("0.6.0", mean)})
    EXPECT_NEAR(seen(import_text(folder, scene(view + integrator() + shape, version)), 4096).y, expected, 0.01) << version;
  // For heights both versions take the luminance.
  for (const char* version : {"3.0.0", "0.6.0"}) {
    const Imported bumps = import_text(
        folder,
        scene(view + integrator() +
                  "<shape type=\"rectangle\"><bsdf type=\"bumpmap\"><texture type=\"bitmap\" name=\"arbitrary\"><string "
                  "name=\"filename\" value=\"a.exr\"/></texture><bsdf type=\"diffuse\"/></bsdf></shape>",
              version));
    ASSERT_TRUE(bumps.job) << bumps.told();
    EXPECT_NE(write_description(*bumps.job).find("as_number: luminance"), std::string::npos) << version;
  }
}

TEST(ImagesOfNumbers, AreExported) {
  const TemporaryFolder folder;
  const std::string floats = picture(folder, "a.exr", NumberType::single), bytes = picture(folder, "a.png", NumberType::uint16);
  const auto decoded = [](double x) { return std::pow((x + 0.055) / 1.055, 2.4); };
  const struct {
    std::string image;
    double expected;
  } cases[] = {
      {"file: \"" + floats + "\"", mean},
      {"file: \"" + floats + "\", as_number: luminance", luminance},
      {"file: \"" + floats + "\", channel: \"G\"", double(green)},
      {"file: \"" + bytes + "\"", (decoded(0.9) + decoded(0.2) + decoded(0.5)) / 3},
      {"file: \"" + bytes + "\", transfer: \"linear\", as_number: luminance", luminance},
      {"file: \"" + bytes + "\", transfer: \"linear\", channel: \"R\"", double(red)},
  };
  for (const auto& c : cases) {
    SCOPED_TRACE(c.image);
    EXPECT_NEAR(test::measure(mixed(c.image)).mean.y, c.expected, 0.01);
    for (const char* name : {"out.xml", "out.pbrt"})
      EXPECT_NEAR(exported(mixed(c.image), name).mean.y, c.expected, 0.012) << name;
  }
}

// A product is written once, as a new image, which is not read before it is written.
TEST(ImagesOfNumbers, ProductsAreExportedToMitsuba) {
  const TemporaryFolder folder;
  const std::string file = picture(folder, "a.exr", NumberType::single, {0.4f, 0.4f, 0.4f}), path = folder / "out.xml";
  const Ref<Job> job =
      load_job_text(square("MixShader { first: Lambertian { color: 0 }, second: Lambertian { color: 1 }, amount: "
                           "RgbProductMap { first: ImageMap { file: \"" +
                           file + "\" }, second: 0.5 } }"),
                    "test.etd");
  Exporting exporting(path);
  folder.write("out.xml", exporter_of(path)->write(*job, exporting));
  exporting.write_files();
  ASSERT_EQ(exporting.notes().size(), 1u);
  EXPECT_NE(std::string(exporting.notes()[0].what()).find("takes the luminance, not the mean"), std::string::npos);
  const Imported back = import_file(path);
  ASSERT_TRUE(back.job) << back.told();
  back.job->outputs.clear();
  back.job->image = job->image;
  EXPECT_NEAR(test::measure(back.job).mean.y, 0.2, 0.01);
}

TEST(ImagesOfColors, AreExportedToMitsubaAsTheyAreDecoded) {
  const TemporaryFolder folder;
  const std::string floats = picture(folder, "a.exr", NumberType::single, {0.6f, 0.3f, 0.4f}),
                    bytes = picture(folder, "a.png", NumberType::uint16, {0.6f, 0.3f, 0.4f});
  for (const std::string& image :
       {"file: \"" + floats + "\"", "file: \"" + floats + "\", transfer: \"srgb\"",
        "file: \"" + bytes + "\", transfer: \"linear\"", "file: \"" + bytes + "\", transfer: \"gamma2.2\"",
        "file: \"" + bytes + "\", channel: \"R\"", "file: \"" + floats + "\", color_space: \"rec2020\""}) {
    SCOPED_TRACE(image);
    const std::string job = square("Lambertian { color: ImageMap { " + image + " } }");
    const Xyz before = test::measure(job).mean;
    const Exported after = exported(job, "out.xml");
    EXPECT_NEAR(after.mean.x / before.x, 1, 0.01);
    EXPECT_NEAR(after.mean.y / before.y, 1, 0.01);
    EXPECT_NEAR(after.mean.z / before.z, 1, 0.015);
    // Mitsuba's spectral variants refuse raw numbers as colours.
    EXPECT_EQ(after.text.find("\"raw\""), std::string::npos);
  }
}

// A normal tilted by 30 degrees towards +x, seen from above in light from above: a cosine of sqrt(3) / 2.
TEST(ImagesOfNormals, AreExportedToMitsuba) {
  const TemporaryFolder folder;
  const std::vector<float> tilted = {0.75f, 0.5f, 0.5f + 0.5f * std::sqrt(0.75f)};
  const std::string bytes = picture(folder, "n.png", NumberType::uint16, tilted),
                    floats = picture(folder, "n.exr", NumberType::single, tilted);
  for (const std::string& image : {"file: \"" + bytes + "\"", "map: ImageMap { file: \"" + bytes + "\", transfer: \"linear\" }",
                                   "map: UvTransformMap { scale: [2, 3], map: ImageMap { file: \"" + floats + "\" } }"}) {
    SCOPED_TRACE(image);
    std::string job = square("NormalMapShader { green: across, shader: Lambertian { color: 1 }, " + image + " }");
    job.insert(job.find("shader:"), "shading_normals: clipped, ");
    const size_t light = job.find("Environment");
    job.replace(light, job.find("Rectangle") - light,
                "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: rgb(1, 1, 1) } }, ");
    const double before = double(test::measure(job).mean.y);
    EXPECT_NEAR(before, std::sqrt(0.75) / 3.14159265, 0.003);
    EXPECT_NEAR(exported(job, "out.xml").mean.y, before, 0.003);
  }
}

}  // namespace
}  // namespace etendue::mitsuba_test
