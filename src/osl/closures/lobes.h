#pragma once
// The scatter models of closures that no shader of the house has.

#include <array>

#include "components/shaders/fresnel.h"
#include "components/shaders/half_vector.h"
#include "components/shaders/layered/sheen.h"
#include "components/shaders/microfacet/facet_reflection.h"
#include "components/shaders/microfacet/film_interference.h"

namespace etendue::osl {

// Sheen (Estevez & Kulla 2017), f = color D / (4 |out.z in.z| ...) as in sheen.h. Directions are sampled uniformly over the
// hemisphere: the lobe is broad.
class SheenModel final : public ScatterModel<SheenModel> {
 public:
  static constexpr bool uses_choice = false;
  SheenModel(const SurfacePoint& p, Spectrum color, float roughness)
      : ScatterModel(p, diffuse_reflection), color_(color), lobe_(roughness) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? color_ * lobe_.value(out, in) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const { return out.z * in.z > 0 ? warp::hemisphere_pdf : 0; }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    s.in = warp::hemisphere(u);
    if (out.z < 0) s.in.z = -s.in.z;
    s.pdf = warp::hemisphere_pdf;
    s.value = local_evaluate(out, s.in, lobes) * std::abs(s.in.z);
    s.lobe = diffuse_reflection;
    return out.z != 0 && s.in.z != 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return lobes & diffuse_reflection ? color_ * lobe_.albedo(out) : Spectrum();
  }

 private:
  Spectrum color_;
  SheenLobe lobe_;
};

// The diffuse part of Burley 2012, "Physically based shading at Disney":
//   f = color / pi (1 + (F90 - 1) (1 - v)^5) (1 + (F90 - 1) (1 - v')^5)   [1/sr],   F90 = 1/2 + 2 roughness u^2,
// with the cosines v, v' of the directions with the normal and u of either with the half-vector. A rough white surface would
// reflect up to 1.3 of the light at grazing angles: with a(v) its albedo seen from v, f is multiplied by the smaller of
// 1 / max(1, a(v)) and 1 / max(1, a(v')), which keeps it reciprocal and below 1. Sampled with cos / pi.
class BurleyModel final : public ScatterModel<BurleyModel> {
 public:
  static constexpr bool uses_choice = false;
  BurleyModel(const SurfacePoint& p, Spectrum color, float roughness)
      : ScatterModel(p, diffuse_reflection), color_(color), roughness_(roughness) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    if (!(out.z * in.z > 0)) return {};
    const float most = std::max(white_albedo(std::abs(out.z)), white_albedo(std::abs(in.z)));
    return color_ * (inverse_pi * relative(out, in, roughness_) / std::max(most, 1.0f));
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? std::abs(in.z) * inverse_pi : 0;
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    s.in = warp::cosine_hemisphere(u);
    if (out.z < 0) s.in.z = -s.in.z;
    s.pdf = local_pdf(out, s.in, lobes);
    s.value = local_evaluate(out, s.in, lobes) * std::abs(s.in.z);
    s.lobe = diffuse_reflection;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return lobes & diffuse_reflection ? color_ * std::min(white_albedo(std::abs(out.z)), 1.0f) : Spectrum();
  }

 private:
  static float relative(const Vector3& out, const Vector3& in, float roughness) {
    const float u = half_vector(out, in).u, f = 2 * roughness * u * u - 0.5f;
    return (1 + f * schlick_growth(std::abs(out.z))) * (1 + f * schlick_growth(std::abs(in.z)));
  }
  /// a(v) of a white surface: the mean of `relative` over directions with the pdf cos / pi. It is a polynomial of second degree
  /// in the roughness, whose coefficients are tabulated by the cosine.
  float white_albedo(float cosine) const {
    static const auto table = [] {
      std::array<std::array<float, 3>, cells + 1> t;
      for (int i = 0; i <= cells; ++i) {
        const float c = std::max(float(i) / cells, 1e-4f), none = mean(c, 0), half = mean(c, 0.5f), full = mean(c, 1);
        t[size_t(i)] = {none, 4 * half - 3 * none - full, 2 * (none + full - 2 * half)};
      }
      return t;
    }();
    const float x = std::min(cosine, 1.0f) * cells;
    const int i = std::min(int(x), cells - 1);
    const auto at = [&](int k) {
      const auto& c = table[size_t(k)];
      return c[0] + roughness_ * (c[1] + roughness_ * c[2]);
    };
    return lerp(x - float(i), at(i), at(i + 1));
  }
  /// By 64 x 64 midpoints.
  static float mean(float cosine, float roughness) {
    constexpr int steps = 64;
    const Vector3 out = towards_x(cosine);
    double sum = 0;
    for (int i = 0; i < steps; ++i) {
      const float z = std::sqrt((float(i) + 0.5f) / steps), sine = safe_sqrt(1 - z * z);
      for (int k = 0; k < steps; ++k) {
        const float phi = pi * (float(k) + 0.5f) / steps;
        sum += double(relative(out, {sine * std::cos(phi), sine * std::sin(phi), z}, roughness));
      }
    }
    return float(sum / (steps * steps));
  }

  static constexpr int cells = 64;
  Spectrum color_;
  float roughness_;
};

