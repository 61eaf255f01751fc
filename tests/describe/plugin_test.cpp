// Installs the package, builds plugins out of tree against it with one CMake call, and renders with them.

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "etendue/core/math.h"
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

/// The mean of an image's luminance.
double mean(const Image& image) {
  double sum = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) sum += double(image.at(x, y, 1));
  return sum / image.width / image.height;
}

// The plugins of the pages write-an-object, -map, -emission, -camera, -volume, -tone-map and -importer: each passes `conform`
// and agrees with a closed form. `program` is the installed one, and `f` the folder with `build`.

/// The mean of a picture that the program renders of the description `name`.
double rendered_mean(const std::string& program, const std::string& f, const std::string& name, int samples,
                     const std::string& options = "") {
  std::string output;
  EXPECT_EQ(run(program + " render " + f + "/" + name + ".etd --samples " + std::to_string(samples) + " --quiet -o " + f + "/" +
                    name + ".npy " + options,
                &output),
            0)
      << output;
  return mean(read_image(f + "/" + name + ".npy"));
}

void check_object(const std::string& program, const std::string& f) {
  std::string output;
  // The shape. Parallel rays across its axis see 2 r h + pi r^2 of a capsule, here in a picture of 4 m^2. Its area is
  // 2 pi r (h + 2 r): a power of 470 nm times pi times that is a radiance of 1 between 360 and 830 nm. Inside a capsule that
  // emits 1, also one that an instance or its own transform stretches, a surface of albedo 0.8 has the radiance 0.8 by sampled
  // points alone. A capsule of glass in an environment of radiance 1 is invisible, also far from the origin.
  const std::string capsule = f + "/build/libcapsule.so";
  EXPECT_EQ(run(program + " conform Capsule --quick --plugin " + capsule, &output), 0) << output;
  std::ofstream(f + "/side.etd") << R"(plugin "build/libcapsule.so"
Job { camera: OrthographicCamera { from: [0, -5, 0], to: [0, 0, 0], up: [0, 0, 1], width: 2 }
      image: ImageBuffer { width: 32, height: 32, filter: BoxFilter {} }
      scene: BruteForceScene { objects: [
          Capsule { radius: 0.4, height: 0.9, emission: DiffuseEmission { power: 470 * pi * 2 * pi * 0.4 * 1.7 } } ] } })";
  EXPECT_NEAR(rendered_mean(program, f, "side", 64), (2 * 0.4 * 0.9 + M_PI * 0.16) / 4, 0.002);
  std::ofstream(f + "/inside.etd") << R"(plugin "build/libcapsule.so"
Job { camera: OrthographicCamera { from: [0, 0, 0.3], to: [0, 0, 0], up: [0, 1, 0], width: 0.2 }
      image: ImageBuffer { width: 4, height: 4, filter: BoxFilter {} }, renderer: SimplePathTracer {}
      scene: BruteForceScene { objects: [
          Rectangle { corner: [-0.1, -0.1, 0], edge_u: [0.2, 0, 0], edge_v: [0, 0.2, 0], shader: Lambertian { color: 0.8 } }
          Instance { transform: scale(2, 1, 1.5), scene: BruteForceScene { objects: [
              Capsule { emission: DiffuseEmission { sides: both } } ] } } ] } })";
  EXPECT_NEAR(rendered_mean(program, f, "inside", 1024), 0.8, 0.01);
  std::ofstream(f + "/glass.etd") << R"(plugin "build/libcapsule.so"
Job { camera: OrthographicCamera { from: [1e7, -5, 0], to: [1e7, 0, 0], up: [0, 0, 1], width: 2 }
      image: ImageBuffer { width: 8, height: 8, filter: BoxFilter {} }, renderer: PathTracer { max_depth: 60 }
      scene: BvhScene { objects: [
          Capsule { transform: translate(1e7, 0, 0) * rotate(30 deg, [1, 2, 3]), shader: Dielectric { ior: 1.5 } }
          Environment { emission: DiffuseEmission {} } ] } })";
  EXPECT_NEAR(rendered_mean(program, f, "glass", 64), 1, 0.001);
  std::ofstream(f + "/stretched.etd") << R"(plugin "build/libcapsule.so"
Job { camera: OrthographicCamera { from: [0, 0, 0.3], to: [0, 0, 0], up: [0, 1, 0], width: 0.2 }
      image: ImageBuffer { width: 4, height: 4, filter: BoxFilter {} }, renderer: SimplePathTracer {}
      scene: BruteForceScene { objects: [
          Rectangle { corner: [-0.1, -0.1, 0], edge_u: [0.2, 0, 0], edge_v: [0, 0.2, 0], shader: Lambertian { color: 0.8 } }
          Capsule { transform: scale(2, 1, 1.5), emission: DiffuseEmission { sides: both } } ] } })";
  EXPECT_NEAR(rendered_mean(program, f, "stretched", 1024), 0.8, 0.01);
}

