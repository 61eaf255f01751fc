// docs/manual is generated from the classes' descriptions and kept beside them, so it must not go stale.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "support/process.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

std::map<std::string, std::string> texts_in(const fs::path& folder) {
  std::map<std::string, std::string> texts;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (!entry.is_regular_file()) continue;
    std::ifstream file(entry.path());
    texts[entry.path().lexically_relative(folder).string()] = std::string(std::istreambuf_iterator<char>(file), {});
  }
  return texts;
}

TEST(Manual, IsWhatTheProgramGenerates) {
  const TemporaryFolder folder;
  const fs::path generated = fs::path(folder.path()) / "manual";
  // The existing pictures are copied, because pages show only pictures that exist.
  fs::create_directories(generated);
  if (fs::exists(ETENDUE_SOURCE_DIR "/docs/manual/pictures"))
    fs::copy(ETENDUE_SOURCE_DIR "/docs/manual/pictures", generated / "pictures", fs::copy_options::recursive);
  Process process(ETENDUE_BINARY_DIR "/etendue", {"manual", "-o", generated.string()}, folder);
  ASSERT_EQ(process.wait(), 0) << process.err();
  const auto expected = texts_in(generated), kept = texts_in(ETENDUE_SOURCE_DIR "/docs/manual");
  for (const auto& [name, text] : expected) {
    const auto found = kept.find(name);
    EXPECT_TRUE(found != kept.end() && found->second == text)
        << "docs/manual/" << name << " is stale; run: ./etendue manual -o docs/manual";
  }
  EXPECT_EQ(kept.size(), expected.size()) << "docs/manual holds pages of classes that are gone";
}

// With one sample per pixel, to check that there is a scene for each class and that it renders.
TEST(Manual, EveryClassThatCanBeSeenHasAPicture) {
  const TemporaryFolder folder;
  const fs::path generated = fs::path(folder.path()) / "manual";
  Process process(ETENDUE_BINARY_DIR "/etendue", {"manual", "-o", generated.string(), "--pictures", "--samples", "1"}, folder);
  ASSERT_EQ(process.wait(), 0) << process.err();
  const auto texts = texts_in(generated);
  for (const char* name :
       {"Plastic", "MarbleMap", "SpotEmission", "Torus", "PathTracer", "HomogeneousVolume", "PerspectiveCamera"}) {
    EXPECT_TRUE(texts.contains(std::string("pictures/") + name + ".png")) << name;
    EXPECT_NE(texts.at(std::string(name) + ".md").find("](pictures/"), std::string::npos) << name;
  }
  EXPECT_NE(texts.at("Pictures.md").find("[Torus]"), std::string::npos);
  // The pictures in the repository are of the same classes.
  for (const auto& [name, text] : texts)
    if (name.starts_with("pictures/"))
      EXPECT_TRUE(fs::exists(fs::path(ETENDUE_SOURCE_DIR "/docs/manual") / name))
          << name << " is missing; run: ./etendue manual -o docs/manual --missing";
  // --missing does not render existing pictures again.
  fs::remove(generated / "pictures/Torus.png");
  const auto sphere = fs::last_write_time(generated / "pictures/Sphere.png");
  Process again(ETENDUE_BINARY_DIR "/etendue", {"manual", "-o", generated.string(), "--missing", "--samples", "1"}, folder);
  ASSERT_EQ(again.wait(), 0) << again.err();
  EXPECT_TRUE(fs::exists(generated / "pictures/Torus.png"));
  EXPECT_EQ(fs::last_write_time(generated / "pictures/Sphere.png"), sphere);
}

}  // namespace
}  // namespace etendue
