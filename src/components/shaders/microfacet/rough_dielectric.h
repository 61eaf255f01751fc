#pragma once
// RoughDielectric: scattering by a microfacet boundary between two dielectrics.

#include "components/shaders/fresnel.h"
#include "components/shaders/joint_scatter.h"
#include "components/shaders/polarized_fresnel.h"
#include "etendue/core/warp.h"
#include "microfacet.h"

namespace etendue {

/// Factors of a boundary's reflected and refracted light. Real boundaries have none: they are for artistic effect, and for
/// scenes of other renderers that have them.
struct BoundaryTint {
  Spectrum reflected = Spectrum(1.0f), transmitted = Spectrum(1.0f);

  bool none() const { return reflected.minimum() == 1 && transmitted.minimum() == 1; }
  /// The probability of choosing reflection, in proportion to the tinted reflectance and transmittance.
  float probability(float fresnel) const {
    const float r = fresnel * reflected.average(), t = (1 - fresnel) * transmitted.average();
    return r + t > 0 ? r / (r + t) : fresnel;
  }
};

// With m the facet that reflects or refracts `out` into `in`, and eta the index on the side of `in` over that on the side of
// `out`, in the convention of importance (Walter et al. 2007, eq. 20 and 21):
//   f = F D(m) G2 / (4 |out.z in.z|)                                                                      in reflection,
//   f = (1 - F) D(m) G2' |out.m in.m| eta^2 / ((out.m + eta in.m)^2 |out.z in.z|)   [1/sr]                in refraction.
// Light scattered more than once is added if requested (see MultipleRefraction). A tint multiplies the reflected or refracted
// light once.
//
// Sampling: with the probability 1 - E(out), E being the albedo of single scattering, the lobe of multiple scattering is
// sampled: a side by its share, then a direction with the pdf cos / pi. Otherwise a visible normal is sampled, lobes reflects
// with the probability F.
//
// Dispersion. A given direction `in` belongs to another facet normal at each wavelength, and f is evaluated for all of them.
// With the hero's pdf alone, f / pdf of the others would be unbounded for narrow lobes. So each of the path's wavelengths
// chooses the direction with equal probability, and the pdf is the mean of theirs (the balance heuristic of Wilkie et al. 2014,
// "Hero wavelength spectral sampling", at a single vertex): no weight exceeds 4 times that of a path of a single wavelength,
// and no wavelength needs to be dropped. Multiple scattering is tabulated for the hero: its transmitted part is multiplied by
// eta / eta_hero, lobes keeps both transports adjoint at every wavelength. The resulting error of energy is the relative
// difference of the indices times the few hundredths of the light that are scattered more than once.
class RoughDielectric final : public JointScatter<RoughDielectric>, public PolarizingScatter {
 public:
  /// eta: index below (z < 0) over that above. `multiple`: whether multiple scattering is added, where it is tabulated.
  /// `single`: only the path's hero wavelength is left.
  RoughDielectric(const SurfacePoint& p, const Frame& frame, const MicrofacetDistribution& distribution, Spectrum eta,
                  bool multiple, bool single, const BoundaryTint& tint)
      : JointScatter(p, frame, glossy_reflection | glossy_transmission),
        distribution_(distribution),
        multiple_refraction_({distribution.kind, std::sqrt(distribution.alpha_x * distribution.alpha_y)}, eta[0]),
        eta_(eta),
        tint_(tint),
        multiple_(multiple && MultipleRefraction::known(distribution, eta[0])),
        varies_(eta.minimum() != eta.maximum()),
        choosing_(varies_ && !single ? spectrum_size : 1) {}

