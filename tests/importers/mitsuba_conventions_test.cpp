// The meaning of Mitsuba's numbers: each convention is tested with a number that follows from its documentation, or that was
// measured with Mitsuba.

#include <cmath>

#include "etendue/describe/color.h"
#include "etendue/volume_shader.h"
#include "mitsuba_support.h"
#include "support/image_file.h"

namespace etendue::mitsuba_test {
namespace {

constexpr double degree = M_PI / 180;

TEST(MitsubaLight, RgbIsWhiteAndSpectraAreAsTheyAre) {
  const auto lamp = [](const std::string& radiance) {
    return seen(import_text(seen_scene(wall("<emitter type=\"area\">" + radiance + "</emitter>"), 1)), 8192);
  };
  const Xyz white = lamp("<rgb name=\"radiance\" value=\"2\"/>");
  EXPECT_NEAR(white.y, 2, 0.01);
  EXPECT_NEAR(white.x / white.y, 0.9505, 0.005);
  EXPECT_NEAR(white.z / white.y, 1.0888, 0.01);
  const Xyz flat = lamp("<spectrum name=\"radiance\" value=\"2\"/>");
  EXPECT_NEAR(flat.x, 2, 0.01);
  EXPECT_NEAR(flat.z, 2, 0.02);
  const Xyz none = lamp("");  // D65 of luminance 1
  EXPECT_NEAR(none.y, 1, 0.005);
  EXPECT_NEAR(none.z / none.y, 1.0888, 0.01);
  // A table is 0 beyond its ends: this fraction of the luminance lies below 555 nm.
  EXPECT_NEAR(lamp("<spectrum name=\"radiance\" value=\"360:1, 555:1\"/>").y, 0.4654, 0.006);
}

// Measured in Mitsuba 3.9.1: camera rays pass through hidden emitters, whose light and shadows on the objects behind are seen;
// rays that then hit nothing are black.
TEST(MitsubaIntegrator, HiddenEmittersLightAndAreNotSeen) {
  const auto seen_of = [](const std::string& content, bool hidden) {
    const std::string hide = hidden ? "<boolean name=\"hide_emitters\" value=\"true\"/>" : "";
    return seen(import_text(scene(sensor() + "<integrator type=\"path\"><integer name=\"max_depth\" value=\"2\"/>" + hide +
                                  "</integrator>" + content)),
                8192)
        .y;
  };
  const std::string around = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.5\"/></emitter>";
  EXPECT_NEAR(seen_of(around, false), 0.5, 0.01);
  EXPECT_EQ(seen_of(around, true), 0);
  EXPECT_NEAR(seen_of(around + wall(diffuse("0.5")), true), 0.25, 0.005);
  // A disc of radius 1 at z = 4 that emits towards the wall: sin^2 = 1 / 2.
  const std::string disc =
      "<shape type=\"disk\"><transform name=\"to_world\"><translate z=\"4\"/></transform>"
      "<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter></shape>";
  EXPECT_NEAR(seen_of(disc + wall(diffuse("0.5")), true), 0.25, 0.005);
  EXPECT_EQ(seen_of(disc + wall(diffuse("0.5")), false), 0);  // the camera sees its back
}

// Nothing is prepared while a file is imported or exported, so it is not known yet whether a mesh is closed.
TEST(MitsubaIntegrator, HiddenEmittersMayBeMeshesOfGlass) {
  const TemporaryFolder folder;
  folder.write("tetrahedron.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  const auto imported = [&](const std::string& bsdf) {
    return import_text(folder, scene("<integrator type=\"path\"><boolean name=\"hide_emitters\" value=\"true\"/></integrator>" +
                                     sensor() + "<shape type=\"obj\"><string name=\"filename\" value=\"tetrahedron.obj\"/>" +
                                     bsdf + "<emitter type=\"area\"/></shape>"));
  };
  const Imported matt_one = imported(diffuse("0.5"));
  EXPECT_EQ(matt_one.told(), "");
  EXPECT_FALSE(*get(matt_one.object(0), "visible_to_camera").as<bool>());
  const Imported glass = imported("<bsdf type=\"dielectric\"/>");
  EXPECT_NE(glass.told().find("an emitter that light goes into is seen"), std::string::npos) << glass.told();
  EXPECT_TRUE(*get(glass.object(0), "visible_to_camera").as<bool>());
}

// The wall stands at z = 5. A clipping plane that the file does not state does not clip.
TEST(MitsubaCamera, ClipsWhereTheFileSaysSo) {
  const auto bright = [](const std::string& clip) {
    return seen(import_text(scene(sensor("<float name=\"fov\" value=\"1\"/>" + clip) + integrator(1) +
                                  wall("<emitter type=\"area\"><rgb name=\"radiance\" value=\"1\"/></emitter>"))),
                64)
        .y;
  };
  const auto planes = [](double nearest, double farthest) {
    return "<float name=\"near_clip\" value=\"" + std::to_string(nearest) + "\"/><float name=\"far_clip\" value=\"" +
           std::to_string(farthest) + "\"/>";
  };
  const double open = bright("");
  EXPECT_GT(open, 0.5);
  EXPECT_NEAR(bright(planes(4.9, 5.1)), open, 0.01 * open);
  EXPECT_EQ(bright(planes(5.1, 100)), 0);
  EXPECT_EQ(bright(planes(0.1, 4.9)), 0);
  const auto told = [](const std::string& clip) { return import_text(scene(sensor(clip) + integrator())).told(); };
  EXPECT_NE(told(planes(2, 1)).find("far_clip must be more than near_clip"), std::string::npos);
  EXPECT_NE(told("<float name=\"near_clip\" value=\"0\"/>").find("near_clip must be more than 0"), std::string::npos);
}

TEST(MitsubaLight, ANumberWasWhiteBeforeVersion2) {
  const std::string lamp = wall("<emitter type=\"area\"><spectrum name=\"radiance\" value=\"2\"/></emitter>");
  const Xyz c = seen(import_text(seen_scene(lamp, 1, "0.5.0")), 8192);
  EXPECT_NEAR(c.z / c.y, 1.0888, 0.01);
}

TEST(MitsubaLight, PointSpotAndDirectional) {
  const double half = 0.5 / M_PI;  // of a diffuse wall of reflectance 0.5
  const auto lit = [](const std::string& light) { return seen(import_text(seen_scene(wall(diffuse("0.5")) + light)), 256).y; };
  EXPECT_NEAR(lit("<emitter type=\"point\"><point name=\"position\" x=\"0\" y=\"0\" z=\"3\"/><rgb name=\"intensity\" "
                  "value=\"8\"/></emitter>"),
              half * 8 / 4, 0.005);
  EXPECT_NEAR(lit("<emitter type=\"directional\"><vector name=\"direction\" value=\"0 0 1\"/><rgb name=\"irradiance\" "
                  "value=\"3\"/></emitter>"),
              half * 3, 0.005);
  EXPECT_NEAR(lit("<emitter type=\"directional\"><rgb name=\"irradiance\" value=\"3\"/></emitter>"), half * 3, 0.005);
  EXPECT_EQ(lit("<emitter type=\"directional\"><vector name=\"direction\" value=\"0 0 -1\"/></emitter>"), 0);
  // The edge falls off linearly in angle, from 15 to 20 degrees: a spot rotated by 17.5 has half of its light in the middle.
  const double c = std::cos(17.5 * degree);
  EXPECT_NEAR(lit("<emitter type=\"spot\"><rgb name=\"intensity\" value=\"10\"/><transform name=\"to_world\"><rotate y=\"1\" "
                  "angle=\"17.5\"/></transform></emitter>"),
              half * 10 / 25 / 2, 0.002)
      << c;
}

TEST(MitsubaLight, SurfacesShowTheirFrontAlone) {
  const std::string back = "<rotate y=\"1\" angle=\"180\"/>";
  const std::string light = "<emitter type=\"constant\"><rgb name=\"radiance\" value=\"1\"/></emitter>";
  EXPECT_NEAR(seen(import_text(seen_scene(light + wall(diffuse("0.5")))), 4096).y, 0.5, 0.01);
  EXPECT_EQ(seen(import_text(seen_scene(light + wall(diffuse("0.5"), back))), 64).y, 0);
  EXPECT_NEAR(
      seen(import_text(seen_scene(light + wall("<bsdf type=\"twosided\">" + diffuse("0.5") + "</bsdf>", back))), 4096).y, 0.5,
      0.01);
  EXPECT_EQ(seen(import_text(seen_scene(wall("<emitter type=\"area\"/>", back))), 64).y, 0);
  EXPECT_NEAR(
      seen(import_text(seen_scene(wall("<boolean name=\"flip_normals\" value=\"true\"/><emitter type=\"area\"/>", back))), 4096)
          .y,
      1, 0.01);
}

TEST(MitsubaSensor, AngleAndHandedness) {
  const auto across = [](const std::string& view, int width, int height, bool vertical = false) {
    Imported i = import_text(scene(sensor(view, width, height) + integrator() + wall(diffuse("0.5"))));
    EXPECT_EQ(i.told(), "");
    Camera& camera = *i.job->camera;
    camera.prepare();
    camera.set_film(width, height);
    const float w = float(width), h = float(height);
    const Ray a = camera.ray(vertical ? Point2{w / 2, 0} : Point2{0, h / 2}, {}, 0);
    const Ray b = camera.ray(vertical ? Point2{w / 2, h} : Point2{w, h / 2}, {}, 0);
    return std::acos(double(dot(a.direction, b.direction))) / degree;
  };
  EXPECT_NEAR(across("", 48, 48), 34.02, 0.01);       // 50 mm, across the diagonal of 36 x 24 mm
  EXPECT_NEAR(across("", 768, 576), 38.1848, 0.001);  // as Mitsuba 3.9 prints it
  EXPECT_NEAR(across("<float name=\"fov\" value=\"40\"/>", 20, 10), 40, 0.001);
  EXPECT_NEAR(across("<float name=\"fov\" value=\"40\"/><string name=\"fov_axis\" value=\"y\"/>", 20, 10, true), 40, 0.001);
  EXPECT_NEAR(across("<float name=\"fov\" value=\"40\"/><string name=\"fovAxis\" value=\"smaller\"/>", 20, 10, true), 40,
              0.001);

  // Right is cross(direction, up): -x for a camera that looks along +z with +y up.
  Imported i = import_text(scene(sensor("<float name=\"fov\" value=\"40\"/>", 10, 10) + integrator() + wall(diffuse("0.5"))));
  i.job->camera->prepare();
  i.job->camera->set_film(10, 10);
  EXPECT_LT(i.job->camera->ray({10, 5}, {}, 0).direction.x, -0.3f);
  EXPECT_GT(i.job->camera->ray({5, 0}, {}, 0).direction.y, 0.3f);
}

TEST(MitsubaSensor, AnOrthographicFilmIsTwoWideTimesItsScale) {
  const Imported i =
      import_text(scene("<sensor type=\"orthographic\"><transform name=\"to_world\"><scale x=\"1.5\" y=\"1.5\"/><translate "
                        "z=\"2\"/></transform><film type=\"hdrfilm\"/></sensor>" +
                        integrator() + wall(diffuse("1"))));
  EXPECT_EQ(i.told(), "");
  EXPECT_NEAR(number(*i.job->camera, "width"), 3, 1e-6);
}

TEST(MitsubaTexture, RowsOfImagesBeginWhereVIsZero) {
  const TemporaryFolder folder;
  const std::string path = folder.write("rows.exr", "");
  // Of two rows the upper one is bright.
  test::write_image(path, {1, 2, 3, NumberType::single}, {0.8f, 0.8f, 0.8f, 0.2f, 0.2f, 0.2f});
  folder.write("square.obj", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  const std::string picture =
      "<bsdf type=\"diffuse\"><texture name=\"reflectance\" type=\"bitmap\"><string name=\"filename\" "
      "value=\"rows.exr\"/><string name=\"filter_type\" value=\"nearest\"/></texture></bsdf>";
  const auto upper_and_lower = [&](const std::string& shape) {
    // Seen from +z, with +y up: the camera looks at (0, +-0.5, 0).
    std::vector<double> found;
    for (const char* y : {"0.5", "-0.5"}) {
      const std::string view =
          std::string("<float name=\"fov\" value=\"1\"/><transform name=\"to_world\"><lookat origin=\"0 ") + y +
          " 4\" target=\"0 " + y + " 0\" up=\"0 1 0\"/></transform>";
      found.push_back(
          seen(import_text(folder, scene(sensor(view) + integrator() + "<emitter type=\"constant\"/>" + shape)), 4096).y);
    }
    return found;
  };
  const auto on_rectangle = upper_and_lower("<shape type=\"rectangle\">" + picture + "</shape>");
  EXPECT_NEAR(on_rectangle[0], 0.2, 0.01);  // upside down
  EXPECT_NEAR(on_rectangle[1], 0.8, 0.02);
  const auto on_obj =
      upper_and_lower("<shape type=\"obj\"><string name=\"filename\" value=\"square.obj\"/>" + picture + "</shape>");
  EXPECT_NEAR(on_obj[0], 0.8, 0.02);  // OBJ files are flipped
  EXPECT_NEAR(on_obj[1], 0.2, 0.01);
  const std::string not_turned = "<boolean name=\"flip_tex_coords\" value=\"false\"/>";
  const auto as_is = upper_and_lower("<shape type=\"obj\"><string name=\"filename\" value=\"square.obj\"/>" + not_turned +
                                     picture + "</shape>");
  EXPECT_NEAR(as_is[0], 0.2, 0.01);
}

TEST(MitsubaTexture, CheckersAndTheirPlace) {
  const auto at = [&](double x, double y, const std::string& to_uv) {
    const std::string p = std::to_string(x) + " " + std::to_string(y) + " ";
    const std::string view = "<float name=\"fov\" value=\"0.1\"/><transform name=\"to_world\"><lookat origin=\"" + p +
                             "4\" target=\"" + p + "0\" up=\"0 1 0\"/></transform>";
    const std::string shape =
        "<shape type=\"rectangle\"><bsdf type=\"diffuse\"><texture type=\"checkerboard\" "
        "name=\"reflectance\">" +
        to_uv + "</texture></bsdf></shape>";
    return seen(import_text(scene(sensor(view) + integrator() + "<emitter type=\"constant\"/>" + shape)), 4096).y;
  };
  EXPECT_NEAR(at(-0.5, -0.5, ""), 0.4, 0.01);  // u = v = 0.25: both below a half
  EXPECT_NEAR(at(0.5, -0.5, ""), 0.2, 0.01);
  EXPECT_NEAR(at(0.5, 0.5, ""), 0.4, 0.01);
  const auto turned = [](const char* steps) { return std::string("<transform name=\"to_uv\">") + steps + "</transform>"; };
  EXPECT_NEAR(at(0.5, -0.5, turned("<translate x=\"0.5\"/>")), 0.4, 0.01);
  // First scaled, then moved: u = 0.75 * 2 + 0.6 = 2.1, v = 0.25 * 2 = 0.5 + 0.1.
  EXPECT_NEAR(at(0.5, -0.5, turned("<scale value=\"2\"/><translate x=\"0.6\" y=\"0.1\"/>")), 0.2, 0.01);
  // A shear: u = 0.75 + 0.5 * 0.25 = 0.875 becomes 1.125 with 0.25 added, v stays.
  EXPECT_NEAR(at(0.5, -0.5, turned("<matrix value=\"1 0.5 0 0.25  0 1 0 0  0 0 1 0  0 0 0 1\"/>")), 0.4, 0.01);
  EXPECT_NEAR(at(0.5, -0.5, turned("<rotate z=\"1\" angle=\"90\"/>")), 0.4, 0.01);  // u = -0.25, v = 0.75: both above
}

TEST(MitsubaLight, AnEnvironmentIsUprightAndRegistered) {
  const TemporaryFolder folder;
  std::vector<float> rgb(size_t(4 * 3 * 3), 0.25f);
  for (size_t k = 0; k < 3; ++k) rgb[size_t(1 * 4 + 1) * 3 + k] = 1;  // column 1 of 4, row 1 of 3
  test::write_image(folder.write("map.exr", ""), {4, 3, 3, NumberType::single}, rgb);
  const auto towards = [&](double u, double v) {
    const double x = std::sin(2 * M_PI * u) * std::sin(M_PI * v), y = std::cos(M_PI * v),
                 z = -std::cos(2 * M_PI * u) * std::sin(M_PI * v);
    const std::string view =
        "<float name=\"fov\" value=\"0.1\"/><transform name=\"to_world\"><lookat origin=\"0 0 0\" target=\"" +
        std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\" up=\"0 1 0.01\"/></transform>";
    const std::string map = "<emitter type=\"envmap\"><string name=\"filename\" value=\"map.exr\"/></emitter>";
    return seen(import_text(folder, scene(sensor(view) + integrator() + map)), 4096).y;
  };
  EXPECT_NEAR(towards(1.5 / 4, 0.5), 1, 0.01);               // the centre of a column at (i + 0.5) / W, a row at j / (H - 1)
  EXPECT_NEAR(towards(1.0 / 4, 0.5), (1 + 0.25) / 2, 0.01);  // between two
  EXPECT_NEAR(towards(1.5 / 4, 0.25), (1 + 0.25) / 2, 0.01);
  EXPECT_NEAR(towards(3.5 / 4, 0.5), 0.25, 0.01);
}

TEST(MitsubaMedium, ExtinctionTimesScaleOverTheWayThrough) {
  const std::string medium =
      "<shape type=\"cube\"><transform name=\"to_world\"><translate z=\"3\"/></transform><bsdf type=\"null\"/><medium "
      "name=\"interior\" "
      "type=\"homogeneous\"><float name=\"scale\" value=\"0.25\"/><spectrum name=\"sigma_t\" value=\"2\"/><float "
      "name=\"albedo\" "
      "value=\"0\"/></medium></shape>";
  const std::string lamp = wall("<emitter type=\"area\"/>");
  EXPECT_NEAR(seen(import_text(scene(sensor() + integrator(1, "volpath") + lamp + medium)), 8192).y, std::exp(-0.5 * 2), 0.02);
}

TEST(MitsubaMedium, PhaseFunctions) {
  const auto imported = [](const std::string& phase) {
    return import_text(scene(sensor() + integrator(1, "volpath") +
                             "<shape type=\"sphere\"><bsdf type=\"null\"/><medium name=\"interior\" type=\"homogeneous\">" +
                             phase + "</medium></shape>"));
  };
  const auto volume = [](const Imported& i) -> const Component& {
    EXPECT_EQ(i.told(), "");
    return part(i.object(0), "interior");
  };
  // The values are compared with Mitsuba's in PhaseFunction.ValuesAreThoseOfMitsuba.
  const Imported air = imported("<phase type=\"rayleigh\"/>");
  EXPECT_EQ(part(volume(air), "phase").class_info().name, "RayleighPhase");
  const Imported lobe = imported("<phase type=\"hg\"><float name=\"g\" value=\"0.25\"/></phase>");
  EXPECT_EQ(number(volume(lobe), "anisotropy"), 0.25);
  const Imported table = imported("<phase type=\"tabphase\"><string name=\"values\" value=\"0.5, 1, 0.25\"/></phase>");
  EXPECT_EQ(get(part(volume(table), "phase"), "values").as<Numbers>()->values, (std::vector<double>{0.5, 1, 0.25}));
  const Imported two = imported(
      "<phase type=\"blendphase\"><float name=\"weight\" value=\"0.25\"/><phase type=\"rayleigh\"/>"
      "<phase type=\"hg\"><float name=\"g\" value=\"-0.5\"/></phase></phase>");
  const Component& blend = part(volume(two), "phase");
  EXPECT_EQ(number(blend, "amount"), 0.25);
  EXPECT_EQ(part(blend, "first").class_info().name, "RayleighPhase");
  EXPECT_EQ(number(part(blend, "second"), "anisotropy"), -0.5);
  const Imported wrong = imported("<phase type=\"blendphase\"><phase type=\"rayleigh\"/></phase>");
  EXPECT_NE(wrong.told().find("has 1 phase functions and 2 weights"), std::string::npos) << wrong.told();
}

// The importer once read the cube's transform after it was destroyed, which AddressSanitizer found.
TEST(MitsubaMedium, AGridStandsInTheWorldAndNotInItsObject) {
  const TemporaryFolder folder;
  std::string grid = "VOL\3";
  for (const std::int32_t number : {1, 1, 1, 1, 1}) grid.append(reinterpret_cast<const char*>(&number), 4);
  for (const float number : {0.f, 0.f, 0.f, 1.f, 1.f, 1.f, 0.5f}) grid.append(reinterpret_cast<const char*>(&number), 4);
  folder.write("grid.vol", grid);
  const Imported i = import_text(
      folder,
      scene(sensor() + integrator(2, "volpath") +
            "<shape type=\"cube\"><transform name=\"to_world\"><translate z=\"3\"/></transform><bsdf type=\"null\"/>"
            "<medium name=\"interior\" type=\"heterogeneous\"><volume type=\"gridvolume\" name=\"sigma_t\"><string "
            "name=\"filename\" value=\"grid.vol\"/><transform name=\"to_world\"><scale value=\"2\"/></transform></volume>"
            "</medium></shape>"));
  ASSERT_EQ(i.told(), "");
  const Value placement = get(part(i.object(0), "interior"), "placement");
  const Transform expected = Transform::translate({0, 0, -3}) * Transform::scale({2, 2, 2});
  if (const auto* placed = placement.as<AnimatedTransform>())
    EXPECT_EQ(placed->still().exact(), expected.exact());
  else
    EXPECT_EQ(placement.as<Transform>()->exact(), expected.exact());
}

// The grid of albedos has another transform than the grid of densities: each is looked up in its own space.
TEST(MitsubaMedium, AlbedosLieWhereTheirGridSays) {
  const TemporaryFolder folder;
  const auto write = [&](const char* name, std::initializer_list<float> values) {
    std::string grid = "VOL\3";
    for (const std::int32_t number : {1, int(values.size()), 1, 1, 1}) grid.append(reinterpret_cast<const char*>(&number), 4);
    for (const float number : {0.f, 0.f, 0.f, 1.f, 1.f, 1.f}) grid.append(reinterpret_cast<const char*>(&number), 4);
    for (const float number : values) grid.append(reinterpret_cast<const char*>(&number), 4);
    folder.write(name, grid);
  };
  write("density.vol", {0.5f});
  write("albedo.vol", {0.25f, 0.75f});
  const Imported i = import_text(
      folder,
      scene(sensor() + integrator(2, "volpath") +
            "<shape type=\"cube\"><transform name=\"to_world\"><translate z=\"3\"/></transform><bsdf type=\"null\"/>"
            "<medium name=\"interior\" type=\"heterogeneous\"><float name=\"scale\" value=\"6\"/>"
            "<volume type=\"gridvolume\" name=\"sigma_t\"><string name=\"filename\" value=\"density.vol\"/>"
            "<transform name=\"to_world\"><scale value=\"4\"/></transform></volume>"
            "<volume type=\"gridvolume\" name=\"albedo\"><string name=\"filename\" value=\"albedo.vol\"/>"
            "<string name=\"filter_type\" value=\"nearest\"/><transform name=\"to_world\"><translate x=\"1\"/></transform>"
            "</volume></medium></shape>"));
  ASSERT_EQ(i.told(), "");
  const Ref<Component> interior = *get(i.object(0), "interior").as<Ref<Component>>();
  prepare_tree(*interior);
  const auto& volume = dynamic_cast<const VolumeShader&>(*interior);
  // In world space the border of the two albedos is at x = 1.5; the object's space begins at z = 3.
  for (const auto& [x, albedo] : {std::pair(1.25f, 0.25f), std::pair(1.75f, 0.75f)}) {
    const VolumeCoefficients c = volume.coefficients({x, 0.5f, 0.5f - 3}, 0, Wavelengths());
    EXPECT_NEAR(c.extinction()[0], 3, 1e-5f);
    EXPECT_NEAR(c.scattering[0], 3 * albedo, 1e-5f);
  }
  EXPECT_EQ(volume.coefficients({-0.1f, 0.5f, -2.5f}, 0, Wavelengths()).extinction()[0], 0);
}

// As PyPI's mitsuba 3.9.1 evaluates its emitter 'sunsky': up is z, transformed by to_world if there is one, and the sun's
// direction is in world space. In Mitsuba 0.6 up is y.
TEST(MitsubaLight, ASkyStandsUprightAndItsSunWhereTheWorldSays) {
  struct Row {
    const char *version, *name, *sun, *to_world, *up;
  };
  const Row rows[] = {{"3.0.0", "sun_direction", "0.3, 0.2, 0.8", "", "0, 0, 1"},
                      {"3.0.0", "sun_direction", "0.3, 0.8, 0.2", "<rotate x=\"1\" angle=\"-90\"/>", "0, 1, 0"},
                      {"0.6.0", "sunDirection", "0.3, 0.8, 0.2", "", "0, 1, 0"}};
  for (const Row& row : rows) {
    const auto luminance = [&](const std::string& target) {
      const std::string look = "<transform name=\"" + std::string(row.version[0] == '0' ? "toWorld" : "to_world") + "\">";
      Imported read =
          import_text(scene(sensor("<float name=\"fov\" value=\"0.1\"/>" + look + "<lookat origin=\"0, 0, 0\" target=\"" +
                                   target + "\" up=\"0.5, 0.4, 0.1\"/></transform>") +
                                "<integrator type=\"path\"/><emitter type=\"sunsky\"><vector name=\"" + row.name +
                                "\" value=\"" + row.sun + "\"/>" + look + row.to_world + "</transform></emitter>",
                            row.version));
      if (!read.job) {
        ADD_FAILURE() << read.told();
        return 0.0;
      }
      read.job->renderer->samples = 16;
      read.job->outputs.clear();
      return double(test::measure(read.job).mean.y);
    };
    const double zenith = luminance(row.up);
    EXPECT_GT(luminance(row.sun), 1000 * zenith) << row.version << row.to_world;
    const std::string down = std::string(row.up) == "0, 0, 1" ? "0, 0, -1" : "0, -1, 0";
    EXPECT_LT(luminance(down), zenith / 2) << row.version << row.to_world;
  }
}

TEST(MitsubaLight, AProjectorsPictureKeepsItsShape) {
  const TemporaryFolder folder;
  test::write_image(folder.write("map.exr", ""), {8, 2, 3, NumberType::single}, std::vector<float>(size_t(8 * 2 * 3), 1.0f));
  const std::string light =
      "<emitter type=\"projector\"><float name=\"fov\" value=\"90\"/><texture name=\"irradiance\" type=\"bitmap\">"
      "<string name=\"filename\" value=\"map.exr\"/></texture></emitter>";
  // Mitsuba's own numbers, with 256 samples: the whole picture has the same brightness on a wall perpendicular to the axis.
  for (const auto& [target, expected] : {std::pair("0 0 5", 0.02), std::pair("4 1 5", 0.02), std::pair("0 2 5", 0.0)}) {
    const std::string view =
        std::string("<float name=\"fov\" value=\"1\"/><transform name=\"to_world\"><lookat origin=\"0 0 0\" target=\"") +
        target + "\" up=\"0 1 0.01\"/></transform>";
    EXPECT_NEAR(seen(import_text(folder, scene(sensor(view) + integrator() + wall(diffuse("0.5")) + light)), 64).y, expected,
                2e-4)
        << target;
  }
}

}  // namespace
}  // namespace etendue::mitsuba_test
