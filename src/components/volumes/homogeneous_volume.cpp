// HomogeneousVolume: a medium that is the same everywhere.

#include <fmt/format.h>

#include "etendue/core/spectral_function.h"
#include "etendue/core/warp.h"
#include "etendue/volume_shader.h"

namespace etendue {
namespace {

// Phase function (Henyey & Greenstein 1941, "Diffuse radiation in the galaxy", eq. 2). With theta the angle between the
// ways light travels before and after, and g = mean of cos(theta),
//     p(theta) = (1 - g^2) / (4 pi (1 + g^2 - 2 g cos(theta))^(3/2))  [1/sr].
// Everything is written in h = 1 - cos(theta), found from the difference d of the two unit vectors as |d|^2 / 2, so that
// nothing cancels in the narrow peak of a large g:
//     1 + g^2 - 2 g cos(theta) = (1 - g)^2 + 2 g h.
// A negative g is the same function of the angle to the opposite way: below, g stands for its absolute value.
//
// Sampling. The probability of an angle up to theta is
//     P(h) = (1 - g^2) / (2 g) (1/(1 - g) - 1/s),  s = sqrt((1 - g)^2 + 2 g h).
// P(h) = u gives s = (1 - g)(1 + g) / q with q = 1 + g - 2 g u, and then
//     h = (s^2 - (1 - g)^2) / (2 g) = (1 - g)^2 u (1 + g + q) / q^2,
// in which g no longer divides: g = 0 gives h = 2u, the uniform sphere.
class HomogeneousVolume final : public VolumeShader {
 public:
  static void describe(Description<HomogeneousVolume>& d) {
    d.summary("A medium that is the same everywhere, with the Henyey-Greenstein phase function.",
              "Henyey & Greenstein 1941, Diffuse radiation in the galaxy")
        .member<&HomogeneousVolume::absorption>("absorption", "1/m", "absorption coefficient, per wavelength",
                                                Meaning::coefficient, soft(0.001, 1000), logarithmic)
        .member<&HomogeneousVolume::scattering>("scattering", "1/m", "scattering coefficient, per wavelength",
                                                Meaning::coefficient, soft(0.001, 1000), logarithmic)
        .member<&HomogeneousVolume::emission>("emission", "W m^-3 sr^-1 nm^-1",
                                              "radiance the medium adds per distance, whatever it absorbs", Meaning::radiance,
                                              soft(0.001, 1000), logarithmic)
        .member<&HomogeneousVolume::anisotropy>("anisotropy", "1",
                                                "mean cosine of the angle light turns by, between -1 (all back) and 1 (all "
                                                "straight on), both excluded; 0 scatters alike in all directions",
                                                range(-1, 1), when("scattering"));
  }

  void prepare() override {
    check("absorption", absorption, ColorUse::coefficient);
    check("scattering", scattering, ColorUse::coefficient);
    emits_ = check("emission", emission, ColorUse::radiance);
    if (!(std::abs(anisotropy) < 1)) fail("anisotropy", "must lie between -1 and 1, both excluded");
  }

  VolumeCoefficients coefficients(const Point3&, float, const Wavelengths& w) const override {
    return {absorption->evaluate(w, ColorUse::coefficient), scattering->evaluate(w, ColorUse::coefficient),
            emits_ ? emission->evaluate(w, ColorUse::radiance) : Spectrum()};
  }
  bool homogeneous() const override { return true; }
  bool emits() const override { return emits_; }
  Spectrum majorant(const Wavelengths& w) const override {
    return absorption->evaluate(w, ColorUse::coefficient) + scattering->evaluate(w, ColorUse::coefficient);
  }

  float phase(const Point3&, const Vector3& out, const Vector3& in) const override {
    return value(length_squared(in - peak(out)) / 2);
  }

  Vector3 sample_phase(const Point3&, const Vector3& out, Point2 u, float& density) const override {
    const float g = std::abs(anisotropy), q = 1 + g - 2 * g * u.x;
    const float h = std::min(square((1 - g) / q) * u.x * (1 + g + q), 2.0f), r = safe_sqrt(h * (2 - h));
    float sine = 0, cosine = 0;
    sin_cos_turn(u.y, sine, cosine);
    density = value(h);
    return Frame(Normal3(peak(out))).to_world({r * cosine, r * sine, 1 - h});
  }

  Color absorption = flat_spectrum(0), scattering = flat_spectrum(0), emission = flat_spectrum(0);
  float anisotropy = 0;

 private:
  /// Where most of the light goes that came from `out`: straight on, or back.
  Vector3 peak(const Vector3& out) const { return anisotropy < 0 ? out : -out; }

  /// p at an angle of 1 - cos = h to the peak.
  float value(float h) const {
    const float g = std::abs(anisotropy), d = square(1 - g) + 2 * g * h;
    return (1 - g) * (1 + g) / (4 * pi * d * std::sqrt(d));
  }

  /// Whether it is more than 0 anywhere; fails when it is negative.
  bool check(const char* member, const Color& color, ColorUse use) const {
    if (!color) fail(member, "a number, a colour or a spectrum is needed");
    if (color->imaginary()) fail(member, "must be real; this is a complex index of refraction");
    const ValueRange range = range_of(*color, use);
    const bool low = !(range.least >= 0);
    if (low || !(range.most < infinity))
      fail(member, fmt::format("must be neither negative nor infinite, and is {} at {} nm", low ? range.least : range.most,
                               low ? range.least_at : range.most_at));
    return range.most > 0;
  }

  bool emits_ = false;
};

const Register<HomogeneousVolume> registered;

}  // namespace
}  // namespace etendue
