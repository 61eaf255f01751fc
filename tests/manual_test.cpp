// docs/manual is generated from the classes' descriptions and kept beside them, so it must not go stale.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>

#include "process.h"

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

}  // namespace
}  // namespace etendue
