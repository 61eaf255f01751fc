// HairShader: hair and fur.

#include "hair.h"

#include "components/shaders/joint_scatter.h"
#include "components/shaders/part_choice.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/scalar_map.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/describe/bands.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {
namespace {

// In the fibre's coordinates (x along the fibre; theta is the angle against the plane across the fibre, phi the azimuth from y
// to z), and with h in [-1, 1] the offset across the fibre at which the ray hits it,
//   f(out, in) |in.z| = sum over p of A_p(out) M_p(theta_out, theta_in) N_p(phi_in - phi_out)   [1/sr]
// (Chiang et al. 2016), where M_p is a pdf of sin(theta) and N_p a pdf of phi, so M_p N_p integrates to 1 over the sphere, and
// f |cos| to the sum of the A_p. z is along the shading normal: the renderer multiplies by |in.z|, so the value is divided by
// it here. Hair scatters into the whole sphere; light that leaves on the side it came from counts as reflection.
//
// Sampling: a lobe is chosen in proportion to the mean of A_p over the wavelengths, and its M_p and N_p are sampled exactly.
// The random number that chose the lobe is rescaled and samples phi.
//
// f is not reciprocal: the reversed path hits the fibre where this one leaves it, at another h, and f |in.z| does not depend on
// the angle between the ribbon's normal and `in`. Averaged over h, as seen from afar, f is reciprocal except for the tilt.
// Importance is the adjoint.
//
// On a ribbon h runs from -1 at one edge to 1 at the other, with the sign flipped when seen from behind. On a closed object,
// such as a tube, h is the sine of the angle between the normal and `out` in projection along the fibre: with e the normalized
// projection of `out` onto the plane across x, the normal z is h (e cross x) + sqrt(1 - h^2) e, so h = -e.y.
class HairScatter final : public JointScatter<HairScatter> {
 public:
  static constexpr Lobes all = glossy_reflection | glossy_transmission;

  HairScatter(const SurfacePoint& p, const Frame& frame, const HairFibre& fibre, bool round, Spectrum absorption)
      : JointScatter(p, frame, all),
        fibre_(fibre),
        round_(round),
        across_(std::isfinite(p.uv.y) ? clamp(-1 + 2 * p.uv.y, -1, 1) : 0),
        absorption_(absorption) {}

  static constexpr bool reciprocal() { return false; }

  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (in.z == 0) return {};
    ScatterValue r = along_and_around(Angles(out), section(out), in);
    r.value /= std::abs(in.z);
    return r;
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    const Angles from(out);
    const HairFibre::Section across = section(out);
    const auto probability = probabilities(across);
    size_t p = 0;
    while (p + 1 < HairFibre::lobes && choice >= probability[p]) choice -= probability[p++];
    choice = clamp(choice / std::max(probability[p], 1e-20f), 0, one_minus_epsilon);

    const float sine = fibre_.sample_longitudinal(int(p), from.sine, from.cosine, u), cosine = safe_sqrt(1 - sine * sine);
    const float phi = from.phi + fibre_.sample_azimuthal(int(p), across, choice);
    s.in = {sine, cosine * std::cos(phi), cosine * std::sin(phi)};
    s.lobe = s.in.z * out.z > 0 ? glossy_reflection : glossy_transmission;
    if (!(lobes & s.lobe) || s.in.z == 0) return false;
    const ScatterValue r = along_and_around(from, across, s.in);
    s.value = r.value;
    s.pdf = r.pdf;
    return true;
  }

