// pbrt's textures as numbers and as colours.

#include "components/maps/noise.h"
#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "pbrt_support.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue::pbrt_test {
namespace {

const std::string sky = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";
const std::string wall =
    "Shape \"trianglemesh\" \"point3 P\" [-1 -1 5 1 -1 5 1 1 5 -1 1 5] \"integer indices\" [0 1 2 0 2 3] \"point2 uv\" [0 0 1 "
    "0 "
    "1 1 0 1]\n";

/// The radiance of a diffuse wall whose reflectance is 0.8 times a texture of numbers.
double as_number(const TemporaryFolder& folder, const std::string& image) {
  return seen(import_text(folder, v4(sky + "Texture \"n\" \"float\" \"imagemap\" " + image +
                                     "\nTexture \"t\" \"spectrum\" \"scale\" \"rgb tex\" [.8 .8 .8] \"texture scale\" "
                                     "\"n\"\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" +
                                     wall)),
              4096)
             .y /
         0.8;
}

TEST(PbrtTexture, NumbersOfImages) {
  const TemporaryFolder folder;
  test::write_image(folder / "rgb.exr", {1, 1, 3, NumberType::single}, {.1f, .2f, .6f});
  test::write_image(folder / "leaf.exr", {1, 2, 4, NumberType::single}, {.1f, .2f, .6f, .7f, .1f, .2f, .6f, .7f});
  test::write_image(folder / "solid.exr", {1, 1, 4, NumberType::single}, {.1f, .2f, .6f, 1});
  EXPECT_NEAR(as_number(folder, "\"string filename\" \"rgb.exr\""), 0.3, 0.005);
  EXPECT_NEAR(as_number(folder, "\"string filename\" \"leaf.exr\""), 0.7, 0.005);  // its alpha
  EXPECT_NEAR(as_number(folder, "\"string filename\" \"solid.exr\""), 0.3, 0.005);
  EXPECT_NEAR(as_number(folder, "\"string filename\" \"leaf.exr\" \"string filter\" \"point\""), 0.1, 0.005);
  EXPECT_NEAR(as_number(folder, "\"string filename\" \"leaf.exr\" \"float scale\" .5 \"bool invert\" true"), 0.65, 0.005);
}

TEST(PbrtTexture, ImagesOfVersion3AreLuminances) {
  const TemporaryFolder folder;
  test::write_image(folder / "red.png", {1, 1, 3, NumberType::uint8}, {1, 0, 0});
  // The luminance of the values in the file is decoded afterwards: 0.212671 becomes 0.0371.
  const Imported i = import_text(
      folder, v3("Texture \"n\" \"float\" \"imagemap\" \"string filename\" \"red.png\"\nTexture \"t\" \"color\" \"mix\" \"rgb "
                 "tex1\" [0 0 0] \"rgb tex2\" [1 1 1] \"texture amount\" \"n\"\n" +
                 sky +
                 "Material \"matte\" \"texture Kd\" \"t\"\nShape \"trianglemesh\" \"point P\" [-9 -9 5 9 -9 5 0 9 5] \"integer "
                 "indices\" [0 1 2] \"float uv\" [0 0 1 0 1 1]\n"));
  EXPECT_NEAR(seen(i, 4096).y, std::pow((0.212671 + 0.055) / 1.055, 2.4), 0.002);
}

// pbrt multiplies red, green and blue, and clamps them to 1, before they become a spectrum.
TEST(PbrtTexture, ScaledColours) {
  const TemporaryFolder folder;
  test::write_image(folder / "rgb.exr", {1, 1, 3, NumberType::single}, {.5f, .25f, .1f});
  const auto shown = [&](const std::string& more) {
    return seen(import_text(folder, v4(sky + "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"rgb.exr\" " + more +
                                       "\nMaterial \"diffuse\" \"texture reflectance\" \"t\"\n" + wall)),
                8192);
  };
  const Xyz twice = shown("\"float scale\" 3"), inverse = shown("\"bool invert\" true");
  // Of linear sRGB (1, 0.75, 0.3) and (0.5, 0.75, 0.9).
  EXPECT_NEAR(twice.y, 0.212671 + 0.71516 * 0.75 + 0.072169 * 0.3, 0.01);
  EXPECT_NEAR(inverse.y, 0.212671 * 0.5 + 0.71516 * 0.75 + 0.072169 * 0.9, 0.01);
}

// |n . d| of the first and the rest of the second; d is in the directive's coordinate system.
TEST(PbrtTexture, MixturesByDirection) {
  const auto shown = [](const std::string& dir) {
    return seen(
               import_text(v4(sky +
                              "AttributeBegin Rotate 90 0 0 1\nTexture \"t\" \"spectrum\" \"directionmix\" \"rgb tex1\" [.8 .8 "
                              ".8] \"rgb tex2\" [.2 .2 .2] " +
                              dir + "\nAttributeEnd Material \"diffuse\" \"texture reflectance\" \"t\"\n" + wall)),
               4096)
        .y;
  };
  EXPECT_NEAR(shown("\"vector3 dir\" [0 0 -3]"), 0.8, 0.01);
  EXPECT_NEAR(shown(""), 0.2, 0.01);
  EXPECT_NEAR(shown("\"vector3 dir\" [0.8 0 0.6]"), 0.6 * 0.8 + 0.4 * 0.2, 0.01);
}

// Half of the squares hold a dot of radius 0.35. In pbrt the dots show "outside".
TEST(PbrtTexture, Dots) {
  const Imported i = import_text(v4(sky +
                                    "Texture \"t\" \"spectrum\" \"dots\" \"rgb inside\" [.9 .9 .9] \"rgb outside\" [.1 .1 .1] "
                                    "\"float uscale\" 1000 \"float vscale\" 1000\nMaterial \"diffuse\" \"texture reflectance\" "
                                    "\"t\"\n" +
                                    wall));
  EXPECT_NE(i.told().find("same character"), std::string::npos) << i.told();
  EXPECT_NEAR(seen(i, 16384).y, 0.9 - 0.8 * M_PI * 0.35 * 0.35 / 2, 0.03);
}

/// A texture's number at a point, where `member` of a wall's shader is the texture.
double noise_at(const Point3& at, const std::string& texture, const std::string& material, const std::string& member) {
  const Imported i = import_text(v4("Texture \"t\" " + texture + "\nMaterial \"diffuse\" " + material + "\n" + wall));
  if (!i.job) {
    ADD_FAILURE() << i.told();
    return 0;
  }
  const Value value = get(part(object(i, 0), "shader"), member);
  const Ref<ObjectMap> map = ref_cast<ObjectMap>(*value.as<Ref<Component>>());
  prepare_tree(*map);
  SurfacePoint p;
  p.position = p.object_position = at;
  return double(map->scalar(p));
}
double bump_at(const Point3& at, const std::string& type) {
  return noise_at(at, "\"float\" " + type, "\"texture displacement\" \"t\"", "height");
}

// As bright as in pbrt: sums of octaves that are not divided by the sum of their weights.
TEST(PbrtNoise, IsAsStrongAsInPbrt) {
  const Point3 at{0.3f, 1.7f, -2.4f};
  const auto octave = [&](double frequency, std::uint32_t i) {
    return double(perlin_noise(float(frequency) * Vector3(at - Point3{}), i));
  };
  const auto fbm = [&](int count, double first) {
    double sum = 0;
    for (int i = 0; i < count; ++i) sum += std::pow(0.5, i) * octave(first * std::pow(1.99, i), std::uint32_t(i));
    return sum;
  };
  EXPECT_NEAR(bump_at(at, "\"fbm\" \"integer octaves\" 1"), fbm(1, 1), 1e-5);
  EXPECT_NEAR(bump_at(at, "\"fbm\""), fbm(8, 1), 1e-4);
  EXPECT_NEAR(bump_at(at, "\"windy\""), std::abs(fbm(3, 0.1)) * fbm(6, 1), 1e-4);
  // pbrt adds a further octave's mean.
  EXPECT_NEAR(bump_at(at, "\"wrinkled\" \"integer octaves\" 2"),
              std::abs(octave(1, 0)) + 0.5 * std::abs(octave(1.99, 1)) + 0.25 * 0.2, 1e-5);
}

// The colour of marble is 1.5 times a point of a curve of colours. Where (1 + sin(y + variation noise)) / 2 is 5.5 / 6, the
// point is 3/8 of the way from the grey of the ground to that of the vein.
TEST(PbrtNoise, MarbleHasTheColoursOfPbrt) {
  const auto of_color = [](double red, double green, double blue) {
    return double(test::create<ObjectMap>("ConstantMap", {{"value", rgb_color("srgb", 1.5 * red, 1.5 * green, 1.5 * blue)}})
                      ->scalar(SurfacePoint{}));
  };
  const double ground = of_color(0.58, 0.58, 0.6), vein = of_color(0.2, 0.2, 0.33);
  const double in_vein = std::asin(5 / 6.0), expected = ground + 3 / 8.0 * (vein - ground);
  const auto marble = [](const Point3& at, double variation) {
    return noise_at(at, "\"spectrum\" \"marble\" \"integer octaves\" 1 \"float variation\" " + std::to_string(variation),
                    "\"texture reflectance\" \"t\"", "color");
  };
  EXPECT_NEAR(marble({0, float(in_vein), 0}, 0), expected, 1e-3);
  EXPECT_NEAR(marble({0, float(-M_PI / 2), 0}, 0), ground, 1e-3);
  const Point3 at{0.3f, 0.4f, -2.4f};
  const double noise = double(perlin_noise(at - Point3{}));
  EXPECT_NEAR(marble(at, (in_vein - double(at.y)) / noise), expected, 1e-3);
}

TEST(PbrtTexture, CoordinatesOfVersion3) {
  const Imported i =
      import_text(v3("Texture \"t\" \"spectrum\" \"uv\"\nMaterial \"matte\" \"texture Kd\" \"t\"\nShape \"sphere\""));
  EXPECT_EQ(i.told(), "");
}

// In v3 a texture's name refers to its definition at the point where the material is given.
TEST(PbrtTexture, Version3MayGiveANameAgain) {
  const auto texture = [](const char* value) {
    return std::string("Texture \"t\" \"color\" \"constant\" \"rgb value\" ") + value + "\n";
  };
  const Imported i = import_text(
      v3(texture("[.2 .2 .2]") + "Material \"matte\" \"texture Kd\" \"t\"\n" + texture("[.7 .7 .7]") + "Shape \"sphere\"\n"));
  ASSERT_TRUE(i.job) << i.told();
  EXPECT_NEAR(number(part(object(i, 0), "shader"), "color"), 0.2, 0.01);
}

}  // namespace
}  // namespace etendue::pbrt_test
