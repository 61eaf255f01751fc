// A crop is a part of the whole picture, not another picture.

#include <gtest/gtest.h>

#include <cmath>

#include "support/filter_support.h"
#include "support/render_support.h"

namespace etendue {
namespace {

constexpr int width = 50, height = 37;

/// Diffuse, specular, transparent and glossy objects, so that every renderer has something to show.
Ref<Job> room(const std::string& renderer, const Ref<Filter>& filter) {
  const Ref<Job> job = load_job_text("Job { renderer: " + renderer + R"(
        camera: PerspectiveCamera { from: [0.1, 0.2, -3.5] m, to: [0, 0, 0] m, fov: 50 deg }
        image: ImageBuffer { layers: ["normal", "depth", "object", "variance", "samples"], path_lengths: 2 }
        scene: BruteForceScene { objects: [
          Rectangle { corner: [-2, -1, -2] m, edge_u: [0, 0, 4] m, edge_v: [4, 0, 0] m,
                      shader: Lambertian { color: CheckerMap { repeat: [5, 5, 5] } } }
          Sphere { centre: [-0.7, -0.4, 0] m, radius: 0.6 m, shader: Dielectric { ior: 1.5 } }
          Sphere { centre: [0.8, -0.4, 0.2] m, radius: 0.6 m, shader: PhongShader { color: 0.3, specular: 0.5, exponent: 40 } }
          Rectangle { corner: [-0.5, 1.5, -0.5] m, edge_u: [1, 0, 0] m, edge_v: [0, 0, 1] m, shader: Lambertian { color: 0.5 }
                      emission: DiffuseEmission { radiance: 4, sides: both } }
          Point { transform: translate(0, 1 m, -2 m), emission: DiffuseEmission { radiance: 3 } }
        ] } })",
                                     "room.etd");
  job->image->width = width;
  job->image->height = height;
  job->image->filter = filter;
  return job;
}

Image render(const Ref<Job>& job, std::vector<int> crop, int threads = 0) {
  job->image->crop = std::move(crop);
  prepare_tree(*job);
  const auto done = test::rendered(job, {.threads = threads});
  EXPECT_EQ(done->film().bad_samples(), 0u);
  return done->picture();
}

/// Pieces with edges on and off the tiles' edges; one of them is a single pixel.
std::vector<std::vector<int>> pieces() {
  return {{0, 0, 16, height}, {16, 0, 33, 20},     {33, 0, width, 20},
          {16, 20, 17, 21},   {17, 20, width, 21}, {16, 21, width, height}};
}

/// The image put together from the pieces.
Image merged(const Ref<Job>& job) {
  Image all;
  std::vector<int> seen(size_t(width) * size_t(height));
  for (const std::vector<int>& crop : pieces()) {
    const Image piece = render(job, crop);
    if (all.channels.empty()) all = Image(width, height, piece.channels);
    EXPECT_EQ(piece.width, crop[2] - crop[0]);
    EXPECT_EQ(piece.height, crop[3] - crop[1]);
    for (int y = 0; y < piece.height; ++y)
      for (int x = 0; x < piece.width; ++x) {
        ++seen[size_t(y + crop[1]) * size_t(width) + size_t(x + crop[0])];
        for (size_t c = 0; c < piece.channels.size(); ++c) all.at(x + crop[0], y + crop[1], c) = piece.at(x, y, c);
      }
  }
  for (const int times : seen) EXPECT_EQ(times, 1);
  return all;
}

/// Whether a pixel's value depends on the samples of other pixels: the renderer splats, or its steps depend on each other.
bool knows_other_pixels(const std::string& renderer) {
  const Ref<Renderer> made = room(renderer + " {}", test::make_filter("BoxFilter"))->renderer;
  return made->splats() || made->steps_depend();
}

/// Every value of every channel is equal to the bit.
void expect_same(const Image& a, const Image& b, const std::string& what) {
  ASSERT_EQ(a.channels, b.channels) << what;
  size_t different = 0;
  for (size_t i = 0; i < a.values.size(); ++i) different += !(a.values[i] == b.values[i]);
  EXPECT_EQ(different, 0u) << what << ": of " << a.values.size() << " values";
}

