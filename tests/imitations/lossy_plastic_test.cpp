// LossyPlastic, against the model that it reproduces.

#include "etendue/object_map.h"
#include "etendue/shader.h"
#include "support/component_test_support.h"
#include "support/shader_test_support.h"

namespace etendue::test {
namespace {

TEST(LossyPlastic, IsThatOfMitsuba) {
  struct Row {
    const char* distribution;
    double roughness;
    bool nonlinear;
    double color, tint, cosine_out, cosine_in, turn;  // turn [rad]: azimuth between the two directions
    double value;                                     // f |cos| [1/sr]
  };
  // eval() of roughplastic and, without roughness, of plastic (its diffuse part) of Mitsuba 3.9.1, scalar_rgb, with the default
  // indices of refraction.
  const Row rows[] = {
      {"beckmann", 0.1, false, 0.5, 1, 0.9, 0.8, M_PI, 0.2676613},
      {"beckmann", 0.1, false, 0.5, 1, 0.5, 0.6, 3, 0.3496791},
      {"beckmann", 0.1, false, 0.5, 1, 0.2, 0.3, 3.1, 4.262763},
      {"beckmann", 0.1, false, 0.5, 1, 0.95, 0.3, 1, 0.03870053},
      {"beckmann", 0.1, false, 0.5, 1, 0.05, 0.6, 2, 0.04201746},
      {"beckmann", 0.1, false, 0.5, 1, 0.7, 0.7, M_PI, 0.6687214},
      {"beckmann", 0.4, true, 0.8, 0.7, 0.9, 0.8, M_PI, 0.1509646},
      {"beckmann", 0.4, true, 0.8, 0.7, 0.5, 0.6, 3, 0.1406616},
      {"beckmann", 0.4, true, 0.8, 0.7, 0.2, 0.3, 3.1, 0.3834488},
      {"beckmann", 0.4, true, 0.8, 0.7, 0.95, 0.3, 1, 0.0460071},
      {"beckmann", 0.4, true, 0.8, 0.7, 0.05, 0.6, 2, 0.07915539},
      {"beckmann", 0.4, true, 0.8, 0.7, 0.7, 0.7, M_PI, 0.1398837},
      {"beckmann", 1, false, 0.3, 0, 0.9, 0.8, M_PI, 0.03872228},
      {"beckmann", 1, false, 0.3, 0, 0.5, 0.6, 3, 0.02592721},
      {"beckmann", 1, false, 0.3, 0, 0.2, 0.3, 3.1, 0.009716854},
      {"beckmann", 1, false, 0.3, 0, 0.95, 0.3, 1, 0.01244352},
      {"beckmann", 1, false, 0.3, 0, 0.05, 0.6, 2, 0.01898452},
      {"beckmann", 1, false, 0.3, 0, 0.7, 0.7, M_PI, 0.03255866},
      {"ggx", 0.01, false, 0.5, 1, 0.9, 0.8, M_PI, 0.1298466},
      {"ggx", 0.01, false, 0.5, 1, 0.5, 0.6, 3, 0.0928287},
      {"ggx", 0.01, false, 0.5, 1, 0.2, 0.3, 3.1, 0.1506639},
      {"ggx", 0.01, false, 0.5, 1, 0.95, 0.3, 1, 0.03915014},
      {"ggx", 0.01, false, 0.5, 1, 0.05, 0.6, 2, 0.02573441},
      {"ggx", 0.01, false, 0.5, 1, 0.7, 0.7, M_PI, 56.32959},
      {"ggx", 0.4, true, 0.9, 0.5, 0.9, 0.8, M_PI, 0.140473},
      {"ggx", 0.4, true, 0.9, 0.5, 0.5, 0.6, 3, 0.1131312},
      {"ggx", 0.4, true, 0.9, 0.5, 0.2, 0.3, 3.1, 0.1741981},
      {"ggx", 0.4, true, 0.9, 0.5, 0.95, 0.3, 1, 0.0428077},
      {"ggx", 0.4, true, 0.9, 0.5, 0.05, 0.6, 2, 0.06643391},
      {"ggx", 0.4, true, 0.9, 0.5, 0.7, 0.7, M_PI, 0.1253626},
      {"ggx", 1, false, 0.5, 1, 0.9, 0.8, M_PI, 0.04755001},
      {"ggx", 1, false, 0.5, 1, 0.5, 0.6, 3, 0.02825951},
      {"ggx", 1, false, 0.5, 1, 0.2, 0.3, 3.1, 0.02160033},
      {"ggx", 1, false, 0.5, 1, 0.95, 0.3, 1, 0.01253981},
      {"ggx", 1, false, 0.5, 1, 0.05, 0.6, 2, 0.01816701},
      {"ggx", 1, false, 0.5, 1, 0.7, 0.7, M_PI, 0.03665273},
      {"ggx", 0, false, 0.5, 1, 0.9, 0.8, 1, 0.1288704},
      {"ggx", 0, false, 0.5, 1, 0.5, 0.1, 1, 0.006868388},
      {"ggx", 0, false, 0.5, 1, 0.05, 0.6, 1, 0.02448431},
      {"ggx", 0, true, 0.8, 1, 0.9, 0.8, 1, 0.1600408},
      {"ggx", 0, true, 0.8, 1, 0.5, 0.1, 1, 0.008529673},
      {"ggx", 0, true, 0.8, 1, 0.05, 0.6, 1, 0.03040643},
  };
  Arena arena;
  for (const Row& row : rows) {
    const Ref<Shader> shader = create<Shader>("LossyPlastic", {{"distribution", row.distribution},
                                                               {"roughness", row.roughness},
                                                               {"color", row.color},
                                                               {"reflection_tint", row.tint},
                                                               {"ior", 1.49 / 1.000277}});
    set(*shader, "nonlinear", Value(row.nonlinear));
    shader->prepare();
    const Scatter& s = *shader->bind(surface_point(), wavelengths(), arena);
    const Vector3 out = at_angle(s.frame(), std::acos(row.cosine_out) * 180 / M_PI, 0),
                  in = at_angle(s.frame(), std::acos(row.cosine_in) * 180 / M_PI, row.turn);
    // For the internal diffuse reflectance of a smooth coat Mitsuba uses a fit, from which the diffuse part here differs by
    // 1.2e-3.
    EXPECT_NEAR(double(s.evaluate(out, in)[0]), row.value, (row.roughness > 0 ? 1e-3 : 1.5e-3) * row.value)
        << row.distribution << " " << row.roughness << " at " << row.cosine_out << " " << row.cosine_in;
  }
}

// With a white body, under diffuse light: from 10^6 samples of Mitsuba 3.9.1 (standard error 1e-4); a smooth coat loses
// nothing.
TEST(LossyPlastic, LosesWhatMeetsMoreThanOneFacet) {
  struct Row {
    double roughness, albedo;
  };
  for (const Row& row : {Row{0, 1}, Row{0.1, 0.9066}, Row{0.4, 0.5900}, Row{1, 0.2891}}) {
    const Ref<Shader> shader = create<Shader>(
        "LossyPlastic", {{"roughness", row.roughness}, {"color", 1.0}, {"distribution", "ggx"}, {"ior", 1.49 / 1.000277}});
    set(*shader, "nonlinear", Value(true));
    shader->prepare();
    Arena arena;
    const Scatter& s = *shader->bind(surface_point(), wavelengths(), arena);
    Random random(4);
    double sampled = 0, told = 0;
    constexpr int n = 40000;
    for (int i = 0; i < n; ++i) {
      const Vector3 out = at_angle(s.frame(), std::acos(std::sqrt(double(random()))) * 180 / M_PI);  // diffuse light
      if (const auto sample = s.sample(out, random(), random.pair())) sampled += double(sample->weight[0]) / n;
      told += double(s.albedo(out)[0]) / n;
    }
    EXPECT_NEAR(sampled, row.albedo, 0.004) << row.roughness;
    EXPECT_NEAR(told, sampled, 0.005) << row.roughness;
  }
}

}  // namespace
}  // namespace etendue::test
