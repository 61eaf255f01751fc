// The temporary folder of a process that does not see a scene's files, and the process that outlives one that is killed.

#include "render/team/scene_folder.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <thread>

#include "etendue/core/error.h"
#include "etendue/describe/value.h"
#include "files/sent_files.h"
#include "support/process.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

class SceneFolderTest : public testing::Test {
 protected:
  SceneFolderTest() {
    const char* const before = std::getenv("TMPDIR");
    before_ = before ? before : "";
    fs::create_directory(folder / "temporary");
    ::setenv("TMPDIR", (folder / "temporary").c_str(), 1);
  }
  ~SceneFolderTest() override {
    if (before_.empty())
      ::unsetenv("TMPDIR");
    else
      ::setenv("TMPDIR", before_.c_str(), 1);
    fs::current_path(here_);
  }
  /// As another machine would name it.
  SentFile sent(const std::string& path, const std::string& text) {
    const FileContent content = content_on_disk(folder.write("written", text));
    return {path, content.size, content.hash};
  }
  static void give(SceneFolder& to, const SentFile& file, const std::string& text) {
    SceneFolder::Arriving arriving(to, file);
    arriving.add(std::as_bytes(std::span(text)));
    arriving.finish();
  }
  size_t left() const { return size_t(std::distance(fs::directory_iterator(folder / "temporary"), fs::directory_iterator())); }

  TemporaryFolder folder;

 private:
  std::string before_;
  const fs::path here_ = fs::current_path();
};

TEST_F(SceneFolderTest, shows_files_at_their_paths_and_removes_them) {
  const SentFile a = sent("/far/away/scene/maps/../a.txt", "one"), b = sent("/far/away/b.txt", "two"),
                 c = sent("/far/away/scene/c.txt", "one");
  {
    SceneFolder scene;
    give(scene, a, "one");
    EXPECT_TRUE(scene.has(c));  // the same content
    give(scene, b, "two");
    scene.show({a, b, c}, "/far/away/scene");
    EXPECT_EQ(file_text("a.txt"), "one");
    EXPECT_EQ(file_text("maps/../c.txt"), "one");
    EXPECT_EQ(file_text("../b.txt"), "two");
    EXPECT_EQ(file_text(FilePath{"/far/away/b.txt", {}}.resolved()), "two");
    EXPECT_EQ(where_sent_from(where_sent("/far/away/b.txt")), "/far/away/b.txt");
    EXPECT_EQ(where_sent("/far/away/none.txt"), "/far/away/none.txt");
    EXPECT_EQ(fs::status(scene.path()).permissions(), fs::perms::owner_all);
    scene.show({b}, "/far/away");
    EXPECT_EQ(file_text("b.txt"), "two");
    EXPECT_FALSE(fs::exists("scene/a.txt"));
  }
  EXPECT_EQ(where_sent("/far/away/b.txt"), "/far/away/b.txt");
  EXPECT_EQ(left(), 0u);
}

TEST_F(SceneFolderTest, refuses_what_is_not_what_was_announced) {
  SceneFolder scene;
  EXPECT_THROW(give(scene, sent("/a.txt", "one"), "two"), Error);
  EXPECT_THROW(scene.require_room(std::uint64_t(1) << 60), Error);
  const SentFile out = sent("/../../a.txt", "one");
  give(scene, out, "one");
  EXPECT_THROW(scene.show({out}, "/"), Error);  // no path leads out of the folder
  EXPECT_FALSE(fs::exists(scene.path() + "/../a.txt"));
}

TEST_F(SceneFolderTest, takes_from_another_on_the_same_machine) {
  const SentFile a = sent("/a.txt", "one");
  SceneFolder first, second;
  give(first, a, "one");
  EXPECT_FALSE(second.has(a));
  EXPECT_TRUE(second.take_from(first.path(), a));
  EXPECT_TRUE(second.has(a));
  EXPECT_FALSE(second.take_from(folder / "nowhere", sent("/b.txt", "two")));
}

TEST_F(SceneFolderTest, is_removed_when_the_process_is_killed) {
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    const SceneFolder scene;
    ::raise(SIGKILL);
  }
  ::waitpid(child, nullptr, 0);
  for (int i = 0; i < 1000 && left() > 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_EQ(left(), 0u);
}

TEST_F(SceneFolderTest, removes_what_killed_processes_have_left) {
  fs::create_directory(folder / "temporary/etendue-scene-abc");
  folder.write("temporary/etendue-scene-abc/lock", "");
  const SceneFolder mine;
  EXPECT_EQ(left(), 1u);
  const SceneFolder other;  // leaves alone the one that is in use
  EXPECT_EQ(left(), 2u);
}

}  // namespace
}  // namespace etendue