// Phong's lobe, f = color (n + 2) / (2 pi) cos(a)^n [1/sr], where a is the angle between `in` and the mirror direction of `out`
// (Lafortune & Willems 1994). Directions have the pdf (n + 1) / (2 pi) cos(a)^n; those below the surface are absorbed. The
// albedo is estimated by the line between its values at normal and at grazing incidence (see phong_shader.cpp).
class PhongModel final : public ScatterModel<PhongModel> {
 public:
  static constexpr bool uses_choice = false;
  PhongModel(const SurfacePoint& p, Spectrum color, float exponent)
      : ScatterModel(p, glossy_reflection), color_(color), exponent_(exponent) {
    const float n = exponent;
    grazing_ = (n + 2) / (2 * pi) * std::exp(std::lgamma((n + 1) / 2) + std::lgamma(1.5f) - std::lgamma(n / 2 + 2));
  }

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? color_ * ((exponent_ + 2) / (2 * pi) * power(out, in)) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? (exponent_ + 1) / (2 * pi) * power(out, in) : 0;
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    const float t = -std::expm1(std::log(std::max(u.x, 1e-30f)) / (exponent_ + 1));
    const float sine = safe_sqrt(t * (2 - t)), phi = 2 * pi * u.y;
    s.in = Frame(Normal3{-out.x, -out.y, out.z}).to_world({sine * std::cos(phi), sine * std::sin(phi), 1 - t});
    s.pdf = local_pdf(out, s.in, lobes);
    s.value = local_evaluate(out, s.in, lobes) * std::abs(s.in.z);
    s.lobe = glossy_reflection;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return lobes & glossy_reflection ? color_ * lerp(std::abs(out.z), grazing_, 1) : Spectrum();
  }

 private:
  /// cos(a)^n from the squared distance of `in` and the mirror direction: cos(a) = 1 - d^2 / 2.
  float power(const Vector3& out, const Vector3& in) const {
    const float d2 = length_squared(in - Vector3{-out.x, -out.y, out.z});
    return d2 >= 2 ? 0 : std::exp(exponent_ * std::log1p(-0.5f * d2));
  }
  Spectrum color_;
  float exponent_, grazing_;
};

/// Fresnel reflection as Schlick's approximation generalizes it: F = F0 + (F90 - F0) (1 - cos)^exponent.
struct SchlickFresnel {
  Spectrum f0, f90;
  float exponent = 5;
  Spectrum at(float cosine) const { return f0 + (f90 - f0) * std::pow(clamp(1 - cosine, 0, 1), exponent); }
  /// The mean under diffuse light: the integral of 2 c (1 - c)^n is 2 / ((n + 1) (n + 2)).
  Spectrum mean() const { return f0 + (f90 - f0) * (2 / ((exponent + 1) * (exponent + 2))); }
};

/// Fresnel reflection of a film (film_interference.h).
struct FilmFresnel {
  Spectrum outside = Spectrum(1.0f), film, base, absorbing;
  Spectrum thickness;  ///< in wavelengths

  void set_thickness(float nanometres, const Wavelengths& w) {
    for (int i = 0; i < spectrum_size; ++i) thickness.set(i, nanometres / w[i]);
  }
  Spectrum at(float cosine) const {
    Spectrum r;
    for (int i = 0; i < spectrum_size; ++i)
      r.set(i, film_fractions(cosine, outside[i], film[i], {base[i], absorbing[i]}, thickness[i]).reflected);
    return r;
  }
  /// The mean under diffuse light, the integral of 2 c F(c), by the midpoint rule in c^2.
  Spectrum mean() const {
    constexpr int steps = 8;
    Spectrum sum;
    for (int i = 0; i < steps; ++i) sum += at(std::sqrt((float(i) + 0.5f) / steps));
    return sum / float(steps);
  }
};

