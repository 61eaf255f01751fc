// `include` of other programs' files: the file as a whole job, its parts by name, its parameters, and its errors.

#include <gtest/gtest.h>

#include <algorithm>

#include "formats/permissions.h"
#include "mitsuba_support.h"
#include "support/language_test_support.h"

namespace etendue {
namespace {

using mitsuba_test::part;

constexpr const char* room =
    R"(<scene version="3.0.0">
  <default name="samples" value="4"/>
  <sensor type="perspective" id="eye"><float name="fov" value="30"/>
    <film type="hdrfilm"><integer name="width" value="7"/><integer name="height" value="5"/></film>
    <sampler type="independent"><integer name="sample_count" value="$samples"/></sampler></sensor>
  <bsdf type="diffuse" id="red-wall"><rgb name="reflectance" value="0.5, 0.1, 0.1"/></bsdf>
  <shape type="sphere"><ref id="red-wall"/></shape>
  <shape type="disk"><ref id="red-wall"/></shape>
  <emitter type="constant"/>
</scene>
)";

struct IncludedScenes : testing::Test {
  IncludedScenes() { folder.write("room.xml", room); }
  Ref<Job> load(const std::string& text, const LoadOptions& options = {}) const {
    return load_job(folder.write("main.etd", text), options);
  }
  std::string errors(const std::string& text, const LoadOptions& options = {}) const {
    std::string all;
    const auto add = [&](const Error& e) {
      std::string line = show(e).substr(0, show(e).find('\n'));
      for (size_t at; (at = line.find(folder.path() + "/")) != std::string::npos;) line.erase(at, folder.path().size() + 1);
      all += line + "\n";
    };
    try {
      load(text, options);
    } catch (const Errors& several) {
      for (const Error& e : several.errors) add(e);
    } catch (const Error& e) {
      add(e);
    }
    return all;
  }
  TemporaryFolder folder;
};

TEST_F(IncludedScenes, AreTheWholeJobWhenNoneIsWritten) {
  EXPECT_EQ(write_description(*load("include \"room.xml\"")), write_description(*load_job(folder / "room.xml")));
  // In JSON, and through another file that is included.
  folder.write("between.etd", "include \"room.xml\"");
  folder.write("main.json", R"({"$include": ["between.etd"]})");
  EXPECT_EQ(write_description(*load_job(folder / "main.json")), write_description(*load_job(folder / "room.xml")));
}

TEST_F(IncludedScenes, GiveTheirPartsByNameToAJobThatIsWritten) {
  const Ref<Job> job = load(
      "include \"room.xml\" as room\n"
      "Job { camera: room.camera, renderer: PathTracer { samples: 3 }, image: room.image,\n"
      "  scene: BvhScene { objects: join(room.objects, [Sphere { shader: room.red_wall }]) } }");
  EXPECT_EQ(job->scene->objects.size(), 4u);
  EXPECT_EQ(job->image->width, 7);
  EXPECT_EQ(job->renderer->samples, 3u);
  EXPECT_EQ(&part(*job->scene->objects[3], "shader"), &part(*job->scene->objects[0], "shader"));
  // The whole scene by the include's name; and, for an include without a name, the file's own names.
  EXPECT_EQ(load("include \"room.xml\" as r\nJob { camera: r.eye, scene: r.scene }")->scene->objects.size(), 3u);
  const Ref<Job> plain =
      load("include \"room.xml\"\nJob { camera: eye, scene: BvhScene { objects: [Disc { shader: red_wall }] } }");
  EXPECT_EQ(part(*plain->scene->objects[0], "shader").class_info().name, "Lambertian");
  // A file that is included under two names is read twice.
  const Ref<Job> twice = load(
      "include \"room.xml\" as a\ninclude \"room.xml\" as b\n"
      "Job { camera: a.eye, scene: BvhScene { objects: [a.objects[0], b.objects[0]] } }");
  EXPECT_NE(twice->scene->objects[0], twice->scene->objects[1]);
}

TEST_F(IncludedScenes, TakeParameters) {
  EXPECT_EQ(load("include \"room.xml\" with { samples: 9 }")->renderer->samples, 9u);
  const std::string named =
      "param n = 2\ninclude \"room.xml\" with { samples: n + 5 } as r\nJob { camera: r.eye, scene: "
      "r.scene, renderer: r.renderer }";
  EXPECT_EQ(load(named)->renderer->samples, 7u);
  LoadOptions options;
  options.defines = {{"n", "20"}};
  EXPECT_EQ(load(named, options)->renderer->samples, 25u);
  options.defines = {{"r.samples", "11"}};
  EXPECT_EQ(load(named, options)->renderer->samples, 11u);
  options.defines = {{"samples", "12"}};
  EXPECT_EQ(load("include \"room.xml\"", options)->renderer->samples, 12u);

  EXPECT_EQ(errors("include \"room.xml\" with { sampels: 9 }"), "main.etd:1:27: 'room.xml' has no parameter 'sampels'\n");
  EXPECT_EQ(
      errors("include \"room.xml\" with { samples: 9 m }"),
      "main.etd:1:27: a parameter of 'room.xml' is a number without a unit, a list of such numbers, a boolean or a string\n");
  options.defines = {{"r.sampels", "12"}};
  EXPECT_EQ(errors(named, options), "-D r.sampels: there is no param 'r.sampels'\n");
}

TEST_F(IncludedScenes, TellWhatIsWrongWhereItIs) {
  EXPECT_EQ(errors("\n include \"none.xml\""), "main.etd:2:10: cannot open 'none.xml': No such file or directory\n");
  folder.write("bad.xml", "<scene version=\"3.0.0\">\n  <shape type=\"sphere\"><ref id=\"gone\"/></shape>\n</scene>");
  const std::string wrong = errors("include \"bad.xml\" as bad\nJob { camera: none, scene: bad.scene }");
  EXPECT_EQ(wrong.substr(0, 10), "bad.xml:2:") << wrong;
  EXPECT_NE(wrong.find("'gone'"), std::string::npos) << wrong;
  EXPECT_NE(wrong.find("included at main.etd:1:9"), std::string::npos) << wrong;
  EXPECT_EQ(wrong.find('\n'), wrong.size() - 1) << "what follows from it is no news: " << wrong;

  folder.write("room2.xml", room);
  EXPECT_NE(errors("include \"room.xml\"\ninclude \"room2.xml\"")
                .find("main.etd:2:9: 'room.xml', included at line 1:9, is the "
                      "whole description already"),
            std::string::npos);
  EXPECT_NE(errors("include \"room.xml\"\nred_wall = Lambertian {}\nJob { camera: none, scene: none }")
                .find("'red_wall' is already defined at main.etd:2:1"),
            std::string::npos);
  EXPECT_NE(errors("include \"room.xml\" as r\nJob { camera: r.camera, scene: r.scenes }").find("'r.scenes' is not defined"),
            std::string::npos);
  EXPECT_EQ(errors("include \"room.xml\" as r"), "main.etd: there is no Job: a render description needs one Job { … }\n");
}

// Errors in an include or elsewhere are reported; names that are missing because a file was not read are not.
TEST_F(IncludedScenes, OneErrorBringsNoOthers) {
  const std::string use = " as r\nJob { camera: r.camera, scene: r.scene, image: r.image }";
  const auto lines = [](const std::string& all) { return std::ranges::count(all, '\n'); };
  for (const char* given : {" with { samples: 2 m }", " with { samples: undefd }", " with { samples: Sphere {} }"}) {
    const std::string wrong = errors("include \"room.xml\"" + std::string(given) + use);
    EXPECT_EQ(lines(wrong), 1) << wrong;
  }
  const std::string twice = errors("include \"room.xml\" as r\ninclude \"room.xml\"" + use);
  EXPECT_EQ(lines(twice), 1) << twice;
  const std::string syntax = errors("include \"room.xml\"" + use + "\nball = Sphere { radius: }");
  EXPECT_EQ(lines(syntax), 1) << syntax;
  LoadOptions options;
  options.defines = {{"r.samples", "2"}, {"r.samples", "3"}};
  const std::string defines = errors("include \"room.xml\"" + use, options);
  EXPECT_EQ(lines(defines), 1) << defines;
}

TEST_F(IncludedScenes, PartsThatNothingUsesBringNoWarning) {
  testing::internal::CaptureStderr();
  load("include \"room.xml\" as r\nJob { camera: r.camera, scene: r.scene, image: r.image }");
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_EQ(told.find("not used"), std::string::npos) << told;
}

TEST_F(IncludedScenes, AreReadAsTheCommandLineSays) {
  // A part that cannot be expressed exactly.
  folder.write("odd.xml",
               "<scene version=\"3.0.0\">\n<sensor type=\"perspective\"/>\n<shape type=\"sphere\"><float name=\"odd\" "
               "value=\"1\"/></shape><emitter type=\"constant\"/></scene>");
  LoadOptions strict;
  strict.import.strict = true;
  EXPECT_EQ(errors("include \"odd.xml\""), "");
  EXPECT_NE(errors("include \"odd.xml\"", strict).find("odd.xml:3:"), std::string::npos);
  // A file outside the scene file's folder, though within the description's folder.
  std::filesystem::create_directories(folder / "inner");
  folder.write("ball.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  folder.write("inner/out.xml",
               "<scene version=\"3.0.0\"><sensor type=\"perspective\"/><shape type=\"ply\"><string "
               "name=\"filename\" value=\"../ball.ply\"/></shape><emitter type=\"constant\"/></scene>");
  EXPECT_NE(errors("include \"inner/out.xml\"").find("--allow-path"), std::string::npos);
  LoadOptions allowed;
  allowed.import.allowed_folders = {folder.path()};
  EXPECT_EQ(errors("include \"inner/out.xml\"", allowed), "");

  // Import reads its file when it is prepared, with the permissions that the user of the program gave.
  const std::string import = "Import { file: \"" + folder / "inner/out.xml" + "\" }";
  EXPECT_THROW(prepare_tree(*parse_component(import)), Errors);
  set_import_permissions(allowed.import);
  EXPECT_NO_THROW(prepare_tree(*parse_component(import)));
  set_import_permissions(strict.import);
  EXPECT_THROW(prepare_tree(*parse_component("Import { file: \"" + folder / "odd.xml" + "\" }")), Errors);
  set_import_permissions({});
  EXPECT_NO_THROW(prepare_tree(*parse_component("Import { file: \"" + folder / "odd.xml" + "\" }")));
}

TEST_F(IncludedScenes, AreNotReadInTextsFromStrangers) {
  LoadOptions strangers;
  strangers.allow_files = false;
  EXPECT_NE(errors("include \"room.xml\"", strangers).find("files are not allowed here"), std::string::npos);
}

}  // namespace
}  // namespace etendue