void check_map(const std::string& program, const std::string& f) {
  std::string output;
  // The texture covers (1 - joint)^2 of the surface with tiles. A corner of this picture is the centre of one, and an eighth of
  // the width further is the middle of a border. A footprint wider than a tile shows the mean in each pixel.
  EXPECT_EQ(run(program + " conform HexagonMap --quick --plugin " + f + "/build/libhexagons.so", &output), 0) << output;
  std::ofstream(f + "/hexagons.etd") << R"(plugin "build/libhexagons.so"
Job { camera: OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], up: [0, 1, 0], width: 1 }
      image: ImageBuffer { width: 64, height: 64, filter: BoxFilter {} }
      scene: BruteForceScene { objects: [
          Rectangle { corner: [-0.5, -0.5, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0], emission: DiffuseEmission {
              radiance: HexagonMap { tile: 0.8, mortar: 0.2, joint: 0.25, repeat: [4, 4 * sqrt(3)] } } } ] } })";
  const double expected = 0.2 + 0.6 * 0.75 * 0.75;
  EXPECT_NEAR(rendered_mean(program, f, "hexagons", 64), expected, 0.003);
  const Image sharp = read_image(f + "/hexagons.npy");
  EXPECT_NEAR(double(sharp.at(0, 0, 1)), 0.8, 0.01);
  EXPECT_NEAR(double(sharp.at(8, 0, 1)), 0.2, 0.01);
  EXPECT_NEAR(rendered_mean(program, f, "hexagons", 16, "--set renderer.map_filter=32"), expected, 0.003);
  const Image filtered = read_image(f + "/hexagons.npy");
  EXPECT_NEAR(double(filtered.at(0, 0, 1)), expected, 0.01);
  EXPECT_NEAR(double(filtered.at(8, 0, 1)), expected, 0.01);
}

void check_emission(const std::string& program, const std::string& f) {
  std::string output;
  // An emission: through an orthographic camera a star's disc has the radiance 1 - a (1 - m), m = sqrt(1 - r^2), and the mean
  // 1 - a / 3; a square around the disc has pi / 4 of that. Light tracing samples its directions.
  const std::string star = f + "/build/liblimb_darkened.so";
  EXPECT_EQ(run(program + " conform LimbDarkenedEmission --quick --plugin " + star, &output), 0) << output;
  std::ofstream(f + "/star.etd") << R"(plugin "build/liblimb_darkened.so"
Job { camera: OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], width: 2 }, image: ImageBuffer { width: 40, height: 40, filter: BoxFilter {} }
      scene: BruteForceScene { objects: [ Sphere { emission: LimbDarkenedEmission {} } ] } })";
  EXPECT_EQ(run(program + " render " + f + "/star.etd --samples 64 --quiet -o " + f + "/star.npy", &output), 0) << output;
  const Image disc = read_image(f + "/star.npy");
  EXPECT_NEAR(mean(disc), 0.8 * 3.14159265 / 4, 0.002);
  EXPECT_NEAR(disc.at(31, 20, 1), 1 - 0.6 * (1 - std::sqrt(1 - 0.575 * 0.575 - 0.025 * 0.025)), 0.003);
  std::ofstream(f + "/starlight.etd") << R"(plugin "build/liblimb_darkened.so"
Job { renderer: PathTracer { max_depth: 3 }, camera: PerspectiveCamera { from: [0, -8, 5], to: [0, 0, 0.5], up: [0, 0, 1] }
      image: ImageBuffer { width: 24, height: 24, filter: BoxFilter {} }
      scene: BruteForceScene { objects: [ Sphere { centre: [0, 0, 1.5], emission: LimbDarkenedEmission { sides: both } }
          Rectangle { corner: [-3, -3, 0], edge_u: [6, 0, 0], edge_v: [0, 6, 0], shader: Lambertian { color: 0.6 } } ] } })";
  EXPECT_EQ(
      run(program + " verify " + f + "/starlight.etd --renderers PathTracer,LightTracer --samples 256 --size 24x24 --quiet",
          &output),
      0)
      << output;
}

