// Installs the package, builds plugins out of tree against it with one CMake call, and renders with them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "etendue/describe/registry.h"
#include "etendue/film/image_tools.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

int run(const std::string& command, std::string* output = nullptr) {
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::string text;
  char buffer[4096];
  for (size_t n; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) text.append(buffer, n);
  const int status = pclose(pipe);
  if (output) *output = text;
  if (status != 0 && !output) ADD_FAILURE() << command << "\n" << text;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

class Plugin : public ::testing::Test {
 protected:
  fs::path folder = fs::temp_directory_path() / ("etendue-plugin-" + std::to_string(getpid()));
  void SetUp() override { fs::create_directories(folder); }
  void TearDown() override { fs::remove_all(folder); }
  /// Installs the package into the folder and builds an out-of-tree project against it.
  bool install_and_build(const std::string& target) const {
    const std::string f = folder.string();
    return run("cmake --install " ETENDUE_BINARY_DIR " --prefix " + f + "/installed") == 0 &&
           run("cmake -G Ninja -S " ETENDUE_SOURCE_DIR "/tests/plugin -B " + f + "/build -DCMAKE_PREFIX_PATH=" + f +
               "/installed && cmake --build " + f + "/build --target " + target) == 0;
  }
};

TEST_F(Plugin, BuildsOutOfTreeAndRenders) {
  const std::string f = folder.string();
  ASSERT_TRUE(install_and_build("all"));
  const std::string library = f + "/build/libgold.so";
  ASSERT_TRUE(fs::exists(library));

  // The file names the plugin by a path relative to itself.
  std::ofstream(f + "/gold.etd") << R"(plugin "build/libgold.so"
Job { camera: PerspectiveCamera { from: [0, 0, -4], to: [0, 0, 0] }, image: ImageBuffer { width: 16, height: 16 }
      scene: BruteForceScene { objects: [ Sphere { shader: GoldShader { purity: 0.9 } }, Environment { emission: DiffuseEmission { sides: both } } ] } })";
  const std::string program = f + "/installed/bin/etendue";
  std::string output;
  EXPECT_EQ(run(program + " render " + f + "/gold.etd --samples 16 --quiet -o " + f + "/gold.npy", &output), 0) << output;
  EXPECT_TRUE(fs::exists(f + "/gold.npy"));
  // Plugins are listed and checked wherever built-in parts are.
  EXPECT_EQ(run(program + " conform GoldShader --quick --plugin " + library, &output), 0) << output;
  EXPECT_EQ(run(program + " classes GoldShader --plugin " + library, &output), 0) << output;
  EXPECT_NE(output.find("purity"), std::string::npos) << output;
  EXPECT_EQ(run(program + " render " + f + "/gold.etd --set 'scene.objects[0].shader.purity=2'", &output), 2);
  EXPECT_NE(output.find("must be from 0 to 1"), std::string::npos) << output;

  // The textured shader evaluates its maps at the hit point: in a uniform environment a surface seen at 60 degrees reflects
  // color cos^darkness, here in squares of darkness 0 and 1.
  const std::string minnaert = f + "/build/libminnaert.so";
  EXPECT_EQ(run(program + " conform MinnaertShader --quick --plugin " + minnaert, &output), 0) << output;
  std::ofstream(f + "/squares.etd") << R"(plugin "build/libminnaert.so"
Job { camera: OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], width: 1 }, image: ImageBuffer { width: 2, height: 1, filter: BoxFilter {} }
      scene: BruteForceScene { objects: [
          Rectangle { corner: [-1, -4, 0], edge_u: [2, 0, 0], edge_v: [0, 8, 0], transform: rotate(60 deg, "x")
                      shader: MinnaertShader { color: 0.8, darkness: CheckerMap { first: 0, second: 1, repeat: [2, 1, 1] } } }
          Environment { emission: DiffuseEmission { sides: both } } ] } })";
  EXPECT_EQ(run(program + " render " + f + "/squares.etd --samples 1024 --quiet -o " + f + "/squares.npy", &output), 0)
      << output;
  const Image squares = read_image(f + "/squares.npy");
  const double lighter = std::max(squares.at(0, 0, 1), squares.at(1, 0, 1)),
               darker = std::min(squares.at(0, 0, 1), squares.at(1, 0, 1));
  EXPECT_NEAR(lighter, 0.8, 0.01);
  EXPECT_NEAR(darker, 0.4, 0.01);

  // The renderer of the manual's other page converges to the same picture as the built-in one.
  EXPECT_EQ(run(program + " verify " ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd -D fov=39.3077deg --plugin " + f +
                    "/build/libstudent_tracer.so --renderers PathTracer,StudentTracer --samples 512 --size 48x48 --quiet",
                &output),
            0)
      << output;

  // The photon mapper can be resumed and its parts merged to the same bytes, without a line of its own for that.
  const auto mapper_with = [&](int photons) {
    return program + " render " ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd --size 24x24 --quiet --plugin " + f +
           "/build/libsmall_photon_mapper.so --set 'renderer=SmallPhotonMapper { photons: " + std::to_string(photons) +
           " }' --samples ";
  };
  const std::string mapper = mapper_with(2000);
  const auto film = [&](const std::string& name) { return " -o " + f + "/" + name + ".npy"; };
  EXPECT_EQ(run(mapper + "6" + film("whole"), &output), 0) << output;
  EXPECT_EQ(run(mapper + "3 --checkpoint " + f + "/half" + film("half"), &output), 0) << output;
  EXPECT_EQ(run(mapper + "6 --resume " + f + "/half" + film("resumed"), &output), 0) << output;
  EXPECT_EQ(run("cmp " + f + "/whole.npy " + f + "/resumed.npy", &output), 0) << output;
  EXPECT_EQ(run(mapper + "6 --passes 0:2 --checkpoint " + f + "/a" + film("a"), &output), 0) << output;
  EXPECT_EQ(run(mapper + "6 --passes 2:6 --checkpoint " + f + "/b" + film("b"), &output), 0) << output;
  EXPECT_EQ(run(program + " image merge " + f + "/b " + f + "/a" + film("merged"), &output), 0) << output;
  EXPECT_EQ(run("cmp " + f + "/whole.npy " + f + "/merged.npy", &output), 0) << output;
  EXPECT_EQ(run(mapper + "6 --pixel 12,20 --sample 4", &output), 0) << output;
  // Killed repeatedly, until it finishes.
  const std::string longer = mapper_with(40000) + "12";
  EXPECT_EQ(run(longer + film("undisturbed"), &output), 0) << output;
  int kills = 0;
  for (const char* time : {"0.4", "0.5", "0.7", "0.9", "60"})
    kills +=
        run("timeout -s KILL " + std::string(time) + " " + longer + " --every 0s --continue " + f + "/killed" + film("killed"),
            &output) != 0;
  EXPECT_GE(kills, 2);
  EXPECT_EQ(run("cmp " + f + "/undisturbed.npy " + f + "/killed.npy", &output), 0) << output;
  // SmallMetropolis, which contains a path tracer, converges to the path tracer's picture. The view is that of the box's
  // photographs (the `fov` given): in the scene's own view, the short block's dark front fills tiles that so short a run of
  // chains reaches only about a dozen times, all within a few visits; the means of sixteen such passes are far from normally
  // distributed, as verify's test assumes (with 4096 samples per pixel they agree within 2 %).
  EXPECT_EQ(run(program + " verify " ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd -D fov=39.3077deg --plugin " + f +
                    "/build/libsmall_metropolis.so --renderers 'PathTracer,SmallMetropolis { inner: PathTracer "
                    "{}, bootstrap: 1024 }' --samples 256 --size 32x32 --quiet",
                &output),
            0)
      << output;
  // A mutation of a plugin works together with the built-in ones.
  EXPECT_EQ(run(program + " verify " ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd -D fov=39.3077deg --plugin " + f +
                    "/build/libturn_mutation.so --renderers 'PathTracer,PathSpaceMetropolis { mutations: [ TurnMutation {} ], "
                    "bootstrap: 0.5 }' --samples 256 --size 32x32 --quiet",
                &output),
            0)
      << output;
}

