#pragma once
// Reflection by a mirror and by facets, for any law of Fresnel reflection: metals, films, and what other renderers have
// instead.
//
// A Fresnel is copied, and has `Spectrum at(float cosine) const`, the reflectance at a facet, and `Spectrum mean() const`, its
// mean under diffuse light, the integral of 2 c F(c) over the cosine c. If it also has `Polarization polarization(const
// Vector3& out, const Vector3& in) const`, what reflection at the facet between these directions does to polarization, the
// reflection polarizes light.

#include <concepts>
#include <type_traits>

#include "etendue/core/warp.h"
#include "etendue/polarizing_scatter.h"
#include "etendue/scatter_model.h"
#include "microfacet.h"

namespace etendue {

template <class Fresnel>
concept PolarizingFresnel = requires(const Fresnel& fresnel, const Vector3& v) {
  { fresnel.polarization(v, v) } -> std::same_as<Polarization>;
};
/// Of a Fresnel that says nothing of polarization.
struct NotPolarizing {};
/// The second base of a reflection, whose function `polarization` it implements.
template <class Fresnel>
using PolarizingIf = std::conditional_t<PolarizingFresnel<Fresnel>, PolarizingScatter, NotPolarizing>;

template <class Fresnel>
class MirrorReflection final : public ScatterModel<MirrorReflection<Fresnel>>, public PolarizingIf<Fresnel> {
 public:
  static constexpr bool uses_choice = false;

  /// `tint`: multiplies the reflected light.
  MirrorReflection(const SurfacePoint& p, const Fresnel& fresnel, Spectrum tint)
      : ScatterModel<MirrorReflection>(p, specular_reflection), fresnel_(fresnel), tint_(tint) {}

  Spectrum local_evaluate(const Vector3&, const Vector3&, Lobes) const { return {}; }
  float local_pdf(const Vector3&, const Vector3&, Lobes) const { return 0; }
  bool local_sample(const Vector3& out, float, Point2, Lobes, LocalSample& s) const {
    s.in = {-out.x, -out.y, out.z};
    s.value = tint_ * fresnel_.at(std::abs(out.z));
    s.pdf = 1;
    s.lobe = specular_reflection;
    return true;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return (lobes & specular_reflection) ? tint_ * fresnel_.at(std::abs(out.z)) : Spectrum();
  }
  bool polarization(const Vector3& out, const Vector3& in, Lobes, Polarization& event) const {
    event = fresnel_.polarization(out, in);
    return true;
  }

 private:
  Fresnel fresnel_;
  Spectrum tint_;
};

// f is the sum of single scattering, f1 = F D(m) G2 / (4 |out.z in.z|)  [1/sr]  (Torrance & Sparrow 1967; Walter et al. 2007,
// eq. 20), and multiple scattering, f2 (see MultipleReflection).
//
// f1 is sampled by visible normals, f2 with the pdf cos / pi. f2 is chosen with a probability q that is its share of the
// reflected light, computed with the mean of F. Samples of f1 that lead below the surface are absorbed, so the pdf integrates
// to less than 1.
template <class Fresnel>
class FacetReflection final : public ScatterModel<FacetReflection<Fresnel>>, public PolarizingIf<Fresnel> {
  using Base = ScatterModel<FacetReflection<Fresnel>>;
  using Base::has_choice_;

 public:
  /// `multiple`: whether light that meets more than one facet is counted, or lost.
  FacetReflection(const SurfacePoint& p, const Frame& frame, const MicrofacetDistribution& distribution, const Fresnel& fresnel,
                  Spectrum tint, bool multiple)
      : Base(p, frame, glossy_reflection),
        distribution_(distribution),
        multiple_reflection_(distribution),
        fresnel_(fresnel),
        tint_(tint) {
    has_choice_ = multiple;
    if (!multiple) return;
    const Spectrum mean = fresnel.mean();
    multiple_ = multiple_reflection_.factor(mean);
    multiple_over_single_ = multiple_.average() / std::max(mean.average(), 1e-6f);
  }

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return local_value_and_pdf(out, in, lobes).value;
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (!above_horizon(out, in)) return 0;
    const float multiple = has_choice_ ? probability_of_multiple(multiple_reflection_.missing(out)) : 0;
    return pdf(out, in, reflection_half_vector(out, in), multiple);
  }
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes) const {
    if (!above_horizon(out, in)) return {};
    const Vector3 m = reflection_half_vector(out, in);
    Spectrum value = fresnel_.at(std::abs(dot(out, m))) * (distribution_.D(m) * distribution_.visibility(out, in));
    if (!has_choice_) return {tint_ * value, pdf(out, in, m, 0)};
    const float missing = multiple_reflection_.missing(out);
    value += multiple_ * multiple_reflection_.value(missing, multiple_reflection_.missing(in));
    return {tint_ * value, pdf(out, in, m, probability_of_multiple(missing))};
  }

  bool local_sample(const Vector3& out, float choice, Point2 u, Lobes lobes, LocalSample& s) const {
    if (has_choice_ && choice < probability_of_multiple(multiple_reflection_.missing(out))) {
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

  /// F is taken at one angle for all facets.
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    if (!(lobes & glossy_reflection)) return {};
    const float missing = multiple_reflection_.missing(out);
    return tint_ * (fresnel_.at(distribution_.typical_cosine(out)) * (1 - missing) + multiple_ * missing);
  }

  /// Light that was scattered more than once is taken for unpolarized.
  bool polarization(const Vector3& out, const Vector3& in, Lobes, Polarization& event) const {
    event = fresnel_.polarization(out, in);
    if (!has_choice_) return true;
    const Vector3 o = this->frame_.to_local(out), i = this->frame_.to_local(in), m = reflection_half_vector(o, i);
    PolarizationMean mean(out, in);
    mean.add(fresnel_.at(std::abs(dot(o, m))) * (distribution_.D(m) * distribution_.visibility(o, i)), event);
    mean.add_unpolarized(multiple_ *
                         multiple_reflection_.value(multiple_reflection_.missing(o), multiple_reflection_.missing(i)));
    return mean.mean(event);
  }

 private:
  /// Whether both directions are on one side, and not both along the surface, where D and the visibility have no limit.
  static bool above_horizon(const Vector3& out, const Vector3& in) { return out.z * in.z > 1e-7f; }
  float probability_of_multiple(float missing) const {
    const float multiple = missing * multiple_over_single_;
    return multiple / (multiple + 1 - missing);
  }
  float pdf(const Vector3& out, const Vector3& in, const Vector3& m, float multiple) const {
    return (1 - multiple) * distribution_.visible_pdf(out, m) * reflection_jacobian(dot(out, m)) +
           multiple * std::abs(in.z) * inverse_pi;
  }

  MicrofacetDistribution distribution_;
  MultipleReflection multiple_reflection_;
  Fresnel fresnel_;
  Spectrum tint_, multiple_;  ///< multiple_: factor of multiple scattering relative to F = 1
  float multiple_over_single_ = 0;
};

}  // namespace etendue
