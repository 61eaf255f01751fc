// Maps: constants, checkers, images with their encodings, orientation, wrapping, filtering and errors.

#include "etendue/object_map.h"

#include <filesystem>
#include <fstream>

#include "etendue/describe/color.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using test::create;
using test::ImageFile;

SurfacePoint at(float u, float v) {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.uv = {u, v};
  return p;
}

TEST(ConstantMap, IsItsValueEverywhere) {
  const Ref<ObjectMap> map = constant(0.25f);
  EXPECT_EQ(map->color(at(0, 0), test::wavelengths(), ColorUse::radiance)[1], 0.25f);
  EXPECT_EQ(map->scalar(at(0.3f, 0.2f)), 0.25f);
  ASSERT_TRUE(map->constant());
  EXPECT_EQ(map->constant()->at(500, ColorUse::radiance), 0.25f);
  const Color ramp = table_spectrum({360, 830}, {0, 1});
  const Ref<ObjectMap> varied = create<ObjectMap>("ConstantMap", {{"value", ramp}});
  EXPECT_NEAR(varied->scalar(at(0, 0)), 0.5f, 1e-5f);
  EXPECT_NEAR(varied->reflectance(at(0, 0), test::wavelengths(595))[0], 0.5f, 1e-5f);
}

TEST(CheckerMap, AlternatesOverUv) {
  const Ref<ObjectMap> map =
      create<ObjectMap>("CheckerMap", {{"first", 0.1}, {"second", 0.9}, {"repeat", std::vector<double>{2, 4, 1}}});
  EXPECT_FALSE(map->constant());
  for (int i = -3; i < 5; ++i)
    for (int k = -3; k < 5; ++k)
      EXPECT_NEAR(map->scalar(at((float(i) + 0.5f) / 2, (float(k) + 0.5f) / 4)), (i + k) % 2 == 0 ? 0.1f : 0.9f, 1e-6f)
          << i << " " << k;
}

TEST(CheckerMap, FlatSurfacesBetweenCubesDoNotFlicker) {
  const Ref<ObjectMap> map = create<ObjectMap>("CheckerMap", {{"space", "object"}, {"repeat", std::vector<double>{1, 1, 1}}});
  SurfacePoint p = at(0, 0);
  float first = -1;
  for (const float z : {-1e-6f, 0.0f, 1e-6f}) {
    p.object_position = {0.5f, 0.5f, z};
    if (first < 0) first = map->scalar(p);
    EXPECT_EQ(map->scalar(p), first);
  }
  p.object_position.x = 1.5f;
  EXPECT_NE(map->scalar(p), first);
}

// With the normal (0.6, 0, 0.8) the projections along x and z have the weights 0.6^s and 0.8^s: u is y in the first, x in the
// second.
TEST(Mappings, TriplanarBlendsByPowersOfTheNormal) {
  const Ref<ObjectMap> across = create<ObjectMap>("FormulaMap", {{"formula", "u"}});
  SurfacePoint p = test::surface_point({0.6f, 0, 0.8f});
  p.position = p.object_position = {2, 5, 7};
  for (const double s : {1.0, 2.0, 5.0}) {
    const Ref<ObjectMap> map = create<ObjectMap>("TriplanarMap", {{"map", across}, {"sharpness", s}});
    const double x = std::pow(0.6, s), z = std::pow(0.8, s);
    EXPECT_NEAR(double(map->scalar(p)), (5 * x + 2 * z) / (x + z), 1e-5) << s;
  }
}

// On a square metre seen from straight above the footprint is independent of rotation: a map filtered at rotated coordinates
// equals the map at those coordinates.
TEST(Mappings, TurnedCoordinatesKeepTheFootprint) {
  test::TestSquare square(1);
  square.reference();
  const Ref<ObjectMap> checker = create<ObjectMap>("CheckerMap", {{"repeat", std::vector<double>{4, 4, 1}}}),
                       turned = create<ObjectMap>("UvTransformMap", {{"map", checker}, {"angle", 30.0}});
  const float c = std::cos(radians(30)), s = 0.5f;
  test::Random random(1);
  for (int i = 0; i < 50; ++i) {
    SurfacePoint p = at(random(), random());
    p.object = &square;
    p.footprint = 0.2f * random();
    SurfacePoint q = p;
    q.uv = {c * p.uv.x - s * p.uv.y, s * p.uv.x + c * p.uv.y};  // counterclockwise: from u towards v
    EXPECT_NEAR(turned->scalar(p), checker->scalar(q), 1e-4f);
  }
}

