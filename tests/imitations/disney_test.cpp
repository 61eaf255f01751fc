// DisneyPrincipled and DisneyThin, against the models that they reproduce.

#include "etendue/describe/color.h"
#include "etendue/object_map.h"
#include "etendue/shader.h"
#include "support/component_test_support.h"

namespace etendue::test {
namespace {

struct Row {
  std::vector<Setting> settings;
  double values[9];  // f |cos| [1/sr] for each pair of directions
};

/// The cosines of both directions, and the azimuth [rad] of the second one relative to the first, which has the azimuth 0.4
/// from the surface's u.
constexpr double directions[9][3] = {{0.9, 0.8, 3.14159265}, {0.5, 0.6, 3},   {0.2, 0.3, 1},
                                     {0.95, 0.4, 2},         {0.7, 0.7, 0.2}, {0.8, -0.7, 3.14159265},
                                     {0.3, -0.9, 2.5},       {-0.6, 0.8, 3},  {-0.7, -0.6, 3.1}};

Vector3 direction(double cosine, double turn) {
  const double s = std::sqrt(1 - cosine * cosine);
  return {float(s * std::cos(turn)), float(s * std::sin(turn)), float(cosine)};
}

void expect_rows(const char* name, const std::vector<Row>& rows) {
  Arena arena;
  for (size_t r = 0; r < rows.size(); ++r) {
    SurfacePoint p = surface_point({0, 0, 1});
    p.dpdu = {1, 0, 0};
    p.dpdv = {0, 1, 0};
    const Scatter& s = *create<Shader>(name, rows[r].settings)->bind(p, wavelengths(), arena);
    for (int i = 0; i < 9; ++i) {
      const auto& [a, b, turn] = directions[i];
      const auto value = [&](double side) {
        return double(
            s.evaluate(direction(side * a, 0.4), direction(side * b, 0.4 + turn), {.transport = Transport::importance})[0]);
      };
      // Mitsuba's model has a back only within `twosided`, where it looks the same; here an opaque surface always has both
      // sides.
      const double expected = a < 0 && b < 0 && rows[r].values[i] == 0 ? value(-1) : rows[r].values[i];
      EXPECT_NEAR(value(1), expected, 1e-3 * expected) << name << " row " << r << " pair " << i;
    }
  }
}

// eval() of Mitsuba 3.9.1, scalar_rgb, in importance mode, with grey colours.
TEST(DisneyPrincipled, IsThatOfMitsuba) {
  expect_rows(
      "DisneyPrincipled",
      {
          {std::vector<Setting>{}, {0.1724568, 0.2123684, 0.0554556, 0.06637123, 0.1126268, 0, 0, 0, 0}},
          {{{"roughness", 0.3}, {"metallic", 0.4}, {"base_color", 0.6}},
           {0.7281557, 0.7722889, 0.03480193, 0.04763458, 0.08117721, 0, 0, 0, 0}},
          {{{"roughness", 0.7}, {"spec_tint", 0.5}, {"metallic", 0.2}, {"base_color", 0.3}},
           {0.09193056, 0.10048, 0.03403191, 0.03884013, 0.05942695, 0, 0, 0, 0}},
          {{{"sheen", 0.8}, {"sheen_tint", 0.5}, {"roughness", 1.0}},
           {0.1305232, 0.1103008, 0.078458, 0.06960815, 0.1153006, 0, 0, 0, 0}},
          {{{"flatness", 0.7}, {"roughness", 0.8}}, {0.1118909, 0.1226669, 0.09463423, 0.0638878, 0.106286, 0, 0, 0, 0}},
          {{{"clearcoat", 0.9}, {"clearcoat_gloss", 0.3}, {"roughness", 0.6}},
           {0.1820979, 0.1821528, 0.06004675, 0.06867272, 0.1141915, 0, 0, 0, 0}},
          {{{"spec_trans", 0.8}, {"roughness", 0.5}, {"base_color", 0.4}, {"ior", 1.4}},
           {0.05199514, 0.1072965, 0.009310055, 0.01175181, 0.01852814, 0.1409001, 0, 0.02878531, 1.209322}},
          {{{"anisotropic", 0.7}, {"roughness", 0.45}, {"metallic", 0.9}, {"base_color", 0.7}},
           {1.025966, 0.6095201, 0.00997416, 0.0138714, 0.02789347, 0, 0, 0, 0}},
      });
}

TEST(DisneyThin, IsThatOfMitsuba) {
  expect_rows("DisneyThin",
              {
                  {std::vector<Setting>{}, {0.1273336, 0.09472966, 0.05464323, 0.06430777, 0.1116766, 0, 0, 0, 0.09540174}},
                  {{{"spec_trans", 0.7}, {"roughness", 0.4}, {"ior", 1.4}, {"base_color", 0.6}},
                   {0.08446953, 0.1341301, 0.01847712, 0.02344605, 0.04037121, 1.488494, 0.004917408, 0.1831824, 0.1254532}},
                  {{{"spec_trans", 0.5}, {"spec_tint", 0.6}, {"roughness", 0.5}, {"base_color", 0.3}, {"diff_trans", 0.8}},
                   {0.04490238, 0.06768683, 0.01023563, 0.01255349, 0.0205769, 0.5953181, 0.02334406, 0.1704448, 0.05461572}},
                  {{{"diff_trans", 1.2}, {"sheen", 0.5}, {"flatness", 0.4}, {"roughness", 0.9}},
                   {0.04555561, 0.04221217, 0.03420981, 0.02539106, 0.0428191, 0.06684507, 0.08594367, 0.07639437, 0.03826204}},
                  {{{"spec_trans", 0.9}, {"anisotropic", 0.6}, {"roughness", 0.6}},
                   {0.03530507, 0.05178538, 0.006338155, 0.007507802, 0.01310069, 1.466934, 0.01897828, 0.4057224, 0.04671509}},
              });
}

// A tint is the colour over its luminance: sheen alone, on black, has no tint, and sheen on a colour has a tint of luminance 1.
TEST(DisneyPrincipled, TintsHaveTheLuminanceOfGrey) {
  const Color red = rgb_color("srgb", 0.6, 0.2, 0.1);
  Arena arena;
  const auto seen = [&](double tint, const Wavelengths& w) {
    const Ref<Shader> shader = create<Shader>(
        "DisneyPrincipled", {{"base_color", red}, Setting{"spec_tint", tint}, {"roughness", 0.6}, {"metallic", 0.0}});
    return shader->bind(surface_point({0, 0, 1}), w, arena)->evaluate(direction(0.9999, 0), direction(0.999, M_PI));
  };
  // The tinted part along the normal: (F0 D G / 4 cos) times the tint, whose mean luminance under daylight is 1; the diffuse
  // part is the same in both.
  double with = 0, without = 0;
  const Color daylight = illuminant_spectrum("D65");
  for (int lambda = 380; lambda <= 780; lambda += 5) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, float(lambda), 1 / 470.0f);
    const double weight = observer(float(lambda)).y * double(daylight->at(float(lambda), ColorUse::radiance));
    with += weight * double(seen(1, w)[0]);
    without += weight * double(seen(0, w)[0]);
  }
  EXPECT_NEAR(with / without, 1, 2e-3);
  Wavelengths blue;
  for (int i = 0; i < spectrum_size; ++i) blue.place(i, 450, 1 / 470.0f);
  EXPECT_LT(seen(1, blue)[0], 0.9f * seen(0, blue)[0]);
}

