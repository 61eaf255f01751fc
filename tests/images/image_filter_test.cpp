// ImageMap filtered over elliptical footprints, on images of any size.

#include <random>

#include "components/maps/footprint.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using test::create;

/// A grey image of floats and the file that holds it.
struct GreyImage : test::ImageFile {
  int width, height;
  std::vector<float> texels;  // rows from the top
  template <class F>
  GreyImage(const std::string& name, int w, int h, F value) : ImageFile(name + ".exr"), width(w), height(h) {
    for (int y = 0; y < h; ++y)
      for (int x = 0; x < w; ++x) texels.push_back(value(x, y));
    write({w, h, 1, NumberType::single});
  }
  void write(const ImageHeader& header) const { test::write_image(path, header, texels); }
  double mean() const {
    double sum = 0;
    for (const float t : texels) sum += double(t);
    return sum / double(texels.size());
  }
  /// Bilinear interpolation between texels; the image is repeated.
  double at(double u, double v) const {
    const double x = u * width - 0.5, y = (1 - v) * height - 0.5, fx = x - std::floor(x), fy = y - std::floor(y);
    const auto texel = [&](int i, int k) {
      return double(texels[size_t(((k % height) + height) % height * width + ((i % width) + width) % width)]);
    };
    const int i = int(std::floor(x)), k = int(std::floor(y));
    return (1 - fy) * ((1 - fx) * texel(i, k) + fx * texel(i + 1, k)) +
           fy * ((1 - fx) * texel(i, k + 1) + fx * texel(i + 1, k + 1));
  }
  Ref<ObjectMap> map(const char* wrap = "repeat", const char* interpolation = "bilinear") const {
    return create<ObjectMap>("ImageMap", {{"file", path}, {"interpolation", interpolation}, {"wrap", wrap}});
  }
};

/// A point on a plane that faces +z, seen at a slant, with tangents.
SurfacePoint seen(float u, float v, float footprint, float cosine = 1, float direction = 0, const Vector3& dpdu = {1, 0, 0},
                  const Vector3& dpdv = {0, 1, 0}) {
  SurfacePoint p = test::surface_point({0, 0, 1});
  p.uv = {u, v};
  p.dpdu = dpdu;
  p.dpdv = dpdv;
  p.footprint = footprint;
  p.footprint_cosine = cosine;
  const float sine = safe_sqrt(1 - cosine * cosine);
  p.ray_direction = {sine * std::cos(direction), sine * std::sin(direction), -cosine};
  return p;
}

/// The mean of an image over the footprint's ellipse.
double mean_over(const GreyImage& image, const SurfacePoint& p) {
  const Footprint f = footprint_of(p);
  const double det = double(p.dpdu.x) * double(p.dpdv.y) - double(p.dpdu.y) * double(p.dpdv.x);
  constexpr int n = 4000;
  double sum = 0;
  for (int k = 0; k < n; ++k) {  // on Vogel's spiral (sunflower)
    const float r = 0.5f * std::sqrt((float(k) + 0.5f) / n), phi = 2.399963f * float(k);
    const Vector3 s = r * std::cos(phi) * f.longer + r * std::sin(phi) * f.shorter;
    sum += image.at(double(p.uv.x) + double(s.x * p.dpdv.y - s.y * p.dpdv.x) / det,
                    double(p.uv.y) + double(p.dpdu.x * s.y - p.dpdu.y * s.x) / det);
  }
  return sum / n;
}

TEST(ImageFilter, StripesAlongTheViewStaySharp) {
  // Stripes of 8 texels a period, seen along them: across, a pixel is 2 texels wide.
  const GreyImage stripes("stripes", 256, 256, [](int x, int) { return 0.5f + 0.5f * std::sin(pi / 4 * (float(x) + 0.5f)); });
  const Ref<ObjectMap> map = stripes.map(), squares = stripes.map("repeat", "nearest"),
                       standard = create<ObjectMap>("ImageMap", {{"file", stripes.path}});
  double contrast = 0, crosswise = 0, worst = 0;
  for (int i = 0; i < 64; ++i) {
    const float u = float(i) / 64 * 8 / 256;
    const SurfacePoint p = seen(u, 0.3f, 2.0f / 256, 0.05f, pi / 2), across = seen(u, 0.3f, 2.0f / 256, 0.05f, 0);
    contrast = std::max(contrast, std::abs(double(map->scalar(p)) - 0.5));
    crosswise = std::max(crosswise, std::abs(double(map->scalar(across)) - 0.5));
    worst = std::max(worst, std::abs(double(map->scalar(p)) - mean_over(stripes, p)));
    EXPECT_EQ(map->scalar(p), standard->scalar(p));
    EXPECT_EQ(map->scalar(p), squares->scalar(p));  // texels are smaller than the ellipse: the mean is the same
  }
  EXPECT_GT(contrast, 0.38);
  EXPECT_LT(crosswise, 0.02);
  EXPECT_LT(worst, 0.06);
}