void check_camera(const std::string& program, const std::string& f) {
  std::string output;
  // A camera: a ball on the axis, seen under 45 degrees on each side, fills a disc of half the radius of the picture's, both by
  // camera rays and by connections to the lens.
  const std::string fisheye = f + "/build/libfisheye.so";
  EXPECT_EQ(run(program + " conform FisheyeCamera --quick --plugin " + fisheye, &output), 0) << output;
  std::ofstream(f + "/ball.etd") << R"(plugin "build/libfisheye.so"
Job { camera: FisheyeCamera { to: [0, 0, 2] }, image: ImageBuffer { width: 32, height: 32, filter: BoxFilter {} }
      scene: BruteForceScene { objects: [ Sphere { centre: [0, 0, 2], radius: 1.41421356, emission: DiffuseEmission {} } ] } })";
  for (const std::string renderer : {"PathTracer", "LightTracer"}) {
    EXPECT_EQ(run(program + " render " + f + "/ball.etd --samples 256 --quiet --set 'renderer=" + renderer + " {}' -o " + f +
                      "/ball.npy",
                  &output),
              0)
        << output;
    EXPECT_NEAR(mean(read_image(f + "/ball.npy")), 3.14159265 / 16, 0.001) << renderer;
  }
  EXPECT_EQ(run(program + " verify " ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd --plugin " + fisheye +
                    " --set 'camera=FisheyeCamera { from: [278, 273, -200] mm, to: [278, 200, 280] mm, fov: 200 deg }'"
                    " --renderers PathTracer,LightTracer,BidirectionalPathTracer --samples 128 --size 16x12 --quiet",
                &output),
            0)
      << output;
}

void check_volume(const std::string& program, const std::string& f) {
  std::string output;
  // A medium: along a ray through the centre of a ball of radius 2 with a planet of radius 1, whose air only absorbs, the
  // optical depth is 2 a (H (1 - exp(-1 / H)) + 1).
  const std::string air = f + "/build/libatmosphere.so";
  EXPECT_EQ(run(program + " conform RayleighAtmosphere --quick --plugin " + air, &output), 0) << output;
  std::ofstream(f + "/air.etd") << R"(plugin "build/libatmosphere.so"
Job { camera: OrthographicCamera { from: [0, 0, 5], to: [0, 0, 0], width: 0.01 }, image: ImageBuffer { width: 1, height: 1, filter: BoxFilter {} }
      scene: BruteForceScene { objects: [
          Sphere { radius: 2, shader: PassThrough {}
                   interior: RayleighAtmosphere { scattering: 0, absorption: 0.5, scale_height: 0.5, radius: 1 } }
          Environment { emission: DiffuseEmission { sides: both } } ] } })";
  EXPECT_EQ(run(program + " render " + f + "/air.etd --samples 16384 --quiet -o " + f + "/air.npy", &output), 0) << output;
  EXPECT_NEAR(read_image(f + "/air.npy").at(0, 0, 1), std::exp(-(0.5 * (1 - std::exp(-2.0)) + 1)), 0.01);
}

void check_tone_map(const std::string& program, const std::string& f) {
  std::string output;
  // The neutral tone map: greys of 0.5 after 0, 2 and -4 stops lie on the three branches of its curve, and a bright colour
  // loses saturation as the formula says. With the space "xyz" a grey is R = G = B exactly.
  const std::string neutral = f + "/build/libneutral_tone_map.so";
  EXPECT_EQ(run(program + " conform NeutralToneMap --quick --plugin " + neutral, &output), 0) << output;
  const auto toned = [&](const std::string& color, const std::string& emission, const std::string& tone_map) {
    std::ofstream(f + "/toned.etd")
        << "plugin \"build/libneutral_tone_map.so\"\n"
           "Job { camera: OrthographicCamera { from: [0, 0, 9], to: [0, 0, 0], width: 1 }, image: "
           "ImageBuffer { width: 4, height: 4 }\n scene: BruteForceScene { objects: [ Sphere { shader: Lambertian "
           "{ color: "
        << color << " } }, Environment { emission: DiffuseEmission { radiance: " << emission
        << ", sides: both } } ] }\n outputs: [NpyOutput { tone_map: NeutralToneMap { exposure: fixed, " << tone_map
        << " } }] }";
    EXPECT_EQ(run(program + " render " + f + "/toned.etd --samples 1024 --quiet -o " + f + "/toned.npy", &output), 0) << output;
    return read_image(f + "/toned.npy");
  };
  for (const auto& [stops, shown] :
       {std::pair{"0", 0.5 - 0.04}, {"2", 1 - 0.0576 / (1.96 + 0.24 - 0.76)}, {"-4", 0.03125 * 0.03125 / 0.16}}) {
    const Image grey = toned("0.5", "1", std::string("color_space: \"xyz\", transfer: \"linear\", stops: ") + stops);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(grey.at(1, 2, c), shown, 0.01 * shown) << stops;
  }
  // (2, 1, 0.5) loses 0.04, its peak 1.96 becomes q = 0.96, and the weight of grey is 1 - 1 / (0.15 (1.96 - 0.96) + 1).
  const Image bright = convert_color_space(toned("1", "rgb(2, 1, 0.5)", "transfer: \"linear\""), "srgb");
  const double q = 0.96, mixed = 0.15 / 1.15;
  const double less[] = {1.96, 0.96, 0.46};
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(bright.at(1, 2, c), less[c] * (q / 1.96) * (1 - mixed) + q * mixed, 0.003) << c;
  EXPECT_EQ(run(program + " render " + f + "/toned.etd --set 'outputs[0].tone_map.start=0.05'", &output), 2);
  EXPECT_NE(output.find("at least twice the reflectance"), std::string::npos) << output;
}

