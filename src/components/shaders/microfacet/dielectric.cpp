// Dielectric: the boundary of glass, water and the like, smooth or rough.

#include "components/shaders/fresnel.h"
#include "components/shaders/polarized_fresnel.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/tangent_frame.h"
#include "etendue/scatter_model.h"
#include "etendue/transport/medium_stack.h"
#include "rough_dielectric.h"
#include "roughness.h"

namespace etendue {
namespace {

// The fraction F of the incident light is reflected and 1 - F refracted. Reflection is chosen with the hero's F, so the hero's
// weight is 1. The reflected direction is the same at every wavelength: the others are kept, with weight F_i / F_hero. The
// refracted direction is the hero's; where the index differs between the path's wavelengths the sample is marked dispersive and
// the path drops the others, which is compensated in the hero's pdf (see Wavelengths::drop_secondary). A wavelength that is
// totally reflected has F_i = 1 like any other.
class DielectricScatter final : public ScatterModel<DielectricScatter>, public PolarizingScatter {
 public:
  /// eta: index inside over index outside.
  DielectricScatter(const SurfacePoint& p, Spectrum eta, bool varies, bool dispersive, const BoundaryTint& tint)
      : ScatterModel(p, specular_reflection | specular_transmission),
        eta_(eta),
        tint_(tint),
        varies_(varies),
        dispersive_(dispersive),
        tinted_(!tint.none()) {
    if (dispersive) dispersed_lobes_ = specular_transmission;
  }

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }

  bool local_sample(const Vector3& out, float choice, Point2, Lobes lobes, LocalSample& s) const {
    float cosine_behind = 0;
    const Spectrum reflected = reflectance(out, cosine_behind);
    const float hero = reflected[0];
    float reflect_probability = tinted_ ? tint_.probability(hero) : hero;
    if (!(lobes & specular_transmission)) reflect_probability = 1;
    if (!(lobes & specular_reflection)) reflect_probability = 0;

    if (choice < reflect_probability) {
      s.in = {-out.x, -out.y, out.z};
      s.value = tint_.reflected * reflected;
      s.pdf = reflect_probability;
      s.lobe = specular_reflection;
      return true;
    }
    if (hero >= 1) return false;  // only refraction was requested, and reflection is total
    const float eta = towards(out, eta_[0]);
    s.in = {-out.x / eta, -out.y / eta, out.z > 0 ? -cosine_behind : cosine_behind};
    s.value = varies_ ? Spectrum(1 - hero) : Spectrum(1.0f) - reflected;
    s.value *= tint_.transmitted;
    s.pdf = 1 - reflect_probability;
    s.lobe = specular_transmission;
    s.eta = eta;
    s.dispersive = dispersive_;
    return true;
  }

  bool total_internal_reflection(const Vector3& out) const {
    float unused = 0;
    return fresnel_dielectric(std::abs(out.z), towards(out, eta_[0]), unused) >= 1;
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    float unused = 0;
    const Spectrum reflected = reflectance(out, unused);
    Spectrum sum;
    if (lobes & specular_reflection) sum += tint_.reflected * reflected;
    if (lobes & specular_transmission) sum += tint_.transmitted * (Spectrum(1.0f) - reflected);
    return sum;
  }

  bool polarization(const Vector3& out, const Vector3& in, Lobes lobes, Polarization& event) const override {
    event = polarized::at_dielectric(out, in, seen_from(out, eta_), lobes);
    return true;
  }

 private:
  /// The same per wavelength, seen from a world direction.
  Spectrum seen_from(const Vector3& out, const Spectrum& eta) const {
    return dot(normal_, out) > 0 ? eta : Spectrum(1.0f) / eta;
  }
  /// Index behind the boundary over index in front, seen from `out`.
  static float towards(const Vector3& out, float eta) { return out.z > 0 ? eta : 1 / eta; }

  /// F per wavelength, and the hero's cosine behind the boundary.
  Spectrum reflectance(const Vector3& out, float& cosine_behind) const {
    const float cosine = std::abs(out.z);
    Spectrum r(fresnel_dielectric(cosine, towards(out, eta_[0]), cosine_behind));
    if (varies_) {
      float unused = 0;
      for (int i = 1; i < spectrum_size; ++i) r.set(i, fresnel_dielectric(cosine, towards(out, eta_[i]), unused));
    }
    return r;
  }

