// Cryptomatte: hashes, coverages, and files.

#include "images/cryptomatte.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "etendue/core/error.h"
#include "render/mattes/mattes.h"
#include "support/render_support.h"

namespace etendue {
namespace {

// Published test vectors of MurmurHash3_x86_32 with the seed 0.
TEST(Cryptomatte, HashesAreMurmurs) {
  EXPECT_EQ(murmur_hash3(""), 0u);
  EXPECT_EQ(murmur_hash3("test"), 0xba6bd213u);
  EXPECT_EQ(murmur_hash3("Hello, world!"), 0xc0363e43u);
  EXPECT_EQ(murmur_hash3("The quick brown fox jumps over the lazy dog"), 0x2e4ff723u);
}

TEST(Cryptomatte, IdentifiersAreOrdinaryFloats) {
  int flipped = 0;
  for (int i = 0; i < 10000; ++i) {
    const std::string name = "object " + std::to_string(i);
    const std::uint32_t identifier = cryptomatte_identifier(name);
    EXPECT_TRUE(std::isnormal(std::bit_cast<float>(identifier)));
    flipped += identifier != murmur_hash3(name);
  }
  EXPECT_NEAR(flipped, 10000 * 2 / 256.0, 35);
}

Ref<Job> job(const std::string& filter = "BoxFilter {}", const std::string& crop = "") {
  std::string text =
      "left = Rectangle { corner: [-2, -2, 0] m, edge_u: [1.875, 0, 0] m, edge_v: [0, 2, 0] m, shader: red }\n"
      "right = Rectangle { corner: [-0.125, -2, 0] m, edge_u: [1.125, 0, 0] m, edge_v: [0, 2, 0] m, shader: red }\n"
      "pane = Rectangle { corner: [-2, 0, 1] m, edge_u: [4, 0, 0] m, edge_v: [0, 1, 0] m, shader: veil }\n"
      "veil = MaskShader { shader: Lambertian {}, opacity: 0.25 }\n"
      "red = Lambertian { color: 0.5 }\n"
      "Job {\n renderer: PathTracer { samples: 64, max_depth: 1 }\n"
      " camera: OrthographicCamera { from: [0, 0, 5] m, to: [0, 0, 0] m, width: 4 m }\n"
      " image: ImageBuffer { width: 16, height: 16, filter: " +
      filter + crop +
      " }\n scene: BruteForceScene { objects: [left, right, pane,\n"
      "  Rectangle { corner: [-2, 1, -1] m, edge_u: [4, 0, 0] m, edge_v: [0, 1, 0] m, shader: Lambertian {} }] }\n}\n";
  return load_job_text(text, "test.etd");
}

std::vector<Cryptomatte> mattes_of(const Ref<Job>& job, int threads = 2) {
  return render_mattes(Render(job, {.threads = threads}), threads, [](double) { return true; });
}

float coverage(const Cryptomatte& kind, const std::string& name, int x, int y) {
  return coverage_of(kind, kind.manifest.at(name))[size_t(y * kind.width + x)];
}

// Pixels are 0.25 m wide, and the camera looks along -z with x to the right and y up.
TEST(Cryptomatte, CoveragesAreTheAreasOfThePixel) {
  const std::vector<Cryptomatte> kinds = mattes_of(job());
  ASSERT_EQ(kinds.size(), 3u);
  const Cryptomatte &objects = kinds[0], &materials = kinds[1], &assets = kinds[2];
  EXPECT_EQ(objects.name, "crypto_object");
  EXPECT_EQ(objects.manifest.size(), 4u);
  EXPECT_TRUE(objects.manifest.contains("Rectangle 1"));
  EXPECT_EQ(materials.manifest.size(), 3u);
  EXPECT_EQ(assets.manifest, objects.manifest);
  // The edge at x = -0.125 m divides pixel 7; 64 stratified samples are exact.
  EXPECT_FLOAT_EQ(coverage(objects, "left", 7, 12), 0.5f);
  EXPECT_FLOAT_EQ(coverage(objects, "right", 7, 12), 0.5f);
  EXPECT_FLOAT_EQ(coverage(materials, "red", 7, 12), 1);
  EXPECT_FLOAT_EQ(coverage(objects, "left", 3, 12), 1);
  EXPECT_FLOAT_EQ(coverage(objects, "right", 14, 12), 0);
  // A quarter of the rays ends at the pane, with nothing behind it.
  double veiled = 0;
  for (int x = 0; x < 16; ++x) veiled += double(coverage(objects, "pane", x, 6)) / 16;
  EXPECT_NEAR(veiled, 0.25, 0.02);
}

TEST(Cryptomatte, CoveragesAreFilteredAndRanked) {
  const std::vector<Cryptomatte> kinds = mattes_of(job("GaussianFilter {}"));
  const Cryptomatte& objects = kinds[0];
  // Across the edge between left and right the filter's weights divide one by one; far from it there is one name.
  for (int x = 5; x < 10; ++x) EXPECT_NEAR(coverage(objects, "left", x, 12) + coverage(objects, "right", x, 12), 1, 1e-6) << x;
  EXPECT_GT(coverage(objects, "left", 6, 12), coverage(objects, "left", 7, 12));
  EXPECT_NEAR(coverage(objects, "left", 7, 12), 0.5, 0.03);
  for (const auto& pixel : objects.pixels)
    for (size_t i = 1; i < pixel.size(); ++i) EXPECT_GE(pixel[i - 1].coverage, pixel[i].coverage);
}

bool same(const Cryptomatte& a, const Cryptomatte& b) {
  return a.manifest == b.manifest && std::ranges::equal(a.pixels, b.pixels, [](const auto& p, const auto& q) {
           return std::ranges::equal(
               p, q, [](const auto& r, const auto& s) { return r.identifier == s.identifier && r.coverage == s.coverage; });
         });
}

TEST(Cryptomatte, BitsDoNotDependOnThreadsNorCrops) {
  const std::vector<Cryptomatte> one = mattes_of(job("GaussianFilter {}"), 1), two = mattes_of(job("GaussianFilter {}"), 2);
  for (size_t k = 0; k < 3; ++k) EXPECT_TRUE(same(one[k], two[k])) << k;
  const std::vector<Cryptomatte> part = mattes_of(job("GaussianFilter {}", ", crop: [5, 4, 10, 14]"));
  ASSERT_EQ(part[0].width, 5);
  for (int y = 0; y < 10; ++y)
    for (int x = 0; x < 5; ++x) {
      const auto& p = part[0].pixels[size_t(y * 5 + x)];
      const auto& q = one[0].pixels[size_t((y + 4) * 16 + x + 5)];
      ASSERT_EQ(p.size(), q.size()) << x << " " << y;
      for (size_t i = 0; i < p.size(); ++i) EXPECT_EQ(p[i].coverage, q[i].coverage) << x << " " << y;
    }
}

TEST(Cryptomatte, PicturesAreReadAsTheyWereWritten) {
  const std::vector<Cryptomatte> kinds = mattes_of(job("GaussianFilter {}"));
  const Image image = cryptomatte_image(kinds);
  const std::vector<Cryptomatte> again = cryptomattes_of(image);
  ASSERT_EQ(again.size(), 3u);
  for (const Cryptomatte& kind : kinds) {
    const auto found = std::ranges::find(again, kind.name, &Cryptomatte::name);
    ASSERT_NE(found, again.end()) << kind.name;
    EXPECT_TRUE(same(kind, *found)) << kind.name;
  }
  EXPECT_EQ(image.channels[0], "crypto_object00.R");
  // The first 7 digits of the hash of the kind's name.
  EXPECT_EQ(image.metadata.at("cryptomatte/f834d0a/conversion"), "uint32_to_float32");
  Image damaged = image;
  damaged.metadata["cryptomatte/f834d0a/manifest"] = "{\"left\": \"12\"}";
  EXPECT_THROW(cryptomattes_of(damaged), Error);
  damaged = image;
  damaged.channels[1] = "other";
  EXPECT_THROW(cryptomattes_of(damaged), Error);
}

}  // namespace
}  // namespace etendue