void check_importer(const std::string& program, const std::string& f) {
  std::string output;
  // The importer: a carbon atom covers pi 1.7^2 of the film's 64 m^2 and reflects the linear value of its sRGB grey 0x90; the
  // rest of the film sees a radiance of 1.
  const std::string importer = f + "/build/libxyz_importer.so", of_plugin = " --quiet --plugin " + importer;
  EXPECT_EQ(run(program + " conform XyzImporter --quick --plugin " + importer, &output), 0) << output;
  std::ofstream(f + "/atom.xyz") << "1\none atom\nC 1 0 0\n";
  std::ofstream(f + "/atom.etd") << R"(plugin "build/libxyz_importer.so"
Job { camera: OrthographicCamera { from: [1, 0, 9], to: [1, 0, 0], width: 8 }, image: ImageBuffer { width: 16, height: 16 }
      scene: BruteForceScene { objects: [ Import { file: "atom.xyz" }, Environment { emission: DiffuseEmission { sides: both } } ] } })";
  EXPECT_EQ(run(program + " render " + f + "/atom.etd --samples 256 --quiet -o " + f + "/atom.npy", &output), 0) << output;
  const Image atom = read_image(f + "/atom.npy");
  const double seen = mean(atom);
  const double reflected = std::pow((0x90 / 255.0 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(seen, 1 - pi * 1.7 * 1.7 / 64 * (1 - reflected), 0.002);
  // The same molecule, compressed.
  gzFile packed = gzopen((f + "/atom.xyz.gz").c_str(), "wb");
  EXPECT_GT(gzputs(packed, "1\none atom\nC 1 0 0\n"), 0);
  gzclose(packed);
  for (const std::string name : {"atom.xyz", "atom.xyz.gz"})
    EXPECT_EQ(run(program + " render " + f + "/" + name + " --size 16x16 --samples 1 -o " + f + "/" + name + ".npy" + of_plugin,
                  &output),
              0)
        << output;
  EXPECT_EQ(read_image(f + "/atom.xyz.npy").values, read_image(f + "/atom.xyz.gz.npy").values);
  // A file of its ending is rendered by itself, what was added and left out is told, and errors have their place.
  std::ofstream(f + "/two.xyz") << "1\nwater, then another frame\nO 0 0 0 -0.8\n1\n\nH 0 0 0\n";
  EXPECT_EQ(run(program + " render " + f + "/two.xyz --size 16x16 --samples 1 -o " + f + "/two.npy" + of_plugin, &output), 0)
      << output;
  for (const char* said :
       {"two.xyz:3:9: warning: what follows coordinates", "two.xyz:4:1: warning: only the first frame", "no camera"})
    EXPECT_NE(output.find(said), std::string::npos) << output;
  EXPECT_EQ(run(program + " render " + f + "/two.xyz --strict --size 16x16 --samples 1" + of_plugin, &output), 2) << output;
  std::ofstream(f + "/wrong.xyz") << "2\n\nC 0 0 0\nO 1 zero 0\n";
  EXPECT_EQ(run(program + " render " + f + "/wrong.xyz --samples 1" + of_plugin, &output), 2);
  EXPECT_NE(output.find("wrong.xyz:4:5: a number is expected here: y"), std::string::npos) << output;
  EXPECT_EQ(run(program + " render " + f + "/atom.xyz --samples 1", &output), 2);  // without the plugin
  EXPECT_NE(output.find("files ending in .xyz are not read"), std::string::npos) << output;
}

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

  check_object(program, f);
  check_map(program, f);
  check_emission(program, f);
  check_camera(program, f);
  check_volume(program, f);
  check_tone_map(program, f);
  check_importer(program, f);
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
  check(ETENDUE_SOURCE_DIR "/tests/plugin/capsule.cpp", ETENDUE_SOURCE_DIR "/docs/write-an-object.md", 90);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/hexagons.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-map.md", 70);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/limb_darkened.cpp", ETENDUE_SOURCE_DIR "/docs/write-an-emission.md", 90);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/fisheye.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-camera.md", 90);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/atmosphere.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-volume.md", 90);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/neutral_tone_map.cpp", ETENDUE_SOURCE_DIR "/docs/write-a-tone-map.md", 90);
  check(ETENDUE_SOURCE_DIR "/tests/plugin/xyz_importer.cpp", ETENDUE_SOURCE_DIR "/docs/write-an-importer.md", 90);
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
