// PrincipledScatter: reflectance and transmittance of its layers, and its albedo.

#include "components/shaders/fresnel.h"
#include "components/shaders/microfacet/film_interference.h"
#include "principled_scatter.h"

namespace etendue {
namespace {

/// 4-point Gauss quadrature of means over diffuse light: cosines, and weights that sum to 1.
constexpr std::pair<float, float> diffuse_rule[] = {{0.13975986434f, 0.06236194190f},
                                                    {0.41640956763f, 0.25969509522f},
                                                    {0.72315698637f, 0.40692913604f},
                                                    {0.94289580388f, 0.27101382684f}};

/// A lower bound of the cosine: at grazing angles on a film with the index of the medium around, the formulas are 0 / 0 within
/// rounding.
float film_cosine(float cosine) { return std::max(cosine, 2e-3f); }

// Kutz, Hasan & Edmondson 2021, "Novel aspects of the Adobe Standard Material": Schlick's formula minus a dip that is greatest
// at 82 degrees.
Spectrum f82(Spectrum normal, Spectrum dip, float cosine) {
  const float c = 1 - cosine, c2 = c * c, c5 = c2 * c2 * c;
  return clamp(normal + (Spectrum(1.0f) - normal) * c5 - dip * (cosine * c5 * c), 0, 1);
}
/// Its mean under diffuse light: Schlick's is normal + (1 - normal) / 21, the dip's integral 2 B(3, 7) = 1 / 126.
Spectrum mean_f82(Spectrum normal, Spectrum dip) {
  return clamp(normal + (Spectrum(1.0f) - normal) * (1.0f / 21) - dip * (1.0f / 126), 0, 1);
}

}  // namespace

PrincipledScatter::Top::Top(const MicrofacetDistribution& facets, float eta)
    : smooth_(facets.smooth()), eta_(eta), mean_(smooth_ ? 1 - mean_fresnel_dielectric(eta) : 0) {
  const float alpha = std::sqrt(0.5f * (square(facets.alpha_x) + square(facets.alpha_y)));
  if (!smooth_) rough_.emplace(MicrofacetDistribution(facets.kind, alpha), eta);
}

float PrincipledScatter::Top::passed(const Vector3& v) const {
  return smooth_ ? 1 - fresnel_dielectric(std::abs(v.z), eta_) : (*rough_)(v);
}

// At some wavelengths a film can make facets reflect more than the base alone: at most, at normal incidence, as a boundary of
// the index ratio n1^2 / (n0 n2) or its inverse (a quarter-wave film). The diffuse body receives what such a boundary
// transmits.
PrincipledScatter::PrincipledScatter(const SurfacePoint& p, const Frame& frame, const PrincipledLayers& layers)
    : JointScatter(p, frame, lobes_of(layers)),
      layers_(layers),
      coat_(layers.coat_facets, layers.coat_eta),
      gloss_(layers.facets,
             [&] {
               const float eta = layers.reflect_eta.maximum();
               if (!(layers.film > 0)) return eta;
               const float quarter = square(layers.film_eta[0]) / eta;
               return std::max({eta, quarter, 1 / quarter});
             }()),
      matt_(layers.diffuse_color, layers.diffuse_roughness),
      matt_through_(layers.diffuse_through_color, layers.diffuse_roughness),
      smooth_(layers.facets.smooth()),
      coat_smooth_(layers.coat_facets.smooth()),
      covered_(layers.coat > 0 || layers.fuzz > 0),
      disperses_(layers.clear > 0 && !layers.thin_walled && layers.eta.minimum() != layers.eta.maximum()),
      colored_(disperses_ || layers.film > 0 || layers.reflect_eta.minimum() != layers.reflect_eta.maximum()),
      choosing_(disperses_ && !layers.single ? spectrum_size : 1) {
  if (!smooth_) prepare_multiple();
  if (smooth_ && disperses_ && !layers.single) dispersed_lobes_ = specular_transmission;
  matt_mean_ = matt_normalizer();
}

// Multiple scattering between facets. The energy that single scattering misses at a clear boundary is tabulated for isotropic
// facets without film or coat. Film and coat change it little; but with these only three quarters of it can be added without
// ever creating energy. A thin sheet's facets scatter R' + T', and lose as much as mirrors do; the lost light is added on both
// sides in proportion to the means of R' and T'.
void PrincipledScatter::prepare_multiple() {
  const PrincipledLayers& l = layers_;
  const bool sheet = l.clear > 0 && l.thin_walled;
  if (l.metal > 0 || sheet) multiple_.emplace(l.facets);
  if (l.metal > 0) metal_more_ = multiple_->factor(mean_f82(l.metal_normal, l.metal_dip) * l.metal_weight) * l.metal_darkening;
  if (sheet) {
    Spectrum back, through;
    for (const auto& [cosine, weight] : diffuse_rule) {
      const Facets f = facets_at(cosine, false);
      back += f.clear * (weight / l.clear);
      through += f.through * (weight / l.clear);
    }
    const Spectrum more = multiple_->factor(back + through) / max(back + through, 1e-6f);
    sheet_back_ = more * back;
    sheet_through_ = more * through;
  } else if (l.clear > 0 && l.facets.isotropic()) {
    clear_multiple_.emplace(l.facets, l.eta[0]);
    clear_more_ = l.film > 0 || l.coat > 0 ? 0.75f : 1;
  }
}

// The mean of t over the light that an EON body reflects: for a Lambertian body, the mean under diffuse light. That of a rough
// body depends on the direction of the illumination, and is greatest for light along the normal: with this mean f = f_EON
// t(out) t(in) / mean never creates energy.
float PrincipledScatter::matt_normalizer() const {
  const bool lambertian = layers_.diffuse_roughness == 0;
  if (lambertian && !covered_) return gloss_.mean_passed();
  const EonLobe white(Spectrum(1.0f), layers_.diffuse_roughness);
  float mean = 0, from_normal = 0;
  for (const auto& [cosine, weight] : diffuse_rule) {
    const Vector3 v{safe_sqrt(1 - cosine * cosine), 0, cosine};
    const float t = weight * matt_passed(v);
    mean += t;
    from_normal += t * pi * white.value({0, 0, 1}, v)[0];
  }
  return std::max(mean, from_normal);
}

float PrincipledScatter::dielectric_reflectance(float cosine, int i) const {
  const float bare = fresnel_dielectric(cosine, layers_.reflect_eta[i]);
  if (!(layers_.film > 0)) return bare;
  const float filmed =
      film_fractions(film_cosine(cosine), 1, layers_.film_eta[i], layers_.reflect_eta[i], layers_.film_thickness[i]).reflected;
  return lerp(layers_.film, bare, filmed);
}

Spectrum PrincipledScatter::metal_reflectance(float cosine) const {
  Spectrum r = f82(layers_.metal_normal, layers_.metal_dip, cosine);
  if (layers_.film > 0)
    for (int i = 0; i < spectrum_size; ++i) {
      const std::complex<float> index(layers_.film_metal_n[i], layers_.film_metal_k[i]);
      r.set(i, lerp(layers_.film, r[i],
                    film_fractions(film_cosine(cosine), 1, layers_.film_eta[i], index, layers_.film_thickness[i]).reflected));
    }
  return r * layers_.metal_weight;
}

PrincipledScatter::Facets PrincipledScatter::facets_at(float cosine, bool from_inside) const {
  Facets f;
  if (layers_.metal > 0) f.metal = metal_reflectance(cosine) * layers_.metal_darkening * layers_.metal;
  if (layers_.opaque > 0 || (layers_.clear > 0 && layers_.thin_walled)) {
    Spectrum r(dielectric_reflectance(cosine, 0));
    for (int i = 1; i < spectrum_size && colored_; ++i) r.set(i, dielectric_reflectance(cosine, i));
    f.opaque = r * layers_.specular_color * layers_.gloss_darkening * layers_.opaque;
    f.clear = r;
  }
  if (!(layers_.clear > 0))
    f.clear = Spectrum();
  else if (layers_.thin_walled)
    thin_facets_at(cosine, f);
  else
    clear_facets_at(cosine, from_inside, f);
  return f;
}

// Each wavelength is refracted by its own index. From whichever side the light comes, the reflectance is computed from the
// cosine on the side of the lower index. Beyond the critical angle everything is reflected.
void PrincipledScatter::clear_facets_at(float cosine, bool from_inside, Facets& f) const {
  for (int i = 0; i < (colored_ ? spectrum_size : 1); ++i) {
    const float eta = from_inside ? 1 / layers_.eta[i] : layers_.eta[i];
    const float behind2 = 1 - (1 - cosine * cosine) / (eta * eta);
    float reflected = 1, thrown_back = 0;
    if (behind2 > 0) {
      const float behind = std::sqrt(behind2);
      reflected = dielectric_reflectance(eta >= 1 ? cosine : behind, i);
      if (from_inside && covered_) thrown_back = (1 - reflected) * (1 - upper_passed(behind));
    }
    f.clear.set(i, reflected + thrown_back);
    f.through.set(i, 1 - reflected);
  }
  if (!colored_) {
    f.clear = Spectrum(f.clear[0]);
    f.through = Spectrum(f.through[0]);
  }
  if (!from_inside) f.clear *= layers_.specular_color;
  f.clear *= layers_.clear;
  f.through *= layers_.transmission_color * layers_.clear;
}

// Both faces of a thin sheet, with R the reflectance of each and a the transmittance of one passage:
//   R' = R + (1 - R)^2 R a^2 / (1 - R^2 a^2),   T' = (1 - R)^2 a / (1 - R^2 a^2),
// whose sum is 1 for a = 1. a is transmission_color to the power 1 / cosine inside.
void PrincipledScatter::thin_facets_at(float cosine, Facets& f) const {
  for (int i = 0; i < spectrum_size; ++i) {
    const float r = f.clear[i], within = safe_sqrt(1 - (1 - cosine * cosine) / square(layers_.eta[i]));
    const float a = std::pow(layers_.transmission_color[i], 1 / std::max(within, 1e-3f));
    const float common = square(1 - r) / std::max(1 - square(r * a), 1e-9f);
    f.clear.set(i, (r + common * r * a * a) * layers_.clear);
    f.through.set(i, common * a * layers_.clear);
  }
  f.clear *= layers_.specular_color;
}

float PrincipledScatter::reflect_probability(const Facets& f, Lobes lobes) const {
  const float r = (lobes & base_reflection()) ? f.reflected().average() : 0;
  const float t = (lobes & base_transmission()) ? f.through.average() : 0;
  return r + t > 0 ? r / (r + t) : 1;
}

float PrincipledScatter::upper_passed(const Vector3& v) const { return covered_ ? fuzz_passed(v) * coat_passed(v) : 1; }

// min(T(out), T(in)) is symmetric and at most T(out): whatever lies below, no energy is created. At the centre of a highlight,
// where T(out) = T(in), it is exact.
Spectrum PrincipledScatter::through_upper(const Vector3& out, const Vector3& in) const {
  if (!covered_) return Spectrum(1.0f);
  const float fuzz = std::min(fuzz_passed(out), fuzz_passed(in)), coat = std::min(coat_passed(out), coat_passed(in));
  return coat_absorption(inverse_cosine_in_coat(out) + inverse_cosine_in_coat(in)) * (fuzz * coat);
}
Spectrum PrincipledScatter::once_through_upper(const Vector3& front, float cosine) const {
  if (!covered_) return Spectrum(1.0f);
  return coat_absorption(inverse_cosine_in_coat(front)) * std::min(upper_passed(front), upper_passed(cosine));
}

float PrincipledScatter::inverse_cosine_in_coat(const Vector3& v) const {
  return 1 / std::max(safe_sqrt(1 - (1 - v.z * v.z) / square(layers_.coat_eta)), 0.01f);
}
Spectrum PrincipledScatter::coat_absorption(float inverse_cosines) const {
  if (!(layers_.coat > 0) || layers_.coat_log_color.black()) return Spectrum(1.0f);
  return Spectrum(1 - layers_.coat) + exp(layers_.coat_log_color * (0.5f * inverse_cosines)) * layers_.coat;
}

namespace {

/// Point i of `count` points spread evenly over the square, by steps of the golden ratio.
Point2 golden_point(int i, int count) {
  const float y = 0.5f + 0.6180339887f * float(i);
  return {(float(i) + 0.5f) / float(count), y - std::floor(y)};
}

}  // namespace

// For rough facets, the mean over a few visible normals: more of them from inside, where reflection is total for some normals
// and not for others. The light of clear facets is multiplied by its masking by other facets; transmitted light also by the
// transmittance of coat and fuzz.
PrincipledScatter::Facets PrincipledScatter::mean_facets(const Vector3& out) const {
  const MicrofacetDistribution& d = layers_.facets;
  const int count = smooth_ ? 1 : inside(out) ? 16 : 5;
  const float share = 1 / float(count), eta = towards(out, layers_.eta[0]);
  Facets sum;
  for (int i = 0; i < count; ++i) {
    const Vector3 m = smooth_ ? Vector3{0, 0, 1} : d.sample_visible(out, golden_point(i, count));
    const float cosine = std::abs(dot(out, m));
    Facets f = facets_at(cosine, inside(out));
    float behind = 0, passed = upper_passed(out);
    if (layers_.clear > 0 && !layers_.thin_walled) {
      const bool total = fresnel_dielectric(cosine, eta, behind) >= 1;
      const Vector3 back = reflect(out, m), through = total ? -out : refract(out, m, eta, behind);
      if (covered_ && inside(out)) passed = std::min(upper_passed(through), upper_passed(behind));
      if (!smooth_) {
        const float seen = 1 + d.lambda(out);
        f.clear *= back.z * out.z > 0 ? d.G2(out, back) * seen : 0;
        f.through *= through.z * out.z < 0 ? d.G2_through(out, through) * seen : 0;
      }
    }
    sum.metal += f.metal * share;
    sum.opaque += f.opaque * share;
    sum.clear += f.clear * share;
    sum.through += f.through * (share * passed);
  }
  return sum;
}

Spectrum PrincipledScatter::local_albedo(const Vector3& out, Lobes lobes) const {
  const PrincipledLayers& l = layers_;
  const float front = fronting(out), upper = upper_passed(out);
  const Spectrum coat = coat_absorption(2 * inverse_cosine_in_coat(out));
  Spectrum sum;
  if (lobes & glossy_reflection) sum += l.fuzz_color * (front * (1 - fuzz_passed(out)));
  if (lobes & coat_reflection()) sum += Spectrum(front * (1 - coat_passed(out)) * fuzz_passed(out));
  if (lobes & diffuse_reflection) sum += matt_.albedo(out) * l.matt_darkening * coat * (l.opaque * matt_passed(out));
  if (lobes & diffuse_transmission) sum += matt_through_.albedo(out) * l.matt_darkening * coat * (l.opaque * matt_passed(out));

  if (lobes & (base_reflection() | base_transmission())) {
    const Facets f = mean_facets(out);
    const Spectrum above = coat * upper;
    const float missing = multiple_ ? multiple_->missing(out) : 0, sheet = l.thin_walled ? missing : 0;
    const float more = clear_more_ > 0 ? l.clear * clear_more_ * clear_multiple_->missing(out) : 0;
    const float share = clear_more_ > 0 ? clear_multiple_->transmitted_share(out) : 0;
    if (lobes & base_reflection()) {
      const Spectrum gloss =
          smooth_ || colored_ ? f.opaque : l.specular_color * l.gloss_darkening * (l.opaque * (1 - gloss_.passed(out)));
      sum += (f.metal * (1 - missing) + metal_more_ * (l.metal * missing) + gloss) * above;
      sum += (f.clear * (1 - sheet) + sheet_back_ * (l.clear * sheet) + Spectrum(more * (1 - share))) *
             (inside(out) ? Spectrum(1.0f) : above);
    }
    if (lobes & base_transmission())
      sum += (f.through * (1 - sheet) + (sheet_through_ * (l.clear * sheet) + l.transmission_color * (more * share)) * upper) *
             coat_absorption(inverse_cosine_in_coat(out));
  }
  sum *= l.opacity;
  if (lobes & null_scattering) sum += Spectrum(1 - l.opacity);
  return clamp(sum, 0, 1);
}

}  // namespace etendue