TEST_F(Plugin, AProgramDrivesARender) {
  const std::string f = folder.string();
  ASSERT_TRUE(install_and_build("drive_a_render"));
  std::ofstream(f + "/small.etd") << R"(Job { renderer: PathTracer { samples: 64 }, image: ImageBuffer { width: 16, height: 12 }
      camera: PerspectiveCamera { from: [0, 0, -4], to: [0, 0, 0] }, outputs: [ NpyOutput {} ]
      scene: BruteForceScene { objects: [ Sphere { shader: Lambertian {} }, Environment { emission: DiffuseEmission { sides: both } } ] } })";
  std::string output;
  EXPECT_EQ(run(f + "/build/drive_a_render " + f + "/small.etd " + f, &output), 0) << output;
  for (const char* said : {"16 x 12 pixels", "refused: ", "must be more than 0", "64 samples per pixel", "picture.npy"})
    EXPECT_NE(output.find(said), std::string::npos) << output;
  // The picture is the same as if the scene had been described that way from the start.
  EXPECT_EQ(
      run(f + "/installed/bin/etendue render " + f + "/small.etd --set camera.fov='35 deg' --quiet -o " + f + "/straight.npy",
          &output),
      0)
      << output;
  EXPECT_EQ(read_image(f + "/picture.npy").values, read_image(f + "/straight.npy").values);
}

