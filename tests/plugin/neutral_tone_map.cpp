// A tone map in one file, out of tree: the neutral curve for pictures of products after Khronos 2024.
#include <algorithm>
#include <array>

#include "etendue/describe/color.h"
#include "etendue/exposed_tone_map.h"

using namespace etendue;

// The Khronos PBR Neutral tone mapper (Khronos Group 2024, github.com/KhronosGroup/ToneMapping). A dielectric in white light of
// radiance 1 shows its base colour plus the Fresnel reflectance F at normal incidence. The curve subtracts F, so that the
// display shows the base colour, and compresses highlights alone. With x the least of R G B, each component loses
//   x - x^2 / (4 F)  where x < 2 F,   F elsewhere.
// Let p be the greatest component after that, s = start - F and d = 1 - s. Where p > s it becomes q = 1 - d^2 / (p + d - s),
// which has slope 1 at s and approaches 1. The colour is multiplied by q / p, then mixed with the grey q by the weight
//   g = 1 - 1 / (desaturation (p - q) + 1).
class NeutralToneMap final : public ExposedToneMap {
  float reflectance = 0.04f, start = 0.8f, desaturation = 0.15f;

 public:
  static void describe(Description<NeutralToneMap>& d) {
    d.summary("Shows the colours of products as they are, minus the haze of their gloss, and compresses highlights alone.",
              "Khronos Group 2024, PBR Neutral Tone Mapper")
        .group("Curve")
        .member<&NeutralToneMap::reflectance>("reflectance", "1", "Fresnel reflectance at normal incidence; it is subtracted",
                                              range(0, 0.2), Effect::retone)
        .member<&NeutralToneMap::start>("start", "1", "component, after the exposure, from which highlights are compressed",
                                        range(0, 0.99), Effect::retone)
        .member<&NeutralToneMap::desaturation>("desaturation", "1", "how fast highlights become white; 0: they keep their hue",
                                               range(0, 10), Effect::retone, soft(0, 1));
  }
  void prepare() override {
    if (start < 2 * reflectance) fail("start", "must be at least twice the reflectance");
  }

 protected:
  void develop(Image& xyz) const override {
    const RgbSpace& space = rgb_space(color_space);
    for (size_t i = 0; i + 2 < xyz.values.size(); i += 3) {
      double* v = &xyz.values[i];
      std::array<double, 3> rgb = product(space.from_xyz, {v[0], v[1], v[2]});
      // Colours outside the RGB space have negative components, for which the curve is not made.
      for (double& c : rgb) c = std::clamp(c, 0.0, 1e9);
      map_rgb(rgb);
      rgb = product(space.to_xyz, rgb);
      std::copy(rgb.begin(), rgb.end(), v);
    }
  }

 private:
  void map_rgb(std::array<double, 3>& rgb) const {
    const double f = double(reflectance), x = std::ranges::min(rgb);
    const double offset = x < 2 * f ? x - x * x / (4 * f) : f;
    for (double& c : rgb) c -= offset;
    const double p = std::ranges::max(rgb), s = double(start) - f, d = 1 - s;
    if (p <= s) return;
    const double q = 1 - d * d / (p + d - s), g = 1 - 1 / (double(desaturation) * (p - q) + 1);
    for (double& c : rgb) c = c * (q / p) * (1 - g) + q * g;
  }

  /// The product of a matrix, row major, and a column.
  static std::array<double, 3> product(const std::array<double, 9>& m, const std::array<double, 3>& v) {
    std::array<double, 3> r;
    for (size_t k = 0; k < 3; ++k) r[k] = m[3 * k] * v[0] + m[3 * k + 1] * v[1] + m[3 * k + 2] * v[2];
    return r;
  }
};

static const Register<NeutralToneMap> registered;
