// A document: its render follows its text, and undo leads back to the first byte.

#include "studio/document/document.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <set>

#include "check/conform/draw.h"
#include "etendue/language/language.h"
#include "files/whole_file.h"
#include "language/writer.h"
#include "studio/document/text_editor.h"

namespace etendue::studio {
namespace {

std::string text_of(const Value& value, const Member& member) {
  return language::Writer(false, {}).value(value, &member, 0, 0);
}

class StudioDocument : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = testing::TempDir() + "studio_document";
    std::filesystem::create_directories(folder_);
    folders_.allow(folder_);
    folders_.allow(fixtures_.folder());
  }
  std::string write(const std::string& name, const std::string& text) {
    write_whole_file(folder_ + "/" + name, text);
    return folder_ + "/" + name;
  }
  Document document() { return Document(RenderSettings{.threads = 1}, folders_); }

  conform::Fixtures fixtures_;
  Folders folders_;
  std::string folder_;
};

constexpr const char* scene = R"(# A comment, é.
param radius = 20 cm   # used twice
white = Lambertian { color: 0.7 }  # a wall
lamp  = DiffuseEmission { radiance: 3 * illuminant("D65") }

Job {
    renderer: PathTracer { samples: 2, max_depth: 3 }  # short
    camera:   PerspectiveCamera { from: [0, 1, -5], to: [0, 0.5, 0] }
    image:    ImageBuffer { width: 24, height: 16 }
    scene: BvhScene { objects: [
        # what stands there
        Sphere { centre: [0, radius, 0], radius: radius, shader: white }   # the ball
        Sphere { centre: [1, 0.5, 0], radius: radius * 2, shader: Lambertian { color: rgb(0.2, 0.4, 0.8) } }
        Rectangle { corner: [-3, 0, -3], edge_u: [6, 0, 0], edge_v: [0, 0, 6], shader: white }
        Rectangle { corner: [-1, 3, -1], edge_u: [2, 0, 0], edge_v: [0, 0, 2], emission: lamp } # shines
    ] }
}
)";

/// The description of a text in a normal form.
std::string meaning(const std::string& text, const std::string& folder) {
  return write_description(*load_job_text(text, "fresh", folder));
}

/// One random edit as a user would make it: of a member, or of the structure of parts.
void edit_at_random(Document& document, const conform::Fixtures& fixtures, std::mt19937_64& random) {
  const auto below = [&](size_t n) { return size_t(random() % n); };
  TextEditor editor(document);
  const auto& parts = document.components();
  const Ref<Component>& part = parts[below(parts.size())];
  const ClassInfo& info = part->class_info();
  if (info.members.empty()) return;
  const Member& member = info.members[below(info.members.size())];
  // A picture 65536 pixels wide is valid, but useless here.
  if (info.name == "ImageBuffer" || info.name == "Job" || member.kind == Kind::file) {
    editor.rename(editor.name_of(parts[below(parts.size())]), "name_" + std::to_string(random() % 1000));
  } else if (const size_t what = below(8); what == 0) {
    editor.reset(slot(part, member.name));
  } else if (what == 1 && member.list && member.kind == Kind::component) {
    editor.remove(slot(part, member.name, 0));
  } else if (what == 2 && member.list && member.kind == Kind::component) {
    editor.add(slot(part, member.name), 0, editor.written(slot(part, member.name, 0)));
  } else if (what == 3 && member.kind == Kind::component && !member.list) {
    editor.set(slot(part, member.name), editor.name_of(parts[below(parts.size())]));
  } else {
    editor.set(slot(part, member.name), text_of(conform::draw_value(info, member, fixtures, random), member));
  }
  static_cast<void>(document.apply(editor.text(), {"edit", ""}));
}

TEST_F(StudioDocument, UndoOf500RandomEditsReturnsToTheFirstBytes) {
  Document d = document();
  d.open(write("scene.etd", scene));
  ASSERT_TRUE(d.valid());
  std::mt19937_64 random(17);
  int refused = 0;
  while (d.undo_count() < 500) {
    const std::string before = d.text();
    try {
      edit_at_random(d, fixtures_, random);
    } catch (const std::exception&) {  // Error and Errors: a random value need not be valid
      ASSERT_EQ(d.text(), before) << "a refused edit changes nothing";
      ASSERT_LT(++refused, 20000);
    }
    if (d.undo_count() % 25 == 0) {
      ASSERT_EQ(write_description(d.job()), meaning(d.text(), folder_)) << "the job is what its text says";
    }
  }
  const std::string last = d.text();
  while (d.undo_count() > 0) d.undo();
  EXPECT_EQ(d.text(), scene);
  EXPECT_EQ(write_description(d.job()), meaning(scene, folder_));
  while (d.redo_count() > 0) d.redo();
  EXPECT_EQ(d.text(), last);
  EXPECT_EQ(write_description(d.job()), meaning(last, folder_));
}