  /// Whether a boundary is treated as smooth: alpha is below smooth_below, or the index ratio is so close to 1 that facets
  /// hardly deflect light, and reflect next to none.
  static bool smooth(const MicrofacetDistribution& d, const Spectrum& eta) {
    const float bend = std::max(std::abs(eta.maximum() - 1), std::abs(1 - eta.minimum()));
    return d.smooth() || std::max(d.alpha_x, d.alpha_y) * bend < 3e-4f;
  }

  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    if (out.z == 0 || in.z == 0) return {};
    ScatterValue r = out.z * in.z > 0 ? reflection(out, in, lobes) : transmission(out, in, lobes);
    if (multiple_) {
      const float missing = multiple_refraction_.missing(out), through = through_probability(out, lobes);
      const float side = out.z * in.z > 0 ? 1 - through : through;
      const float more = multiple_refraction_.value(out, in);
      r.value += side_factor(out, in) * more;
      r.pdf = lerp(missing, r.pdf, side * std::abs(in.z) * inverse_pi);
    }
    r.value *= out.z * in.z > 0 ? tint_.reflected : tint_.transmitted;
    return r;
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    if (out.z == 0) return false;
    const float missing = multiple_ ? multiple_refraction_.missing(out) : 0;
    if (choice < missing) {
      s.in = warp::cosine_hemisphere(u);
      const bool below = choice < missing * through_probability(out, lobes);
      if (below == (out.z > 0)) s.in.z = -s.in.z;
    } else {
      choice = (choice - missing) / (1 - missing) * float(choosing_);
      const int chosen = std::min(int(choice), choosing_ - 1);
      choice -= float(chosen);
      const float eta = towards(out, eta_[chosen]);
      const Vector3 m = distribution_.sample_visible(out, u);
      float cosine_behind = 0;
      const float reflected = fresnel_dielectric(std::abs(dot(out, m)), eta, cosine_behind);
      const bool reflects = choice < reflect_probability(reflected, lobes);
      if (!reflects && reflected >= 1) return false;  // only refraction was requested, and reflection is total
      s.in = reflects ? reflect(out, m) : refract(out, m, eta, cosine_behind);
      if ((s.in.z * out.z > 0) != reflects) return false;  // blocked by another facet
    }
    const bool above = s.in.z * out.z > 0;
    s.lobe = above ? glossy_reflection : glossy_transmission;
    if (!above) s.eta = towards(out, eta_[0]);
    return complete(s, local_value_and_pdf(out, s.in, lobes));
  }

