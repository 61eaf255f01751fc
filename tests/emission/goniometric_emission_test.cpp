// GoniometricEmission: power, samples and interpolation against sums over directions.

#include "etendue/emission_shader.h"
#include "etendue/scene_object.h"
#include "support/component_test_support.h"
#include "support/image_file.h"

namespace etendue {
namespace {

using test::create;
using test::ImageFile;

struct Case {
  std::string layout, interpolation;
  int width, height;
};
const Case cases[] = {{"lat_long", "nearest", 12, 6},
                      {"lat_long", "bilinear", 12, 6},
                      {"equal_area", "nearest", 8, 8},
                      {"equal_area", "bilinear", 8, 8}};

std::vector<float> pattern(int width, int height) {
  std::vector<float> rgb;
  for (int i = 0; i < width * height; ++i)
    for (int c = 0; c < 3; ++c) rgb.push_back(i % 5 == 0 ? 0 : float((7 * i) % 11));
  return rgb;
}

// References from uniform directions: the integral of the intensity, the integral of the pdf, and the expected number of
// samples in each octant.
TEST(GoniometricEmission, SamplesPowerAndDensityAreThoseOfTheIntensity) {
  for (const Case& c : cases) {
    const ImageFile file("gonio.exr", c.width, c.height, pattern(c.width, c.height));
    const auto e = create<EmissionShader>(
        "GoniometricEmission", {{"file", file.path}, {"layout", c.layout}, {"interpolation", c.interpolation}, {"scale", 2.0}});
    const Ref<SceneObject> point = create<SceneObject>("Point", {});
    point->transform = Transform::rotate(1.0, {1, 2, 3}) * Transform::scale({1, 1, -1});
    point->prepare();
    const SurfacePoint p = point->sample_area({0.5f, 0.5f}, 0).point;
    const Wavelengths w = test::wavelengths();
    test::Random random(7);
    constexpr int count = 60000;
    double power = 0, total = 0, drawn = 0, squares = 0;
    const auto octant = [](const Vector3& d) { return size_t((d.x > 0) + 2 * (d.y > 0) + 4 * (d.z > 0)); };
    std::vector<double> expected(8), counts(8);
    for (int i = 0; i < count; ++i) {
      const float z = 1 - 2 * random(), phi = 2 * pi * random(), r = safe_sqrt(1 - z * z);
      const Vector3 d{r * std::cos(phi), r * std::sin(phi), z};
      const float f = e->radiance(p, d, w)[0], pdf = e->pdf(p, d);
      if (f > 0) EXPECT_GT(pdf, 0);
      power += double(f) * 4 * M_PI / count;
      total += double(pdf) * 4 * M_PI / count;
      expected[octant(d)] += double(pdf) * 4 * M_PI / count * count;
      const DirectionSample s = e->sample(p, random.pair());
      EXPECT_EQ(e->pdf(p, s.direction), s.pdf);
      if (!(s.pdf > 0)) continue;  // rounded into a neighbouring texel
      ++counts[octant(s.direction)];
      const double value = double(e->radiance(p, s.direction, w)[0] / s.pdf);
      drawn += value / count;
      squares += value * value / count;
    }
    const std::string what = c.layout + " " + c.interpolation;
    EXPECT_NEAR(total, 1, 0.02) << what;
    EXPECT_NEAR(drawn, power, 0.02 * power) << what;
    EXPECT_NEAR(double(e->power(*point, w)[0]), power, 0.02 * power) << what;
    for (size_t i = 0; i < 8; ++i) EXPECT_NEAR(counts[i], expected[i], 0.05 * expected[i] + 100) << what;
    // With "nearest" interpolation the pdf is proportional to the intensity.
    if (c.interpolation == "nearest") EXPECT_LT(squares - drawn * drawn, 1e-3 * drawn * drawn) << what;
  }
}

// Light at a pole alone, where rows differ most in solid angle: the power is the integral of the intensity by the midpoint
// rule.
TEST(GoniometricEmission, RowsAtThePolesCountForWhatTheyLight) {
  for (const int rows : {1, 2, 4, 16}) {
    std::vector<float> rgb(size_t(8 * rows * 3));
    std::fill(rgb.begin(), rgb.begin() + 8 * 3, 1.0f);
    const ImageFile file("pole.exr", 8, rows, rgb);
    const auto e = create<EmissionShader>("GoniometricEmission",
                                          {{"file", file.path}, {"layout", "lat_long"}, {"interpolation", "bilinear"}});
    const Ref<SceneObject> point = create<SceneObject>("Point", {});
    const SurfacePoint p = point->sample_area({0.5f, 0.5f}, 0).point;
    const Wavelengths w = test::wavelengths();
    double power = 0;
    constexpr int steps = 20000;
    for (int i = 0; i < steps; ++i) {
      const double theta = M_PI * (i + 0.5) / steps;
      const Vector3 d{float(std::sin(theta)), float(std::cos(theta)), 0};
      power += 2 * M_PI * M_PI / steps * std::sin(theta) * double(e->radiance(p, d, w)[0]);
    }
    EXPECT_NEAR(double(e->power(*point, w)[0]), power, 1e-3 * power) << rows;
  }
}

TEST(GoniometricEmission, AnAmountTakesTheScalesPlace) {
  const ImageFile file("gonio.exr", 8, 8, pattern(8, 8));
  const auto of = [&](std::vector<test::Setting> settings) {
    settings.insert(settings.end(), {{"file", file.path}, {"layout", "equal_area"}});
    return create<EmissionShader>("GoniometricEmission", settings);
  };
  const Ref<SceneObject> point = create<SceneObject>("Point", {});
  double watts = 0;
  for (float lambda = 360; lambda < 830; lambda += 10) {
    Wavelengths w;
    for (int i = 0; i < spectrum_size; ++i) w.place(i, lambda + 5, 1 / 470.0f);
    watts += 10 * double(of({{"power", 30.0}})->power(*point, w)[0]);
  }
  EXPECT_NEAR(watts, 30, 0.05);
  EXPECT_THROW(create<EmissionShader>("GoniometricEmission",
                                      {{"file", ImageFile("wide.exr", 4, 2, pattern(4, 2)).path}, {"layout", "equal_area"}}),
               Error);
}

}  // namespace
}  // namespace etendue
