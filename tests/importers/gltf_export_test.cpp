// A scene exported to glTF and read back makes the same picture, as far as glTF can express it.

#include <filesystem>

#include "components/scenes/import.h"
#include "etendue/exporter.h"
#include "etendue/language/language.h"
#include "files/input_files.h"
#include "files/regular_file.h"
#include "mitsuba_support.h"
#include "support/image_file.h"

namespace etendue::mitsuba_test {
namespace {

struct Exported {
  std::string text, told;
  std::vector<std::string> beside;
  Imported back;
};

Exported export_job(const TemporaryFolder& folder, const std::string& job, const std::string& name) {
  Exported result;
  const Ref<Job> described = load_job_text(job, "test.etd", folder.path());
  Exporting exporting(folder / name);
  result.text = exporter_of(name)->write(*described, exporting);
  result.beside = exporting.files_beside();
  exporting.write_files();
  for (const Error& note : exporting.notes()) result.told += note.what() + std::string("\n");
  folder.write(name, result.text);
  result.back = import_file(folder / name);
  return result;
}

std::string job(const std::string& objects) {
  return "wood = Lambertian { color: rgb(0.5, 0.3, 0.15) }\n"
         "Job {\n renderer: PathTracer { samples: 1024, max_depth: 5 }\n camera: PerspectiveCamera { from: [0.5, 1, 6] m, to: "
         "[0, 0, 0] m, fov: 35 deg, transform: rotate(5 deg, \"z\") }\n image: ImageBuffer { width: 12, height: 8, filter: "
         "BoxFilter {} }\n scene: BvhScene { objects: [\n" +
         objects + "\n] }\n}\n";
}

void expect_same(const std::string& described, const Exported& exported) {
  ASSERT_TRUE(exported.back.job) << exported.back.told() << exported.text;
  const Ref<Job> before = load_job_text(described, "test.etd");
  exported.back.job->outputs.clear();
  exported.back.job->renderer = before->renderer;
  exported.back.job->image = before->image;
  const Xyz a = test::measure(before).mean, b = test::measure(exported.back.job).mean;
  EXPECT_NEAR(b.x / a.x, 1, 0.02) << exported.told;
  EXPECT_NEAR(b.y / a.y, 1, 0.02);
  EXPECT_NEAR(b.z / a.z, 1, 0.025);
}

TEST(GltfExport, MakesTheSamePictureWhenReadBack) {
  const char* const scenes[] = {
      // Shapes with and without transforms, nested and repeated; a luminaire of a given power, a point and a spot.
      "Sphere { centre: [-1, 0, 0] m, shader: wood, transform: translate(0.2, 0, 0) * scale(1, 1.3, 1) },"
      "Box { size: [1, 1, 1] m, centre: [1, 0, 0.5] m, shader: Lambertian { color: 0.7 } },"
      "Instance { scene: EmbreeScene { objects: [Cylinder { shader: wood, radius: 0.3 m }] }, transform: translate(0, 1, 0) },"
      "Rectangle { corner: [-4, -1, 4] m, edge_u: [8, 0, 0] m, edge_v: [0, 0, -8] m, shader: Lambertian { color: 0.4 } },"
      "Rectangle { corner: [-1, 4, -1] m, edge_u: [2, 0, 0] m, edge_v: [0, 0, 2] m, sides: front, emission: DiffuseEmission {"
      " radiance: rgb(4, 3, 2), power: 90 W } },"
      "Point { position: [0, 2, 5] m, emission: DiffuseEmission { radiance: rgb(20, 30, 40) } },"
      "Point { position: [3, 3, 3] m, emission: ForeignSpotEmission { radiance: rgb(60, 50, 40), axis: [-1, -1, -1], "
      "outer_angle: 30 "
      "deg, inner_angle: 10 deg, edge: square } }",
      // A mirror under a distant light, and triangles with holes.
      "Distant { direction: [0.3, -1, -0.4], emission: DiffuseEmission { radiance: rgb(3, 3, 2.5) } },"
      "Sphere { centre: [-1, 0, 0] m, shader: PerfectSpecular { color: 0.8 } },"
      "TriangleMesh { positions: [[-3, -1, -2], [3, -1, -2], [0, 3, -2]], triangles: [0, 1, 2], shader: MaskShader { opacity: "
      "0.6, shader: Lambertian { color: 0.6 } } },"
      "Rectangle { corner: [-4, -1, 4] m, edge_u: [8, 0, 0] m, edge_v: [0, 0, -8] m, shader: Lambertian { color: 0.4 } }",
  };
  for (const char* objects : scenes)
    for (const char* name : {"out.gltf", "out.glb"}) {
      SCOPED_TRACE(objects);
      const TemporaryFolder folder;
      expect_same(job(objects), export_job(folder, job(objects), name));
    }
}

// An image whose four quarters differ, rotated, scaled and shifted, on a square that fills the picture: each pixel is the same.
TEST(GltfExport, LaysImagesWhereTheyWere) {
  const TemporaryFolder folder;
  const test::ImageFile image("quarters.png", {2, 2, 3, NumberType::uint8}, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 0});
  int turn = 0;
  for (const char* placed :
       {"", "scale: [2, 1.5], shift: [0.2, 0.4]", "angle: 30 deg", "scale: [1.3, 0.7], angle: 70 deg, shift: [0.1, 0.3]"}) {
    // By turns to a file whose name is no URI, and to a single file.
    const bool one_file = turn++ % 2 == 1;
    const std::string described =
        "Job { renderer: DirectRenderer { samples: 256 }\n camera: OrthographicCamera { from: [0, 0, 3] m, to: [0, 0, 0] m, "
        "width: "
        "2 m }\n image: ImageBuffer { width: 8, height: 8, filter: BoxFilter {} }\n scene: BvhScene { objects: [\n"
        "Rectangle { corner: [-1, -1, 0] m, edge_u: [2, 0, 0] m, edge_v: [0, 2, 0] m, shader: Lambertian { color: "
        "UvTransformMap { map: "
        "ImageMap { file: \"" +
        image.path + "\", interpolation: nearest }, " + placed +
        " } } },\n"
        "Distant { direction: [0, 0, -1], emission: DiffuseEmission { radiance: rgb(1, 1, 1) } }] } }";
    Exported exported = export_job(folder, described, one_file ? "out.glb" : "o#u t%20.gltf");
    EXPECT_EQ(exported.beside.size(), one_file ? 0u : 2u);
    ASSERT_TRUE(exported.back.job) << exported.back.told() << exported.text;
    const Ref<Job> before = load_job_text(described, "test.etd");
    exported.back.job->outputs.clear();
    exported.back.job->renderer = before->renderer;
    exported.back.job->image->width = exported.back.job->image->height = 8;
    exported.back.job->image->filter = before->image->filter;
    const Image a = test::rendered(before)->picture(), b = test::rendered(exported.back.job)->picture();
    // Values lie between 0 and 1 / pi, so that the mean of 256 samples has a standard deviation of at most 0.01, and the
    // difference of 0.014.
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) EXPECT_NEAR(b.at(x, y, 1), a.at(x, y, 1), 0.06) << placed << " at " << x << ", " << y;
  }
}