TEST(ImageFilter, AgreesWithTheMeanOverTheEllipse) {
  // White noise, which holds every frequency, on tangents that are neither orthogonal nor of one length.
  test::Random texel(1), random(2);
  const GreyImage noise("noise", 251, 190, [&](int, int) { return texel(); });
  const Ref<ObjectMap> map = noise.map();
  const Vector3 sheared_u{1, 0.2f, 0}, sheared_v{1.2f, -0.7f, 0};
  for (const float width : {0.5f, 3.0f, 12.0f})
    for (const float cosine : {1.0f, 0.3f, 0.08f}) {
      double wrong = 0, spread = 0, bias = 0;
      constexpr int n = 80;
      for (int i = 0; i < n; ++i) {
        const SurfacePoint p = seen(random(), random(), width / 200, cosine, 2 * pi * random(), sheared_u, sheared_v);
        const double wanted = mean_over(noise, p), got = double(map->scalar(p));
        wrong += (got - wanted) * (got - wanted) / n;
        bias += (got - wanted) / n;
        spread += (wanted - 0.5) * (wanted - 0.5) / n;
      }
      EXPECT_LT(wrong, 0.6 * spread) << width << " " << cosine;
      EXPECT_LT(std::abs(bias), 4 * std::sqrt(wrong / n)) << width << " " << cosine;
    }
}

// The mean of x^2 over any distribution around x is x^2 plus the distribution's variance: w^2 / 16 for a circle of diameter w,
// plus 1 / 6 on average for the interpolation between texels. This holds for circles that one of the halved images (mip levels)
// represents.
TEST(ImageFilter, BlursAsMuchAsACircleDoes) {
  const GreyImage bowl("bowl", 128, 128, [](int x, int) { return square(float(x) + 0.5f - 64); });
  const Ref<ObjectMap> map = bowl.map();
  for (const float squared : {0.0f, 12.0f, 60.0f}) {  // 4 (4^level - 1)
    double variance = 0;
    constexpr int n = 256;
    for (int i = 0; i < n; ++i) {  // evenly over texels
      const float x = 60 + 8 * (float(i) + 0.5f) / n;
      variance += double(map->scalar(seen(x / 128, 0.4f, std::sqrt(squared) / 128)) - square(x - 64)) / n;
    }
    EXPECT_NEAR(variance, double(squared) / 16 + 1 / 6.0, 2e-3) << squared;
  }
}

TEST(ImageFilter, KeepsTheMeanOfImagesOfAnySize) {
  test::Random texel(3), random(4);
  for (const auto& [w, h] : {std::pair(1, 1), {3, 3}, {7, 1}, {1, 6}, {63, 63}, {100, 37}, {64, 5}}) {
    const GreyImage image("odd", w, h, [&](int, int) { return texel(); });
    const GreyImage constant("constant", w, h, [](int, int) { return 0.7f; });
    for (const char* interpolation : {"nearest", "bilinear"}) {
      const Ref<ObjectMap> map = image.map("repeat", interpolation), same = constant.map("repeat", interpolation);
      EXPECT_NEAR(map->scalar(seen(0.3f, 0.8f, 300)), image.mean(), 1e-5) << w << "x" << h << interpolation;
      // The mean of the filtered image is that of the image.
      for (const float footprint : {0.02f, 0.2f}) {
        double sum = 0;
        constexpr int side = 64;
        for (int i = 0; i < side * side; ++i) {
          const float u = (float(i % side) + random()) / side, v = (float(i / side) + random()) / side;
          const SurfacePoint p = seen(u, v, footprint, 0.1f + 0.9f * random(), 6 * random());
          sum += double(map->scalar(p)) / (side * side);
          ASSERT_NEAR(same->scalar(p), 0.7f, 1e-5f);
        }
        EXPECT_NEAR(sum, image.mean(), 0.01) << w << "x" << h << interpolation << footprint;
      }
    }
  }
}

