// Files that several threads read before anything is prepared.

#include <gtest/gtest.h>

#include "etendue/language/language.h"
#include "etendue/render/job.h"
#include "support/image_file.h"
#include "support/process.h"
#include "support/render_support.h"

namespace etendue {
namespace {

/// Panes side by side in front of the camera, each with an image; the images are `files` files in turn.
Ref<Job> gallery(const TemporaryFolder& folder, int panes, int files) {
  std::string text;
  for (int i = 0; i < panes; ++i)
    text += "  Rectangle { corner: [" + std::to_string(i) + ", 0, 0], edge_u: [1, 0, 0], edge_v: [0, 1, 0], emission: " +
            "DiffuseEmission { radiance: ReadAsMap { as: coefficient, map: ImageMap { file: \"" +
            (folder / ("image" + std::to_string(i % files) + ".exr")) + "\" } } } }\n";
  return load_job_text("Job { renderer: PathTracer { samples: 16 }\ncamera: OrthographicCamera { from: [" +
                           std::to_string(panes / 2.0) + ", 0.5, 5], to: [" + std::to_string(panes / 2.0) +
                           ", 0.5, 0], width: " + std::to_string(panes) +
                           " m }\nimage: ImageBuffer { width: " + std::to_string(panes) +
                           ", height: 1, filter: BoxFilter {} }\nscene: BvhScene { objects: [\n" + text + "] } }",
                       "gallery.etd", folder.path());
}

TEST(ReadAhead, EveryMapHasItsOwnFile) {
  const TemporaryFolder folder;
  constexpr int files = 7, panes = 30;
  for (int i = 0; i < files; ++i)
    test::write_image(folder.write("image" + std::to_string(i) + ".exr", ""), {4, 4, 3, NumberType::single},
                      std::vector<float>(size_t(4 * 4 * 3), float(i + 1)));
  const Image image = test::rendered(gallery(folder, panes, files))->picture();
  ASSERT_EQ(image.width, panes);
  for (int i = 0; i < panes; ++i) EXPECT_NEAR(image.at(i, 0, 1), i % files + 1, 0.05) << i;
}

TEST(ReadAhead, WhatIsWrongIsToldAtItsPlaceAndTheFirstOfAll) {
  const TemporaryFolder folder;
  for (int i = 0; i < 5; ++i)
    test::write_image(folder.write("image" + std::to_string(i) + ".exr", ""), {4, 4, 3, NumberType::single},
                      std::vector<float>(size_t(4 * 4 * 3), 1.0f));
  folder.write("image2.exr", "this is no image");
  folder.write("image4.exr", "nor is this");
  for (int again = 0; again < 5; ++again) {
    try {
      test::rendered(gallery(folder, 5, 5));
      FAIL() << "an image that is none was read";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("image2.exr"), std::string::npos) << error.what();
      EXPECT_EQ(error.location.line, 7);
    }
  }
}

}  // namespace
}  // namespace etendue