// A 2 x 2 image whose grey values distinguish the texels.
const std::vector<float> four{0.1f, 0.2f, 0.3f, 0.4f};

TEST(ImageMap, RowZeroIsAtTheTop) {
  const ImageFile file("four.exr", {2, 2, 1, NumberType::single}, four);
  const Ref<ObjectMap> map = create<ObjectMap>("ImageMap", {{"file", file.path}, {"interpolation", "nearest"}});
  EXPECT_NEAR(map->scalar(at(0.25f, 0.75f)), 0.1f, 1e-6f);
  EXPECT_NEAR(map->scalar(at(0.75f, 0.75f)), 0.2f, 1e-6f);
  EXPECT_NEAR(map->scalar(at(0.25f, 0.25f)), 0.3f, 1e-6f);
  EXPECT_NEAR(map->scalar(at(0.75f, 0.25f)), 0.4f, 1e-6f);
}

TEST(ImageMap, InterpolatesAndWraps) {
  const ImageFile file("four.exr", {2, 2, 1, NumberType::single}, four);
  const auto map = [&](const char* wrap, const char* interpolation = "bilinear") {
    return create<ObjectMap>("ImageMap", {{"file", file.path}, {"interpolation", interpolation}, {"wrap", wrap}});
  };
  EXPECT_NEAR(map("clamp")->scalar(at(0.5f, 0.5f)), 0.25f, 1e-5f);
  EXPECT_NEAR(map("clamp")->scalar(at(0.5f, 0.75f)), 0.15f, 1e-5f);
  EXPECT_NEAR(map("clamp", "nearest")->scalar(at(1.25f, 0.75f)), 0.2f, 1e-6f);
  EXPECT_NEAR(map("repeat", "nearest")->scalar(at(1.25f, 0.75f)), 0.1f, 1e-6f);
  EXPECT_NEAR(map("repeat", "nearest")->scalar(at(-0.25f, 1.25f)), 0.4f, 1e-6f);
  EXPECT_NEAR(map("mirror", "nearest")->scalar(at(1.25f, 0.75f)), 0.2f, 1e-6f);
  EXPECT_NEAR(map("mirror", "nearest")->scalar(at(1.75f, 0.75f)), 0.1f, 1e-6f);
  EXPECT_EQ(map("black", "nearest")->scalar(at(1.25f, 0.75f)), 0);
}

TEST(ImageMap, MayBeContinuedOtherwiseAboveAndBelow) {
  const ImageFile file("four.exr", {2, 2, 1, NumberType::single}, four);
  for (const char* const interpolation : {"nearest", "bilinear"}) {
    const auto map = [&](const char* wrap, const char* wrap_v) {
      return create<ObjectMap>("ImageMap",
                               {{"file", file.path}, {"interpolation", interpolation}, {"wrap", wrap}, {"wrap_v", wrap_v}});
    };
    // The rows are 0.1 0.2 above and 0.3 0.4 below.
    EXPECT_NEAR(map("repeat", "clamp")->scalar(at(1.25f, 5.0f)), 0.1f, 1e-6f);
    EXPECT_NEAR(map("clamp", "repeat")->scalar(at(5.0f, 1.25f)), 0.4f, 1e-6f);
    EXPECT_NEAR(map("clamp", "mirror")->scalar(at(-3.0f, 1.25f)), 0.1f, 1e-6f);
    EXPECT_EQ(map("repeat", "black")->scalar(at(1.25f, 5.0f)), 0);
    EXPECT_NEAR(map("mirror", "same")->scalar(at(1.25f, 1.25f)), 0.2f, 1e-6f);
  }
}

