// Tests of all renderers that only trace rays from the camera: Whitted, distribution, direct light, ambient occlusion,
// features.

#include <gtest/gtest.h>

#include "etendue/render/job.h"
#include "support/simple_renderers_support.h"

namespace etendue::test {
namespace {

// Dispersive refraction is followed for the hero wavelength alone, which is weighted for all; the reflected branch at the same
// surface keeps all wavelengths.
TEST(SimpleRenderers, DispersionDropsSecondaryWavelengthsInItsBranchAlone) {
  const std::string lamps = "Rectangle { corner: [-9,-9,-3], edge_u: [18,0,0], edge_v: [0,18,0], emission: " + lit +
                            " }\nRectangle { corner: [-9,-9,5], edge_u: [18,0,0], edge_v: [0,18,0], emission: " + lit + " }";
  const Color glass = glass_index("N-SF11");
  const auto reflectance = [&](float wavelength) {
    const float n = glass->at(wavelength, ColorUse::coefficient);
    return square((n - 1) / (n + 1));
  };
  std::string prism = slab;
  prism.replace(prism.find("1.5"), 3, "glass(\"N-SF11\")");
  for (const char* renderer : {"WhittedRenderer { max_depth: 3 }", "DistributionRenderer { max_depth: 3, split_depth: 3 }",
                               "DistributionRenderer { max_depth: 3, split_depth: 3, specular_samples: 3 }"}) {
    SCOPED_TRACE(renderer);
    Ready ready(job_text(renderer, pinhole("[0,0,3]", "[0,0,0]"), 1, prism + lamps));
    std::array<Spectrum, 3> lengths{};
    const Wavelengths w = ready.sample(0, 0, 0, lengths).wavelengths;
    for (int i = 0; i < spectrum_size; ++i) {
      EXPECT_NEAR(lengths[1][i], reflectance(w[i]), 1e-5f);
      EXPECT_NEAR(lengths[2][i], i == 0 ? float(spectrum_size) * square(1 - reflectance(w[0])) : 0, 1e-4f);
    }
  }
  // A single boundary: the radiance above is that below over the squared index.
  Ready ready(job_text("DirectRenderer { shader_samples: 4096 }", pinhole("[0,0,3]", "[0,0,0]"), 1,
                       floor_of("Dielectric { ior: glass(\"N-SF11\") }") +
                           "Rectangle { corner: [-9,-9,-3], edge_u: [18,0,0], edge_v: [0,18,0], emission: " + lit + " }"));
  const auto s = ready.sample(0, 0, 0);
  const float n = glass->at(s.wavelengths[0], ColorUse::coefficient);
  // The lobe choice is stratified, so the fraction of refracted directions is exact to one of them.
  EXPECT_NEAR(s.value[0], float(spectrum_size) * (1 - reflectance(s.wavelengths[0])) / square(n), 2e-3f);
  for (int i = 1; i < spectrum_size; ++i) EXPECT_EQ(s.value[i], 0);
}

// ---- null-scattering surfaces -------------------------------------------------------------------------------------------

TEST(SimpleRenderers, AreNotDisturbedBySurfacesThatAreNotThere) {
  const std::string sheets = R"(
    Rectangle { corner: [-20,-20,0.4], edge_u: [40,0,0], edge_v: [0,40,0], shader: PassThrough {} }
    Sphere { centre: [0,0,0.3], radius: 4, shader: PassThrough {} }
    )";
  const std::string area = "Rectangle { corner: [-1,-1,1], edge_u: [2,0,0], edge_v: [0,2,0], emission: " + lit + " }";
  const std::string point = "Point { position: [0,0,2], emission: DiffuseEmission { radiance: 4 } }";
  const std::string camera = pinhole("[0,0,0.9]", "[0,0,0]"), objects = floor_of("Lambertian { color: 1 }") + sheets;
  for (const char* renderer :
       {"DirectRenderer { strategy: light, samples: 512 }", "DirectRenderer { strategy: shader, samples: 4096 }",
        "DirectRenderer { samples: 1024 }", "DistributionRenderer { max_depth: 2, samples: 256 }",
        "DistributionRenderer { max_depth: 2, split_depth: 0, samples: 1024 }"}) {
    SCOPED_TRACE(renderer);
    expect_value(measure(job_text(renderer, camera, 8, objects + area)), 1.740840 / double(pi));
  }
  for (const char* renderer :
       {"DirectRenderer {}", "WhittedRenderer { max_depth: 2 }", "DistributionRenderer { max_depth: 2 }"}) {
    SCOPED_TRACE(renderer);
    expect_flat(Ready(job_text(renderer, camera, 1, objects + point)).sample(0, 0, 0).value, inverse_pi);
  }
  expect_flat(Ready(job_text("WhittedRenderer { max_depth: 1 }", pinhole("[0,0,0.9]", "[0,0,2]"), 1, objects + area))
                  .sample(0, 0, 0)
                  .value,
              1);
}

TEST(SimpleRenderers, LengthsAddUpToTheSample) {
  for (const char* renderer :
       {"WhittedRenderer { max_depth: 6 }", "DistributionRenderer { max_depth: 6 }", "DirectRenderer {}",
        "AmbientOcclusionRenderer {}", "FeatureRenderer { feature: depth }", "FeatureRenderer { feature: albedo }"}) {
    Ready ready(job_text(renderer, room_camera, 8, room()));
    double light = 0;
    for (int i = 0; i < 64; ++i) {
      std::array<Spectrum, 8> lengths{};
      const Spectrum value = ready.sample(i % 8, i / 8, 0, lengths).value;
      Spectrum sum;
      for (const Spectrum& part : lengths) sum += part;
      for (int k = 0; k < spectrum_size; ++k) EXPECT_NEAR(sum[k], value[k], 1e-5f * (1 + std::abs(value[k]))) << renderer;
      light += double(value.average());
    }
    EXPECT_GT(light, 0) << renderer;
  }
}

TEST(SimpleRenderers, NoteFeaturesLikeThePathTracer) {
  const auto features = [](const char* renderer) {
    const Ref<Job> job = load_job_text(job_text(renderer, room_camera, 8, room()), "test.etd");
    job->image->layers = {"albedo", "normal", "depth", "object"};
    return rendered(job)->picture();
  };
  const Image expected = features("PathTracer { samples: 2 }");
  for (const char* renderer :
       {"WhittedRenderer { samples: 2 }", "DistributionRenderer { samples: 2 }", "DirectRenderer { samples: 2 }",
        "AmbientOcclusionRenderer { samples: 2 }", "FeatureRenderer { samples: 2 }"}) {
    const Image image = features(renderer);
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x)
        for (size_t channel = 3; channel < image.channels.size(); ++channel)
          ASSERT_EQ(image.at(x, y, channel), expected.at(x, y, channel)) << renderer << ' ' << image.channels[channel];
  }
}

