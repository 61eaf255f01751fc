// Plastic: a diffuse body under a dielectric coat, polished or rough.

#include <optional>

#include "coated_body.h"
#include "components/shaders/polarized_fresnel.h"
#include "components/shaders/reflectance.h"
#include "etendue/transport/medium_stack.h"
#include "roughness.h"

namespace etendue {
namespace {

// The coat reflects F (or, if rough, the lobe F D G2 / (4 |out.z in.z|)) and transmits all the rest, T(v). Under it the body
// reflects rho diffusely; of this light the coat reflects the fraction Fi back to the body, repeatedly. With eta the index of
// the coat over that in front, the light that leaves is spread over eta^2 times the solid angle:
//   f_d = T(out) T(in) rho / (pi eta^2 (1 - rho Fi))  [1/sr]
// (Saunderson 1942, with the angles of Wolff 1994, "Diffuse-reflectance model for smooth dielectric surfaces"). By reciprocity,
// the transmittance from inside is that from outside over eta^2: 1 - Fi = Tm / eta^2 with Tm the mean of T under diffuse light.
// For a smooth coat Fi is thus the mean Fresnel reflectance from inside. So f_d has the albedo T(out) rho (1 - Fi) / (1 - rho
// Fi), and where rho = 1 nothing is lost. f_d is reciprocal.
//
// Without `nonlinear`, rho Fi in the denominator is replaced by Fi: the albedo is then T(out) rho, without the more saturated
// colour that repeated reflection at the body causes.
struct Coat {
  float eta, through_mean;                   ///< Tm
  std::optional<CoatTransmittance> rough{};  ///< empty: polished

  Coat(float index, const MicrofacetDistribution& d) : eta(index) {
    if (!d.smooth()) rough.emplace(d, index);
    through_mean = rough ? rough->mean() : 1 - mean_fresnel_dielectric(index);
  }
  float through(const Vector3& v) const { return rough ? (*rough)(v) : 1 - fresnel_dielectric(std::abs(v.z), eta); }
};

class PlasticScatter final : public CoatedBodyScatter<PlasticScatter>, public PolarizingScatter {
 public:
  PlasticScatter(const SurfacePoint& p, const MicrofacetDistribution& distribution, const Coat& coat, Spectrum body,
                 bool nonlinear)
      : CoatedBodyScatter(
            p, Lobes((body.black() ? 0 : diffuse_reflection) | (coat.rough ? glossy_reflection : specular_reflection))),
        distribution_(distribution),
        coat_(coat) {
    const float inside = clamp(1 - coat.through_mean / square(coat.eta), 0, 0.9999f);
    const Spectrum kept = nonlinear ? Spectrum(1.0f) - body * inside : Spectrum(1 - inside);
    body_ = body / kept;
    body_albedo_ = body_ * (1 - inside);
    body_ /= square(coat.eta);
    body_weight_ = body_albedo_.average();
  }

  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    const float through = coat_.through(out);
    Spectrum sum;
    if (lobes & diffuse_reflection) sum += body_albedo_ * through;
    if (lobes & (glossy_reflection | specular_reflection)) sum += Spectrum(1 - through);
    return sum;
  }

  /// The coat reflects as glass does. The light of the body is unpolarized below the coat, and polarized by passing it; of a
  /// rough coat as of a smooth one.
  bool polarization(const Vector3& out, const Vector3& in, Lobes lobes, Polarization& event) const override {
    const Polarization coat = polarized::at_dielectric(out, in, Spectrum(coat_.eta), specular_reflection);
    if (lobes & specular_reflection & lobes_ && !(lobes & smooth_lobes)) {
      event = coat;
      return true;
    }
    PolarizationMean mean(out, in);
    mean.add(evaluate(out, in, {.lobes = glossy_reflection}), coat);
    mean.add(evaluate(out, in, {.lobes = diffuse_reflection}), polarized::through_boundary_twice(out, in, frame_.n, coat_.eta));
    return mean.mean(event);
  }

  const MicrofacetDistribution& facets() const { return distribution_; }
  float eta() const { return coat_.eta; }
  float through(const Vector3& v) const { return coat_.through(v); }
  const Spectrum& body() const { return body_; }
  Spectrum coat(const Vector3& out, const Vector3& in, float fresnel, float density) const {
    return Spectrum(fresnel * density * distribution_.visibility(out, in));
  }
  Spectrum mirrored(const Vector3&, float through) const { return Spectrum(1 - through); }
  float coat_share(const Vector3&, float through) const { return (1 - through) / (1 - through + through * body_weight_); }

 private:
  MicrofacetDistribution distribution_;
  Coat coat_;
  Spectrum body_;         ///< f_d pi / (T(out) T(in))
  Spectrum body_albedo_;  ///< albedo of the body seen through the coat, over T(out)
  float body_weight_;
};

class Plastic final : public Shader {
 public:
  static void describe(Description<Plastic>& d) {
    d.summary(
         "A diffuse body under a clear dielectric coat, polished or rough, with all reflections between the two: "
         "plastic, varnished wood, glazed china, ...",
         "Saunderson 1942, Calculation of the color of pigmented plastics; Wolff 1994, Diffuse-reflectance model for smooth "
         "dielectric surfaces")
        .member<&Plastic::color>("color", "1", "fraction of light the body under the coat reflects, per wavelength",
                                 Meaning::reflectance)
        .member<&Plastic::ior>("ior", "1", "index of refraction of the coat", range(1, 4), soft(1, 2.5))
        .member<&Plastic::roughness>("roughness", "1",
                                     "the alpha of the distribution of the coat's facets (not its square root); below 0.001 "
                                     "polished",
                                     Meaning::number, soft(0, 1))
        .member<&Plastic::distribution>("distribution", "", "of the directions of facets", choices("ggx", "beckmann"))
        .member<&Plastic::nonlinear>(
            "nonlinear", "",
            "whether light that the coat throws back to the body takes on its colour again, lobes makes "
            "colours deeper");
  }

  void prepare() override {
    require_reflectance(*this, "color", color);
    require_roughness(*this, roughness, nullptr);
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    float eta = ior;
    // Dispersion of the coat and of the medium in front is ignored: the index ratio is the same at all wavelengths.
    if (const SceneObject* outside = p.media && p.object ? p.media->outside_of(*p.object) : nullptr)
      eta /= MediumStack::index(outside, w).average();
    const MicrofacetDistribution d = distribution_at(distribution, *roughness, nullptr, p);
    return arena.make<PlasticScatter>(p, d, Coat(eta, d), reflectance_at(*color, p, w), nonlinear);
  }
  /// Interpolation error of the albedo table.
  float albedo_error() const override { return everywhere(roughness, 0) ? 0 : 0.02f; }
  Lobes possible_lobes() const override {
    return Lobes(diffuse_reflection | specular_reflection | (everywhere(roughness, 0) ? 0 : glossy_reflection));
  }
  bool lossless() const override { return everywhere(color, 1) && everywhere(roughness, 0); }

  Ref<ObjectMap> color = constant(0.5f), roughness = constant(0.1f);
  float ior = 1.5f;
  MicrofacetDistribution::Kind distribution = MicrofacetDistribution::ggx;
  bool nonlinear = true;
};

const Register<Plastic> registered;

}  // namespace
}  // namespace etendue
