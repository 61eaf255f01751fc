// A medium out of tree: the air of a planet, thinner with height, which scatters blue light more than red.
#include "etendue/core/spectral_function.h"
#include "etendue/describe/description.h"
#include "etendue/volume_shader.h"

using namespace etendue;

// Air of one temperature is in hydrostatic balance when its density falls as exp(-h / H) with the height h, H = R T / (M g)
// being the scale height (8.4 km at 288 K). Molecules scatter in proportion to the fourth power of the frequency (Rayleigh
// 1871):
//     s_s(h) = s_0 (550 nm / lambda)^4 exp(-h / H),     s_a(h) = a exp(-h / H),
// with s_0 = 1.15e-5 / m for air at the ground (Bucholtz 1995). The optical depth of all air above h is (s_s(h) + s_a(h)) H.
// Below the ground the density is that at the ground: so h = 0 is the majorant.
//
// The phase function is 3 / (16 pi) (1 + c^2) [1/sr], c = cos(theta). The probability that the cosine is less than c is
// (4 + 3 c + c^3) / 8 = u, so that c^3 + 3 c = 8 u - 4, which c = 2 sinh(asinh(4 u - 2) / 3) solves.
class RayleighAtmosphere final : public VolumeShader {
  float scattering = 1.15e-5f, scale_height = 8400, radius = 0;
  Color absorption = flat_spectrum(0);

 public:
  static void describe(Description<RayleighAtmosphere>& d) {
    d.summary("The air of a planet, thinner with height; it scatters as molecules do.",
              "Bucholtz 1995, Rayleigh-scattering calculations for the terrestrial atmosphere")
        .member<&RayleighAtmosphere::scattering>("scattering", "1/m", "scattering coefficient at the ground, at 550 nm",
                                                 at_least(0), soft(1e-6, 1e-3), logarithmic)
        .member<&RayleighAtmosphere::absorption>("absorption", "1/m", "absorption coefficient at the ground, per wavelength",
                                                 Meaning::coefficient, soft(1e-6, 1e-3), logarithmic)
        .member<&RayleighAtmosphere::scale_height>("scale_height", "m", "height in which the density falls to 1/e",
                                                   more_than(0), soft(1, 10000), logarithmic)
        .member<&RayleighAtmosphere::radius>(
            "radius", "m",
            "of the planet, around the origin of the object's own coordinates; 0: the ground is "
            "the plane y = 0",
            at_least(0), soft(0, 1e7));
  }
  void prepare() override {
    if (!absorption) fail("absorption", "is none");
    if (absorption->imaginary()) fail("absorption", "must be real; this is a complex index of refraction");
    const ValueRange values = range_of(*absorption, ColorUse::coefficient);
    if (!(values.least >= 0 && values.most < infinity)) fail("absorption", "must be neither negative nor infinite");
    if (!std::isfinite(scattering)) fail("scattering", "must be finite");
    if (!std::isfinite(radius)) fail("radius", "must be finite");
  }

  bool homogeneous() const override { return false; }
  VolumeCoefficients coefficients(const Point3& p, float, const Wavelengths& w) const override {
    const float height = radius > 0 ? length(p - Point3{}) - radius : p.y;
    const float density = std::exp(-std::max(height, 0.0f) / scale_height);
    VolumeCoefficients c = ground(w);
    c.scattering *= density;
    c.absorption *= density;
    return c;
  }
  Spectrum majorant(const Wavelengths& w) const override { return ground(w).extinction(); }

  float phase(const Point3&, const Vector3& out, const Vector3& in) const override {
    return 3 / (16 * pi) * (1 + square(dot(out, in)));
  }
  Vector3 sample_phase(const Point3& p, const Vector3& out, Point2 u, float& pdf) const override {
    const float c = clamp(2 * std::sinh(std::asinh(4 * u.x - 2) / 3), -1, 1), s = safe_sqrt(1 - c * c);
    float sine = 0, cosine = 0;
    sin_cos_turn(u.y, sine, cosine);
    const Vector3 in = Frame(Normal3(-out)).to_world({s * cosine, s * sine, c});
    pdf = phase(p, out, in);
    return in;
  }

 private:
  /// The coefficients at the ground.
  VolumeCoefficients ground(const Wavelengths& w) const {
    VolumeCoefficients c;
    for (int i = 0; i < spectrum_size; ++i) c.scattering.set(i, scattering * square(square(550 / w[i])));
    c.absorption = absorption->evaluate(w, ColorUse::coefficient);
    return c;
  }
};

static const Register<RayleighAtmosphere> registered;