std::vector<std::string> renderers() {
  std::vector<std::string> names;
  const Registry& registry = Registry::instance();
  const ClassInfo* interface = registry.find("Renderer");
  for (const ClassInfo* info : registry.subclasses(*interface))
    if (info != interface && info->provider.empty()) names.push_back(info->name);
  return names;
}

TEST(Crop, pieces_are_the_whole_to_the_bit_for_every_renderer) {
  size_t compared = 0;
  for (const std::string& name : renderers()) {
    if (knows_other_pixels(name)) continue;
    const Ref<Job> job = room(name + " { samples: 5 }", test::make_filter("GaussianFilter"));
    expect_same(merged(job), render(job, {}), name);
    ++compared;
  }
  EXPECT_GE(compared, 6u);
}

TEST(Crop, pieces_are_the_whole_to_the_bit_for_every_filter) {
  for (const Ref<Filter>& filter : test::all_filters()) {
    const Ref<Job> job = room("DirectRenderer { samples: 3 }", filter);
    expect_same(merged(job), render(job, {}), test::name(*filter));
  }
}

TEST(Crop, passes_of_the_whole_are_those_of_its_pieces) {
  // 512 x 512 pixels take passes of 2 samples, 9 x 9 of them passes of 4096: the sums must be made in the same order.
  const Ref<Job> job = room("FeatureRenderer { samples: 7 }", test::make_filter("MitchellFilter"));
  job->image->layers.clear();
  job->image->path_lengths = 0;
  job->image->width = job->image->height = 512;
  const Image whole = render(job, {});
  const std::vector<int> crop = {250, 301, 259, 310};
  const Image piece = render(job, crop);
  for (int y = 0; y < piece.height; ++y)
    for (int x = 0; x < piece.width; ++x)
      for (size_t c = 0; c < 3; ++c) EXPECT_EQ(piece.at(x, y, c), whole.at(x + crop[0], y + crop[1], c));
}

TEST(Crop, does_not_depend_on_threads) {
  const Ref<Job> job = room("PathTracer { samples: 9, max_depth: 3 }", test::make_filter("LanczosFilter"));
  expect_same(render(job, {10, 5, 29, 30}, 1), render(job, {10, 5, 29, 30}, 4), "threads");
}

// The contributions of light paths depend on which paths were traced: only those of the crop's pixels. Their mean is the same,
// also at the crop's edge. A piece and the whole are independent if their seeds differ; the standard error of each pixel's mean
// over 16 renders with different seeds comes from their spread. Significance 1e-4 over all pixels together: 4.9 errors for each
// of 48 pixels and 2 renderers (Student's distribution with 15 degrees of freedom exceeds 6.5 as rarely).
TEST(Crop, pieces_of_light_paths_have_the_means_of_the_whole) {
  constexpr int runs = 16;
  const std::vector<int> crop = {20, 12, 28, 18};
  for (const char* name : {"LightTracer", "BidirectionalPathTracer"}) {
    const Ref<Job> job = room(std::string(name) + " { samples: 24, max_depth: 3 }", test::make_filter("MitchellFilter"));
    job->image->layers.clear();
    job->image->path_lengths = 0;
    const size_t pixels = 8 * 6;
    std::vector<double> sum(pixels), square(pixels);
    for (int run = 0; run < runs; ++run) {
      job->seed = std::uint64_t(100 + run);
      const Image piece = render(job, crop);
      job->seed = std::uint64_t(200 + run);
      const Image whole = render(job, {});
      for (size_t i = 0; i < pixels; ++i) {
        const int x = int(i % 8), y = int(i / 8);
        const double difference = piece.at(x, y, 1) - whole.at(x + crop[0], y + crop[1], 1);
        sum[i] += difference;
        square[i] += difference * difference;
      }
    }
    for (size_t i = 0; i < pixels; ++i) {
      const double mean = sum[i] / runs, error = std::sqrt((square[i] / runs - mean * mean) / (runs - 1));
      EXPECT_LT(std::abs(mean), 6.5 * error + 1e-12) << name << " at " << i % 8 << ", " << i / 8;
    }
  }
}

}  // namespace
}  // namespace etendue