// A thousand times the image's width away, texel coordinates exceed the range of integers.
TEST(ImageMap, FarBesideAWideImageIsItsBorder) {
  std::vector<float> ramp(2'200'000, 0.5f);
  ramp.front() = 0.25f;
  ramp.back() = 0.75f;
  const ImageFile file("wide.exr", {int(ramp.size()), 1, 1, NumberType::single}, ramp);
  for (const char* const interpolation : {"nearest", "bilinear"}) {
    const Ref<ObjectMap> map =
        create<ObjectMap>("ImageMap", {{"file", file.path}, {"interpolation", interpolation}, {"wrap", "clamp"}});
    EXPECT_EQ(map->scalar(at(-900, 0.5f)), 0.25f) << interpolation;
    EXPECT_EQ(map->scalar(at(900, 0.5f)), 0.75f) << interpolation;
  }
}

TEST(ImageMap, EightBitsAreSrgbAndDecodedBeforeFiltering) {
  const ImageFile file("bits.png", {2, 1, 3, NumberType::uint8}, {0, 0, 0, 1, 1, 1});
  const Ref<ObjectMap> map =
      create<ObjectMap>("ImageMap", {{"file", file.path}, {"interpolation", "bilinear"}, {"wrap", "clamp"}});
  EXPECT_NEAR(map->scalar(at(0.5f, 0.5f)), 0.5f, 1e-3f);  // averaged before decoding it would be 0.214
  const ImageFile grey("grey.png", {1, 1, 3, NumberType::uint8}, {0.5f, 0.5f, 0.5f});
  EXPECT_NEAR(create<ObjectMap>("ImageMap", {{"file", grey.path}})->scalar(at(0.5f, 0.5f)),
              decode_transfer("srgb", 128 / 255.0), 1e-4);
  EXPECT_NEAR(create<ObjectMap>("ImageMap", {{"file", grey.path}, {"transfer", "linear"}})->scalar(at(0.5f, 0.5f)), 128 / 255.0,
              1e-4);
  const ImageFile deep("deep.png", {1, 1, 4, NumberType::uint16}, {0.25f, 0.25f, 0.25f, 1});
  EXPECT_NEAR(create<ObjectMap>("ImageMap", {{"file", deep.path}})->scalar(at(0.5f, 0.5f)), decode_transfer("srgb", 0.25),
              1e-4);
}

TEST(ImageMap, ColoursBecomeSpectra) {
  const ImageFile file("red.exr", {1, 1, 3, NumberType::single}, {0.8f, 0.1f, 0.05f});
  const Ref<ObjectMap> map = create<ObjectMap>("ImageMap", {{"file", file.path}});
  const Wavelengths w = test::wavelengths();
  const RgbSpace& space = rgb_space("srgb");
  for (const ColorUse use : {ColorUse::reflectance, ColorUse::radiance, ColorUse::coefficient}) {
    const Spectrum got = map->color(at(0.5f, 0.5f), w, use), wanted = rgb_spectrum(space, 0.8f, 0.1f, 0.05f, use, w);
    for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-5f);
  }
  EXPECT_NEAR(map->scalar(at(0, 0)), 0.95f / 3, 1e-5f);
}

TEST(ImageMap, FiltersOverTheFootprint) {
  // A fine checkerboard of 64 x 64 texels: detail smaller than the footprint averages to a half.
  std::vector<float> values;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) values.push_back(float((x + y) % 2));
  const ImageFile file("fine.exr", {64, 64, 1, NumberType::single}, values);
  const Ref<ObjectMap> map = create<ObjectMap>("ImageMap", {{"file", file.path}}),
                       squares = create<ObjectMap>("ImageMap", {{"file", file.path}, {"interpolation", "nearest"}});
  test::TestSquare square(2);
  square.reference();
  SurfacePoint p = at((10 + 0.5f) / 64, (10 + 0.5f) / 64);
  p.object = &square;
  const float texel = map->scalar(p);  // without a footprint: the texel itself
  EXPECT_TRUE(texel == 0 || texel == 1);
  p.footprint = 2.0f / 64 / 100;
  EXPECT_NEAR(map->scalar(p), texel, 1e-3f);
  EXPECT_EQ(squares->scalar(p), texel);
  p.footprint = 2.0f / 64 * 4;
  EXPECT_NEAR(map->scalar(p), 0.5f, 1e-3f);
  EXPECT_NEAR(squares->scalar(p), 0.5f, 1e-3f);
  p.footprint = 100;
  EXPECT_NEAR(map->scalar(p), 0.5f, 1e-3f);
}

