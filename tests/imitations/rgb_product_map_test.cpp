// RgbProductMap.

#include <gtest/gtest.h>

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue::test {
namespace {

SurfacePoint at(float u, float v) {
  SurfacePoint p = surface_point({0, 0, 1});
  p.uv = {u, v};
  return p;
}

// r = f_r a_r b_r + g_r, and the spectrum of the resulting RGB: not the product of the spectra.
TEST(RgbProductMap, MultipliesRedGreenAndBlue) {
  const ImageFile a("a.exr", {1, 1, 3, NumberType::single}, {0.8f, 0.4f, 0.9f}),
      b("b.exr", {1, 1, 1, NumberType::single}, {0.5f});
  const auto image = [](const ImageFile& f) { return create<ObjectMap>("ImageMap", {{"file", f.path}}); };
  const std::vector<double> factor{1, 0.5, 0.25}, offset{0, 0.1, -0.2};
  const Ref<ObjectMap> map =
      create<ObjectMap>("RgbProductMap", {{"first", image(a)}, {"second", image(b)}, {"factor", factor}, {"offset", offset}});
  const float wanted[3] = {0.8f * 0.5f, 0.4f * 0.5f * 0.5f + 0.1f, 0};  // the last would be negative
  EXPECT_NEAR(map->scalar(at(0.5f, 0.5f)), (wanted[0] + wanted[1]) / 3, 1e-5f);
  const RgbSpace& space = rgb_space("srgb");
  for (const float hero : {380.0f, 450.0f, 590.0f})
    for (const ColorUse use : {ColorUse::reflectance, ColorUse::radiance, ColorUse::coefficient}) {
      const Wavelengths w = wavelengths(hero);
      const Spectrum got = map->color(at(0.5f, 0.5f), w, use),
                     of = rgb_spectrum(space, wanted[0], wanted[1], wanted[2], use, w);
      for (int i = 0; i < spectrum_size; ++i) EXPECT_NEAR(got[i], of[i], 1e-4f);
    }
  // The second factor is a colour's RGB under white light, a product's RGB numbers, or the grey of any other map.
  const Ref<ObjectMap> by_color = create<ObjectMap>(
      "RgbProductMap",
      {{"first", map}, {"second", create<ObjectMap>("ConstantMap", {{"value", rgb_color("srgb", 0.5, 1, 1)}})}});
  EXPECT_NEAR(by_color->scalar(at(0.5f, 0.5f)), (wanted[0] / 2 + wanted[1]) / 3, 2e-3f);
  const Ref<ObjectMap> by_grey = create<ObjectMap>(
      "RgbProductMap", {{"first", map}, {"second", create<ObjectMap>("AddMap", {{"first", 0.25}, {"second", 0.25}})}});
  EXPECT_NEAR(by_grey->scalar(at(0.5f, 0.5f)), (wanted[0] + wanted[1]) / 6, 1e-5f);
}

}  // namespace
}  // namespace etendue::test