TEST_F(StudioDocument, PictureAfterEditsIsThatOfAFreshRender) {
  Document d = document();
  d.open(write("scene.etd", scene));
  ASSERT_TRUE(d.valid());
  d.render()->run();
  std::mt19937_64 random(5);
  for (size_t made = 0; made < 30; made = d.undo_count()) {
    try {
      edit_at_random(d, fixtures_, random);
    } catch (const std::exception&) {
    }
  }
  TextEditor editor(d);
  editor.set(slot(Ref<Component>(const_cast<Job*>(&d.job())), "renderer"), "PathTracer { samples: 2 }");
  static_cast<void>(d.apply(editor.text(), {"renderer", ""}));
  d.render()->restart();
  d.render()->run();
  Render fresh(load_job_text(d.text(), "fresh", folder_), {.threads = 1});
  fresh.run();
  EXPECT_EQ(d.render()->picture().values, fresh.picture().values);
}

TEST_F(StudioDocument, KeepsPartsThatAnEditDoesNotConcern) {
  Document d = document();
  d.open(write("scene.etd", scene));
  ASSERT_TRUE(d.valid());
  const int camera = d.id_of(*d.job().camera), ball = d.id_of(*d.job().scene->objects[1]);
  const Render* render = d.render().get();
  TextEditor editor(d);
  editor.remove(slot(d.component(d.id_of(*d.job().scene)), "objects", 0));
  const Applied applied = d.apply(editor.text(), {"remove", ""});
  EXPECT_TRUE(applied.structure);
  EXPECT_EQ(d.job().scene->objects.size(), 3u);
  EXPECT_EQ(d.id_of(*d.job().camera), camera);
  EXPECT_EQ(d.id_of(*d.job().scene->objects[0]), ball) << "the second ball is the first now, and is known again";
  EXPECT_EQ(d.render().get(), render) << "nothing is begun from nothing";
  EXPECT_NE(d.text().find("# what stands there"), std::string::npos);
  EXPECT_NE(d.text().find("# the ball"), std::string::npos) << "comments are nobody's to take away";
}

TEST_F(StudioDocument, SharesAndUnshares) {
  Document d = document();
  d.open(write("scene.etd", scene));
  ASSERT_TRUE(d.valid());
  const auto object = [&](size_t i) { return Ref<Component>(d.job().scene->objects[i].get()); };
  TextEditor share(d);
  share.set(slot(object(0), "shader"), share.name_of(Ref<Component>(d.job().scene->objects[1]->shader.get())));
  static_cast<void>(d.apply(share.text(), {"share", ""}));
  EXPECT_EQ(d.job().scene->objects[0]->shader.get(), d.job().scene->objects[1]->shader.get());
  EXPECT_NE(d.text().find("lambertian = Lambertian { color: rgb(0.2, 0.4, 0.8) }"), std::string::npos) << d.text();
  TextEditor unshare(d);
  const Slot s = slot(object(0), "shader");
  ASSERT_EQ(unshare.name_in(s), "lambertian");
  unshare.set(s, unshare.written_out(*d.job().scene->objects[0]->shader));
  static_cast<void>(d.apply(unshare.text(), {"unshare", ""}));
  EXPECT_NE(d.job().scene->objects[0]->shader.get(), d.job().scene->objects[1]->shader.get());
}

TEST_F(StudioDocument, WritesDefaultsAndLiteralsWhereTheyAreUsed) {
  Document d = document();
  d.open(write("scene.etd", scene));
  ASSERT_TRUE(d.valid());
  TextEditor editor(d);
  editor.set(slot(Ref<Component>(d.job().tone_map.get()), "color_space"), "\"rec2020\"");
  editor.set(slot(Ref<Component>(d.job().tone_map.get()), "transfer"), "\"linear\"");
  static_cast<void>(d.apply(editor.text(), {"edit", ""}));
  EXPECT_NE(d.text().find("tone_map: AgXToneMap { color_space: \"rec2020\", transfer: \"linear\" }"), std::string::npos)
      << d.text();
  Ref<Component> map;
  for (const Ref<Component>& part : d.components())
    if (part->class_info().name == "ConstantMap") map = part;
  ASSERT_TRUE(map);
  TextEditor literal(d);
  literal.set(slot(map, "value"), "0.25");
  static_cast<void>(d.apply(literal.text(), {"edit", ""}));
  EXPECT_NE(d.text().find("0.25 }"), std::string::npos) << d.text();
}