// The reflection of a smooth dielectric boundary through which no light goes: a coat, of which only the reflection is wanted.
// It is not the house's dielectric without its refraction, as that sees facets of the opposite tilt under total internal
// reflection, to let trapped light out (scatter_corrections.h): here they would lose light.
class CoatModel final : public ScatterModel<CoatModel> {
 public:
  static constexpr bool uses_choice = false;
  /// eta: the index behind the surface over that in front.
  CoatModel(const SurfacePoint& p, Spectrum color, Spectrum eta)
      : ScatterModel(p, specular_reflection), color_(color), eta_(eta) {}
  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3& out, float, Point2, Lobes, LocalSample& s) const {
    s.in = {-out.x, -out.y, out.z};
    s.value = reflectance(out);
    s.pdf = 1;
    s.lobe = specular_reflection;
    return true;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return lobes & specular_reflection ? reflectance(out) : Spectrum();
  }

 private:
  Spectrum reflectance(const Vector3& out) const {
    Spectrum r;
    for (int i = 0; i < spectrum_size; ++i) r.set(i, fresnel_dielectric(std::abs(out.z), out.z > 0 ? eta_[i] : 1 / eta_[i]));
    return color_ * r;
  }
  Spectrum color_, eta_;
};

// The same with facets: f = F D G2 / (4 |out.z in.z|) [1/sr]. Light that the coat scatters more than once counts as
// transmitted, as in the house's coats (CoatTransmittance).
class RoughCoatModel final : public ScatterModel<RoughCoatModel> {
 public:
  static constexpr bool uses_choice = false;
  RoughCoatModel(const SurfacePoint& p, const Frame& frame, const MicrofacetDistribution& distribution, Spectrum color,
                 Spectrum eta)
      : ScatterModel(p, frame, glossy_reflection),
        distribution_(distribution),
        color_(color),
        eta_(eta),
        varies_(eta.minimum() != eta.maximum()) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return local_value_and_pdf(out, in, lobes).value;
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (!(out.z * in.z > 1e-7f)) return 0;
    const Vector3 m = reflection_half_vector(out, in);
    return distribution_.visible_pdf(out, m) * reflection_jacobian(dot(out, m));
  }
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (!(out.z * in.z > 1e-7f)) return {};
    const Vector3 m = reflection_half_vector(out, in);
    const float out_m = dot(out, m);
    const Spectrum f = of_each(out, [&](float eta) { return fresnel_dielectric(std::abs(out_m), eta); });
    return {color_ * f * (distribution_.D(m) * distribution_.visibility(out, in)),
            distribution_.visible_pdf(out, m) * reflection_jacobian(out_m)};
  }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes lobes, LocalSample& s) const {
    s.in = reflect(out, distribution_.sample_visible(out, u));
    const ScatterValue both = local_value_and_pdf(out, s.in, lobes);
    s.value = both.value * std::abs(s.in.z);
    s.pdf = both.pdf;
    s.lobe = glossy_reflection;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    if (!(lobes & glossy_reflection)) return {};
    return color_ * of_each(out, [&](float eta) { return reflected(out, eta); });
  }

 private:
  /// f of the index behind the surface over that in front, at each wavelength.
  template <class F>
  Spectrum of_each(const Vector3& out, const F& f) const {
    const auto at = [&](int i) { return f(out.z > 0 ? eta_[i] : 1 / eta_[i]); };
    Spectrum s(at(0));
    for (int i = 1; i < spectrum_size && varies_; ++i) s.set(i, at(i));
    return s;
  }
  /// The albedo of single reflection. It is tabulated for isotropic distributions; of others for the alpha along `out`.
  float reflected(const Vector3& out, float eta) const {
    const float s2 = out.x * out.x + out.y * out.y, x2 = s2 > 0 ? out.x * out.x / s2 : 1;
    const MicrofacetDistribution d(distribution_.kind,
                                   std::sqrt(lerp(x2, square(distribution_.alpha_y), square(distribution_.alpha_x))));
    return 1 - CoatTransmittance(d, clamp(eta, 0.2501f, 3.999f))(out);
  }

  MicrofacetDistribution distribution_;
  Spectrum color_, eta_;
  bool varies_;
};

}  // namespace etendue::osl
