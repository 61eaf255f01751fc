// Files that Assimp cannot read, or crashes on, until they are prepared for it (src/assimp/prepared.h): Collada with blanks, in
// UTF-16 and Latin-1, LightWave's old format, 3MF with images; and the messages when its process crashes nevertheless.

#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <filesystem>

#include "components/objects/meshes/mesh_data.h"
#include "etendue/importer.h"
#include "etendue/render/job.h"
#include "etendue/scene.h"
#include "support/process.h"

namespace etendue {
namespace {

struct Model {
  Ref<Scene> scene;
  std::string told, error;
};
Model model(const std::string& path) {
  Model result;
  try {
    Importing importing(path, {});
    const Ref<Component> read = importer_of(path)->import(importing);
    const Ref<Job> job = ref_cast<Job>(read);
    result.scene = job ? job->scene : ref_cast<Scene>(read);
    for (const Error& note : importing.notes()) result.told += std::string(note.what()) + "\n";
  } catch (const Error& error) {
    result.error = error.what();
  }
  return result;
}

Bounds3 bounds(const Scene& scene) {
  Bounds3 all;
  for (const Ref<SceneObject>& object : scene.objects) {
    prepare_tree(*object);
    all.add(object->bounds());
  }
  return all;
}

/// A triangle with a colour, from (0, 0, 0) to (1, 2, 0).
std::string collada(const std::string& declaration, const std::string& color, const std::string& name = "t") {
  return declaration +
         "<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\n<!-- <color> -->"
         "<asset><unit meter=\"1\" name=\"a > b\"/><up_axis>\n Y_UP </up_axis></asset><library_effects><effect id=\"e\">"
         "<profile_COMMON><technique sid=\"c\"><lambert><diffuse><color>" +
         color +
         "</color></diffuse></lambert></technique></profile_COMMON></effect></library_effects><library_materials><material "
         "id=\"m\" name=\"" +
         name +
         "\"><instance_effect url=\"#e\"/></material></library_materials><library_geometries><geometry id=\"g\"><mesh><source "
         "id=\"p\"><float_array id=\"a\" count=\"9\">\n0 0 0\n1 0 0\n\t0 2 0\n</float_array><technique_common><accessor "
         "source=\"#a\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param "
         "name=\"Z\" type=\"float\"/></accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
         "source=\"#p\"/></vertices><triangles count=\"1\" material=\"m\"><input semantic=\"VERTEX\" source=\"#v\" "
         "offset=\"0\"/><p> 0 1 2 </p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene "
         "id=\"w\"><node><matrix>\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n</matrix><instance_geometry url=\"#g\"><bind_material>"
         "<technique_common><instance_material symbol=\"m\" target=\"#m\"/></technique_common></bind_material>"
         "</instance_geometry></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#w\"/></scene>"
         "</COLLADA>";
}

void expect_triangle(const Model& m, const std::string& what) {
  ASSERT_EQ(m.error, "") << what;
  const Vector3 size = bounds(*m.scene).diagonal();
  EXPECT_NEAR(size.x, 1, 1e-5) << what;
  EXPECT_NEAR(size.y, 2, 1e-5) << what;
  EXPECT_NE(write_description(*m.scene).find("base_color: rgb(0.5, 0.25, 0.125)"), std::string::npos)
      << what << write_description(*m.scene);
}

TEST(PreparedFiles, BlanksAroundNumbersOfCollada) {
  const TemporaryFolder folder;
  for (const char* color :
       {"0.5 0.25 0.125 1", "  0.5 0.25 0.125 1  ", "\n\t0.5\n0.25\n0.125\n1\n", "\r\n0.5  0.25\t0.125 1\r\n"})
    expect_triangle(model(folder.write("t.dae", collada("<?xml version=\"1.0\"?>", color))), color);
}

// A camera's angle is read whether it has a name or only an identifier.
TEST(PreparedFiles, CamerasOfColladaWithoutAName) {
  const TemporaryFolder folder;
  const auto angle = [&](const std::string& name) {
    std::string text = collada("<?xml version=\"1.0\"?>", "0.5 0.25 0.125 1");
    const auto before = [&](const std::string& tag, const std::string& more) { text.insert(text.find(tag), more); };
    before("<library_effects>", "<library_cameras><camera id=\"c\"" + name +
                                    "><optics><technique_common><perspective><yfov>40</yfov><aspect_ratio>1</aspect_ratio>"
                                    "<znear>0.1</znear><zfar>100</zfar></perspective></technique_common></optics></camera>"
                                    "</library_cameras>");
    before("</visual_scene>", "<node id=\"k\"><translate>0.5 1 5</translate><instance_camera url=\"#c\"/></node>");
    const std::string path = folder.write("c.dae", text);
    Importing importing(path, {});
    const Ref<Job> job = ref_cast<Job>(importer_of(path)->import(importing));
    return job ? get(*job->camera, "fov").as<Number>()->value * 180 / M_PI : 0;
  };
  EXPECT_NEAR(angle(" name='eye'"), 40, 1e-3);
  EXPECT_NEAR(angle(""), 40, 1e-3);
}

// Exporters that write a transparency of 0, which taken literally leaves nothing visible.
TEST(PreparedFiles, WhatIsWhollyTransparentInColladaIsOpaque) {
  const TemporaryFolder folder;
  std::string text = collada("<?xml version=\"1.0\"?>", "0.5 0.25 0.125 1");
  text.insert(text.find("</lambert>"),
              "<transparent><color>1 1 1 1</color></transparent><transparency><float>0</float></transparency>");
  const Model m = model(folder.write("t.dae", text));
  expect_triangle(m, "transparency 0");
  EXPECT_EQ(write_description(*m.scene).find("MaskShader"), std::string::npos);
  EXPECT_NE(m.told.find("wholly transparent by the letter are opaque"), std::string::npos) << m.told;
}

TEST(PreparedFiles, EncodingsOfCollada) {
  const TemporaryFolder folder;
  const auto wide = [](const std::string& text, bool little) {
    std::string made;
    for (const char c : text) made += little ? std::string{c, '\0'} : std::string{'\0', c};
    return made;
  };
  const std::string text = collada("<?xml version=\"1.0\" encoding=\"UTF-16\"?>", " 0.5 0.25 0.125 1");
  expect_triangle(model(folder.write("a.dae", "\xff\xfe" + wide(text, true))), "little endian");
  expect_triangle(model(folder.write("b.dae", "\xfe\xff" + wide(text, false))), "big endian");
  expect_triangle(model(folder.write("c.dae", wide(text, true))), "little endian, without a mark");
  expect_triangle(model(folder.write("d.dae", "\xef\xbb\xbf" + collada("<?xml version=\"1.0\"?>", "0.5 0.25 0.125 1"))),
                  "UTF-8");
  const std::string latin = "<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>";
  expect_triangle(model(folder.write("e.dae", collada(latin, "0.5 0.25 0.125 1", "gr\xfcn"))), "Latin-1");
}

void put(std::string& to, std::uint32_t value, int bytes) {
  for (int i = bytes; i-- > 0;) to += char(value >> 8 * i);
}
std::string chunk(const std::string& kind, const std::string& content, int bytes = 4) {
  std::string made = kind;
  put(made, std::uint32_t(content.size()), bytes);
  return made + content + std::string(content.size() % 2, '\0');
}
std::string name(std::string text) { return text.append(text.size() % 2 ? 1 : 2, '\0'); }

// Four faces of a pyramid in two surfaces; the first face carries a further face.
TEST(PreparedFiles, LightWavesOldFormat) {
  const TemporaryFolder folder;
  std::string points, faces, half;
  for (const float x : {-1.f, -1.f, 0.f, 1.f, -1.f, 0.f, 1.f, 1.f, 0.f, -1.f, 1.f, 0.f, 0.f, 0.f, 2.f})
    put(points, std::bit_cast<std::uint32_t>(x), 4);
  const auto face = [&](std::initializer_list<std::uint32_t> numbers) {
    for (const std::uint32_t n : numbers) put(faces, n, 2);
  };
  face({3, 0, 1, 4, 0xffff, 1, 3, 0, 1, 4, 2});  // surface -1: one more face follows
  for (std::uint32_t i = 1; i < 4; ++i) face({3, i, (i + 1) % 4, 4, 1});
  put(half, std::bit_cast<std::uint32_t>(0.5f), 4);
  const auto file = [&](const std::string& more) {
    const std::string paint = "\xff\x80" + std::string(2, '\0');
    const std::string content = "LWOB" + chunk("PNTS", points) + chunk("SRFS", name("red") + name("odd")) +
                                chunk("POLS", faces) +
                                chunk("SURF", name("red") + chunk("COLR", paint, 2) + chunk("FLAG", std::string("\1\4", 2), 2) +
                                                  chunk("VDIF", half, 2) + more) +
                                chunk("SURF", name("odd") + chunk("COLR", std::string(4, '\x7f'), 2));
    return folder.write("p.lwo", chunk("FORM", content));
  };
  const Model m = model(file(""));
  ASSERT_EQ(m.error, "");
  EXPECT_EQ(m.told, "");
  const Vector3 size = bounds(*m.scene).diagonal();
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(size[k], 2, 1e-4);
  ASSERT_EQ(m.scene->objects.size(), 2u);
  const std::string text = write_description(*m.scene);
  EXPECT_NE(text.find("base_color: rgb(0.5"), std::string::npos) << "half of red\n" << text;
  EXPECT_NE(model(file(chunk("CTEX", name("Planar Image Map"), 2))).told.find("textures of LightWave's old format"),
            std::string::npos);
  const std::string whole = chunk("FORM", "LWOB" + chunk("PNTS", points) + chunk("POLS", faces));
  EXPECT_FALSE(model(folder.write("cut.lwo", whole.substr(0, whole.size() - 9))).error.empty());
}

// A missing reader, as on clusters, and a crash of the reader are not blamed on the file.
TEST(PreparedFiles, AReaderThatDiesSaysNothingOfTheFile) {
  const TemporaryFolder folder;
  const std::string python = folder.write("python", "#!/bin/sh\nkill -SEGV $$\n");
  std::filesystem::permissions(python, std::filesystem::perms::owner_all);
  const char* const before = std::getenv("ETENDUE_PYTHON");
  const std::string kept = before ? before : "";
  ::setenv("ETENDUE_PYTHON", python.c_str(), 1);
  const Model dead = model(folder.write("s.usda", "#usda 1.0\n"));
  ::setenv("ETENDUE_PYTHON", (folder / "none").c_str(), 1);
  const Model none = model(folder.write("t.usda", "#usda 1.0\n"));
  if (before)
    ::setenv("ETENDUE_PYTHON", kept.c_str(), 1);
  else
    ::unsetenv("ETENDUE_PYTHON");
  for (const char* words : {"signal 11", "may well be right", "Another format"})
    EXPECT_NE(dead.error.find(words), std::string::npos) << dead.error;
  EXPECT_EQ(dead.error.find("damaged"), std::string::npos) << dead.error;
  EXPECT_NE(none.error.find("pip install usd-core numpy"), std::string::npos) << none.error;
}

}  // namespace
}  // namespace etendue