TEST(PluginPage, ShowsExactlyWhatIsBuilt) {
  const auto text = [](const char* path) {
    std::ifstream file(path);
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  const auto check = [&](const char* source, const char* page, int lines) {
    const std::string listing = text(source);
    EXPECT_NE(text(page).find("```cpp\n" + listing + "```"), std::string::npos) << page;
    EXPECT_LT(std::count(listing.begin(), listing.end(), '\n'), lines) << source;
  };
  check(ETENDUE_SOURCE_DIR "/tests/plugin/gold.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-shader.md", 60);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/minnaert.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-textured-shader.md", 70);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/student_tracer.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-renderer.md", 60);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/small_photon_mapper.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-renderer.md", 190);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/small_metropolis.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-renderer.md", 160);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/turn_mutation.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-renderer.md", 50);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/drive_a_render.cpp", ETENDUE_SOURCE_DIR "/docs/drive-a-render.md", 70);
}

TEST_F(Plugin, RefusesWhatIsNone) {
  const std::string f = folder.string();
  std::ofstream(f + "/text.so") << "no library";
  EXPECT_THROW(Registry::instance().load_plugin(f + "/text.so"), Error);
  EXPECT_THROW(Registry::instance().load_plugin(f + "/missing.so"), Error);
  // A library built for other interfaces is refused before anything in it is adopted.
  std::ofstream(f + "/old.cpp") << "extern \"C\" const char* etendue_plugin_abi() { return \"interfaces 0\"; }";
  ASSERT_EQ(run("c++ -shared -fPIC " + f + "/old.cpp -o " + f + "/old.so"), 0);
  try {
    Registry::instance().load_plugin(f + "/old.so");
    ADD_FAILURE() << "was adopted";
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("build it again"), std::string::npos) << e.what();
  }
  std::ofstream(f + "/none.cpp") << "int x;";
  ASSERT_EQ(run("c++ -shared -fPIC " + f + "/none.cpp -o " + f + "/none.so"), 0);
  EXPECT_THROW(Registry::instance().load_plugin(f + "/none.so"), Error);
}

}  // namespace
}  // namespace etendue
