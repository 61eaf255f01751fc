#pragma once
// The scatter models of closures that no shader of the house has.

#include "components/shaders/fresnel.h"
#include "components/shaders/half_vector.h"
#include "components/shaders/layered/sheen.h"
#include "components/shaders/microfacet/film_interference.h"
#include "components/shaders/microfacet/microfacet.h"
#include "etendue/core/warp.h"
#include "etendue/scatter_model.h"

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
// with the cosines v, v' of the directions with the normal and u of either with the half-vector. Sampled with cos / pi.
class BurleyModel final : public ScatterModel<BurleyModel> {
 public:
  static constexpr bool uses_choice = false;
  BurleyModel(const SurfacePoint& p, Spectrum color, float roughness)
      : ScatterModel(p, diffuse_reflection), color_(color), roughness_(roughness) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? color_ * (inverse_pi * relative(out, in)) : Spectrum();
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
    return lobes & diffuse_reflection ? color_ * mean(std::abs(out.z)) : Spectrum();
  }

 private:
  float relative(const Vector3& out, const Vector3& in) const {
    const float u = half_vector(out, in).u, f = 2 * roughness_ * u * u - 0.5f;
    return (1 + f * schlick_growth(std::abs(out.z))) * (1 + f * schlick_growth(std::abs(in.z)));
  }
  /// The mean of `relative` over directions with the pdf cos / pi, by 4 x 8 midpoints.
  float mean(float cosine) const {
    const Vector3 out = towards_x(cosine);
    float sum = 0;
    for (int i = 0; i < 4; ++i) {
      const float z = std::sqrt((float(i) + 0.5f) / 4), sine = safe_sqrt(1 - z * z);
      for (int k = 0; k < 8; ++k) {
        const float phi = pi * (float(k) + 0.5f) / 8;
        sum += relative(out, {sine * std::cos(phi), sine * std::sin(phi), z});
      }
    }
    return sum / 32;
  }

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

/// Fresnel reflection of a film (film_interference.h), times a colour.
struct FilmFresnel {
  Spectrum color = Spectrum(1.0f), outside = Spectrum(1.0f), film, base, absorbing;
  Spectrum thickness;  ///< in wavelengths

  void set_thickness(float nanometres, const Wavelengths& w) {
    for (int i = 0; i < spectrum_size; ++i) thickness.set(i, nanometres / w[i]);
  }
  Spectrum at(float cosine) const {
    Spectrum r;
    for (int i = 0; i < spectrum_size; ++i)
      r.set(i, film_fractions(cosine, outside[i], film[i], {base[i], absorbing[i]}, thickness[i]).reflected);
    return color * r;
  }
  /// The mean under diffuse light, the integral of 2 c F(c), by the midpoint rule in c^2.
  Spectrum mean() const {
    constexpr int steps = 8;
    Spectrum sum;
    for (int i = 0; i < steps; ++i) sum += at(std::sqrt((float(i) + 0.5f) / steps));
    return sum / float(steps);
  }
};

// A mirror with that reflectance; exponent 5 and F0 = F90 = 1 is the perfect one.
class MirrorModel final : public ScatterModel<MirrorModel> {
 public:
  static constexpr bool uses_choice = false;
  MirrorModel(const SurfacePoint& p, const SchlickFresnel& fresnel) : ScatterModel(p, specular_reflection), fresnel_(fresnel) {}
  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3& out, float, Point2, Lobes, LocalSample& s) const {
    s.in = {-out.x, -out.y, out.z};
    s.value = fresnel_.at(std::abs(out.z));
    s.pdf = 1;
    s.lobe = specular_reflection;
    return true;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return lobes & specular_reflection ? fresnel_.at(std::abs(out.z)) : Spectrum();
  }

 private:
  SchlickFresnel fresnel_;
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

// Facets with that reflectance: f = F D G2 / (4 |out.z in.z|) [1/sr] and multiple scattering, as of a metal (conductor.cpp).
template <class Fresnel>
class FacetModel final : public ScatterModel<FacetModel<Fresnel>> {
  using Base = ScatterModel<FacetModel<Fresnel>>;

 public:
  FacetModel(const SurfacePoint& p, const Frame& frame, const MicrofacetDistribution& distribution, const Fresnel& fresnel)
      : Base(p, frame, glossy_reflection), distribution_(distribution), multiple_reflection_(distribution), fresnel_(fresnel) {
    const Spectrum mean = fresnel.mean();
    multiple_ = multiple_reflection_.factor(mean);
    multiple_over_single_ = multiple_.average() / std::max(mean.average(), 1e-6f);
  }

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return local_value_and_pdf(out, in, lobes).value;
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const { return local_value_and_pdf(out, in, lobes).pdf; }
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (!(out.z * in.z > 0)) return {};
    const Vector3 m = reflection_half_vector(out, in);
    const float missing = multiple_reflection_.missing(out), multiple = probability_of_multiple(missing);
    if (std::abs(out.z * in.z) < 1e-7f) return {};  // along the surface
    return {fresnel_.at(std::abs(dot(out, m))) * (distribution_.D(m) * distribution_.visibility(out, in)) +
                multiple_ * multiple_reflection_.value(missing, multiple_reflection_.missing(in)),
            (1 - multiple) * distribution_.visible_pdf(out, m) * reflection_jacobian(dot(out, m)) +
                multiple * std::abs(in.z) * inverse_pi};
  }
  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    if (choice < probability_of_multiple(multiple_reflection_.missing(out))) {
      s.in = warp::cosine_hemisphere(u);
      if (out.z < 0) s.in.z = -s.in.z;
    } else {
      s.in = reflect(out, distribution_.sample_visible(out, u));
    }
    const ScatterValue both = local_value_and_pdf(out, s.in, lobes);
    s.value = both.value * std::abs(s.in.z);
    s.pdf = both.pdf;
    s.lobe = glossy_reflection;
    return s.pdf > 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    if (!(lobes & glossy_reflection)) return {};
    const float missing = multiple_reflection_.missing(out);
    return fresnel_.at(distribution_.typical_cosine(out)) * (1 - missing) + multiple_ * missing;
  }

 private:
  float probability_of_multiple(float missing) const {
    const float multiple = missing * multiple_over_single_;
    return multiple / (multiple + 1 - missing);
  }
  MicrofacetDistribution distribution_;
  MultipleReflection multiple_reflection_;
  Fresnel fresnel_;
  Spectrum multiple_;
  float multiple_over_single_;
};

}  // namespace etendue::osl
