// Outputs, reading pictures back, comparing them.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"
#include "etendue/output.h"

namespace etendue {
namespace {

namespace fs = std::filesystem;

/// A folder of its own for each test, removed afterwards.
class OutputTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "etendue-test-XXXXXX").string();
    ASSERT_NE(::mkdtemp(pattern.data()), nullptr);
    folder = pattern;
  }
  void TearDown() override { fs::remove_all(folder); }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  size_t files() const { return size_t(std::distance(fs::directory_iterator(folder), {})); }
  fs::path folder;
};

std::string bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  return all.str();
}

void write_bytes(const std::string& path, const std::string& data) { std::ofstream(path, std::ios::binary) << data; }

std::string message(const std::function<void()>& f) {
  try {
    f();
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

Ref<Output> make_output(const std::string& name) { return ref_cast<Output>(Registry::instance().create(name)); }

std::vector<Ref<Output>> all_outputs() {
  std::vector<Ref<Output>> outputs;
  for (const ClassInfo* c : Registry::instance().subclasses(*Registry::instance().find("Output")))
    outputs.push_back(make_output(c->name));
  return outputs;
}

/// X Y Z of colours within sRGB, with two layers.
Image picture(int width = 17, int height = 11) {
  Image image(width, height, {"X", "Y", "Z", "depth.Z", "object.ID"});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0.05, 0.95);
  const std::array<double, 9> m = rgb_space("srgb").to_xyz;
  for (size_t i = 0; i < image.values.size(); i += 5) {
    const double rgb[] = {uniform(random), uniform(random), uniform(random)};
    for (size_t c = 0; c < 3; ++c) image.values[i + c] = m[3 * c] * rgb[0] + m[3 * c + 1] * rgb[1] + m[3 * c + 2] * rgb[2];
    image.values[i + 3] = 10 * uniform(random);
    image.values[i + 4] = 100001;
  }
  image.metadata = {{"color_space", "xyz"}, {"file_hash", "0123abcd"}, {"seed", "42"}, {"samples", "64"}, {"version", "0.1.0"}};
  return image;
}

Image toned() {
  const auto map = ref_cast<ToneMap>(Registry::instance().create("ExposureToneMap"));
  return map->apply(picture());
}

TEST_F(OutputTest, EveryFormatReadsBack) {
  ASSERT_GE(all_outputs().size(), 5u);
  for (const auto& output : all_outputs()) {
    SCOPED_TRACE(output->class_info().name);
    const std::string file = path("picture" + output->extension());
    output->write_image(output->for_display() ? toned() : picture(), file);
    EXPECT_EQ(files(), 1u) << "something was left beside the file";
    const Image back = read_image(file);
    ASSERT_EQ(back.width, 17);
    ASSERT_EQ(back.height, 11);
    const Image expected = convert_color_space(picture(), "srgb"), got = convert_color_space(back, "srgb");
    // half a step of 8 bits times the slope of the sRGB curve, at most 2.3; HDR keeps 8 bits of the largest channel
    const std::string e = output->extension();
    const double tolerance = e == ".npy" ? 1e-14 : e == ".exr" ? 1e-6 : e == ".hdr" ? 1.0 / 128 : 2.3 * 0.51 / 255;
    for (int y = 0; y < 11; ++y)
      for (int x = 0; x < 17; ++x)
        for (size_t c = 0; c < 3; ++c) {
          const auto channel = [&](const Image& i) {
            return size_t(std::find(i.channels.begin(), i.channels.end(), std::string(1, "RGB"[c])) - i.channels.begin());
          };
          ASSERT_NEAR(got.at(x, y, channel(got)), expected.at(x, y, channel(expected)), tolerance) << x << ' ' << y << ' ' << c;
        }
    // The same picture gives the same bytes.
    const std::string first = bytes(file);
    output->write_image(output->for_display() ? toned() : picture(), file);
    EXPECT_EQ(bytes(file), first);
    fs::remove(file);
  }
}

TEST_F(OutputTest, MetadataSurvive) {
  for (const char* name : {"ExrOutput", "PngOutput"}) {
    const auto output = make_output(name);
    const std::string file = path("picture" + output->extension());
    output->write_image(output->for_display() ? toned() : picture(), file);
    const Image back = read_image(file);
    for (const char* key : {"file_hash", "seed", "samples", "version"})
      EXPECT_EQ(back.metadata.count(key) ? back.metadata.at(key) : "missing", picture().metadata.at(key)) << name << ' ' << key;
    EXPECT_EQ(back.metadata.at("color_space"), "srgb");
    EXPECT_NE(describe_image(file).find("file_hash: 0123abcd"), std::string::npos);
    EXPECT_NE(describe_image(file).find("17 x 11"), std::string::npos);
  }
}

TEST_F(OutputTest, ExrLayersPrecisionSpaceAndCrop) {
  const auto output = make_output("ExrOutput");
  const auto channel = [](const Image& i, const char* name) {
    return size_t(std::find(i.channels.begin(), i.channels.end(), name) - i.channels.begin());
  };
  Image image = picture();
  image.metadata["crop_x"] = "5";
  image.metadata["crop_y"] = "3";
  image.metadata["full_width"] = "40";
  image.metadata["full_height"] = "30";
  set(*output, "precision", Value(std::string("half")));
  output->write_image(image, path("a.exr"));
  Image back = read_image(path("a.exr"));
  ASSERT_EQ(back.channels.size(), 5u);
  EXPECT_EQ(back.at(3, 4, channel(back, "object.ID")), 100001);  // a half float could not represent it
  EXPECT_NEAR(back.at(3, 4, channel(back, "depth.Z")), image.at(3, 4, 3), 1e-6 * image.at(3, 4, 3));
  EXPECT_EQ(back.metadata.at("crop_x"), "5");
  EXPECT_EQ(back.metadata.at("crop_y"), "3");
  EXPECT_EQ(back.metadata.at("full_width"), "40");
  EXPECT_EQ(back.metadata.at("full_height"), "30");
  const Comparison halves = compare(back, image);
  EXPECT_GT(halves.maximum_difference, 1e-6);
  EXPECT_LT(halves.maximum_difference, 1e-3);

  set(*output, "precision", Value(std::string("float")));
  set(*output, "layers", Value(false));
  for (const char* space : {"xyz", "acescg", "rec2020", "srgb"}) {
    set(*output, "color_space", Value(std::string(space)));
    output->prepare();
    output->write_image(image, path("b.exr"));
    back = read_image(path("b.exr"));
    EXPECT_EQ(back.channels.size(), 3u);
    EXPECT_EQ(back.metadata.at("color_space"), space);
    EXPECT_LT(compare(back, image).maximum_difference, 1e-6) << space;
  }
  // A tone mapped picture is stored linear.
  output->write_image(toned(), path("c.exr"));
  EXPECT_LT(compare(read_image(path("c.exr")), picture()).maximum_difference, 1e-6);
}

TEST_F(OutputTest, PngOf16BitsAndDither) {
  const auto output = make_output("PngOutput");
  set(*output, "bits", Value(Number{16}));
  output->write_image(toned(), path("a.png"));
  EXPECT_LT(compare(read_image(path("a.png")), picture(), "srgb").maximum_difference, 2.3 * 0.51 / 65535);
  set(*output, "bits", Value(Number{12}));
  EXPECT_THROW(output->prepare(), Error);

  // A uniform grey between two code values: rounding gives one of them, with dither the mean is right.
  Image grey(64, 64, {"R", "G", "B"});
  std::fill(grey.values.begin(), grey.values.end(), 100.3 / 255);
  grey.metadata = {{"color_space", "srgb"}, {"transfer", "linear"}};
  set(*output, "bits", Value(Number{8}));
  output->write_image(grey, path("b.png"));
  EXPECT_NEAR(compare(read_image(path("b.png")), grey, "srgb").channels[0].mean_a * 255, 100, 1e-4);
  set(*output, "dither", Value(true));
  output->write_image(grey, path("b.png"));
  // the standard deviation of a mean of 4096 values that are off by one with probability 0.3 is 0.007; the tolerance is five of
  // these
  EXPECT_NEAR(compare(read_image(path("b.png")), grey, "srgb").channels[0].mean_a * 255, 100.3, 0.036);
}

TEST_F(OutputTest, NpyHeaderIsNumPys) {
  const auto output = make_output("NpyOutput");
  output->write_image(picture(), path("a.npy"));
  const std::string data = bytes(path("a.npy"));
  EXPECT_EQ(data.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const size_t header = 10 + size_t(static_cast<unsigned char>(data[8])) + 256 * size_t(static_cast<unsigned char>(data[9]));
  EXPECT_EQ(header % 64, 0u);
  EXPECT_EQ(data[header - 1], '\n');
  EXPECT_EQ(data.size(), header + 17 * 11 * 3 * 8);
  EXPECT_EQ(data.substr(10, 62), "{'descr': '<f8', 'fortran_order': False, 'shape': (11, 17, 3),");
  double value = 0;
  std::memcpy(&value, data.data() + header + 8 * (3 * (2 * 17 + 5) + 1), 8);
  EXPECT_EQ(value, picture().at(5, 2, 1));
  set(*output, "layers", Value(true));
  output->write_image(picture(), path("a.npy"));
  const Image back = read_image(path("a.npy"));
  ASSERT_EQ(back.channels.size(), 5u);
  EXPECT_EQ(back.at(5, 2, 4), 100001);
}

TEST_F(OutputTest, FailedWritesNameTheReasonAndKeepTheOldFile) {
  for (const auto& output : all_outputs()) {
    SCOPED_TRACE(output->class_info().name);
    const Image image = output->for_display() ? toned() : picture();
    const std::string missing = path("missing/picture" + output->extension());
    const std::string said = message([&] { output->write_image(image, missing); });
    EXPECT_NE(said.find(missing), std::string::npos) << said;
    EXPECT_NE(said.find("no folder"), std::string::npos) << said;
    EXPECT_NE(message([&] { output->write_image(image, folder.string()); }).find("is a folder"), std::string::npos);

    // A limit on the size of files simulates a full disk.
    const std::string file = path("picture" + output->extension());
    write_bytes(file, "what was there before");
    rlimit old{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
    const rlimit small{64, old.rlim_max};
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    const std::string full = message([&] { output->write_image(image, file); });
    ::setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(full.find(file), std::string::npos) << full;
    EXPECT_NE(full.find("File too large"), std::string::npos) << full;
    EXPECT_EQ(bytes(file), "what was there before");
    EXPECT_EQ(files(), 1u);
    fs::remove(file);
  }
  EXPECT_NE(message([&] { make_output("PngOutput")->write_image(picture(), path("a.png")); }).find("not tone mapped"),
            std::string::npos);
  EXPECT_EQ(files(), 0u);
}

TEST_F(OutputTest, LinksAndPermissionsStay) {
  write_bytes(path("real.npy"), "old");
  fs::permissions(path("real.npy"), fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink(path("real.npy"), path("link.npy"));
  make_output("NpyOutput")->write_image(picture(), path("link.npy"));
  EXPECT_TRUE(fs::is_symlink(path("link.npy")));
  EXPECT_EQ(read_image(path("real.npy")).width, 17);
  EXPECT_EQ(fs::status(path("real.npy")).permissions(), fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(OutputTest, DamagedFilesAreRefused) {
  EXPECT_NE(message([&] { read_image(path("none.png")); }).find("no such file"), std::string::npos);
  EXPECT_NE(message([&] { read_image(folder.string()); }).find("folder"), std::string::npos);
  write_bytes(path("empty.exr"), "");
  EXPECT_NE(message([&] { read_image(path("empty.exr")); }).find("empty"), std::string::npos);
  for (const auto& output : all_outputs()) {
    SCOPED_TRACE(output->class_info().name);
    const std::string file = path("picture" + output->extension());
    output->write_image(output->for_display() ? toned() : picture(), file);
    const std::string whole = bytes(file);
    const std::vector<double> values = read_image(file).values;
    for (const double part : {0.02, 0.2, 0.4, 0.6, 0.8, 0.95}) {
      write_bytes(file, whole.substr(0, size_t(double(whole.size()) * part)));
      bool refused_or_equal = false;  // the part after a TGA file's pixels may be missing
      const std::string said = message([&] { refused_or_equal = read_image(file).values == values && part > 0.5; });
      EXPECT_TRUE(refused_or_equal || said.find(file) != std::string::npos) << part << ' ' << said;
    }
    write_bytes(file, "This is not a picture, whatever its name may say about it. It is long enough for a header, though.");
    EXPECT_NE(message([&] { read_image(file); }).find(file), std::string::npos);
  }
  const std::string start("\x93NUMPY\x01\x00", 8);
  for (const char* header :
       {"{'descr': '>f8', 'fortran_order': False, 'shape': (1, 1, 3), }",
        "{'descr': '<f8', 'fortran_order': True, 'shape': (1, 1, 3), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 1, 2), }", "{'descr': '<f8', 'shape': (1, 1, 3), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (1048576, 1048576, 3), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': "}) {
    write_bytes(path("a.npy"), start + char(std::strlen(header)) + '\0' + header + std::string(24, '\0'));
    EXPECT_NE(message([&] { read_image(path("a.npy")); }).find("a.npy"), std::string::npos) << header;
  }
}

TEST_F(OutputTest, WriteAnyChoosesByEnding) {
  for (const char* name : {"a.PNG", "a.exr", "a.hdr", "a.tga", "a.npy"}) {
    write_any(picture(), path(name));
    const Comparison c = compare(read_image(path(name)), picture(), "srgb");
    EXPECT_LT(c.maximum_difference, 1.0 / 128) << name;
    write_any(toned(), path(name));
    EXPECT_LT(compare(read_image(path(name)), picture(), "srgb").maximum_difference, 1.0 / 128) << name;
  }
  EXPECT_NE(message([&] { write_any(picture(), path("a.xyz")); }).find(".png"), std::string::npos);
}

TEST(Compare, Measures) {
  Image a(2, 1, {"R", "G", "B"}), b = a;
  a.values = {1, 2, 3, 4, 5, 6};
  b.values = {1, 2, 3, 4, 5, 8};
  Comparison c = compare(a, b, "srgb");
  const double mean = 23.0 / 6;
  EXPECT_NEAR(c.root_mean_square_error, std::sqrt(4.0 / 6), 1e-12);
  EXPECT_NEAR(c.relative_mean_square_error, 4 / (64 + 0.01 * mean * mean) / 6, 1e-12);
  EXPECT_NEAR(c.symmetric_error, 2 * 2.0 / 14 / 6, 1e-12);
  EXPECT_EQ(c.maximum_difference, 2);
  EXPECT_EQ(c.maximum_x, 1);
  EXPECT_EQ(c.maximum_channel, "B");
  EXPECT_NEAR(c.channels[2].ratio, 9.0 / 11, 1e-12);
  EXPECT_EQ(c.channels[0].ratio, 1);
  EXPECT_EQ(c.not_finite, 0u);
  c = compare(a, a);
  EXPECT_EQ(c.root_mean_square_error, 0);
  EXPECT_EQ(c.relative_mean_square_error, 0);
  b.values[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(compare(a, b, "srgb").not_finite, 1u);
  std::fill(b.values.begin(), b.values.end(), b.values[0]);
  EXPECT_TRUE(std::isnan(compare(a, b, "srgb").root_mean_square_error));
  EXPECT_THROW(compare(a, Image(1, 2, {"R", "G", "B"})), Error);
  EXPECT_THROW(compare(a, Image(2, 1, {"A", "G", "B"})), Error);
}

TEST(Compare, TileRatios) {
  Image a(5, 3, {"X", "Y", "Z"}), b(5, 3, {"X", "Y", "Z"});
  std::fill(b.values.begin(), b.values.end(), 2);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 5; ++x) a.at(x, y, 1) = x < 2 ? 1 : 4;
  const auto tiles = tile_ratios(a, b, 2);
  ASSERT_EQ(tiles.size(), 6u);
  EXPECT_EQ(tiles[0].ratio, 0.5);
  EXPECT_EQ(tiles[1].ratio, 2);
  EXPECT_EQ(tiles[5].area, (PixelArea{4, 2, 5, 3}));
  EXPECT_EQ(tiles[5].mean_a, 4);
  EXPECT_EQ(tile_ratios(Image(1, 1, {"X", "Y", "Z"}), Image(1, 1, {"X", "Y", "Z"}), 8)[0].ratio, 1);
  EXPECT_THROW(tile_ratios(a, b, 0), Error);
}

}  // namespace
}  // namespace etendue