  Spectrum eta_;
  BoundaryTint tint_;
  bool varies_, dispersive_, tinted_;
};

class Dielectric final : public Shader {
 public:
  static void describe(Description<Dielectric>& d) {
    d.summary("The boundary of a transparent body, smooth or rough: Fresnel reflection and refraction, with dispersion.",
              "Born & Wolf 1999, Principles of Optics, section 1.5; Walter et al. 2007, Microfacet models for refraction "
              "through rough surfaces; Kulla & Conty 2017, Revisiting physically based shading at Imageworks; nested bodies "
              "after Schmidt & Budge 2002")
        .group("Boundary")
        .member<&Dielectric::ior>(
            "ior", "1", "index of refraction inside the object: a number, glass(\"N-BK7\"), or a spectrum", Meaning::index)
        .member<&Dielectric::exterior>(
            "exterior", "1",
            "index of refraction on the front side, for surfaces that are one of several boundaries of one body; by default "
            "that of what the path is in",
            Meaning::index)
        .member<&Dielectric::reflection_tint>(
            "reflection_tint", "1", "what reflected light is multiplied by; real boundaries have 1", Meaning::reflectance)
        .member<&Dielectric::transmission_tint>(
            "transmission_tint", "1",
            "what refracted light is multiplied by at each passage; coloured glass is rather a medium inside",
            Meaning::reflectance)
        .group("Roughness")
        .member<&Dielectric::roughness>("roughness", "1",
                                        "the alpha of the distribution of facets, along the surface's u direction unless "
                                        "rotated (not its square root); below 0.001 smooth",
                                        Meaning::number, soft(0, 1))
        .member<&Dielectric::roughness_v>("roughness_v", "1", "alpha across that direction; by default the same",
                                          Meaning::number, soft(0, 1))
        .member<&Dielectric::rotation>("rotation", "turn", "turns those directions, counter-clockwise", Meaning::number,
                                       soft(0, 1), when("roughness_v"))
        .member<&Dielectric::distribution>("distribution", "", "of the directions of facets", choices("ggx", "beckmann"))
        .member<&Dielectric::multiple_scattering>(
            "multiple_scattering", "",
            "whether light that meets more than one facet is counted, or lost; where roughness_v differs it is lost")
        .member<&Dielectric::heights>(
            "heights", "",
            "of facets that hide light on its way in and on its way out: by_side, the same ones hide both ways in reflection, "
            "and "
            "others through the surface; independent, always others, as in Mitsuba; correlated, always the same, as in pbrt",
            choices("by_side", "independent", "correlated"), unless("multiple_scattering"));
  }

  void prepare() override {
    if (!ior) fail("ior", "an index of refraction is needed");
    check_index("ior", *ior);
    if (exterior) check_index("exterior", *exterior);
    require_reflectance(*this, "reflection_tint", reflection_tint);
    require_reflectance(*this, "transmission_tint", transmission_tint);
    require_roughness(*this, roughness, roughness_v);
    if (!rotation) fail("rotation", "a map or a number is needed");
    constexpr Lobes smooth = specular_reflection | specular_transmission, rough = glossy_reflection | glossy_transmission;
    lobes_ = everywhere(roughness, 0) && (!roughness_v || everywhere(roughness_v, 0)) ? smooth : smooth | rough;
    tinted_ = !everywhere(reflection_tint, 1) || !everywhere(transmission_tint, 1);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const SceneObject* outside = p.media && p.object && !exterior ? p.media->outside_of(*p.object) : nullptr;
    Spectrum eta = interior_index(w);
    if (exterior) eta = eta / exterior->evaluate(w, ColorUse::coefficient);
    if (outside) eta = eta / MediumStack::index(outside, w);
    BoundaryTint tint;
    if (tinted_) tint = {reflectance_at(*reflection_tint, p, w), reflectance_at(*transmission_tint, p, w)};
    MicrofacetDistribution d = distribution_at(distribution, *roughness, roughness_v.get(), p);
    if (!multiple_scattering) d.heights = heights;
    if (!RoughDielectric::smooth(d, eta)) {
      const Frame frame = d.isotropic() ? Frame(p.shading_normal) : tangent_frame(p, rotation->scalar(p));
      return arena.make<RoughDielectric>(p, frame, d, eta, multiple_scattering, w.single(), tint);
    }
    const bool varies = eta.minimum() != eta.maximum();
    return arena.make<DielectricScatter>(p, eta, varies, varies && !w.single(), tint);
  }
  /// A rough boundary uses tables, an anisotropic one the mean of two of their values.
  float albedo_error() const override { return !(lobes_ & glossy_lobes) ? 0 : roughness_v ? 0.15f : 0.05f; }
  Lobes possible_lobes() const override { return lobes_; }
  Spectrum interior_index(const Wavelengths& w) const override { return ior->evaluate(w, ColorUse::coefficient); }
  /// A rough boundary loses up to a hundredth at some angles, the error of its tables.
  bool lossless() const override { return !(possible_lobes() & glossy_lobes) && !tinted_; }

  Color ior = flat_spectrum(1.5f), exterior;
  Ref<ObjectMap> reflection_tint = constant(1.0f), transmission_tint = constant(1.0f);
  Ref<ObjectMap> roughness = constant(0.0f), roughness_v, rotation = constant(0.0f);
  MicrofacetDistribution::Kind distribution = MicrofacetDistribution::ggx;
  MicrofacetDistribution::Heights heights = MicrofacetDistribution::Heights::by_side;
  bool multiple_scattering = true;

 private:
  void check_index(const char* member, const SpectralFunction& index) const {
    if (index.imaginary()) fail(member, "a dielectric's index is real; this one is complex (a metal's)");
    for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 5) {
      const float n = index.at(lambda, ColorUse::coefficient);
      if (!(n > 0 && n < 100))
        fail(member, "an index of refraction lies between 0 and 100, and this is " + std::to_string(n) + " at " +
                         std::to_string(int(lambda)) + " nm");
    }
  }

  // Derived from the maps once, as possible_lobes() is called at every vertex and every boundary of a path.
  Lobes lobes_ = specular_reflection | specular_transmission;
  bool tinted_ = false;
};

const Register<Dielectric> registered;

}  // namespace
}  // namespace etendue