double sent_away(const char* name, const std::vector<Setting>& settings, const Vector3& out) {
  SurfacePoint p = surface_point({0, 0, 1});
  p.dpdu = {1, 0, 0};
  p.dpdv = {0, 1, 0};
  Arena arena;
  const Scatter& s = *create<Shader>(name, settings)->bind(p, wavelengths(), arena);
  Random random(11);
  double sum = 0;
  constexpr int n = 20000;
  for (int i = 0; i < n; ++i)
    if (const auto sample = s.sample(out, random(), random.pair(), {.transport = Transport::importance}))
      sum += double(sample->weight[0]) / n;
  return sum;
}

// With all members at their brightest, no more light is reflected and transmitted than arrives, from any side.
TEST(DisneyPrincipled, SendsAwayNoMoreThanArrives) {
  for (const char* name : {"DisneyPrincipled", "DisneyThin"})
    for (const double roughness : {0.05, 0.4, 1.0})
      for (const double cosine : {0.03, 0.2, 0.5, 0.95}) {
        std::vector<Setting> settings{{"base_color", 1.0}, {"roughness", roughness}, {"sheen", 1.0}};
        if (std::string(name) == "DisneyThin")
          settings.insert(settings.end(), {{"diff_trans", 0.8}, {"spec_trans", 0.2}});
        else
          settings.insert(settings.end(), {{"clearcoat", 1.0}, {"clearcoat_gloss", 0.2}});
        const double sum = sent_away(name, settings, direction(cosine, 0.3));
        EXPECT_LT(sum, 1.01) << name << " " << roughness << " " << cosine;
        EXPECT_GT(sum, 0.75) << name << " " << roughness << " " << cosine;
      }
}

