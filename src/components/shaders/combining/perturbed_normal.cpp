#include "perturbed_normal.h"

#include <algorithm>

#include "components/shaders/part_choice.h"

namespace etendue {
namespace {

// Shadowing. A perturbed normal is treated as one of the steepest facets of a rough surface. A GGX distribution of the
// corresponding alpha transmits, of light at the angle theta with the unperturbed normal, the fraction
//     2 / (1 + sqrt(1 + alpha^2 tan^2 theta)),   alpha^2 = min(tan^2(tilt) / 8, 1)
// (Conty Estevez, Lecocq & Stein 2019, equations 1 to 3), a function of the direction of the light alone.
//
// Opposite slopes. A viewer from whom the perturbed normal faces away sees the facet that is tilted as far the other way
// (Schuessler et al. 2017, section 3). The viewer is at `out` for radiance and at `in` for importance, where the visible facet
// is known only after `in` has been sampled. So for importance one of the two facets, each with probability 1/2, samples the
// direction, the pdf is the mean of both, and the value is that of the facet visible from `in`. Values for importance are thus
// the adjoint of those for radiance. Where values cannot be evaluated (delta lobes, null scattering, and shaders that are
// `stochastic`), samples of the facet that is not visible have weight 0, and those of the visible one twice their weight.
class TiltedScatter final : public Scatter {
 public:
  /// `opposite` null: the perturbed normal is used from all directions.
  TiltedScatter(const SurfacePoint& p, const Normal3& tilted, const Scatter* own, const Scatter* opposite, float alpha2,
                bool stochastic)
      : Scatter(p, Lobes(own->lobes() | (opposite ? opposite->lobes() : no_lobes))),
        own_(own),
        opposite_(opposite),
        untilted_(p.shading_normal),
        tilted_(tilted),
        alpha2_(alpha2),
        stochastic_(stochastic) {
    frame_ = own->frame();
  }

  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override {
    const bool radiance = context.transport == Transport::radiance;
    ScatterValue v = seen_from(radiance ? out : in).value_and_pdf(out, in, context);
    if (!radiance && opposite_) v.pdf = (own_->pdf(out, in, context) + opposite_->pdf(out, in, context)) / 2;
    v.value *= let_through(radiance ? in : out);
    return v;
  }

  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override {
    const bool radiance = context.transport == Transport::radiance;
    if (radiance || !opposite_ || context.lobes == null_scattering) {
      const Scatter& part = radiance || context.lobes == null_scattering ? seen_from(out) : *own_;
      std::optional<ScatterSample> s = part.sample(out, choice, u, context);
      if (s && s->lobe != null_scattering) s->weight *= let_through(radiance ? s->direction : out);
      return s;
    }
    const Scatter& part = choice < 0.5f ? *own_ : *opposite_;
    std::optional<ScatterSample> s = part.sample(out, left_of_choice(choice, 0.5f), u, context);
    if (!s) return s;
    const bool discrete = s->specular() || s->lobe == null_scattering;
    if (discrete || stochastic_) {
      if (&seen_from(s->direction) != &part) return std::nullopt;
      s->weight *= s->lobe == null_scattering ? 2 : 2 * let_through(out);
      s->pdf = discrete ? s->pdf / 2 : world_value_and_pdf(out, s->direction, context).pdf;
      return s;
    }
    const ScatterValue v = world_value_and_pdf(out, s->direction, context);
    if (!(v.pdf > 0)) return std::nullopt;
    s->weight = v.value / v.pdf;
    s->pdf = v.pdf;
    return s;
  }

  Spectrum world_albedo(const Vector3& out, Lobes lobes) const override { return seen_from(out).albedo(out, lobes); }

 private:
  const Scatter& seen_from(const Vector3& v) const {
    return opposite_ && dot(v, untilted_) * dot(v, tilted_) <= 0 ? *opposite_ : *own_;
  }
  float let_through(const Vector3& v) const {
    if (alpha2_ == 0) return 1;
    const float c2 = dot(v, untilted_) * dot(v, untilted_);
    return c2 > 0 ? 2 / (1 + std::sqrt(1 + alpha2_ * std::max(1 - c2, 0.0f) / c2)) : 0;
  }

  const Scatter *own_, *opposite_;
  Normal3 untilted_, tilted_;
  float alpha2_;
  bool stochastic_;
};

}  // namespace

const Scatter* PerturbedNormalShader::bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const {
  SurfacePoint tilted = perturbed(p);
  const Scatter* own = shader->bind(tilted, w, arena);
  const Normal3 n = tilted.shading_normal;
  if (!own || !(shadowing || opposite_slopes) || n == p.shading_normal) return own;
  const float cosine = dot(n, p.shading_normal), c2 = cosine * cosine;
  const float alpha2 = !shadowing ? 0 : c2 > 0 ? std::min(std::max(1 - c2, 0.0f) / (8 * c2), 1.0f) : 1;
  const Scatter* opposite = nullptr;
  if (opposite_slopes) {
    tilted.shading_normal = above_surface(2 * cosine * Vector3(p.shading_normal) - Vector3(n), p);
    opposite = shader->bind(tilted, w, arena);
  }
  return arena.make<TiltedScatter>(p, n, own, opposite, alpha2, stochastic());
}

}  // namespace etendue
