// Other programs' interpretation of their files, where Étendue by itself would read them differently: numbers of Mitsuba 3.9.1
// and the formulas of pbrt and of file formats.

#include <numbers>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/describe/color.h"
#include "etendue/scene_object.h"
#include "mitsuba_support.h"

namespace etendue {
namespace {

using mitsuba_test::import_file;
using mitsuba_test::Imported;
using mitsuba_test::number;
using mitsuba_test::part;

constexpr double pi_exactly = std::numbers::pi;

/// The mean Y of a picture, whatever messages there were.
double brightness(const Imported& imported, int samples) {
  EXPECT_TRUE(imported.errors.empty()) << imported.told();
  if (!imported.job) return 0;
  imported.job->renderer->samples = samples;
  imported.job->outputs.clear();
  return double(test::measure(imported.job).mean.y);
}

std::string text_of(const Component& of, const std::string& member) {
  const Value value = get(of, member);
  const auto* found = value.as<std::string>();
  return found ? *found : "";
}

std::string lit_mesh(const std::string& sensor, const std::string& direction, const std::string& mesh,
                     const std::string& bsdf) {
  return "<scene version=\"3.0.0\"><integrator type=\"path\"><integer name=\"max_depth\" value=\"2\"/></integrator>" + sensor +
         "<emitter type=\"directional\"><vector name=\"direction\" value=\"" + direction +
         "\"/><rgb name=\"irradiance\" value=\"1\"/></emitter><shape type=\"obj\"><string name=\"filename\" value=\"" + mesh +
         "\"/>" + bsdf + "</shape></scene>";
}
std::string view(const std::string& type, int size, const std::string& more = {}) {
  const std::string s = std::to_string(size);
  return "<sensor type=\"" + type + "\">" + more +
         "<transform name=\"to_world\"><lookat origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"/></transform><film "
         "type=\"hdrfilm\"><integer name=\"width\" value=\"" +
         s + "\"/><integer name=\"height\" value=\"" + s + "\"/><rfilter type=\"box\"/></film></sensor>";
}

// ---- Mitsuba ------------------------------------------------------------------------------------------------------

// A ball of 120 triangles with smooth normals, lit from behind: at its silhouette Mitsuba drops the light that shading normals
// would send through the surface. mitsuba 3.9.1, scalar_rgb, 4096 samples a pixel: 0.0274210 for an irradiance of 3.
TEST(OtherPrograms, MitsubaLosesLightAtSmoothOutlines) {
  const TemporaryFolder folder;
  constexpr int n = 12, m = 6;
  std::string obj;
  for (int j = 0; j <= m; ++j)
    for (int i = 0; i < n; ++i) {
      const double t = pi_exactly * j / m, p = 2 * pi_exactly * i / n;
      const std::string place =
          fmt::format(" {:.6f} {:.6f} {:.6f}\n", std::sin(t) * std::cos(p), std::cos(t), std::sin(t) * std::sin(p));
      obj += "v" + place + "vn" + place;
    }
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * n + i + 1, b = j * n + (i + 1) % n + 1, c = a + n, d = b + n;
      if (j > 0) obj += fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", a, b, c);
      if (j < m - 1) obj += fmt::format("f {0}//{0} {1}//{1} {2}//{2}\n", b, d, c);
    }
  folder.write("ball.obj", obj);
  const std::string diffuse = "<bsdf type=\"twosided\"><bsdf type=\"diffuse\"/></bsdf>";
  const Imported smooth =
      import_file(folder.write("ball.xml", lit_mesh(view("orthographic", 16), "-1,-.2,.6", "ball.obj", diffuse)));
  EXPECT_EQ(smooth.told(), "");
  EXPECT_NEAR(brightness(smooth, 256), 0.0274210 / 3, 0.01 * 0.0274210 / 3);
  // Triangles with face normals lose no light.
  const Imported flat =
      import_file(folder.write("flat.xml", lit_mesh(view("orthographic", 16), "-1,-.2,.6", "ball.obj",
                                                    "<boolean name=\"face_normals\" value=\"true\"/>" + diffuse)));
  EXPECT_EQ(text_of(flat.object(1), "shading_normals"), "folded");
}

// Surface coordinates mirrored over a square: green tilts the normal along the cross product of the normal and the direction of
// u. mitsuba 3.9.1, without the shadowing function: 0.0546621 for green and 0.0739546 for red.
TEST(OtherPrograms, MitsubaTiltsGreenAcrossU) {
  const TemporaryFolder folder;
  folder.write("square.obj",
               "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nvt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  const auto seen = [&](const char* name, const std::string& color, const std::string& more) {
    std::string pixels;
    for (int i = 0; i < 4; ++i) pixels += color;
    folder.write(std::string(name) + ".ppm", "P6\n2 2\n255\n" + pixels);
    const std::string bsdf = "<bsdf type=\"normalmap\">" + more +
                             "<texture type=\"bitmap\" name=\"normalmap\"><string name=\"filename\" value=\"" + name +
                             ".ppm\"/><boolean name=\"raw\" value=\"true\"/></texture><bsdf type=\"diffuse\"/></bsdf>";
    return import_file(
        folder.write(std::string(name) + ".xml",
                     lit_mesh(view("perspective", 1, "<float name=\"fov\" value=\"1\"/>"), "-.3,-.5,-.8", "square.obj", bsdf)));
  };
  const std::string off = "<boolean name=\"use_shadowing_function\" value=\"false\"/>";
  // Eight bits do not represent 0.5, 0.8 and 0.9 exactly, which changes the light by one per cent.
  const Imported green = seen("green", "\x80\xcc\xe6", off), red = seen("red", "\xcc\x80\xe6", off);
  EXPECT_EQ(green.told(), "");
  EXPECT_NEAR(brightness(green, 64), 0.0546621, 0.02 * 0.0546621);
  EXPECT_NEAR(brightness(red, 64), 0.0739546, 0.02 * 0.0739546);
}

// Since 3.7.1 Mitsuba treats tilted normals like microfacets: slanted light is attenuated (shadowing function), and a viewer
// behind the tilted normal sees the flipped one. mitsuba 3.9.1: 0.1148296 (0.1306420 without), and 0.1499672 (nothing without).
TEST(OtherPrograms, MitsubasTiltedNormalsAreSlopes) {
  const TemporaryFolder folder;
  folder.write("square.obj",
               "v -9 -9 0\nv 9 -9 0\nv 9 9 0\nv -9 9 0\nvt 1 0\nvt 0 0\nvt 0 1\nvt 1 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n");
  folder.write("tilt.ppm", "P6\n2 2\n255\n\x80\xcc\xe6\x80\xcc\xe6\x80\xcc\xe6\x80\xcc\xe6");
  const auto seen = [&](const std::string& from, const std::string& light, const std::string& more) {
    std::string camera = view("perspective", 1, "<float name=\"fov\" value=\"1\"/>");
    camera.replace(camera.find("0,0,5"), 5, from);
    camera.replace(camera.find("up=\"0,1,0\""), 10, "up=\"0,1,0.1\"");
    const std::string bsdf = "<bsdf type=\"normalmap\">" + more +
                             "<texture type=\"bitmap\" name=\"normalmap\"><string name=\"filename\" value=\"tilt.ppm\"/>"
                             "<boolean name=\"raw\" value=\"true\"/></texture><bsdf type=\"diffuse\"/></bsdf>";
    return brightness(import_file(folder.write("tilt.xml", lit_mesh(camera, light, "square.obj", bsdf))), 64);
  };
  EXPECT_NEAR(seen("0,0,5", "0,.9,-.3", ""), 0.1148296, 0.01 * 0.1148296);
  EXPECT_NEAR(seen("0,4.9,1", "-.3,-.5,-.8", ""), 0.1499672, 0.01 * 0.1499672);
  EXPECT_EQ(seen("0,4.9,1", "-.3,-.5,-.8", "<boolean name=\"flip_invalid_normals\" value=\"false\"/>"), 0);
}

// ---- pbrt ---------------------------------------------------------------------------------------------------------

Imported pbrt(const TemporaryFolder& folder, const std::string& world, const std::string& before = {}) {
  return import_file(folder.write(
      "scene.pbrt", before + "Camera \"perspective\" \"float fov\" 1\nFilm \"" + (before.starts_with("#3") ? "image" : "rgb") +
                        "\" \"integer xresolution\" 1 \"integer yresolution\" 1\nWorldBegin\n" + world));
}

// pbrt's Disk: u = phi / phi_max, v = (radius - r) / (radius - inner radius), and their derivatives (shapes.h).
TEST(OtherPrograms, PbrtsDisksHaveCoordinatesAroundThem) {
  const TemporaryFolder folder;
  for (const auto& [inner, turn] : {std::pair{0.0, 360.0}, {0.5, 360.0}, {0.5, 270.0}, {0.0, 100.0}}) {
    const Imported imported = pbrt(
        folder, fmt::format("Shape \"disk\" \"float radius\" 2 \"float innerradius\" {} \"float phimax\" {}", inner, turn));
    ASSERT_EQ(imported.told(), "");
    SceneObject& object = *imported.job->scene->objects.at(0);
    prepare_tree(object);
    const double most = turn * pi_exactly / 180;
    for (const auto& [r, phi] : {std::pair{0.7, 0.3}, {1.9, 1.5}, {1.2, 4.0}}) {
      if (phi > most) continue;
      const Ray ray(Point3{float(r * std::cos(phi)), float(r * std::sin(phi)), 3}, Vector3{0, 0, -1});
      Hit hit;
      ASSERT_TRUE(object.intersect(ray, hit));
      SurfacePoint p;
      object.surface_point(ray, hit, p);
      object.tangents(p);
      EXPECT_NEAR(double(p.uv.x), phi / most, 1e-5);
      EXPECT_NEAR(double(p.uv.y), (2 - r) / (2 - inner), 1e-5);
      const double x = r * std::cos(phi), y = r * std::sin(phi);
      EXPECT_LT(length(p.dpdu - Vector3{float(-most * y), float(most * x), 0}), 1e-4f);
      EXPECT_LT(length(p.dpdv - Vector3{float(x * (inner - 2) / r), float(y * (inner - 2) / r), 0}), 1e-4f);
    }
  }
}

// v3's PlanarMapping2D uses the point in world space (texture.cpp), v4's the point in texture space.
TEST(OtherPrograms, PbrtsThirdVersionProjectsPlacesOfTheWorld) {
  const TemporaryFolder folder;
  const auto seen = [&](const char* before, const char* kind) {
    const Imported imported = pbrt(folder,
                                   std::string("LightSource \"infinite\" \"rgb L\" [1 1 1]\nAttributeBegin\nTranslate 1 0 0\n"
                                               "Texture \"t\" \"") +
                                       kind +
                                       "\" \"checkerboard\" \"rgb tex1\" [1 1 1] \"rgb tex2\" [0 0 0] \"string mapping\" "
                                       "\"planar\" \"vector3 v1\" [1 0 0] \"vector3 v2\" [0 1 0]\nAttributeEnd\nMaterial \"" +
                                       (before[1] == '3' ? "matte\" \"texture Kd\"" : "diffuse\" \"texture reflectance\"") +
                                       " \"t\"\nTranslate 0 0 9\nShape \"disk\" \"float radius\" 9\n",
                                   before);
    return brightness(imported, 16);
  };
  const double third = seen("#3\nTranslate -0.4 -0.3 0\n", "color"), fourth = seen("#4\nTranslate -0.4 -0.3 0\n", "spectrum");
  EXPECT_GT(third, 0.2);
  EXPECT_EQ(fourth, 0);
}

// lights.cpp of pbrt-v4: "scale" is multiplied by power / (the light's own power), so that both count.
TEST(OtherPrograms, PbrtsScaleCountsBesidePower) {
  const TemporaryFolder folder;
  folder.write("white.ppm", "P6\n2 2\n255\n" + std::string(12, '\xff'));
  const auto amount = [&](const std::string& world, const char* member) {
    const Imported imported = pbrt(folder, world);
    return imported.job ? number(part(imported.object(0), "emission"), member) : 0;
  };
  const std::string area = "AreaLightSource \"diffuse\" \"float power\" 10 ", ball = "\nShape \"sphere\"\n",
                    sky = "LightSource \"infinite\" \"string filename\" \"white.ppm\" \"float illuminance\" 10 ",
                    slide = "LightSource \"projection\" \"string filename\" \"white.ppm\" \"float power\" 10 ";
  const double lamp = amount(area + ball, "luminous_flux"), light = amount(sky, "illuminance"), beam = amount(slide, "scale");
  EXPECT_GT(lamp, 0);
  EXPECT_NEAR(amount(area + "\"float scale\" 3" + ball, "luminous_flux") / lamp, 3, 1e-9);
  EXPECT_NEAR(amount(sky + "\"float scale\" 3", "illuminance") / light, 3, 1e-9);
  EXPECT_NEAR(amount(slide + "\"float scale\" 3", "scale") / beam, 3, 1e-6);
}

// A name stands for the coefficients of Jensen et al. 2001, table 1, which are reduced ones, so that g is not used
// (materials.cpp).
TEST(OtherPrograms, PbrtsSubsurfaceMaterialsMayBeNamed) {
  const TemporaryFolder folder;
  const auto made = [&](const std::string& material) {
    const Imported imported = pbrt(folder, "Material \"subsurface\" " + material + "\nShape \"sphere\"\n");
    return imported.job ? write_value(get(part(imported.object(0), "shader"), "mean_free_path")) + imported.told() : "none";
  };
  const std::string skin = made("\"rgb sigma_a\" [.032 .17 .48] \"rgb sigma_s\" [.74 .88 1.01]");
  EXPECT_EQ(made("\"string name\" \"Skin1\" \"float g\" .5"), skin);
  EXPECT_NE(made(""), skin);
  EXPECT_NE(made("\"string name\" \"Custard\"").find("no measured medium 'Custard'"), std::string::npos);
}

// ---- Models -------------------------------------------------------------------------------------------------------

struct Model {
  Ref<Scene> scene;
  std::string told;
};
Model model(const std::string& path) {
  Importing importing(path, {});
  Model result{ref_cast<Scene>(importer_of(path)->import(importing)), {}};
  for (const Error& e : importing.notes()) result.told += std::string(e.what()) + "\n";
  return result;
}

Model mtl(const TemporaryFolder& folder, const std::string& lines) {
  folder.write("grey.ppm", "P6\n1 1\n255\n\x80\x80\xff");
  folder.write("m.mtl", "newmtl m\n" + lines);
  return model(folder.write("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"));
}

TEST(OtherPrograms, ImagesOfMtlFilesCountOrAreTold) {
  const TemporaryFolder folder;
  EXPECT_NE(mtl(folder, "Kd .5 .5 .5\nmap_Ns grey.ppm\n").told.find("exponent Ns is left out"), std::string::npos);
  const Model shiny = mtl(folder, "Kd .5 .5 .5\nmap_Ks grey.ppm\nNs 50\n");
  EXPECT_EQ(part(part(*shiny.scene->objects[0], "shader"), "specular_color").class_info().name, "ImageMap");
  const Model soft = mtl(folder, "Kd .5 .5 .5\nPr .5\nmap_Ps grey.ppm\n");
  EXPECT_EQ(text_of(part(part(*soft.scene->objects[0], "shader"), "fuzz_color"), "transfer"), "linear");
  for (const double strength : {2.5, -2.5}) {
    const Model tilted = mtl(folder, fmt::format("Kd .5 .5 .5\nnorm -bm {} grey.ppm\n", strength));
    EXPECT_EQ(number(part(*tilted.scene->objects[0], "shader"), "strength"), strength);
  }
}

double red_of(const MeshData& mesh, size_t triangle) {
  for (const VertexAttribute& a : mesh.face_attributes)
    if (a.name == "face_color") return double(a.values.at(3 * triangle));
  return -1;
}

TEST(OtherPrograms, ColoursOfFacesAreSeen) {
  const TemporaryFolder folder;
  const Model ply = model(folder.write(
      "f.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty "
      "list uchar int vertex_indices\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0\n"));
  EXPECT_EQ(text_of(part(part(*ply.scene->objects[0], "shader"), "base_color"), "name"), "face_color");
  // Two triangles: one red, by the bits of either dialect, and one without a colour of its own.
  const auto stl = [&](const std::string& head, std::uint16_t first, std::uint16_t second) {
    std::string file = head + std::string(80 - head.size(), ' ') + std::string("\2\0\0\0", 4);
    for (const std::uint16_t bits : {first, second}) {
      const float numbers[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, float(bits & 1)};
      file.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
      file.append(reinterpret_cast<const char*>(&bits), 2);
    }
    return folder.write("c.stl", file);
  };
  const std::string viscam = stl("exported by VisCAM", 0x8000 | 31 << 10, 1);
  EXPECT_NEAR(red_of(read_mesh(viscam), 0), 1, 1e-6);
  EXPECT_NEAR(red_of(read_mesh(viscam), 1), 0.7, 1e-6);
  EXPECT_EQ(text_of(part(part(*model(viscam).scene->objects[0], "shader"), "base_color"), "name"), "face_color");
  const std::string magics = stl("COLOR=\x80\x80\x80\xff", 31, 0x8001);
  EXPECT_NEAR(red_of(read_mesh(magics), 0), 1, 1e-6);
  EXPECT_NEAR(red_of(read_mesh(magics), 1), 0.2158605, 1e-5);  // 128 of 255 in sRGB
  EXPECT_EQ(red_of(read_mesh(stl("none", 0, 1)), 0), -1);
  const std::string capital = folder.write("C.STL",
                                           "SOLID part\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\n"
                                           "VERTEX 0 1 0\nENDLOOP\nENDFACET\nENDSOLID part\n");
  EXPECT_EQ(read_mesh(capital).triangles.size(), 1u);
}

}  // namespace
}  // namespace etendue