// With energy: kept, whose lobes are layers, a white material, half of it glass, scatters all light that arrives, from outside
// and inside: in a uniform environment of 1 it has the radiance 1, where Mitsuba's added lobes give 0.74.
TEST(DisneyPrincipled, KeepsAllLightWhereThatIsAskedFor) {
  for (const double glass : {0.0, 0.5, 1.0})
    for (const double roughness : {0.1, 0.3, 0.8})
      for (const double cosine : {0.2, 0.6, 0.95, -0.3, -0.9}) {
        if (cosine < 0 && glass == 0) continue;
        const double sum =
            sent_away("DisneyPrincipled",
                      {{"base_color", 1.0}, {"roughness", roughness}, {"spec_trans", glass}, {"energy", std::string("kept")}},
                      direction(cosine, 0.3));
        EXPECT_NEAR(sum, 1, 0.03) << glass << " " << roughness << " " << cosine;
      }
}

// Nor is there more light towards a lower index, where beyond the critical angle everything is reflected, in addition to the
// metal's and the coat's reflection; nor with anisotropic roughness.
TEST(DisneyPrincipled, SendsAwayNoMoreThanArrivesTowardsLowerIndices) {
  for (const double ior : {0.25, 0.5, 0.78, 0.95})
    for (const double roughness : {0.1, 0.5, 1.0})
      for (const double cosine : {0.05, 0.26, 0.6, 0.9, 1.0})
        for (const double tint : {0.0, 1.0})
          EXPECT_LT(sent_away("DisneyPrincipled",
                              {{"base_color", 0.6},
                               {"roughness", roughness},
                               {"ior", ior},
                               {"metallic", 0.4},
                               {"spec_tint", tint},
                               {"clearcoat", 1.0}},
                              direction(cosine, 0.3)),
                    1.01)
              << ior << " " << roughness << " " << cosine << " " << tint;
}

TEST(DisneyThin, SendsAwayNoMoreThanArrivesAlongGrooves) {
  for (const double turn : {0.0, 0.4, 1.5707})
    for (const double roughness : {0.2, 0.5, 1.0})
      for (const double cosine : {0.009, 0.1, 0.4})
        EXPECT_LT(sent_away("DisneyThin",
                            {{"base_color", 0.4},
                             {"roughness", roughness},
                             {"anisotropic", 1.0},
                             {"spec_trans", 1.0},
                             {"spec_tint", 0.7},
                             {"ior", 2.0}},
                            direction(cosine, turn)),
                  1.01)
            << turn << " " << roughness << " " << cosine;
}

// Without reflection among the requested lobes there is none, not even beyond the critical angle.
TEST(DisneyPrincipled, ReflectsOnlyWhereThatIsAskedFor) {
  Arena arena;
  const Scatter& s = *create<Shader>("DisneyPrincipled", {{"spec_trans", 0.8}, {"ior", 0.5}, {"roughness", 0.3}})
                          ->bind(surface_point({0, 0, 1}), wavelengths(), arena);
  Random random(3);
  // The diffuse lobe has a nonzero pdf in the direction of a reflection, which could let the reflection be accepted.
  constexpr Lobes lobes = diffuse_reflection | glossy_transmission;
  int refracted = 0;
  for (int i = 0; i < 2000; ++i)
    if (const auto sample = s.sample(direction(0.8, 0), random(), random.pair(), {.lobes = lobes})) {
      EXPECT_NE(sample->lobe, glossy_reflection);
      refracted += sample->lobe == glossy_transmission;
    }
  EXPECT_GT(refracted, 10);
}

}  // namespace
}  // namespace etendue::test
