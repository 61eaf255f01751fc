// OpenImageIO is loaded when an image file is read or written, and not before.

#include "images/image_library.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "etendue/core/error.h"
#include "support/process.h"

namespace etendue {
namespace {

constexpr const char* scene = R"(Job { camera: PerspectiveCamera { from: [0, 0, -4], to: [0, 0, 0] }
  image: ImageBuffer { width: 4, height: 4 }, outputs: [ PngOutput {} ]
  scene: BruteForceScene { objects: [ Sphere {}, Environment { emission: DiffuseEmission { sides: both } } ] } })";
const std::string program = ETENDUE_BINARY_DIR "/etendue";

/// Whether the program, with these arguments, loads OpenImageIO.
bool loads(const TemporaryFolder& folder, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"LD_DEBUG=files", program});
  Process process("/usr/bin/env", arguments, folder);
  EXPECT_EQ(process.wait(), 0) << arguments[2];
  const std::string said = process.err();
  EXPECT_NE(said.find("libetendue"), std::string::npos);
  return said.find("libOpenImageIO") != std::string::npos;
}

TEST(ImageLibrary, IsLoadedForImageFilesAlone) {
  const TemporaryFolder folder;
  folder.write("a.etd", scene);
  EXPECT_FALSE(loads(folder, {"--help"}));
  EXPECT_FALSE(loads(folder, {"classes"}));
  EXPECT_FALSE(loads(folder, {"check", "a.etd"}));
  EXPECT_FALSE(loads(folder, {"render", "a.etd", "--samples", "1", "-o", "a.npy"}));
  EXPECT_FALSE(loads(folder, {"image", "info", "a.npy"}));
  EXPECT_TRUE(loads(folder, {"render", "a.etd", "--samples", "1", "-o", "a.png"}));
  EXPECT_TRUE(loads(folder, {"image", "info", "a.png"}));
}

TEST(ImageLibrary, IsMissedBeforeRendering) {
  // The program's own library in a folder without the library for image files.
  const TemporaryFolder folder, other;
  folder.write("a.etd", scene);
  for (const auto& entry : std::filesystem::directory_iterator(ETENDUE_BINARY_DIR))
    if (const std::string name = entry.path().filename().string();
        name.starts_with("libetendue.so.") || name == "libetendue_commands.so")
      std::filesystem::copy_file(entry.path(), other / entry.path().filename());
  const auto run = [&](std::vector<std::string> arguments, int status) {
    arguments.insert(arguments.begin(), {"LD_LIBRARY_PATH=" + other.path(), program});
    Process process("/usr/bin/env", arguments, folder);
    EXPECT_EQ(process.wait(), status) << process.err();
    return process.err();
  };
  run({"--help"}, 0);
  run({"render", "a.etd", "--samples", "1", "-o", "a.npy", "--quiet"}, 0);
  std::string said = run({"render", "a.etd", "--samples", "1000000000", "--time", "20s", "--quiet"}, 2);
  EXPECT_NE(said.find("a.etd:2"), std::string::npos) << said;
  EXPECT_NE(said.find("libetendue_openimageio.so"), std::string::npos) << said;
  folder.write("a.png", "no picture");
  said = run({"image", "info", "a.png"}, 2);
  EXPECT_NE(said.find("cannot read 'a.png': the library for image files cannot be loaded"), std::string::npos) << said;

  // Any other library of that name is loaded without error, but does not report this version.
  std::filesystem::copy_file(ETENDUE_CONFORM_FAULTS_LIBRARY, other / "libetendue_openimageio.so");
  said = run({"image", "info", "a.png"}, 2);
  EXPECT_NE(said.find("not of this version"), std::string::npos) << said;
}

TEST(ImageLibrary, IsOneForAllThreads) {
  std::set<const ImageLibrary*> seen;
  std::mutex mutex;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      const ImageLibrary* const library = &image_library();
      const std::lock_guard lock(mutex);
      seen.insert(library);
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(seen.size(), 1u);
}

TEST(ImageLibrary, RefusesPixelsThatDoNotFit) {
  const std::vector<float> five(5);
  EXPECT_THROW(image_library().encode(".exr", {2, 2, 1, NumberType::single}, five), Error);
  EXPECT_THROW(image_library().encode(".exr", {2, 2, std::vector<ImageHeader::Channel>{}}, {}), Error);
  EXPECT_THROW(image_library().encode(".nothing", {5, 1, 1, NumberType::single}, five), Error);
}

}  // namespace
}  // namespace etendue