  // Single reflection, and the energy that single scattering misses, are tabulated for isotropic distributions. For anisotropic
  // ones a weighted mean of the values for the alphas along and across `out` is used.
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    Spectrum reflected, refracted;
    float missing = 0;
    for (int i = 0; i < (varies_ ? spectrum_size : 1); ++i) {
      const Once once = scattered_once(out, eta_[i]);
      reflected.set(i, once.reflected);
      refracted.set(i, std::max(1 - once.missing - once.reflected, 0.0f));
      if (i == 0 && multiple_) missing = once.missing;
    }
    if (!varies_) {
      reflected = Spectrum(reflected[0]);
      refracted = Spectrum(refracted[0]);
    }
    const float through = missing > 0 ? missing * multiple_refraction_.transmitted_share(out) : 0;
    Spectrum sum;
    if (lobes & glossy_reflection) sum += tint_.reflected * (reflected + Spectrum(missing - through));
    if (lobes & glossy_transmission) sum += tint_.transmitted * (refracted + side_factor(out, -out) * through);
    return sum;
  }
  Spectrum relative_index(const Vector3& out, const Vector3& in) const {
    if (out.z * in.z > 0) return Spectrum(1.0f);
    return out.z > 0 ? eta_ : Spectrum(1.0f) / eta_;
  }

  /// Light that was scattered more than once is taken for unpolarized.
  bool polarization(const Vector3& out, const Vector3& in, Lobes, Polarization& event) const override {
    const bool transmitted = dot(normal_, out) * dot(normal_, in) < 0;
    PolarizationMean mean(out, in);
    const Vector3 o = frame_.to_local(out), i = frame_.to_local(in);
    const Spectrum once = transmitted ? transmission(o, i, lobes_).value : reflection(o, i, lobes_).value;
    mean.add(once, polarized::at_dielectric(out, in, dot(normal_, out) > 0 ? eta_ : Spectrum(1.0f) / eta_,
                                            transmitted ? glossy_transmission : glossy_reflection));
    if (multiple_) mean.add_unpolarized(side_factor(o, i) * multiple_refraction_.value(o, i));
    return mean.mean(event);
  }

 private:
  /// The directional albedo of single reflection, and the energy that single scattering misses.
  struct Once {
    float reflected = 0, missing = 0;
  };
  Once scattered_once(const Vector3& out, float eta) const {
    const float s2 = out.x * out.x + out.y * out.y, x2 = s2 > 0 ? out.x * out.x / s2 : 1;
    Once once;
    if (!(eta > 0.25f && eta < 4)) return beyond_tables(out, towards(out, eta));
    const auto add = [&](float weight, float along_x) {
      const float alpha = std::sqrt(lerp(along_x, square(distribution_.alpha_y), square(distribution_.alpha_x)));
      const MicrofacetDistribution d(distribution_.kind, alpha);
      once.missing += weight * MultipleRefraction(d, eta).missing(out);
      once.reflected += weight * (1 - CoatTransmittance(d, towards(out, eta))(out));
    };
    const float along = distribution_.isotropic() ? 1 : 0.5f + 0.2f * s2;
    add(along, x2);
    if (along < 1) add(1 - along, 1 - x2);
    return once;
  }

  /// The same for indices outside the tables: the mean weight of 8 x 8 samples.
  Once beyond_tables(const Vector3& out, float eta) const {
    constexpr int side = 8;
    float reflected = 0, refracted = 0;
    for (int i = 0; i < side * side; ++i) {
      const Vector3 m = distribution_.sample_visible(out, {(float(i % side) + 0.5f) / side, (float(i / side) + 0.5f) / side});
      const float out_m = std::abs(dot(out, m)), facets = distribution_.D(m) / distribution_.visible_pdf(out, m);
      float cosine_behind = 0;
      const float fresnel = fresnel_dielectric(out_m, eta, cosine_behind);
      const Vector3 back = reflect(out, m), on = refract(out, m, eta, cosine_behind);
      if (back.z * out.z > 0)
        reflected += fresnel * facets * distribution_.visibility(out, back) * std::abs(back.z) / reflection_jacobian(out_m);
      if (fresnel < 1 && on.z * out.z < 0)
        refracted += (1 - fresnel) * facets * distribution_.G2_through(out, on) * out_m / std::abs(out.z);
    }
    reflected /= side * side;
    refracted /= side * side;
    return {reflected, std::max(1 - reflected - refracted, 0.0f)};
  }

  /// Index behind the boundary over index in front, seen from `out`.
  static float towards(const Vector3& out, float eta) { return out.z > 0 ? eta : 1 / eta; }

  /// Factor of multiple scattering per wavelength: eta / eta_hero in transmission, 1 in reflection.
  Spectrum side_factor(const Vector3& out, const Vector3& in) const {
    if (!varies_ || out.z * in.z > 0) return Spectrum(1.0f);
    return relative_index(out, in) / towards(out, eta_[0]);
  }
  static float reflect_probability(float reflected, Lobes lobes) {
    if (!(lobes & glossy_transmission)) return 1;
    return (lobes & glossy_reflection) ? reflected : 0;
  }
  float through_probability(const Vector3& out, Lobes lobes) const {
    if (!(lobes & glossy_transmission)) return 0;
    return (lobes & glossy_reflection) ? multiple_refraction_.transmitted_share(out) : 1;
  }

  ScatterValue reflection(const Vector3& out, const Vector3& in, Lobes lobes) const {
    const Vector3 m = reflection_half_vector(out, in);
    const float out_m = std::abs(dot(out, m));
    const float front = distribution_.D(m) * distribution_.visibility(out, in);
    ScatterValue r;
    float probability = 0;
    for (int i = 0; i < (varies_ ? spectrum_size : 1); ++i) {
      const float reflected = fresnel_dielectric(out_m, towards(out, eta_[i]));
      r.value.set(i, front * reflected);
      if (i < choosing_) probability += reflect_probability(reflected, lobes) / float(choosing_);
    }
    if (!varies_) r.value = Spectrum(r.value[0]);
    r.pdf = probability * distribution_.visible_pdf(out, m) * reflection_jacobian(out_m);
    return r;
  }

  ScatterValue transmission(const Vector3& out, const Vector3& in, Lobes lobes) const {
    const float front = distribution_.G2_through(out, in) / std::abs(out.z * in.z);
    ScatterValue r;
    for (int i = 0; i < (varies_ ? spectrum_size : 1); ++i) {
      const float eta = towards(out, eta_[i]);
      const Vector3 m = refraction_half_vector(out, in, eta);
      const float out_m = dot(out, m), in_m = dot(in, m);
      if (!(out_m * out.z > 0 && in_m * in.z > 0)) continue;
      const float reflected = fresnel_dielectric(std::abs(out_m), eta), jacobian = refraction_jacobian(out_m, in_m, eta);
      r.value.set(i, front * (1 - reflected) * distribution_.D(m) * std::abs(out_m) * jacobian);
      if (i < choosing_)
        r.pdf += (1 - reflect_probability(reflected, lobes)) * distribution_.visible_pdf(out, m) * jacobian / float(choosing_);
    }
    if (!varies_) r.value = Spectrum(r.value[0]);
    return r;
  }

  MicrofacetDistribution distribution_;
  MultipleRefraction multiple_refraction_;
  Spectrum eta_;
  BoundaryTint tint_;
  bool multiple_, varies_;
  int choosing_;  ///< how many of the path's wavelengths may choose the direction
};

}  // namespace etendue