TEST(GltfExport, TellsWhatItCannotExpress) {
  const TemporaryFolder folder;
  const std::string told =
      export_job(folder,
                 job("Torus { shader: PhongShader {} }, Environment { emission: DiffuseEmission {} },"
                     "Sphere { shader: Lambertian { color: CheckerMap {} }, interior: HomogeneousVolume { scattering: 1 }, "
                     "priority: 1 }"),
                 "out.gltf")
          .told;
  for (const char* words : {"Torus", "an environment is left out", "curved shapes become triangles", "a map like CheckerMap",
                            "media do not scatter in glTF", "'priority' of Sphere is left out"})
    EXPECT_NE(told.find(words), std::string::npos) << words << " in " << told;
}

// Files written beside the export never take the name of a file that is read, and they are written only after the whole export
// has succeeded.
TEST(GltfExport, LeavesTheFilesThatAreRead) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "elsewhere");
  folder.write("elsewhere/a.png", "far");
  folder.write("out-a.png", "near");
  const Ref<Job> described = load_job_text(
      job("Box { shader: Lambertian { color: ImageMap { file: \"elsewhere/a.png\" } } }, Box { shader: Lambertian { "
          "color: ImageMap { file: \"out-a.png\" } } }"),
      "test.etd", folder.path());
  std::filesystem::create_directory(folder / "there");
  folder.write("there/out-a.png", "another");
  note_input(folder / "there/out-a.png");
  folder.write("there/out-data1.bin", "a buffer");
  note_input(folder / "there/out-data1.bin");
  Exporting exporting(folder / "there/out.gltf");
  exporter_of("out.gltf")->write(*described, exporting);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "there"), {}), 2);
  exporting.write_files();
  EXPECT_EQ(read_regular_file(folder / "there/out-a.png"), "another");
  EXPECT_EQ(read_regular_file(folder / "there/out-data1.bin"), "a buffer");
  EXPECT_EQ(read_regular_file(folder / "there/out-1-a.png"), "far");
  EXPECT_EQ(read_regular_file(folder / "there/out-out-a.png"), "near");
  EXPECT_GT(read_regular_file(folder / "there/out-data2.bin").size(), 8u);
}