  // Exact: M_p integrates to 1 over sin(theta) for any theta of `out`, and the side on which light leaves depends on phi alone,
  // so A_p is multiplied by the integral of N_p over that side.
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    const HairFibre::Section across = section(out);
    const float front_begins = out.z > 0 ? 0 : -pi;
    Spectrum sum;
    for (int p = 0; p < HairFibre::lobes; ++p) {
      const float reflected = fibre_.azimuthal_share(p, across, front_begins - Angles(out).phi);
      const float asked = ((lobes & glossy_reflection) ? reflected : 0) + ((lobes & glossy_transmission) ? 1 - reflected : 0);
      sum += across.attenuation[size_t(p)] * asked;
    }
    return sum;
  }

 private:
  /// A direction by the fibre's angles theta and phi.
  struct Angles {
    explicit Angles(const Vector3& v)
        : sine(clamp(v.x, -1, 1)), cosine(std::sqrt(v.y * v.y + v.z * v.z)), phi(std::atan2(v.z, v.y)) {}
    float sine, cosine;  // of theta
    float phi;
  };

  HairFibre::Section section(const Vector3& out) const {
    const Angles from(out);
    float h = out.z < 0 ? -across_ : across_;
    if (round_) h = from.cosine > 0 ? clamp(-out.y / from.cosine, -1, 1) : 0;
    return fibre_.section(from.sine, from.cosine, h, absorption_);
  }
  static std::array<float, HairFibre::lobes> probabilities(const HairFibre::Section& across) {
    std::array<float, HairFibre::lobes> r;
    float sum = 0;
    for (size_t p = 0; p < r.size(); ++p) sum += r[p] = across.attenuation[p].average();
    for (float& x : r) x /= std::max(sum, 1e-30f);
    return r;
  }
  /// f |in.z| and its pdf, both [1/sr].
  ScatterValue along_and_around(const Angles& from, const HairFibre::Section& across, const Vector3& in) const {
    const Angles to(in);
    const auto probability = probabilities(across);
    ScatterValue r;
    for (int p = 0; p < HairFibre::lobes; ++p) {
      const float shape =
          fibre_.longitudinal(p, from.sine, from.cosine, to.sine, to.cosine) * fibre_.azimuthal(p, across, to.phi - from.phi);
      r.value += across.attenuation[size_t(p)] * shape;
      r.pdf += probability[size_t(p)] * shape;
    }
    return r;
  }

  HairFibre fibre_;
  bool round_;
  float across_;  // h on a ribbon seen from its front
  Spectrum absorption_;
};

// The wall of a closed fibre, such as a tube. The scattering by the whole fibre is evaluated at the point that the viewer sees
// from outside, for light from all directions, including light that reaches this point through the fibre. So the far wall must
// not block light: light that arrives from outside, and a camera path that arrives from inside, passes the wall by null
// scattering of weight 1. Nothing is scattered towards a viewer inside. Light that arrives from outside is thus both scattered
// and passed on in full, so the sum of the two is not a fraction.
class WallScatter final : public Scatter {
 public:
  static constexpr Lobes all = HairScatter::all | null_scattering;

  WallScatter(const SurfacePoint& p, const HairScatter& fibre) : Scatter(p, all), fibre_(fibre) { frame_ = fibre.frame(); }

  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override {
    if (!outside(context.transport == Transport::radiance ? out : in)) return {};
    const ScatterValue v = fibre_.value_and_pdf(out, in, context);
    return {v.value, v.pdf * (1 - straight_probability(out, context))};
  }

  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override {
    const float straight = straight_probability(out, context);
    if (choice < straight) return straight_on(out, Spectrum(1 / straight), straight);
    if (context.transport == Transport::radiance && !outside(out)) return std::nullopt;
    std::optional<ScatterSample> s = fibre_.sample(out, left_of_choice(choice, straight), u, context);
    if (!s || (context.transport == Transport::importance && !outside(s->direction))) return std::nullopt;
    s->weight /= 1 - straight;
    s->pdf *= 1 - straight;
    return s;
  }

  Spectrum world_albedo(const Vector3& out, Lobes lobes) const override {
    if (outside(out)) return fibre_.albedo(out, lobes);
    return lobes & null_scattering ? Spectrum(1.0f) : Spectrum();
  }

 private:
  bool outside(const Vector3& v) const { return dot(normal_, v) > 0; }
  float straight_probability(const Vector3& out, ScatterContext context) const {
    if (!(context.lobes & null_scattering) || outside(out) == (context.transport == Transport::radiance)) return 0;
    return context.transport == Transport::importance && context.lobes & glossy_lobes ? 0.5f : 1;
  }

  const HairScatter& fibre_;
};

class HairShader final : public Shader {
 public:
  enum class Pigment { melanin, color, absorption };

