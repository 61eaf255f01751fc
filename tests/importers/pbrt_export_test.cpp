// A scene exported to pbrt-v4 and imported again is the same scene.

#include "etendue/exporter.h"
#include "pbrt_support.h"

namespace etendue::pbrt_test {
namespace {

struct Exported {
  std::string text, told;
};

Exported exported(const Ref<Job>& job, const std::string& path) {
  Exporting exporting(path);
  Exported result;
  result.text = exporter_of(path)->write(*job, exporting);
  exporting.write_files();
  for (const Error& note : exporting.notes()) result.told += note.what() + std::string("\n");
  return result;
}

/// A job whose camera sees all of it, with enough samples for the picture's mean to be good to half a per cent.
Ref<Job> job_of(const std::string& objects, const std::string& camera = "from: [1, 2, 6] m, to: [0, 0, 0] m, fov: 40 deg") {
  return load_job_text(
      "Job {\n tone_map: ExposureToneMap {}\n renderer: PathTracer { samples: 1024, max_depth: 6 }\n camera: " +
          (camera.find('{') == std::string::npos ? "PerspectiveCamera { " + camera + " }" : camera) +
          "\n image: ImageBuffer { width: 12, height: 8, filter: BoxFilter {} }\n scene: BruteForceScene { "
          "objects: [\n" +
          objects + "\n] }\n}\n",
      "test.etd");
}

/// Exports, imports and compares pixel by pixel: relative to the brightest pixel, within noise.
void expect_same(const std::string& objects, const std::string& told = "",
                 const std::string& camera = "from: [1, 2, 6] m, to: [0, 0, 0] m, fov: 40 deg", double tolerance = 0.02) {
  const TemporaryFolder folder;
  const Ref<Job> job = job_of(objects, camera);
  const Exported e = exported(job, folder / "scene.pbrt");
  EXPECT_EQ(e.told, told);
  const Imported again = import_text(folder, e.text);
  ASSERT_TRUE(again.job) << again.told() << e.text;
  EXPECT_EQ(again.told(), "") << e.text;
  again.job->outputs.clear();
  const Image a = test::rendered(job)->picture(), b = test::rendered(again.job)->picture();
  ASSERT_EQ(a.width, b.width);
  ASSERT_EQ(a.height, b.height);
  double brightest = 0;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) brightest = std::max(brightest, double(a.at(x, y, 1)));
  ASSERT_GT(brightest, 0);
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(a.at(x, y, c), b.at(x, y, c), tolerance * brightest) << x << " " << y << " " << c << "\n" << e.text;
}

const std::string sky = "Environment { emission: DiffuseEmission { radiance: rgb(0.4, 0.5, 0.6) } }\n";

// A Disc's uv cells are squares, where pbrt's disk has sectors of rings; only `coordinates: around` is exported as a disk.
TEST(PbrtExport, TexturesOfDiscs) {
  const std::string squares = "shader: Lambertian { color: CheckerMap { first: 0.1, second: 0.9, repeat: [3, 5, 1] } } }\n";
  expect_same("Disc { radius: 2 m, transform: rotate(-60, \"x\"), " + squares + sky,
              "a Disc with these surface coordinates becomes triangles\n");
  expect_same("Disc { radius: 2 m, transform: rotate(-60, \"x\"), coordinates: around, " + squares + sky);
}

TEST(PbrtExport, ShapesAndTransforms) {
  expect_same(
      sky +
      "Sphere { centre: [1, 0, 0] m, radius: 0.5 m, shader: Lambertian { color: rgb(0.8, 0.2, 0.1) } }\n"
      "Box { transform: translate(-1, 0, 0) * rotate(30, \"y\"), shader: Lambertian { color: 0.6 } }\n"
      "Disc { transform: translate(0, -1, 0) * rotate(-90, \"x\"), radius: 3 m, shader: Lambertian { color: 0.3 } }\n"
      "Ellipsoid { centre: [0, 1, 0] m, radii: [0.6, 0.2, 0.3] m, shader: Lambertian { color: 0.9 } }\n"
      "Cylinder { transform: translate(0, 0, 1) * rotate(70, \"x\"), radius: 0.3 m, height: 0.6 m, shader: Lambertian {} }\n");
}

TEST(PbrtExport, MeshesInFilesBesideIt) {
  // More vertices than are written into the scene itself.
  const TemporaryFolder folder;
  const Ref<Job> job =
      job_of(sky +
             "SubdivisionSurface { positions: [[-1,-1,-1],[1,-1,-1],[1,1,-1],[-1,1,-1],[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]], "
             "indices: [0,3,2,1, 4,5,6,7, 0,1,5,4, 1,2,6,5, 2,3,7,6, 3,0,4,7], levels: 3, shader: Lambertian {} }\n");
  const Exported e = exported(job, folder / "scene.pbrt");
  EXPECT_NE(e.text.find("scene-mesh1.ply"), std::string::npos);
  const Imported again = import_text(folder, e.text);
  ASSERT_TRUE(again.job) << again.told();
  job->renderer->samples = again.job->renderer->samples = 256;
  EXPECT_NEAR(test::measure(job).mean.y, seen(again).y, 0.003);
}

TEST(PbrtExport, LightsOfAllKinds) {
  const std::string floor =
      "Disc { transform: translate(0, -1, 0) * rotate(-90, \"x\"), radius: 9 m, shader: Lambertian { color: 0.5 } }\n";
  expect_same(floor + "Point { position: [1, 1, 0] m, emission: DiffuseEmission { radiance: 3 * rgb(1, 0.8, 0.6) } }\n");
  expect_same(floor +
              "Point { position: [1, 2, 0] m, transform: rotate(20, \"z\"), emission: SpotEmission { radiance: 9, axis: [0, "
              "-1, 0], inner_angle: 20 deg, outer_angle: 40 deg } }\n");
  expect_same(floor + "Distant { direction: [1, -2, 0], emission: DiffuseEmission { radiance: blackbody(4000 K) } }\n");
  expect_same(floor +
              "Rectangle { transform: translate(0, 2, 0) * rotate(90, \"x\"), emission: DiffuseEmission { radiance: "
              "illuminant(\"A\") } }\n");
  expect_same(floor + "Sphere { radius: 0.3 m, emission: DiffuseEmission { radiance: 2, sides: both } }\n");
  expect_same(floor +
              "Rectangle { transform: translate(0, 1, 0) * rotate(-90, \"x\"), emission: DiffuseEmission { radiance: 4, sides: "
              "back } }\n");
}

TEST(PbrtExport, AmountsOfLight) {
  const std::string floor =
      "Disc { transform: translate(0, -1, 0) * rotate(-90, \"x\"), radius: 9 m, shader: Lambertian { color: 0.5 } }\n";
  expect_same(floor + "Sphere { radius: 0.3 m, emission: DiffuseEmission { radiance: blackbody(3000 K), power: 60 W } }\n");
  expect_same(floor + "Point { position: [0, 1, 0] m, emission: DiffuseEmission { luminous_flux: 800 lm } }\n");
}

TEST(PbrtExport, Materials) {
  const auto ball = [](const std::string& shader) { return sky + "Sphere { shader: " + shader + " }\n"; };
  expect_same(ball("Conductor { ior: metal(\"Au\"), roughness: 0.3, multiple_scattering: false }"));
  const TemporaryFolder folder;
  const std::string brass = exported(job_of(ball("Conductor { ior: metal(\"brass\") }")), folder / "scene.pbrt").text;
  EXPECT_NE(brass.find("\"metal-CuZn-eta\""), std::string::npos) << brass;
  expect_same(ball("Conductor { ior: complex(1.5, 2), roughness: 0.3, roughness_v: 0.1, multiple_scattering: false }"));
  expect_same(ball("Dielectric { ior: 1.4, multiple_scattering: false }"));
  expect_same(ball("Dielectric { ior: 1.6, exterior: 1.2, multiple_scattering: false }"));
  expect_same(ball("ThinDielectric { ior: 1.7, polarizations: averaged }"));
  expect_same(ball("DiffuseTransmitter { reflectance: rgb(0.1, 0.4, 0.2), transmittance: 0.3 }"));
  expect_same(ball("MixShader { first: Lambertian { color: 0.1 }, second: Lambertian { color: 0.9 }, amount: 0.25 }"));
  expect_same(
      ball("MaskShader { shader: Lambertian { color: 0.1 }, opacity: CheckerMap { first: 1, second: 0, repeat: [3, 2, 1] } }"));
  expect_same(ball("Lambertian { color: CheckerMap { first: rgb(0.9, 0.1, 0.1), second: 0.3, repeat: [4, 2, 1] } }"));
}

TEST(PbrtExport, CamerasThatMirrorAndWideOnes) {
  const std::string scene = sky + "Sphere { centre: [1, 0.5, 0] m, radius: 0.5 m, shader: Lambertian { color: 0.9 } }\n";
  expect_same(scene, "", "from: [1, 2, 6] m, to: [0, 0, 0] m, fov: 50 deg, fov_axis: width");
  expect_same(scene, "",
              "from: [1, 2, 6] m, to: [0, 0, 0] m, focal_length: 0.06, fov_axis: diagonal, principal_point: [0.1, -0.05]");
  expect_same(scene, "", "from: [1, 2, 6] m, to: [0, 0, 0] m, fov: 50 deg, transform: scale(-1, 1, 1)");
  for (const char* more : {"", ", mapping: equal_area", ", transform: scale(-1, 1, 1)"})
    expect_same(scene, "", std::string("SphericalCamera { from: [0.4, 1, 0.8] m, to: [0, 0, 0] m") + more + " }");
}

TEST(PbrtExport, Lenses) {
  const std::string scene = sky + "Sphere { centre: [0.3, 0.2, 0] m, radius: 0.5 m, shader: Lambertian { color: 0.9 } }\n";
  for (const char* more : {"", ", aperture_diameter: 0.005, measures: irradiance", ", unit: 0.0015, focus_distance: 2 m"})
    expect_same(scene, "", std::string("LensCamera { from: [1, 1, 3] m, to: [0, 0, 0] m") + more + " }");
}

TEST(PbrtExport, InstancesAndMedia) {
  expect_same(sky +
              "Sphere { radius: 1 m, shader: PassThrough {}, interior: HomogeneousVolume { absorption: rgb(0.1, 0.5, 0.9), "
              "scattering: 0.5, anisotropy: 0.3 } }\n"
              "Instance { transform: translate(-2, 0, 0), scene: BvhScene { objects: [Sphere { radius: 0.5 m, shader: "
              "Lambertian {} }] } }\n");
}

TEST(PbrtExport, WhatCannotBeExpressedIsTold) {
  const TemporaryFolder folder;
  const Exported e = exported(job_of("Torus { shader: PhongShader {} }\n"), folder / "scene.pbrt");
  EXPECT_NE(e.told.find("pbrt has no shape like Torus"), std::string::npos) << e.told;
  // Members that the exporter does not read.
  const Exported f = exported(job_of("Sphere { priority: 1, visible_to_camera: false }\n"), folder / "scene.pbrt");
  EXPECT_NE(f.told.find("'priority' of Sphere is left out"), std::string::npos) << f.told;
  EXPECT_NE(f.told.find("'visible_to_camera' of Sphere is left out"), std::string::npos) << f.told;
}

}  // namespace
}  // namespace etendue::pbrt_test