// The texels of a list and those of a file are the same to the bit, whatever the lookup and the encoding.
TEST(ImageMap, AListOfNumbersIsTheImageOfAFile) {
  test::Random random(3);
  test::TestSquare square(2);
  square.reference();
  for (const bool integers : {false, true})
    for (const int channels : {1, 3}) {
      constexpr int width = 13, height = 9;
      std::vector<double> listed;
      std::vector<float> stored;
      for (int i = 0; i < width * height * channels; ++i) {
        listed.push_back(integers ? std::floor(256.0 * double(random())) : double(random()));
        stored.push_back(float(listed.back()) / (integers ? 255.0f : 1.0f));
      }
      const ImageFile file(integers ? "listed.png" : "listed.exr",
                           {width, height, channels, integers ? NumberType::uint8 : NumberType::single}, stored);
      for (const char* interpolation : {"nearest", "bilinear"}) {
        const Ref<ObjectMap> of_file = create<ObjectMap>("ImageMap", {{"file", file.path}, {"interpolation", interpolation}}),
                             of_list = create<ObjectMap>("ImageMap", {{"resolution", std::vector<double>{width, height}},
                                                                      {"values", listed},
                                                                      {"number_type", integers ? "uint8" : "float"},
                                                                      {"interpolation", interpolation}});
        EXPECT_EQ(of_list->largest(), of_file->largest());
        for (int i = 0; i < 200; ++i) {
          SurfacePoint p = at(3 * random() - 1, 3 * random() - 1);
          p.object = &square;
          p.footprint = i % 2 == 0 ? 0 : random();
          EXPECT_EQ(of_list->scalar(p), of_file->scalar(p)) << p.uv.x << " " << p.uv.y << " " << p.footprint;
        }
      }
    }
}

TEST(ImageMap, LargeTiledAndUntiledFiles) {
  std::vector<float> values;
  for (int y = 0; y < 150; ++y)
    for (int x = 0; x < 200; ++x) values.push_back(float(x) / 200 + float(y));
  for (const bool tiled : {false, true}) {
    ImageHeader header(200, 150, 1, NumberType::single);
    if (tiled) header.tile_side = 32;
    const ImageFile file(tiled ? "tiled.exr" : "lines.exr", header, values);
    const Ref<ObjectMap> map = create<ObjectMap>("ImageMap", {{"file", file.path}, {"interpolation", "nearest"}});
    for (const auto& [x, y] : {std::pair(0, 0), {199, 149}, {63, 64}, {100, 31}, {31, 127}})
      EXPECT_NEAR(map->scalar(at((float(x) + 0.5f) / 200, 1 - (float(y) + 0.5f) / 150)), float(x) / 200 + float(y), 1e-4f)
          << tiled << x << " " << y;
  }
}

std::string error_of(const std::vector<test::Setting>& settings) {
  try {
    create<ObjectMap>("ImageMap", settings);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(ImageMap, SaysWhatIsWrong) {
  const std::string missing = error_of({{"file", "/nowhere/wood.png"}});
  EXPECT_NE(missing.find("file"), std::string::npos) << missing;
  EXPECT_NE(missing.find("/nowhere/wood.png"), std::string::npos) << missing;
  EXPECT_EQ(missing.find('|'), std::string::npos) << missing;

  const ImageFile nonsense("nonsense.png");
  std::ofstream(nonsense.path) << "this is no picture";
  EXPECT_NE(error_of({{"file", nonsense.path}}).find(nonsense.path), std::string::npos);

  // A file that is cut off in the middle.
  std::vector<float> values;
  test::Random random(1);
  for (int i = 0; i < 200 * 200 * 3; ++i) values.push_back(random());
  const ImageFile whole("cut.exr", {200, 200, 3, NumberType::single}, values);
  std::filesystem::resize_file(whole.path, std::filesystem::file_size(whole.path) / 2);
  const std::string cut = error_of({{"file", whole.path}});
  EXPECT_NE(cut.find(whole.path), std::string::npos) << cut;

  const ImageFile good("good.exr", {2, 2, 1, NumberType::single}, four);
  EXPECT_NE(error_of({{"file", good.path}, {"color_space", "srgbb"}}).find("srgb"), std::string::npos);
  EXPECT_NE(error_of({{"file", good.path}, {"transfer", "gama2.2"}}).find("gamma2.2"), std::string::npos);
}

}  // namespace
}  // namespace etendue
