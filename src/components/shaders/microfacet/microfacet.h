#pragma once
// Microfacet surfaces: distributions of normals, Smith's masking, sampling of visible normals, half vectors, and energy
// compensation for multiple scattering.
//
// All functions are local: z is along the mean normal. Directions `out` and `in` point away from the surface and may lie on
// either side; micronormals m have m.z > 0. Walter et al. 2007, "Microfacet models for refraction through rough surfaces";
// Heitz 2014, "Understanding the masking-shadowing function in microfacet-based BRDFs".

#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"

namespace etendue {

struct MicrofacetDistribution {
  enum Kind { ggx, beckmann };
  /// A surface whose alphas are both at most this is treated as smooth: the lobe is narrower than any pixel or light source.
  static constexpr float smooth_below = 1e-3f;

  /// How masking and shadowing are correlated by the heights of facets. by_side: by the same heights in reflection
  /// (correlated), and independent in transmission. Other renderers take the two for independent everywhere, or for correlated
  /// everywhere: at oblique angles this changes up to a tenth of the reflected light.
  enum class Heights : std::uint8_t { by_side, independent, correlated };

  Kind kind = ggx;
  Heights heights = Heights::by_side;
  float alpha_x = 1, alpha_y = 1;  ///< root of twice the mean square slope along x and y (Beckmann); the same scale for GGX

  MicrofacetDistribution() = default;
  /// Roughness is alpha, clamped to [smooth_below, 1]; not-a-number becomes smooth_below.
  MicrofacetDistribution(Kind k, float roughness_x, float roughness_v)
      : kind(k), alpha_x(valid(roughness_x)), alpha_y(valid(roughness_v)) {}
  MicrofacetDistribution(Kind k, float roughness) : MicrofacetDistribution(k, roughness, roughness) {}

  bool smooth() const { return std::max(alpha_x, alpha_y) <= smooth_below; }
  bool isotropic() const { return alpha_x == alpha_y; }

  /// The distribution of normals: area of facets with normals around m, per area of the surface and solid angle [1/sr]. The
  /// integral of D(m) m.z is 1.
  float D(const Vector3& m) const {
    if (!(m.z > 0)) return 0;
    const float x = m.x / alpha_x, y = m.y / alpha_y, z2 = m.z * m.z, front = inverse_pi / (alpha_x * alpha_y);
    if (kind == ggx) return front / square(x * x + y * y + z2);
    return front * std::exp(-(x * x + y * y) / z2) / (z2 * z2);
  }

  /// Smith's auxiliary function: the area of masked front-facing facets over that of visible ones, seen from v.
  float lambda(const Vector3& v) const { return kind == ggx ? 0.5f * (stretched(v) / std::abs(v.z) - 1) : beckmann_lambda(v); }

  /// Masking: the fraction of facets of normal m that is visible from v (independent of m, except that m must face v).
  float G1(const Vector3& v, const Vector3& m) const { return dot(v, m) * v.z > 0 ? 1 / (1 + lambda(v)) : 0; }

  /// Masking-shadowing in reflection: the fraction visible from both directions, on the same side. Heights are correlated
  /// (Heitz 2014, eq. 99) unless `heights` says independent.
  float G2(const Vector3& out, const Vector3& in) const {
    return heights == Heights::independent ? independent_G2(out, in) : correlated_G2(out, in);
  }
  /// G2 / (4 |out.z in.z|), the factor of a reflecting lobe: f = F D(m) visibility.
  float visibility(const Vector3& out, const Vector3& in) const {
    if (kind == ggx && heights != Heights::independent)
      return 0.5f / (std::abs(out.z) * stretched(in) + std::abs(in.z) * stretched(out));
    return G2(out, in) / (4 * std::abs(out.z * in.z));
  }
  /// Masking-shadowing in transmission, for directions on opposite sides. Heights are independent (Walter et al. 2007, eq. 23)
  /// unless `heights` says correlated.
  float G2_through(const Vector3& out, const Vector3& in) const {
    return heights == Heights::correlated ? correlated_G2(out, in) : independent_G2(out, in);
  }

