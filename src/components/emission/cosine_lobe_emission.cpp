// CosineLobeEmission: light that falls off as a power of the cosine.

#include "axial_emission.h"

namespace etendue {
namespace {

// Profile f = cos(theta)^n = (1 - h)^n for h < 1 (AxialEmission), the generalized Lambertian source: n = 0 is a hemisphere of
// constant radiance, n = 1 the nominal pattern of many LEDs. Omega = 2 pi / (n + 1); for a lobe about a surface's normal,
// K = integral of cos^(n + 1) dw = 2 pi / (n + 2) on each side. The radiance is half of its maximum at
// cos(theta) = 2^(-1/n).
//
// Directions are sampled in proportion to f, and about a normal to f cos: with the pdf (m + 1) / (2 pi) cos^m, m = n or n + 1,
// by h = 1 - (1 - u)^(1 / (m + 1)), written with expm1 and log1p so that narrow lobes keep their precision.
class CosineLobeEmission final : public AxialEmission {
 public:
  CosineLobeEmission() { about = About::normal; }

  static void describe(Description<CosineLobeEmission>& d) {
    d.summary(
         "Light that falls off as a power of the cosine to the surface's normal, or to an axis: a diode, a reflector lamp. Its "
         "intensity falls to a half at the angle whose cosine is 2^(-1/n), with n the exponent, and n + 1 on a surface.",
         "Moreno & Sun 2008, Modeling the radiation pattern of LEDs")
        .group("Light")
        .member<&CosineLobeEmission::map>("radiance", "W m^-2 sr^-1 nm^-1",
                                          "radiance in the middle; only its shape counts when an amount is given",
                                          Meaning::radiance, soft(0.01, 1000), logarithmic);
    describe_amounts(d);
    d.group("Lobe")
        .member<&CosineLobeEmission::exponent>("exponent", "1",
                                               "the cosine's power, n; 0: the same radiance all over a hemisphere",
                                               range(0, 1e6), soft(1, 1000), logarithmic)
        .member<&CosineLobeEmission::about>("about", "", "what the lobe is about; a Point, which has no normal, takes the axis",
                                            choices("normal", "axis"))
        .member<&CosineLobeEmission::axis>(
            "axis", "1", "the middle of the lobe, the way its light travels, in the object's own coordinates; of any length");
  }

  void prepare() override {
    if (!(exponent >= 0 && std::isfinite(exponent))) fail("exponent", "must be a number no less than 0");
    prepare_axis();
    prepare_amounts("radiance");
  }

  float exponent = 1;

 protected:
  float fall_off(float h) const override { return h < 1 ? power(h, exponent) : 0; }
  double solid_angle() const override { return 2 * 3.14159265358979323846 / (double(exponent) + 1); }
  /// The h at which f is about exp(-40).
  double outer() const override { return std::min(1.0, 40 / (double(exponent) + 1e-3)); }

  float draw(float u, bool surface) const override {
    return -std::expm1(std::log1p(-u) / (exponent + (surface ? 2.0f : 1.0f)));
  }
  float drawn(float h, bool surface) const override {
    const float m = exponent + (surface ? 1.0f : 0.0f);
    return h < 1 ? (m + 1) / (2 * pi) * power(h, m) : 0;
  }

 private:
  static float power(float h, float m) { return std::exp(m * std::log1p(-h)); }
};

const Register<CosineLobeEmission> registered;

}  // namespace
}  // namespace etendue
