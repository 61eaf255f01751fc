#pragma once
// Shared by tests of replayed samples and of advice: scenes with caustics, and a renderer with splats and bad samples.

#include <regex>

#include "render_support.h"

namespace etendue::replay_test {

inline const char* const camera = "PerspectiveCamera { from: [0, 2, -6] m, to: [0, 0, 0] m, fov: 45 deg }";
inline const char* const floor_disc =
    R"(Disc { radius: 5 m, transform: translate(0, -1 m, 0) * rotate(-90, "x"), shader: Lambertian { color: 0.6 } })";
inline const char* const glass_ball = R"(Sphere { radius: 1 m, shader: Dielectric { ior: glass("N-SF11") } })";
inline const char* const round_lamp =
    "Sphere { centre: [1, 3, 0] m, radius: 0.3 m, emission: DiffuseEmission { radiance: 50 } }";

inline std::string objects(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) text += part + "\n";
  return text;
}

inline Ref<Job> loaded(const std::string& text) { return load_job_text(text, "test.etd"); }
inline Ref<Job> prepared(const std::string& text) {
  Ref<Job> job = loaded(text);
  prepare_tree(*job);
  return job;
}

/// A lamp whose light a dispersive glass ball concentrates on a floor: many dim paths, and a few bright ones.
inline std::string glass_text(int samples) {
  return test::job_text(
      "PathTracer { samples: " + std::to_string(samples) + " }", camera, 16,
      objects({floor_disc, glass_ball, round_lamp, "Environment { emission: DiffuseEmission { radiance: 0.1 } }"}));
}

inline constexpr int px = 6, py = 10;  // a pixel in the caustic on the floor

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline const char* const lamp_and_ball = R"(lamp = Point { position: [1, 3, 0] m, emission: DiffuseEmission { radiance: 20 } }
ball = Sphere { radius: 1 m, shader: Dielectric { ior: 1.5 } }
)";

inline std::string point_scene(const std::string& renderer, const std::vector<std::string>& parts) {
  return lamp_and_ball + test::job_text(renderer, camera, 4, objects(parts));
}

/// Adds a little light to its own pixel and much to two film points, one of which lies outside the image. Some samples are NaN,
/// and some are negative at one wavelength.
class Sprinkler final : public Renderer {
 public:
  static void describe(Description<Sprinkler>& d) { d.summary("For tests: splats much light, some of it bad."); }
  Spectrum radiance(const RenderContext&, const Ray&, SampleContext& sample) const override {
    const float u = sample.numbers.next();
    Spectrum own(0.001f * u);
    if (u < 0.12f)
      own.set(1, std::numeric_limits<float>::quiet_NaN());
    else if (u < 0.25f)
      own.set(1, -0.0001f);  // the XYZ of the whole spectrum is still positive
    for (const Point2 film : {Point2(2.5f, 3.25f), Point2(-4.0f, 3.0f)}) {
      sample.sink.splat(film, Spectrum(u), sample.wavelengths, 3);
      if (sample.sink.record)
        sample.sink.record->contributions.push_back({"1 from the luminaire", 3, 1, Spectrum(u), film, true});
    }
    if (sample.sink.record) sample.sink.record->contributions.push_back({"met", 1, 1, own, {}, false});
    return own;
  }
};

/// A job with the Sprinkler. Its class is registered without a constructor, so that tests of all renderers do not find it.
inline Ref<Job> sprinkled(const std::string& text, int samples) {
  static RegistrationNode node{typeid(Sprinkler), typeid(Renderer),
                               [](ClassInfo& info) {
                                 Description<Sprinkler> d(info);
                                 Sprinkler::describe(d);
                                 d.finish();
                               },
                               nullptr, nullptr};
  [[maybe_unused]] static const bool known = (enlist(node), true);
  Ref<Job> job = loaded(text);
  job->renderer = Ref<Renderer>(new Sprinkler);
  job->renderer->samples = samples;
  return job;
}

struct Listed {
  int x = 0, y = 0;
  std::uint32_t sample = 0;
  double luminance = 0, ratio = 0;
};

/// The samples that `fireflies_text` lists.
inline std::vector<Listed> listed_in(const std::string& text) {
  std::vector<Listed> list;
  const std::regex line(R"(--pixel (\d+),(\d+) --sample (\d+)    # Y ([0-9.e+-]+)[^\n]*, ([0-9.e+-]+) times its pixel's)");
  for (std::sregex_iterator at(text.begin(), text.end(), line), end; at != end; ++at)
    list.push_back({std::stoi((*at)[1]), std::stoi((*at)[2]), std::uint32_t(std::stoul((*at)[3])), std::stod((*at)[4]),
                    std::stod((*at)[5])});
  return list;
}

}  // namespace etendue::replay_test