  static void describe(Description<HairShader>& d) {
    d.summary(
         "Fibres of hair or fur, which run along the first surface coordinate (dpdu). On what encloses a volume, such as a "
         "tube, the place across the fibre follows from the normal; on anything else, such as a flat ribbon, from the second "
         "surface coordinate, from 0 to 1, so that it looks like a round fibre.",
         "Chiang et al. 2016, A practical and controllable hair and fur model for production path tracing")
        .group("Colour")
        .member<&HairShader::pigment>("pigment", "", "what gives the hair its colour: one of the following members",
                                      choices("melanin", "color", "absorption"))
        .member<&HairShader::eumelanin>("eumelanin", "1", "concentration of black pigment: 0.3 blond, 1.3 brown, 8 black",
                                        Meaning::number, soft(0, 8), when("pigment", "melanin"))
        .member<&HairShader::pheomelanin>("pheomelanin", "1", "concentration of red pigment", Meaning::number, soft(0, 8),
                                          when("pigment", "melanin"))
        .member<&HairShader::color>("color", "1", "the colour of dense hair, in all that is scattered many times",
                                    Meaning::reflectance, when("pigment", "color"))
        .member<&HairShader::absorption>("absorption", "1", "absorption over a distance of the fibre's radius",
                                         Meaning::coefficient, soft(0.01, 10), logarithmic, when("pigment", "absorption"))
        .group("Fibre")
        .member<&HairShader::longitudinal_roughness>("longitudinal_roughness", "1", "along the fibre, from 0 to 1",
                                                     Meaning::number, soft(0, 1))
        .member<&HairShader::azimuthal_roughness>("azimuthal_roughness", "1", "around the fibre, from 0 to 1", Meaning::number,
                                                  soft(0, 1))
        .member<&HairShader::tilt>("tilt", "deg", "by which the scales of the cuticle stand off the fibre, towards its tip",
                                   range(-15, 15))
        .member<&HairShader::ior>("ior", "1", "index of refraction of the fibre", range(1, 3));
  }

  void prepare() override {
    require_scalar(*this, "eumelanin", eumelanin, 0, densest);
    require_scalar(*this, "pheomelanin", pheomelanin, 0, densest);
    require_reflectance(*this, "color", color);
    if (!absorption) fail("absorption", "a map or a colour is needed");
    if (const Color all = absorption->constant())
      for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 5)
        if (!(all->at(lambda, ColorUse::coefficient) >= 0 && all->at(lambda, ColorUse::coefficient) < infinity))
          fail("absorption", "a coefficient of absorption is a number of at least 0");
    require_scalar(*this, "longitudinal_roughness", longitudinal_roughness);
    require_scalar(*this, "azimuthal_roughness", azimuthal_roughness);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    float eta = ior;
    if (const SceneObject* around = p.media && p.object ? p.media->outside_of(*p.object) : nullptr)
      eta /= MediumStack::index(around, w)[0];
    const HairFibre fibre(scalar_at(*longitudinal_roughness, p), scalar_at(*azimuthal_roughness, p), radians(tilt), eta);
    const bool round = p.object && p.object->closed();
    const auto* scatter = arena.make<HairScatter>(p, tangent_frame(p), fibre, round, absorption_at(p, w, fibre));
    if (!round) return scatter;
    return arena.make<WallScatter>(p, *scatter);
  }
  Lobes possible_lobes() const override { return WallScatter::all; }
  // Light that passes through a fibre is outside again: there is no interior for a path to enter.
  bool transmits() const override { return false; }
  bool reciprocal() const override { return false; }  // see HairScatter

  Pigment pigment = Pigment::melanin;
  Ref<ObjectMap> eumelanin = constant(1.3f), pheomelanin = constant(0.2f), color = constant(0.5f), absorption = constant(0.2f);
  Ref<ObjectMap> longitudinal_roughness = constant(0.3f), azimuthal_roughness = constant(0.3f);
  float tilt = 2, ior = 1.55f;

 private:
  static constexpr float densest = 1000;

  Spectrum absorption_at(const SurfacePoint& p, const Wavelengths& w, const HairFibre& fibre) const {
    switch (pigment) {
      case Pigment::melanin: return melanin(scalar_at(*eumelanin, p, 0, densest), scalar_at(*pheomelanin, p, 0, densest), w);
      case Pigment::color: return fibre.absorption_of(reflectance_at(*color, p, w));
      default:
        return map(absorption->color(p, w, ColorUse::coefficient), [](float x) { return x > 0 ? std::min(x, 1e6f) : 0; });
    }
  }
  // Absorption per radius of human hair for red, green and blue: (0.419, 0.697, 1.37) by eumelanin and (0.187, 0.4, 1.05) by
  // pheomelanin (d'Eon et al. 2011). Within 3 %, these are the values at 645, 550 and 450 nm of power laws of their spectra,
  // lambda^-3.33 and lambda^-4.75 (Donner & Jensen 2006, "A spectral BSSRDF for shading human skin").
  static Spectrum melanin(float black, float red, const Wavelengths& w) {
    if (in_bands(w)) return black * band_spectrum(0.419f, 0.697f, 1.37f) + red * band_spectrum(0.187f, 0.4f, 1.05f);
    Spectrum r;
    for (int i = 0; i < spectrum_size; ++i) {
      const float x = std::log(550 / w[i]);
      r.set(i, black * 0.697f * std::exp(3.33f * x) + red * 0.4f * std::exp(4.75f * x));
    }
    return r;
  }
};

const Register<HairShader> registered;

}  // namespace
}  // namespace etendue
