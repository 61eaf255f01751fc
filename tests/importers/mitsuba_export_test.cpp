// A scene exported to Mitsuba's XML and read back makes the same picture. Whether Mitsuba itself renders that picture is tested
// by references/exports.py.

#include <cstring>

#include "etendue/exporter.h"
#include "etendue/language/language.h"
#include "mitsuba_support.h"

namespace etendue::mitsuba_test {
namespace {

struct Exported {
  std::string text;
  std::vector<Error> notes;
  Imported back;
};

Exported export_job(const TemporaryFolder& folder, const std::string& job) {
  Exported result;
  const Ref<Job> described = load_job_text(job, "test.etd");
  const std::string path = folder / "out.xml";
  Exporting exporting(path);
  result.text = exporter_of(path)->write(*described, exporting);
  exporting.write_files();
  result.notes = exporting.notes();
  folder.write("out.xml", result.text);
  result.back = import_file(path);
  return result;
}

std::string job(const std::string& objects) {
  return "Job {\n renderer: PathTracer { samples: 4096, max_depth: 4 }\n camera: PerspectiveCamera { from: [0, 1, 6] m, to: "
         "[0, "
         "0, 0] m, "
         "fov: 35 deg }\n image: ImageBuffer { width: 12, height: 8, filter: BoxFilter {} }\n scene: BvhScene { objects: [\n" +
         objects + "\n] }\n}\n";
}

TEST(MitsubaExport, MakesTheSamePictureWhenReadBack) {
  const char* const scenes[] = {
      // Checkers as colours and as numbers.
      "Rectangle { shader: MixShader { first: Lambertian { color: CheckerMap { first: 0.9, second: 0.1, repeat: [2, 1, 1] } }, "
      "second: "
      "Lambertian { color: 0.1 }, amount: CheckerMap { first: 0.2, second: 0.9 } }, corner: [-1, 0, 0] m },"
      "Environment { emission: DiffuseEmission {} }",
      // Lights by amounts, on surfaces and points; shapes under transforms; sides.
      "Sphere { shader: Lambertian { color: rgb(0.2, 0.5, 0.8) }, transform: translate(1, 0, 0) * scale(1, 0.5, 1) },"
      "Rectangle { transform: translate(0, 3, 0) * rotate(90 deg, \"x\"), emission: DiffuseEmission { radiance: blackbody(3000 "
      "K), "
      "power: 300 W } },"
      "Point { position: [0, 0, 5], emission: DiffuseEmission { radiance: illuminant(\"D65\"), luminous_flux: 40000 lm } },"
      "Rectangle { corner: [-4, -1, 4] m, edge_u: [8, 0, 0] m, edge_v: [0, 0, -8] m, sides: front, shader: Lambertian { color: "
      "CheckerMap { first: 0.1, second: rgb(0.9, 0.5, 0.2), repeat: [5, 3, 1] } } }",
      // Metals, glass, plastic, holes; a box, a cylinder, a disc, triangles.
      "Environment { emission: EnvironmentEmission { radiance: rgb(0.5, 0.45, 0.35), scale: 2 } },"
      "Box { size: [1, 2, 1] m, centre: [1.5, 0, 0] m, shader: LossyPlastic { color: 0.5, roughness: 0.2 } },"
      "Cylinder { caps: false, height: 2 m, radius: 0.5 m, transform: rotate(40 deg, \"x\"), shader: MaskShader { opacity: "
      "0.4, shader: "
      "Conductor { ior: metal(\"Au\"), roughness: 0.3, multiple_scattering: false, heights: independent } } },"
      "Disc { transform: translate(-1.5, 0, 0), shader: MixShader { first: Lambertian {}, second: PerfectSpecular {}, amount: "
      "0.25 } },"
      "TriangleMesh { positions: [[-3, -1, -2], [3, -1, -2], [0, 3, -2]], triangles: [0, 1, 2], shader: Lambertian { color: "
      "0.7 } }",
      // Pictures (slides) in front of lamps.
      "Rectangle { corner: [-2, -2, 0] m, edge_u: [4, 0, 0] m, edge_v: [0, 4, 0] m, shader: Lambertian { color: 0.8 } },"
      "Point { transform: translate(0.5, 0, 4) * rotate(180 deg, \"y\"), emission: ForeignSpotEmission { radiance: "
      "illuminant(\"D65\"), edge: linear, picture: CheckerMap { first: rgb(0.9, 0.2, 0.1), second: 0.1 } } },"
      "Point { position: [0, 0, 4] m, transform: translate(-0.5, 0, 8) * rotate(180 deg, \"y\"), emission: ProjectorEmission { "
      "fov: 50, scale: 12, picture: CheckerMap { first: 0.1, second: 0.9 } } }",
      // Densities on a grid.
      "Environment { emission: DiffuseEmission {} },"
      "Box { transform: rotate(90 deg, \"x\") * scale(2, 1, 1), shader: PassThrough {}, interior: GridVolume { resolution: [2, "
      "1, 1], density: [1, 3], outside: cut, extinction: 2, albedo: rgb(0.9, 0.5, 0.2), placement: translate(-0.5, -0.5, "
      "-0.5), "
      "anisotropy: 0.3 } }",
  };
  for (const char* objects : scenes) {
    const TemporaryFolder folder;
    const Exported exported = export_job(folder, job(objects));
    std::string told;
    for (const Error& note : exported.notes) told += note.what() + std::string("\n");
    EXPECT_EQ(told, "");
    ASSERT_TRUE(exported.back.job) << exported.back.told() << exported.text;
    exported.back.job->outputs.clear();
    const Xyz before = test::measure(job(objects)).mean, after = test::measure(exported.back.job).mean;
    // Two renders of about 400 000 paths each differ by up to half a per cent.
    EXPECT_NEAR(after.x / before.x, 1, 0.02) << exported.text;
    EXPECT_NEAR(after.y / before.y, 1, 0.02);
    EXPECT_NEAR(after.z / before.z, 1, 0.025);
  }
}

TEST(MitsubaExport, ComponentsOfMoreThanOneAreWrittenAsMitsubaTakesThem) {
  const TemporaryFolder folder;
  for (const char* extinction : {"3 * rgb(1, 0.5, 0.25)", "rgb(3, 1.5, 0.75)"}) {
    const Exported e =
        export_job(folder, job(std::string("Sphere { shader: PassThrough {}, interior: HomogeneousVolume { extinction: ") +
                               extinction + ", albedo: 0.5 } },\nSphere { shader: Lambertian { color: rgb(1.5, 0.5, 0.2) } }"));
    EXPECT_NE(e.text.find(R"(<float name="scale" value="3" />)"), std::string::npos) << e.text;
    EXPECT_NE(e.text.find(R"(<rgb name="sigma_t" value="1 0.5 0.25" />)"), std::string::npos) << e.text;
    EXPECT_NE(e.text.find(R"(value="1 0.5 0.2" />)"), std::string::npos) << e.text;
  }
}

// A MapVolume that was read from a medium on a grid is exported as that medium; what Mitsuba cannot express is reported.
TEST(MitsubaExport, GridsThatAreTurned) {
  const TemporaryFolder folder;
  const auto exported = [&](const std::string& interior) {
    return export_job(folder, job("Box { shader: PassThrough {}, interior: " + interior + " }"));
  };
  const std::string cut = "density: GridMap { outside: cut, placement: scale(2, 2, 2) }, ",
                    grid = "first: GridMap { resolution: [2, 1, 1], values: [1, 3], placement: scale(2, 2, 2) }";
  const Exported e = exported("MapVolume { " + cut + "extinction: MultiplyMap { " + grid + ", second: 4 }, albedo: 0.25 }");
  EXPECT_TRUE(e.notes.empty()) << e.notes[0].what();
  EXPECT_NE(e.text.find(R"(<float name="scale" value="4" />)"), std::string::npos) << e.text;
  EXPECT_EQ(e.back.told(), "");
  EXPECT_EQ(part(e.back.object(0), "interior").class_info().name, "GridVolume");
  const Exported smaller = exported("MapVolume { density: GridMap { outside: cut }, extinction: MultiplyMap { " + grid +
                                    ", second: 4 }, albedo: 0.25 }");
  ASSERT_EQ(smaller.notes.size(), 1u);
  EXPECT_STREQ(smaller.notes[0].what(), "a medium on a grid ends with the box around its densities in Mitsuba");
  const Exported colored = exported("GridVolume { extinction: rgb(1, 2, 3), outside: cut }");
  ASSERT_EQ(colored.notes.size(), 1u);
  EXPECT_STREQ(colored.notes[0].what(),
               "a medium on a grid is left out whose extinction differs from wavelength to wavelength");
}

TEST(MitsubaExport, AShiftedLensIsNot) {
  const TemporaryFolder folder;
  const auto notes = [&](const char* lens) {
    std::string text = job("Sphere {}");
    text.insert(text.find("fov: 35"), std::string("principal_point: [0.1, 0], ") + lens);
    const Exported e = export_job(folder, text);
    EXPECT_EQ(e.text.find("principal_point_offset") == std::string::npos, *lens != 0) << e.text;
    return e.notes.size();
  };
  EXPECT_EQ(notes(""), 0u);
  EXPECT_EQ(notes("lens_radius: 0.1 m, "), 1u);
}

TEST(MitsubaExport, PhaseFunctions) {
  const TemporaryFolder folder;
  const Exported e = export_job(
      folder,
      job("Sphere { shader: PassThrough {}, interior: HomogeneousVolume { phase: BlendPhase { first: RayleighPhase {}, second: "
          "BlendPhase { first: TabulatedPhase { values: [1, 2, 4] }, second: HenyeyGreensteinPhase { anisotropy: 0.5 } }, "
          "amount: 0.125 } } }"));
  EXPECT_TRUE(e.notes.empty());
  EXPECT_EQ(e.back.told(), "");
  const Component &blend = part(part(e.back.object(0), "interior"), "phase"), &inner = part(blend, "second");
  EXPECT_EQ(number(blend, "amount"), 0.125);
  EXPECT_EQ(part(blend, "first").class_info().name, "RayleighPhase");
  EXPECT_EQ(get(part(inner, "first"), "values").as<Numbers>()->values, (std::vector<double>{1, 2, 4}));
  EXPECT_EQ(number(part(inner, "second"), "anisotropy"), 0.5);

  const Exported fog =
      export_job(folder, job("Sphere { shader: PassThrough {}, interior: HomogeneousVolume { phase: FogPhase {} } }"));
  ASSERT_EQ(fog.notes.size(), 1u);
  EXPECT_STREQ(fog.notes[0].what(), "FogPhase becomes one lobe of the same mean cosine");
  EXPECT_NEAR(number(part(fog.back.object(0), "interior"), "anisotropy"), 0.86, 0.02);
}

TEST(MitsubaExport, TellsWhatItCannotExpress) {
  const TemporaryFolder folder;
  const Exported exported =
      export_job(folder, job("Torus { shader: PhongShader {} }, Distant { emission: DiffuseEmission {} }"));
  std::string told;
  for (const Error& note : exported.notes) told += note.what() + std::string("\n");
  EXPECT_NE(told.find("Mitsuba has no shape like Torus"), std::string::npos) << told;
}

// Members that an exporter does not read are reported with their location, if they have an effect.
TEST(MitsubaExport, MembersThatAreLeftOutAreTold) {
  const TemporaryFolder folder;
  const std::string bumps = "BumpShader { shader: Lambertian {}, height: CheckerMap { first: 0, second: 1 } }";
  const Exported e = export_job(folder, job("Sphere { priority: 2, shader: Dielectric {} },\nSphere { priority: 0 },\n"
                                            "Sphere { priority: 3, shading_normals: clipped, shader: " +
                                            bumps +
                                            " },\n"
                                            "Sphere { shader: MaskShader { shader: " +
                                            bumps + " } }"));
  ASSERT_EQ(e.notes.size(), 2u);
  // The sphere with `clipped` normals is not reported: those are Mitsuba's.
  EXPECT_EQ(std::string(e.notes[0].what()).find("light that tilted normals would send through the surface is lost"), 0u);
  EXPECT_EQ(e.notes[0].location.line, 9);
  EXPECT_STREQ(e.notes[1].what(), "'priority' of Sphere is left out (2 times)");
  EXPECT_EQ(e.notes[1].location.line, 6);
  EXPECT_EQ(e.notes[1].location.column, 20);
}

TEST(MitsubaExport, NormalsThatAMeshFindsForItself) {
  const TemporaryFolder folder;
  export_job(folder,
             job("TriangleMesh { positions: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], triangles: [0, 2, 1, 0, 1, 3], "
                 "smooth: true }"));
  const std::string ply = file_text(folder / "out-mesh1.ply");
  EXPECT_NE(ply.find("property float nx"), std::string::npos);
  const char* vertices = ply.data() + ply.find("end_header\n") + 11;
  float first[6];
  std::memcpy(first, vertices, sizeof first);
  // Between the triangles' normals, (0, 0, -1) and (0, -1, 0): both have a right angle there.
  EXPECT_NEAR(first[3], 0, 1e-5f);
  EXPECT_NEAR(first[4], -std::sqrt(0.5f), 1e-5f);
  EXPECT_NEAR(first[5], -std::sqrt(0.5f), 1e-5f);
  // Indices of vertices that do not exist are left to the reader to refuse.
  const Exported bad = export_job(folder, job("TriangleMesh { positions: [[0, 0, 0], [1, 0, 0]], triangles: [0, 1, 7], smooth: "
                                              "true }"));
  EXPECT_NE(bad.text.find("ply"), std::string::npos);
}

TEST(MitsubaExport, HidesEmittersIfNoneIsSeen) {
  const TemporaryFolder folder;
  const auto exported = [&](const std::string& objects) { return export_job(folder, job(objects)); };
  const std::string unseen = ", visible_to_camera: false }", lamp = "Sphere { emission: DiffuseEmission {}";
  const Exported all = exported("Environment { emission: EnvironmentEmission {}" + unseen + ",\n" + lamp + unseen +
                                ",\nPoint { emission: DiffuseEmission {} }, Sphere {}");
  EXPECT_TRUE(all.notes.empty()) << all.notes[0].what();
  EXPECT_NE(all.text.find("hide_emitters"), std::string::npos);
  EXPECT_EQ(all.back.told(), "");
  for (int i : {0, 1}) EXPECT_FALSE(*get(all.back.object(size_t(i)), "visible_to_camera").as<bool>()) << i;
  for (int i : {2, 3}) EXPECT_TRUE(*get(all.back.object(size_t(i)), "visible_to_camera").as<bool>()) << i;
  for (const std::string& other : {lamp + " }", "Sphere {" + unseen.substr(1)}) {
    const Exported some = exported(lamp + unseen + ",\n" + other);
    EXPECT_EQ(some.text.find("hide_emitters"), std::string::npos);
    ASSERT_EQ(some.notes.size(), 1u);
    EXPECT_NE(std::string(some.notes[0].what()).find("the camera sees this"), std::string::npos);
    EXPECT_EQ(some.notes[0].location.line, 6);
  }
}

}  // namespace
}  // namespace etendue::mitsuba_test