TEST(SimpleRenderers, SayWhatTheyMiss) {
  const auto lost = [](const char* name, const std::vector<Setting>& settings, const SceneTraits& traits) {
    std::string text;
    for (const Advice& advice : create<Renderer>(name, settings)->misses(traits)) text += advice.lost + "; ";
    return text;
  };
  SceneTraits matt_room;
  matt_room.smooth = matt_room.diffuse = {"'wall'"};
  matt_room.areas = {"'lamp'"};
  EXPECT_NE(lost("WhittedRenderer", {}, matt_room).find("light of 'lamp' on 'wall'"), std::string::npos);
  EXPECT_NE(lost("DirectRenderer", {}, matt_room), "");
  EXPECT_EQ(lost("DistributionRenderer", {}, matt_room), "");
  EXPECT_NE(lost("DistributionRenderer", {{"diffuse_samples", 0.0}}, matt_room), "");
  EXPECT_NE(lost("AmbientOcclusionRenderer", {}, matt_room), "");
  EXPECT_NE(lost("FeatureRenderer", {}, matt_room), "");

  SceneTraits mirrors;
  mirrors.specular = {"'mirror'"};
  mirrors.areas = {"'lamp'"};
  EXPECT_EQ(lost("WhittedRenderer", {}, mirrors), "");
  EXPECT_EQ(lost("DistributionRenderer", {}, mirrors), "");
  EXPECT_NE(lost("DirectRenderer", {{"strategy", "light"}}, mirrors).find("sees in or through 'mirror'"), std::string::npos);

  SceneTraits bulb = matt_room;
  bulb.areas.clear();
  bulb.points = {"'bulb'"};
  EXPECT_EQ(lost("DistributionRenderer", {}, bulb), "");
  EXPECT_NE(lost("DirectRenderer", {{"strategy", "shader"}}, bulb).find("light of 'bulb'"), std::string::npos);
  bulb.specular = {"'glass'"};
  EXPECT_NE(lost("DistributionRenderer", {}, bulb).find("caustics"), std::string::npos);

  SceneTraits fog = mirrors;
  fog.media = {"'cloud'"};
  for (const char* name : {"WhittedRenderer", "DistributionRenderer", "DirectRenderer"})
    EXPECT_NE(lost(name, {}, fog).find("'cloud'"), std::string::npos) << name;
}

}  // namespace
}  // namespace etendue::test
