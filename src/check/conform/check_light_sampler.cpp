// Checks of every light sampler: luminaires are chosen with the stated probabilities, and none that emits has probability zero.

#include <fmt/format.h>

#include "conformance.h"
#include "etendue/language/language.h"
#include "etendue/light_sampler.h"
#include "shader_trial.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

/// Luminaires of all kinds, near and far, strong and weak, and one that is black.
constexpr const char* varied = R"(EmbreeScene { objects: [
  Rectangle { transform: translate([0, 0, 2]), emission: DiffuseEmission { radiance: 3 } }
  Rectangle { transform: translate([3, 0, 1]), emission: DiffuseEmission { radiance: 0.1, sides: both } }
  Rectangle { transform: translate([-2, 1, -1]), emission: DiffuseEmission { radiance: 1, sides: back } }
  Sphere { centre: [1, 2, 0], radius: 0.3, emission: DiffuseEmission { radiance: 20 } }
  Sphere { centre: [-20, 5, 3], radius: 0.01, emission: DiffuseEmission { radiance: 1e4 } }
  Disc { transform: translate([0, -3, 0]), emission: CosineLobeEmission { radiance: 2 } }
  Point { position: [-1, -1, 1], emission: DiffuseEmission { radiance: 0.5 } }
  Point { position: [2, -1, 3], emission: SpotEmission { radiance: 5 } }
  Distant { direction: [1, -1, -2], emission: DiffuseEmission { radiance: 0.01 } }
  Environment { emission: EnvironmentEmission { radiance: 0.2 } }
  Sphere { centre: [4, 4, 4], radius: 0.5, emission: DiffuseEmission { radiance: 0 } }
  TriangleMesh { positions: [[-3, -3, 0], [-2, -3, 0], [-3, -2, 1]], triangles: [[0, 1, 2]],
                 emission: DiffuseEmission { radiance: 4, sides: both } }
] })";

Ref<Scene> scene_of(const std::string& text) {
  const Ref<Scene> scene = ref_cast<Scene>(parse_component(text, "luminaires"));
  prepare_tree(*scene);
  return scene;
}

class LightTrial {
 public:
  LightTrial(Trial& t, LightSampler& sampler, const std::string& text) : trial(t), sampler_(sampler), scene_(scene_of(text)) {
    sampler_.build(*scene_);
  }

  void check() {
    check_power();
    for (int i = trial.samples(40); i > 0; --i) {
      const Point3 p{8 * trial.uniform() - 4, 8 * trial.uniform() - 4, 6 * trial.uniform() - 2};
      check_point(p, i % 4 == 0 ? Normal3{} : Normal3(trial.direction()));
    }
  }

 private:
  static std::string name(const SceneObject& luminaire) {
    return fmt::format("luminaire {} (a {})", luminaire.luminaire_index(), luminaire.class_info().name);
  }

  /// Samples many times and compares with `said`, the probability of each luminaire, by a chi-square test.
  template <class C>
  void count(const std::string& where, const std::vector<double>& said, const C& choose, const std::string& check) {
    const int n = trial.samples(20000);
    std::vector<double> counts(said.size() + 1), expected;
    double sum = 0;
    for (const double p : said) {
      sum += p;
      expected.push_back(p * n);
    }
    expected.push_back(std::max(0.0, 1 - sum) * n);
    for (int i = 0; i < n; ++i) {
      const LightChoice c = choose(trial.uniform());
      if (!c.luminaire) {
        ++counts.back();
        continue;
      }
      const size_t k = size_t(c.luminaire->luminaire_index());
      if (!trial.expect(k < said.size(), "choices are luminaires of the scene", [&] { return where; })) return;
      ++counts[k];
      trial.expect(std::abs(double(c.probability) - said[k]) <= 1e-3 * said[k] + 1e-7,
                   "a choice's probability is that of its luminaire",
                   [&] { return fmt::format("{}, {}: {} and {}", where, name(*c.luminaire), c.probability, said[k]); });
    }
    const double p_value = statistics::chi_square(counts, expected, 10);
    trial.expect(p_value > Trial::significance, check, [&] { return fmt::format("{}: p = {:.2g}", where, p_value); });
  }

  void check_power() {
    std::vector<double> said;
    double sum = 0;
    for (const SceneObject* l : scene_->luminaires()) sum += said.emplace_back(double(sampler_.probability(*l)));
    trial.expect(std::abs(sum - (said.empty() ? 0 : 1)) < 1e-4, "probabilities without a point sum to 1",
                 [&] { return fmt::format("{} of {} luminaires", sum, said.size()); });
    count(
        "without a point", said, [&](float u) { return sampler_.choose(u); },
        "choices without a point have their probabilities");
    const Wavelengths w = spread_wavelengths(500);
    for (const SceneObject* l : scene_->luminaires())
      trial.expect(sampler_.probability(*l) > 0 || l->emission->power(*l, w).black(), "nothing that emits is left out",
                   [&] { return name(*l) + ", without a point"; });
  }

  void check_point(const Point3& p, const Normal3& normal) {
    const std::string where = fmt::format("at ({}, {}, {}), normal ({}, {}, {})", p.x, p.y, p.z, normal.x, normal.y, normal.z);
    std::vector<double> said;
    double sum = 0;
    for (const SceneObject* l : scene_->luminaires()) {
      const double probability = double(sampler_.probability(p, normal, *l));
      trial.expect(probability >= 0 && probability <= 1.0001, "probabilities are in [0, 1]",
                   [&] { return fmt::format("{}, {}: {}", where, name(*l), probability); });
      sum += said.emplace_back(probability);
      trial.expect(probability > 0 || !lights(*l, p), "nothing that emits is left out",
                   [&] { return where + ", " + name(*l) + ", which sends light there"; });
    }
    trial.expect(sum < 1.0001, "probabilities sum to at most 1", [&] { return fmt::format("{}: {}", where, sum); });
    count(where, said, [&](float u) { return sampler_.choose(p, normal, u); }, "choices have their probabilities");
  }

  /// Whether the luminaire illuminates a point from any of 16 points sampled on it.
  bool lights(const SceneObject& l, const Point3& from) {
    const Wavelengths w = spread_wavelengths(500);
    for (int i = 0; i < 16; ++i) {
      const SurfaceSample s = l.sample_visible(from, trial.pair(), 0);
      if (s.pdf > 0 && !l.emission->radiance(s.point, -s.direction, w).black()) return true;
    }
    return false;
  }

  Trial& trial;
  LightSampler& sampler_;
  Ref<Scene> scene_;
};

void check_light_sampler(Trial& trial) {
  LightSampler& sampler = trial.part<LightSampler>();
  const Ref<Scene> dark = scene_of("EmbreeScene { objects: [Sphere {}] }");
  sampler.build(*dark);
  trial.expect(!sampler.choose(0.5f).luminaire && !sampler.choose({}, {0, 0, 1}, 0.5f).luminaire,
               "without luminaires nothing is chosen");
  LightTrial(trial, sampler, "EmbreeScene { objects: [Sphere { emission: DiffuseEmission {} }] }").check();
  LightTrial(trial, sampler, "EmbreeScene { objects: [Environment { emission: EnvironmentEmission {} }] }").check();
  LightTrial(trial, sampler, varied).check();
}

const RegisterCheck<LightSampler> registered(check_light_sampler);

}  // namespace
}  // namespace etendue::conform
