// The scene of docs/nested-glass.md: two algorithms that share little code agree, and the page shows parts of the scene's file.

#include <gtest/gtest.h>

#include "support/process.h"

namespace etendue {
namespace {

TEST(GlassOfWater, PathsFromOneEndAndFromBothAgree) {
  const TemporaryFolder folder;
  Process verify(ETENDUE_BINARY_DIR "/etendue",
                 {"verify", ETENDUE_SOURCE_DIR "/scenes/glass_of_water.etd", "--renderers",
                  "PathTracer,BidirectionalPathTracer", "--size", "32x32", "--samples", "128"},
                 folder);
  EXPECT_EQ(verify.wait(), 0) << verify.out() << verify.err();
}

TEST(GlassOfWater, ThePageShowsTheScene) {
  const std::string scene = file_text(ETENDUE_SOURCE_DIR "/scenes/glass_of_water.etd");
  const std::string page = file_text(ETENDUE_SOURCE_DIR "/docs/nested-glass.md");
  size_t shown = 0;
  for (size_t begin = page.find("```etd\n"); begin != std::string::npos; begin = page.find("```etd\n", begin + 1), ++shown) {
    const size_t from = begin + 7, end = page.find("```", from);
    const std::string listing = page.substr(from, end - from);
    EXPECT_NE(scene.find(listing), std::string::npos) << listing;
  }
  EXPECT_EQ(shown, 3u);
}

}  // namespace
}  // namespace etendue
