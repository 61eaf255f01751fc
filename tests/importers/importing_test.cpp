// What all importers share: where the files that a source names are, which of them may be read, and the messages.

#include <gtest/gtest.h>

#include <filesystem>

#include "etendue/importer.h"
#include "render/import_job.h"
#include "support/language_test_support.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;
using language_test::Folder;

std::string error_of(const std::function<void()>& act) {
  try {
    act();
  } catch (const Errors& e) {
    std::string all;
    for (const Error& one : e.errors) all += (all.empty() ? "" : "; ") + std::string(one.what());
    return all;
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

struct ImportingFiles : testing::Test {
  ImportingFiles() {
    fs::create_directories(folder.path() + "/scene/textures");
    fs::create_directories(folder.path() + "/common");
    folder.write("scene/a.xml", "");
    folder.write("scene/textures/Wood.PNG", "");
    folder.write("common/shared.ply", "");
    folder.write("secret.png", "");
  }
  std::string at(const std::string& name) const { return folder.path() + "/" + name; }
  Importing importing(std::vector<std::string> allowed = {}) const {
    ImportOptions options;
    options.allowed_folders = std::move(allowed);
    return Importing(at("scene/a.xml"), options);
  }
  Folder folder;
};

TEST_F(ImportingFiles, LieBesideTheSource) {
  EXPECT_EQ(importing().file("textures/Wood.PNG", {}), at("scene/textures/Wood.PNG"));
  EXPECT_EQ(importing().file("textures\\Wood.PNG", {}), at("scene/textures/Wood.PNG"));
  EXPECT_EQ(importing().file("Wood.PNG", {}, at("scene/textures")), at("scene/textures/Wood.PNG"));
}

TEST_F(ImportingFiles, OfTheAuthorsMachineAreFoundByTheirLastName) {
  fs::copy(at("scene/textures/Wood.PNG"), at("scene/Wood.PNG"));
  for (const char* named : {"wood.png", "/home/somebody/maps/wood.png", "C:\\maps\\WOOD.png", "../elsewhere/wood.png"})
    EXPECT_EQ(importing().file(named, {}), at("scene/Wood.PNG")) << named;
}

TEST_F(ImportingFiles, OutsideOfTheFolderAreRefusedUnlessAllowed) {
  const std::string refused = "'../common/shared.ply' is outside of the folder of '" + at("scene/a.xml") + "'; --allow-path " +
                              fs::canonical(at("common")).string() + " lets files be read there";
  EXPECT_EQ(error_of([&] { importing().file("../common/shared.ply", {}); }), refused);
  EXPECT_NE(error_of([&] { importing().file(at("secret.png"), {}); }).find("--allow-path"), std::string::npos);
  EXPECT_EQ(fs::canonical(importing({at("common")}).file("../common/shared.ply", {})), fs::canonical(at("common/shared.ply")));
  EXPECT_NE(error_of([&] { importing({at("common")}).file("../secret.png", {}); }).find("--allow-path"), std::string::npos);
  // A name that begins like an allowed folder's name can be that of another folder.
  fs::create_directories(at("common2"));
  folder.write("common2/x.ply", "");
  EXPECT_NE(error_of([&] { importing({at("common")}).file("../common2/x.ply", {}); }), "");
}

TEST_F(ImportingFiles, BehindLinksThatLeadOutAreRefused) {
  fs::create_symlink(at("secret.png"), at("scene/link.png"));
  fs::create_directory_symlink(at("common"), at("scene/out"));
  EXPECT_NE(error_of([&] { importing().file("link.png", {}); }).find("--allow-path"), std::string::npos);
  EXPECT_NE(error_of([&] { importing().file("out/shared.ply", {}); }).find("--allow-path"), std::string::npos);
  EXPECT_NE(error_of([&] { importing().file("LINK.png", {}); }), "");
}

TEST_F(ImportingFiles, ThatAreNotThereAreTold) {
  EXPECT_EQ(error_of([&] { importing().file("none.png", {}); }), "there is no file 'none.png'");
  EXPECT_EQ(error_of([&] { importing().file("", {}); }), "the file name is empty");
  EXPECT_EQ(error_of([&] { importing().file(std::string("a\0b", 3), {}); }), "the file name holds a zero byte");
  EXPECT_NE(error_of([&] { importing().file("textures", {}); }), "");  // a folder
  Importing optional = importing();
  EXPECT_FALSE(optional.optional_file("none.png", optional.at(3, 4)));
  ASSERT_EQ(optional.notes().size(), 1u);
  EXPECT_EQ(optional.notes()[0].location.line, 3);
}

TEST_F(ImportingFiles, AreLookedForInSearchFolders) {
  Importing allowed = importing({at("common")});
  allowed.add_search_folder("../common", {});
  EXPECT_EQ(fs::canonical(allowed.file("shared.ply", {})), fs::canonical(at("common/shared.ply")));
  EXPECT_NE(error_of([&] { importing().add_search_folder("../common", {}); }).find("--allow-path"), std::string::npos);
}

TEST(ImportingNotes, AreToldOnceInTheOrderTheyCame) {
  Importing importing("x.xml", {}, {{"spp", "4"}, {"sspp", "4"}});
  importing.inexact("second", importing.at(9));
  importing.inexact("first", importing.at(2));
  importing.inexact("second", importing.at(12));
  importing.inexact("second", importing.at(11));
  EXPECT_EQ(importing.parameter("spp"), "4");
  EXPECT_EQ(importing.parameter("size"), std::nullopt);
  const std::vector<Error> notes = importing.notes();
  ASSERT_EQ(notes.size(), 3u);
  EXPECT_STREQ(notes[0].what(), "second (and at 2 more places)");
  EXPECT_EQ(notes[0].location.line, 9);
  EXPECT_STREQ(notes[1].what(), "first");
  EXPECT_STREQ(notes[2].what(), "the file has no parameter 'sspp'");
}

/// An importer that returns one box, like a file of a single model.
class BoxImporter final : public Importer {
 public:
  explicit BoxImporter(bool empty, DoubleVector3 up) : empty_(empty), up_(up) {}
  std::vector<std::string> extensions() const override { return {"box"}; }
  Ref<Component> import(Importing& importing) const override {
    importing.up = up_;
    return parse_component(empty_ ? "EmbreeScene {}"
                                  : "EmbreeScene { objects: [ Box { size: [2, 2, 2] m, transform: translate(100, 50, 3), "
                                    "shader: Lambertian {} } ] }");
  }

 private:
  bool empty_;
  DoubleVector3 up_;
};

TEST(ImportedModels, AreSeenWholeAndLit) {
  for (const DoubleVector3& up : {DoubleVector3{0, 1, 0}, DoubleVector3{0, 0, 1}}) {
    const BoxImporter importer(false, up);
    const ImportedJob imported = import_job(importer, "a.box", {});
    ASSERT_EQ(imported.notes.size(), 2u);
    Job& job = *imported.job;
    prepare_tree(job);
    job.camera->set_film(64, 64);
    EXPECT_GE(job.scene->luminaires().size(), 1u);
    // All corners of the box lie within the picture: the rays through the picture's border all miss the box.
    Hit hit;
    for (int i = 0; i < 64; ++i) {
      const float t = float(i) + 0.5f;
      for (const Point2 p : {Point2{t, 0}, Point2{t, 64}, Point2{0, t}, Point2{64, t}})
        EXPECT_FALSE(job.scene->nearest(job.camera->ray(p, {0.5f, 0.5f}, 0), hit));
    }
    EXPECT_TRUE(job.scene->nearest(job.camera->ray({32, 32}, {0.5f, 0.5f}, 0), hit));
  }
}

TEST(ImportedModels, ThatAreEmptyOrInexactAreErrorsWhenTheyShouldBe) {
  const BoxImporter nothing(true, {0, 1, 0}), box(false, {0, 1, 0});
  EXPECT_EQ(error_of([&] { import_job(nothing, "a.box", {}); }), "there is nothing in it to be seen");
  LoadOptions strict;
  strict.import.strict = true;
  EXPECT_NE(error_of([&] { import_job(box, "a.box", strict); }).find("it has no camera"), std::string::npos);
}

}  // namespace
}  // namespace etendue