TEST(ImageFilter, HasNoSeamWhereTheImageIsRepeated) {
  test::Random texel(5), random(6);
  const GreyImage image("whole", 128, 128, [&](int, int) { return texel(); });
  const GreyImage rolled("rolled", 128, 128,
                         [&](int x, int y) { return image.texels[size_t((y + 64) % 128 * 128 + (x + 64) % 128)]; });
  const Ref<ObjectMap> map = image.map(), other = rolled.map(), mirrored = image.map("mirror");
  for (int i = 0; i < 300; ++i) {
    const float near = 0.1f * (random() - 0.5f), v = random(), footprint = 0.08f * random(), cosine = 0.1f + 0.9f * random();
    const SurfacePoint p = seen(near, v, footprint, cosine, 6 * random());
    SurfacePoint q = p, r = p;
    q.uv = {p.uv.x - 0.5f, p.uv.y + 0.5f};
    EXPECT_NEAR(map->scalar(p), other->scalar(q), 1e-4f);
    // A mirrored image is even about its border, and so is the ellipse after a reflection.
    r.uv.x = -r.uv.x;
    r.ray_direction.x = -r.ray_direction.x;
    EXPECT_NEAR(mirrored->scalar(p), mirrored->scalar(r), 1e-4f);
  }
}

TEST(ImageFilter, TakesACircleWhereTangentsSpanNoPlane) {
  test::Random texel(7);
  const GreyImage image("degenerate", 64, 64, [&](int, int) { return texel(); });
  const Ref<ObjectMap> map = image.map();
  const SurfacePoint circle = seen(0.4f, 0.6f, 0.1f);
  const float wanted = map->scalar(circle);
  for (const auto& [u, v] :
       {std::pair(Vector3{1, 0, 0}, Vector3{}), {Vector3{}, Vector3{0, 1, 0}}, {Vector3{1, 0, 0}, Vector3{1, 0, 0}}})
    EXPECT_NEAR(map->scalar(seen(0.4f, 0.6f, 0.1f, 0.05f, 1, u, v)), wanted, 1e-5f);
  for (const float footprint : {1e-30f, 1e-3f, 1e10f, 1e38f, infinity})
    for (const float length : {1e-30f, 1e-4f, 1e30f})
      for (const char* wrap : {"repeat", "mirror", "clamp", "black"})
        for (const float u : {0.5f, -1e30f, 3e9f}) {
          const float got =
              image.map(wrap)->scalar(seen(u, 0.5f, footprint, 0.01f, 1, {length, 0, 0}, {length, 1e-3f * length, 0}));
          EXPECT_TRUE(got >= 0 && got <= 1.0001f) << got << " " << footprint << " " << length << " " << wrap << " " << u;
        }
}

TEST(ImageFilter, KnowsPicturesThatAreSmallerThanTheirFrame) {
  // 80 x 90 pixels that begin at (30, 20) of a frame of 150 x 130, which begins at (-10, 5): white on black.
  const GreyImage image("frame", 80, 90, [](int, int) { return 1.0f; });
  ImageHeader header(80, 90, 1, NumberType::single);
  header.x = 20, header.y = 25;
  header.whole = {-10, 5, 140, 135};
  image.write(header);
  for (const char* interpolation : {"nearest", "bilinear"}) {
    const Ref<ObjectMap> map = image.map("repeat", interpolation);
    for (int y = 0; y < 130; y += 3)
      for (int x = 0; x < 150; x += 3) {
        const bool inside = x >= 30 && x < 110 && y >= 20 && y < 110;
        EXPECT_NEAR(map->scalar(seen((float(x) + 0.5f) / 150, 1 - (float(y) + 0.5f) / 130, 1e-6f)), inside ? 1 : 0, 1e-3f)
            << x << " " << y;
      }
  }
  EXPECT_NEAR(image.map()->scalar(seen(0, 0, 1000)), 80.0f * 90 / (150 * 130), 1e-5f);
}

/// Images with few different values are stored as bytes; an image that turns out to have more is converted to floats while it
/// is read.
TEST(ImageTexels, AreTheFilesHoweverManyDifferentNumbers) {
  for (const int different : {1, 3, 255, 256, 257, 4000}) {
    const GreyImage image("texels" + std::to_string(different), 80, 50,
                          [&](int x, int y) { return 0.001f * float((x + 80 * y) % different * (x + 80 * y) % different); });
    for (const char* wrap : {"repeat", "clamp", "black", "mirror"}) {
      const Ref<ObjectMap> exact = image.map(wrap, "nearest"), between = image.map(wrap);
      for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
          const float u = (float(x) + 0.5f) / float(image.width), v = 1 - (float(y) + 0.5f) / float(image.height);
          EXPECT_EQ(exact->scalar(seen(u, v, 0)), image.texels[size_t(y * image.width + x)]) << different << " " << wrap;
        }
      std::mt19937 random(7);
      std::uniform_real_distribution<float> inside(0.02f, 0.98f);
      for (int i = 0; i < 100; ++i) {
        const float u = inside(random), v = inside(random);
        EXPECT_NEAR(double(between->scalar(seen(u, v, 0))), image.at(double(u), double(v)), 1e-3) << different << " " << wrap;
      }
    }
  }
}

}  // namespace
}  // namespace etendue