TEST_F(StudioDocument, ReplacesClassesAndKeepsMembersThatFit) {
  Document d = document();
  d.open(write("scene.etd", scene));
  ASSERT_TRUE(d.valid());
  TextEditor editor(d);
  editor.replace_class(Ref<Component>(d.job().renderer.get()), *Registry::instance().find("BidirectionalPathTracer"));
  static_cast<void>(d.apply(editor.text(), {"replace", ""}));
  EXPECT_NE(d.text().find("renderer: BidirectionalPathTracer { samples: 2, max_depth: 3 }  # short"), std::string::npos)
      << d.text();
}

TEST_F(StudioDocument, RefusesFilesOutsideOfItsFolders) {
  Document d = document();
  d.open(write("scene.etd", scene));
  ASSERT_TRUE(d.valid());
  const std::string before = d.text();
  const auto with = [&](const std::string& text) { return d.apply(text, {"type", ""}); };
  EXPECT_ANY_THROW(with("include \"/etc/passwd\"\n" + before));
  EXPECT_ANY_THROW(with("plugin \"/usr/lib/evil.so\"\n" + before));
  EXPECT_ANY_THROW(with("f = \"/etc/passwd\"\nc = spectrum(f)\n" + before));
  std::string output = before;
  output.insert(output.find("    image:"), "    outputs: [ PngOutput { file: \"../../out.png\" } ]\n");
  EXPECT_ANY_THROW(with(output));
  std::filesystem::remove(folder_ + "/link");
  std::filesystem::create_directory_symlink("/etc", folder_ + "/link");
  std::string link = before;
  link.insert(link.find("    image:"), "    outputs: [ PngOutput { file: \"link/out.png\" } ]\n");
  EXPECT_ANY_THROW(with(link));
  EXPECT_EQ(d.text(), before);
  std::string inside = before;
  inside.insert(inside.find("    image:"), "    outputs: [ PngOutput { file: \"out.png\" } ]\n");
  EXPECT_NO_THROW(with(inside));
}

TEST_F(StudioDocument, OpensWhatIsWrongAsADraft) {
  Document d = document();
  d.open(write("wrong.etd", "Job { camera: Camra {} }\n"));
  EXPECT_FALSE(d.valid());
  ASSERT_TRUE(d.draft());
  EXPECT_EQ(d.draft()->text, "Job { camera: Camra {} }\n");
  EXPECT_FALSE(d.draft()->errors.empty());
  static_cast<void>(d.apply(scene, {"type", ""}));
  EXPECT_TRUE(d.valid());
  EXPECT_FALSE(d.draft());
}

// ---- every class ------------------------------------------------------------------------------------------------------------

/// A description that contains a part of a class within parts that may hold it; "" if none is found.
std::string host(const ClassInfo& info, const std::string& text, const conform::Fixtures& fixtures, int depth) {
  const auto takes = [&](const Member& member) {
    const ClassInfo* wanted = member.kind == Kind::component ? Registry::instance().find(member.component_class) : nullptr;
    return wanted && info.is_a(*wanted);
  };
  const auto in_member = [](const Member& m, const std::string& t) { return m.name + ": " + (m.list ? "[" + t + "]" : t); };
  const ClassInfo& job = *Registry::instance().find("Job");
  if (&info == &job) return text;
  for (const Member& member : job.members) {
    if (!takes(member)) continue;
    std::string members = in_member(member, text);
    if (member.name != "camera") members += "\ncamera: PerspectiveCamera {}";
    if (member.name != "scene") members += "\nscene: BvhScene { objects: [] }";
    if (member.name != "image") members += "\nimage: ImageBuffer { width: 8, height: 8 }";
    return "Job {\n" + members + "\n}\n";
  }
  if (depth == 0) return {};
  std::mt19937_64 random(1);
  for (const ClassInfo* holder : Registry::instance().all()) {
    if (holder->abstract() || holder == &job || !holder->provider.empty()) continue;
    for (const Member& member : holder->members) {
      if (!takes(member)) continue;
      const conform::Drawn drawn = conform::default_part(*holder, fixtures, random);
      if (!drawn.part) continue;
      std::string written = text_of(Value(drawn.part), *job.find("scene"));
      const Outline outline("x = " + written, intern("host"));
      if (!outline.definition("x")) continue;
      written =
          with_member(outline, outline.definition("x")->value, member.name, member.list ? "[" + text + "]" : text).substr(4);
      const std::string whole = host(*holder, written, fixtures, depth - 1);
      if (whole.empty()) continue;
      try {
        Render tried(load_job_text(whole, "host"), {.threads = 1});
        return whole;
      } catch (const std::exception&) {  // another holder is tried
      }
    }
  }
  return {};
}