  /// The pdf [1/sr] of sample_visible, the distribution of visible normals: of the projected area visible from `out`, the share
  /// with normals around m: G1(out) |out . m| D(m) / |out.z| (Heitz 2014, eq. 16).
  float visible_pdf(const Vector3& out, const Vector3& m) const {
    const float cosine = out.z > 0 ? dot(out, m) : -dot(out, m);
    if (!(cosine > 0)) return 0;
    if (kind == ggx) return 2 * cosine * D(m) / (std::abs(out.z) + stretched(out));
    return cosine * D(m) / (std::abs(out.z) * (1 + beckmann_lambda(out)));
  }
  /// Samples a visible normal.
  Vector3 sample_visible(const Vector3& out, Point2 u) const {
    const bool above = out.z > 0;
    const Vector3 v = above ? out : -out;  // normals visible from below are those visible from the opposite direction
    return kind == ggx ? sample_visible_ggx(v, u) : sample_visible_beckmann(v, u);
  }

  /// A typical |v . m| of the facets visible from v, by a fit: for estimates of their reflectance.
  float typical_cosine(const Vector3& v) const {
    const float slope2 = (kind == ggx ? 2.0f : 0.75f) * (square(alpha_x * v.x) + square(alpha_y * v.y));
    return std::sqrt((v.z * v.z + slope2) / (1 + slope2));
  }

 private:
  float correlated_G2(const Vector3& out, const Vector3& in) const { return 1 / (1 + lambda(out) + lambda(in)); }
  float independent_G2(const Vector3& out, const Vector3& in) const { return 1 / ((1 + lambda(out)) * (1 + lambda(in))); }
  static float valid(float roughness) { return roughness > smooth_below ? std::min(roughness, 1.0f) : smooth_below; }
  /// Length of v after the surface is stretched to alpha 1.
  float stretched(const Vector3& v) const { return std::sqrt(square(alpha_x * v.x) + square(alpha_y * v.y) + v.z * v.z); }
  float beckmann_lambda(const Vector3& v) const;
  Vector3 sample_visible_ggx(const Vector3& v, Point2 u) const;
  Vector3 sample_visible_beckmann(const Vector3& v, Point2 u) const;
};

// ---- half vectors -----------------------------------------------------------------------------------------------------

/// The micronormal (m.z > 0) that reflects `out` into `in`, both on the same side.
inline Vector3 reflection_half_vector(const Vector3& out, const Vector3& in) {
  const Vector3 h = out + in;
  return normalize(h.z < 0 ? -h : h);
}
/// `out` reflected by a facet of normal m.
inline Vector3 reflect(const Vector3& out, const Vector3& m) { return 2 * dot(out, m) * m - out; }
/// Jacobian of reflection: solid angle of normals over that of reflected directions (Walter et al. 2007, eq. 14), from out . m.
inline float reflection_jacobian(float out_m) { return 1 / (4 * std::abs(out_m)); }

/// The micronormal (m.z > 0) that refracts `out` into `in`, on opposite sides; eta: index on the side of `in` over that on
/// the side of `out`. No facet does so unless out . m has the sign of out.z and in . m that of in.z.
inline Vector3 refraction_half_vector(const Vector3& out, const Vector3& in, float eta) {
  const Vector3 h = out + eta * in;
  const float squared = length_squared(h);
  if (!(squared > 0)) return {0, 0, 1};
  return h * std::copysign(1 / std::sqrt(squared), h.z);
}
/// `out` refracted by a facet of normal m; cosine_behind is that of the refracted direction (see fresnel_dielectric).
inline Vector3 refract(const Vector3& out, const Vector3& m, float eta, float cosine_behind) {
  const float out_m = dot(out, m);
  return (-1 / eta) * out + (out_m / eta - std::copysign(cosine_behind, out_m)) * m;
}
/// Jacobian of refraction: solid angle of normals over that of refracted directions (Walter et al. 2007, eq. 17), from out . m
/// and in . m.
inline float refraction_jacobian(float out_m, float in_m, float eta) {
  return eta * eta * std::abs(in_m) / square(out_m + eta * in_m);
}

// ---- light scattered more than once -----------------------------------------------------------------------------------

/// Energy compensation for reflection: the light that single scattering loses at a surface of F = 1, returned as a lobe of its
/// own (Kulla & Conty 2017, "Revisiting physically based shading at Imageworks"). With E the albedo of single scattering and Em
/// its mean under diffuse light, f = (1 - E(out)) (1 - E(in)) / (pi (1 - Em)) is reciprocal, and has the albedo 1 - E(out). E
/// comes from a table, computed at first use.
class MultipleReflection {
 public:
  explicit MultipleReflection(const MicrofacetDistribution&);

