// Denoising: the guide images, the paths of the denoised images, and the reduction of error.

#include "render/denoising.h"

#include <gtest/gtest.h>

#include <cmath>

#include "etendue/film/image_tools.h"
#include "support/render_support.h"

namespace etendue {
namespace {

Ref<Output> png() { return ref_cast<Output>(Registry::instance().create("PngOutput")); }

TEST(Denoising, NamesStandBesideThePictures) {
  const auto name = [](const std::string& file) {
    const Ref<Output> output = png();
    if (!file.empty()) output->file = FilePath{file, ""};
    return denoised_paths(with_denoising({output}), "folder.x/stem").at(0);
  };
  EXPECT_EQ(name(""), "folder.x/stem.denoised.png");
  EXPECT_EQ(name("a.b.png"), "a.b.denoised.png");
  EXPECT_EQ(name("some/plain"), "some/plain.denoised");
  EXPECT_TRUE(denoised_paths({png()}, "stem").empty());
}

TEST(Denoising, WrappedOutputsWriteThePictureWhereItWasToGo) {
  const Ref<Output> output = png();
  output->file = FilePath{"a.png", "folder"};
  output->tone_map = ref_cast<ToneMap>(Registry::instance().create("NoToneMap"));
  const std::vector<Ref<Output>> wrapped = with_denoising({output, nullptr});
  EXPECT_EQ(wrapped.at(0)->path("stem"), "folder/a.png");
  EXPECT_EQ(wrapped.at(0)->tone_map->class_info().name, "NoToneMap");
  EXPECT_TRUE(wrapped.at(0)->for_display());
  EXPECT_EQ(wrapped.at(1).get(), nullptr);
  // An output is not wrapped twice.
  EXPECT_EQ(with_denoising(wrapped).at(0).get(), wrapped.at(0).get());
  EXPECT_EQ(output->path("stem"), "folder/a.png") << "the one that was given was changed";
}

// ---- guides -----------------------------------------------------------------------------------------------------------------

struct Guides {
  Vector3 albedo, normal;  ///< means over all pixels
};

/// Guides of an image of 8 x 8 pixels seen from the origin towards +z, with rays nearly parallel to the axis.
Guides guides_of(const std::string& objects) {
  const Ref<Job> job = load_job_text(
      test::job_text("PathTracer {}", "PerspectiveCamera { from: [0, 0, 0] m, to: [0, 0, 1] m, fov: 4 deg }", 8, objects),
      "test.etd");
  prepare_tree(*job);
  const Image image = denoising_guides(*job, 256, 1);
  const std::vector<std::string> expected{"albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z"};
  EXPECT_EQ(image.channels, expected);
  double sums[6] = {};
  for (size_t i = 0; i < image.values.size(); ++i) sums[i % 6] += image.values[i] / 64;
  return {{float(sums[0]), float(sums[1]), float(sums[2])}, {float(sums[3]), float(sums[4]), float(sums[5])}};
}

/// A large rectangle perpendicular to the axis.
std::string sheet(const std::string& z, const std::string& material) {
  return "Rectangle { corner: [-50, -50, " + z + "] m, edge_u: [100, 0, 0] m, edge_v: [0, 100, 0] m, " + material + " }\n";
}
const std::string paint = "shader: Lambertian { color: rgb(0.7, 0.4, 0.2) }";

/// Expects a mean albedo of `share` of the paint plus `white`, and a mean normal.
void expect_guides(const std::string& objects, float share, float white, const Vector3& normal) {
  SCOPED_TRACE(objects);
  const Guides g = guides_of(objects);
  // 16384 samples of 8 wavelengths each: the colour noise is below 0.004.
  EXPECT_NEAR(g.albedo.x, 0.7f * share + white, 0.015f);
  EXPECT_NEAR(g.albedo.y, 0.4f * share + white, 0.015f);
  EXPECT_NEAR(g.albedo.z, 0.2f * share + white, 0.015f);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(g.normal[i], normal[i], 0.015f) << i;
}

TEST(Denoising, GuidesAreOfTheFirstSurfaceThatScattersToAllSides) {
  // A surface seen from its back: the normal is flipped towards the viewer.
  expect_guides(sheet("3", paint), 1, 0, {0, 0, -1});
  // A mirror has the guides of the wall behind the camera: the albedo times 0.8, and the wall's normal.
  expect_guides(sheet("2", "shader: PerfectSpecular { color: 0.8 }") + sheet("-3", paint), 0.8f, 0, {0, 0, 1});
  // A pane reflects R = 2 r / (1 + r) of light along its normal, with Fresnel's r = 0.04 of one boundary, and transmits the
  // rest (Stokes 1862); the reflected rays leave the scene, which counts as black.
  const float passed = 1 - 2 * 0.04f / 1.04f;
  expect_guides(sheet("2", "shader: ThinDielectric {}") + sheet("3", paint), passed, 0, {0, 0, -passed});
  // A slab of glass reflects and transmits the same, by all its internal reflections.
  expect_guides("Box { centre: [0, 0, 1.25] m, size: [100, 100, 0.5] m, shader: Dielectric {} }\n" + sheet("3", paint), passed,
                0, {0, 0, -passed});
}

TEST(Denoising, LuminairesAreWhiteAndNothingIsBlack) {
  expect_guides(sheet("3", "emission: DiffuseEmission { radiance: 7 }"), 0, 1, {0, 0, -1});
  expect_guides(sheet("-3", paint), 0, 0, {0, 0, 0});
  expect_guides("Environment { emission: DiffuseEmission { radiance: rgb(3, 1, 1) } }", 0, 1, {0, 0, 0});
  // Between two mirrors a path ends at its 32nd vertex, on the mirror behind the camera.
  expect_guides(sheet("2", "shader: PerfectSpecular { color: 0.5 }") + sheet("-2", "shader: PerfectSpecular { color: 0.5 }"), 0,
                0, {0, 0, 1});
}

TEST(Denoising, GuidesOfACropAreThoseOfTheWhole) {
  const auto guides = [](const std::vector<int>& crop) {
    const Ref<Job> job = load_job(ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd");
    job->image->width = job->image->height = 40;
    job->image->crop = crop;
    prepare_tree(*job);
    return denoising_guides(*job, 4, 2);
  };
  const Image whole = guides({}), part = guides({7, 20, 30, 33});
  ASSERT_EQ(part.width, 23);
  for (int y = 0; y < part.height; ++y)
    for (int x = 0; x < part.width; ++x)
      for (size_t c = 0; c < 6; ++c) ASSERT_EQ(part.at(x, y, c), whole.at(x + 7, y + 20, c)) << x << " " << y << " " << c;
}

// ---- the picture ------------------------------------------------------------------------------------------------------------

/// Halves the radiance, and reports a worker.
class HalvingDenoiser final : public Denoiser {
 public:
  std::string worker() const override { return "a pencil"; }
  Image denoised(const Image& picture, const Image&, int) const override {
    Image image = picture;
    for (size_t i = 0; i < image.values.size(); ++i)
      if (i % image.channels.size() < 3) image.values[i] /= 2;
    return image;
  }
  static void describe(Description<HalvingDenoiser>& d) { d.summary("Halves the light; for tests."); }
};
const Register<HalvingDenoiser> halving;

TEST(Denoising, TheTextsTellOfTheBiasAndLayersOfNoiseAreLeftOut) {
  const Ref<Job> job = load_job(ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd");
  job->image->width = job->image->height = 6;
  job->image->layers = {"variance", "depth"};
  job->image->path_lengths = 2;
  job->renderer->samples = 2;
  const Image picture = test::rendered(job)->picture();
  const Ref<Denoiser> denoiser = ref_cast<Denoiser>(Registry::instance().create("HalvingDenoiser"));
  const Image second = denoised(*denoiser, *job, picture, 1);
  EXPECT_EQ(second.channels, (std::vector<std::string>{"X", "Y", "Z", "depth.Z"}));
  EXPECT_EQ(picture.channels.back(), "depth.Z");
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 6; ++x) {
      for (size_t c = 0; c < 3; ++c) EXPECT_EQ(second.at(x, y, c), picture.at(x, y, c) / 2);
      EXPECT_EQ(second.at(x, y, 3), picture.at(x, y, picture.channels.size() - 1));
    }
  EXPECT_EQ(second.metadata.at("denoiser"), "HalvingDenoiser, a pencil");
  EXPECT_NE(second.metadata.at("bias").find("denoised"), std::string::npos);
  EXPECT_FALSE(picture.metadata.contains("bias"));
  EXPECT_EQ(second.metadata.at("seed"), picture.metadata.at("seed"));
}

TEST(Denoising, OpenImageDenoiseComesNearerToTheTruth) {
  const Ref<Denoiser> denoiser = ref_cast<Denoiser>(Registry::instance().create("OpenImageDenoiser"));
  try {
    denoiser->require();
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  const Ref<Job> job = load_job(ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd");
  job->image->width = job->image->height = 64;
  job->image->filter = ref_cast<Filter>(Registry::instance().create("BoxFilter"));
  job->renderer->samples = 8;
  const std::unique_ptr<Render> few = test::rendered(job);
  const Image picture = few->picture();
  const Image with = denoised(*denoiser, *job, picture, 1);
  denoiser->guide_samples = 0;
  const Image without = denoised(*denoiser, *job, picture, 1);
  const Ref<Job> reference = load_job(ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd");
  reference->image->width = reference->image->height = 64;
  reference->image->filter = job->image->filter;
  reference->renderer->samples = 256;
  reference->seed = 1;
  const Image truth = test::rendered(reference)->picture();
  const auto error = [&](const Image& image) { return compare(image, truth).relative_mean_square_error; };
  // Measured: see docs/denoising.md.
  EXPECT_LT(error(with), error(picture) / 4);
  EXPECT_LT(error(with), error(without));
  // The mean is preserved to 2 %.
  EXPECT_NEAR(compare(with, picture).channels.at(1).ratio, 1, 0.02);
}

}  // namespace
}  // namespace etendue