TEST(GltfExport, HoldsWhatAnImportHolds) {
  const TemporaryFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Ref<Job> described =
      load_job_text(job("Instance { scene: BvhScene { objects: [Import { file: \"a.obj\" }] } }"), "test.etd", folder.path());
  read_imports(*described);
  Exporting exporting(folder / "out.gltf");
  EXPECT_NE(exporter_of("out.gltf")->write(*described, exporting).find("\"meshes\""), std::string::npos);
  // A missing file is reported at the place where it is named.
  const Ref<Job> without = load_job_text(job("Import { file: \"none.obj\" }"), "test.etd", folder.path());
  try {
    read_imports(*without);
    FAIL() << "read without a file";
  } catch (const Error& error) {
    EXPECT_GT(error.location.line, 0);
    EXPECT_NE(std::string(error.what()).find("none.obj"), std::string::npos) << error.what();
  }
}

// A weak lamp is still a lamp: no studio lights are added.
TEST(GltfExport, KeepsWeakLamps) {
  const TemporaryFolder folder;
  export_job(folder, job("Box { shader: wood, emission: DiffuseEmission { radiance: rgb(0.2, 0.1, 0.05) } }"), "out.glb");
  Importing importing(folder / "out.glb", {}, {});
  importer_of("out.glb")->import(importing);
  EXPECT_TRUE(importing.is_lit.value_or(false));
}

TEST(GltfExport, KeepsThePartsOfPrincipledOrSaysSo) {
  const TemporaryFolder folder;
  const Exported kept = export_job(
      folder,
      job("Box { shader: Principled { base_color: 0.5, base_weight: 0.5, geometry_opacity: 0.25, fuzz_weight: 0.5, "
          "fuzz_roughness: 0.25, "
          "thin_film_weight: 0.5 } }, Sphere { shader: Principled { transmission_weight: 1, transmission_color: 0.125 } }"),
      "out.gltf");
  const std::string back = write_description(*kept.back.job);
  const auto after = [&](const std::string& words) {
    const size_t at = back.find(words);
    return at == std::string::npos ? -1 : std::stod(back.substr(at + words.size()));
  };
  EXPECT_NEAR(after(" base_color: rgb("), 0.25, 1e-3) << back;
  EXPECT_NEAR(after("fuzz_weight: "), 0.5, 1e-3) << back;
  EXPECT_NEAR(after("fuzz_roughness: "), 0.25, 1e-3) << back;
  EXPECT_NEAR(after("transmission_color: rgb("), 0.125, 1e-3) << back;
  EXPECT_EQ(after(" opacity: "), 0.25) << back;
  EXPECT_EQ(after("thin_film_weight: "), 0.5) << back;
  const std::string told =
      export_job(
          folder,
          job("Box { shader: Principled { transmission_weight: 0.5, transmission_color: rgb(1, 0.2, 0.3), coat_weight: 1, "
              "coat_color: rgb(1, 0.5, 0.5), subsurface_weight: 0.5 } }, Sphere { shader: Dielectric { ior: 1.5, "
              "roughness: 0.2, roughness_v: 0.1 } }"),
          "out.gltf")
          .told;
  for (const char* words : {"'transmission_color' of Principled is left out", "the index of a clear coat is 1.5",
                            "'coat_color' of Principled is left out", "a clear coat darkens nothing",
                            "'subsurface_weight' of Principled is left out", "'roughness_v' is left out"})
    EXPECT_NE(told.find(words), std::string::npos) << words << " in " << told;
}

}  // namespace
}  // namespace etendue::mitsuba_test