  /// 1 - E(v).
  float missing(const Vector3& v) const;
  /// 1 - Em.
  float mean_missing() const { return mean_missing_; }
  /// f for F = 1 [1/sr].
  float value(const Vector3& out, const Vector3& in) const { return value(missing(out), missing(in)); }
  float value(float missing_out, float missing_in) const {
    return missing_out * missing_in * inverse_pi / std::max(mean_missing_, 1e-7f);
  }
  /// The factor of the lobe for F < 1, given F's mean under diffuse light (mean_fresnel_...). Each reflection multiplies by F:
  /// F (1 - Em) of the light hits a second facet, and of that the series F Em (1 + F (1 - Em) + ...) leaves. This is divided by
  /// 1 - Em, which leaves for F = 1.
  Spectrum factor(Spectrum mean_fresnel) const {
    return mean_fresnel * mean_fresnel * (1 - mean_missing_) / (Spectrum(1.0f) - mean_fresnel * mean_missing_);
  }

 private:
  MicrofacetDistribution distribution_;
  float mean_missing_;
};

/// Energy compensation for a boundary between dielectrics, which absorbs nothing: with M the mean of 1 - E under diffuse light
/// on the side of `in`, f = x (1 - E(out)) (1 - E(in)) / (pi M), where x is the share of the light lost by single scattering
/// that leaves on that side.
class MultipleRefraction {
 public:
  /// eta: index below the surface (z < 0) over that above; if it is outside the tables (see `known`), the nearest one inside is
  /// used.
  MultipleRefraction(const MicrofacetDistribution&, float eta);

  /// Whether albedos are tabulated for a distribution and an eta: isotropic distributions, and eta from 1 / 4 to 4.
  static bool known(const MicrofacetDistribution& d, float eta) { return d.isotropic() && eta >= 0.25f && eta <= 4; }

  /// 1 - E(v), with E the albedo of single reflection and refraction together.
  float missing(const Vector3& v) const;
  /// Of the light from the side of v that single scattering loses, the share that is transmitted.
  float transmitted_share(const Vector3& v) const { return transmitted_[v.z < 0]; }
  /// f [1/sr], in the convention of importance; reciprocal: f(out, in) / n_in^2 = f(in, out) / n_out^2.
  float value(const Vector3& out, const Vector3& in) const {
    const float through = transmitted_share(out), share = out.z * in.z > 0 ? 1 - through : through;
    return share * missing(out) * missing(in) * inverse_pi / std::max(mean_missing_[in.z < 0], 1e-7f);
  }

 private:
  MicrofacetDistribution distribution_;
  // By side: above, below.
  float eta_[2], mean_missing_[2], transmitted_[2];
};

/// The transmittance of a rough dielectric coat: 1 minus the albedo of single reflection. Light scattered more than once by the
/// coat counts as transmitted. For isotropic distributions, and eta from 1 / 4 to 4.
class CoatTransmittance {
 public:
  /// eta: index of the coat over that in front.
  CoatTransmittance(const MicrofacetDistribution&, float eta);

  float operator()(const Vector3& v) const;
  /// The mean under diffuse light.
  float mean() const { return mean_; }

 private:
  MicrofacetDistribution distribution_;
  float eta_, mean_;
};

}  // namespace etendue