TEST_F(StudioDocument, EveryMemberOfEveryClassIsEditedSavedAndReloadedEqual) {
  std::mt19937_64 random(3);
  const std::set<std::string> of_tests{"Balloon",       "Gadget",       "Lamp",  "LanguageConstant",
                                       "LanguageNeedy", "LanguagePart", "Widget"};
  std::vector<std::string> homeless;
  int classes = 0, members = 0, refused = 0;
  for (const ClassInfo* info : Registry::instance().all()) {
    if (info->abstract() || !info->provider.empty()) continue;
    const auto is_a = [&](const char* interface) { return info->is_a(*Registry::instance().find(interface)); };
    if (is_a("Importer") || is_a("Exporter")) continue;  // scenes cannot contain one
    conform::Drawn drawn = conform::default_part(*info, fixtures_, random);
    for (int tries = 0; !drawn.part && tries < 4; ++tries) drawn = conform::default_part(*info, fixtures_, random);
    std::string text =
        drawn.part ? text_of(Value(drawn.part), *Registry::instance().find("Job")->find("scene")) : info->name + " {}";
    if (!text.starts_with(info->name)) text = info->name + " {}";  // instead of the plain value that stands for it
    const std::string whole = info->name == "Job" ? std::string(scene) : host(*info, text, fixtures_, 3);
    if (whole.empty()) {
      // Other tests in this program register classes that no part can hold.
      if (!of_tests.contains(info->name)) homeless.push_back(text + " " + drawn.refused);
      continue;
    }
    SCOPED_TRACE(info->name);
    Document d = document();
    d.open(write("class.etd", whole));
    ASSERT_TRUE(d.valid()) << whole << (d.draft() ? show(d.draft()->errors.front()) : "");
    ++classes;
    int id = 0;
    for (const Ref<Component>& part : d.components())
      if (id == 0 && &part->class_info() == info) id = d.id_of(*part);
    ASSERT_NE(id, 0);
    for (const Member& member : info->members) {
      if ((info->name == "ImageBuffer" && (member.name == "width" || member.name == "height" || member.name == "crop")))
        continue;
      ++members;
      bool made = false;
      for (int tries = 0; tries < 8 && !made; ++tries) {
        try {
          TextEditor editor(d);
          const Value value = member.kind == Kind::file ? Value(FilePath{fixtures_.file_for(*info, member), ""})
                                                        : conform::draw_value(*info, member, fixtures_, random);
          editor.set(slot(d.component(id), member.name), text_of(value, member));
          static_cast<void>(d.apply(editor.text(), {"edit", ""}));
          made = true;
        } catch (const std::exception&) {
        }
      }
      refused += !made;
      ASSERT_EQ(write_description(d.job()), meaning(d.text(), folder_)) << member.name;
      // The part keeps its id through all edits of its members.
      ASSERT_NO_THROW(d.component(id)) << member.name;
    }
    d.save(folder_ + "/saved.etd");
    Document again = document();
    again.open(folder_ + "/saved.etd");
    ASSERT_TRUE(again.valid());
    ASSERT_EQ(write_description(again.job()), write_description(d.job()));
    while (d.undo_count() > 0) d.undo();
    ASSERT_EQ(d.text(), whole);
  }
  std::printf("%d classes, %d members, of %d no valid value was drawn; without a place: %zu\n", classes, members, refused,
              homeless.size());
  for (const std::string& name : homeless) std::printf("  %s\n", name.c_str());
  EXPECT_LT(double(refused), 0.1 * members);
  EXPECT_TRUE(homeless.empty());
}

// A shader that is saved is compiled again, and its faults are those of the line that names it.
TEST_F(StudioDocument, FollowsTheFilesOfShaders) {
  write("followed.osl", "surface followed(float k = 0.25) { Ci = k * diffuse(N); }");
  const std::string text = "plugin \"followed.osl\"\n" +
                           std::string(scene).replace(std::string(scene).find("shader: white }"), 15, "shader: Followed {} }");
  Document d = document();
  d.open(write("followed.etd", text));
  ASSERT_TRUE(d.valid());
  write("followed.osl", "surface followed(float k = 0.25, float added = 1) { Ci = k * added * diffuse(N); }");
  EXPECT_TRUE(d.apply(d.text(), {}).structure);
  const auto is_it = [](const Ref<Component>& part) { return part->class_info().name == "Followed"; };
  const auto found = std::ranges::find_if(d.components(), is_it);
  ASSERT_NE(found, d.components().end());
  EXPECT_TRUE((*found)->class_info().find("added"));
  EXPECT_EQ(d.undo_count(), 0u);
  write("followed.osl", "surface followed() { Ci = nothing(N); }");
  try {
    d.apply(d.text(), {});
    FAIL();
  } catch (const Errors& e) {
    ASSERT_FALSE(e.errors.empty());
    EXPECT_EQ(e.errors.front().location.line, 1);
    EXPECT_NE(std::string(e.errors.front().what()).find("followed.osl:1:"), std::string::npos);
  }
  write("followed.osl", "surface followed() { Ci = 0.5 * diffuse(N); }");
  d.apply(d.text(), {});
  EXPECT_TRUE(d.valid());
}

}  // namespace
}  // namespace etendue::studio
