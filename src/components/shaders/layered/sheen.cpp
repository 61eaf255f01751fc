// SheenShader: the bright edges of velvet and dusty things, over any other surface.

#include "sheen.h"
#include "components/shaders/part_choice.h"
#include "components/shaders/reflectance.h"
#include "components/shaders/scalar_map.h"
#include "etendue/core/warp.h"
#include "etendue/scatter_model.h"

namespace etendue {
namespace {

/// The fibres alone. E is at most 0.93, and small except near the horizon; directions are sampled uniformly, with the pdf 1 /
/// (2 pi).
class SheenScatter final : public ScatterModel<SheenScatter> {
 public:
  static constexpr bool uses_choice = false;

  SheenScatter(const SurfacePoint& p, const Frame& frame, const SheenLobe& lobe, Spectrum color)
      : ScatterModel(p, frame, glossy_reflection), lobe_(lobe), color_(color) {}

  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes) const {
    return out.z * in.z > 0 ? color_ * lobe_.value(out, in) : Spectrum();
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes) const { return out.z * in.z > 0 ? warp::hemisphere_pdf : 0; }
  bool local_sample(const Vector3& out, float, Point2 u, Lobes, LocalSample& s) const {
    s.in = warp::hemisphere(u);
    if (out.z < 0) s.in.z = -s.in.z;
    s.value = color_ * (lobe_.value(out, s.in) * std::abs(s.in.z));
    s.pdf = warp::hemisphere_pdf;
    s.lobe = glossy_reflection;
    return s.in.z != 0;
  }
  Spectrum local_albedo(const Vector3& out, Lobes lobes) const {
    return (lobes & glossy_reflection) ? color_ * lobe_.albedo(out) : Spectrum();
  }

 private:
  SheenLobe lobe_;
  Spectrum color_;
};

// f = c w f_sheen + t(out, in) f_base, where w is the fraction of the surface that has fibres and
//   t(out, in) = min(T(out), T(in)),   T(v) = 1 - w E(v).
// The albedo is at most w E(out) + T(out) = 1 whatever the base is, as t <= T(out); f stays reciprocal, as t is symmetric. No
// larger t has both properties for every base: a specular base allows for no more. Estevez & Kulla 2017 scale by T(in) and
// T(out) as well. Fibres absorb nothing: the light that they do not reflect reaches the base, with its spectrum unchanged. A
// base that scatters widely loses some light (a white Lambertian one 13 % by default), as if fibres blocked it.
class CoveredScatter final : public Scatter {
 public:
  CoveredScatter(const SurfacePoint& p, const SheenScatter& sheen, const SheenLobe& lobe, float weight, const Scatter& base,
                 bool stochastic)
      : Scatter(p, Lobes(sheen.lobes() | base.lobes())),
        sheen_(sheen),
        base_(base),
        lobe_(lobe),
        weight_(weight),
        stochastic_(stochastic) {
    frame_ = base.frame();
  }

  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override {
    const float probability = sheen_probability(out, context.lobes);
    const ScatterValue a = sheen_.value_and_pdf(out, in, context);
    const ScatterValue b = base_.value_and_pdf(out, in, context);
    return {a.value + b.value * through(out, in), lerp(probability, b.pdf, a.pdf)};
  }

  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override {
    const float sheen = sheen_probability(out, context.lobes);
    const bool fibres = choice < sheen;
    const Scatter& chosen = fibres ? static_cast<const Scatter&>(sheen_) : base_;
    std::optional<ScatterSample> s = chosen.sample(out, left_of_choice(choice, sheen), u, context);
    if (!s) return s;
    const float probability = fibres ? sheen : 1 - sheen, t = through(out, s->direction);
    const float share = fibres ? 1 : t;
    if (s->specular()) {
      s->weight *= share / probability;
      s->pdf *= probability;
      return s;
    }
    const Scatter& other = fibres ? base_ : static_cast<const Scatter&>(sheen_);
    const ScatterValue v = other.value_and_pdf(out, s->direction, context);
    const float pdf = probability * s->pdf + (1 - probability) * v.pdf;
    if (stochastic_)  // the base's pdf is not that of its samples: each sample counts for its own part only
      s->weight *= share / probability;
    else
      s->weight = (s->weight * (share * s->pdf) + v.value * (fibres ? t : 1)) / pdf;
    s->pdf = pdf;
    return s;
  }

  Spectrum world_albedo(const Vector3& out, Lobes lobes) const override {
    return sheen_.albedo(out, lobes) + base_.albedo(out, lobes) * passed(out);
  }

 private:
  /// T(v).
  float passed(const Vector3& v) const { return 1 - weight_ * lobe_.albedo(frame_.to_local(v)); }
  float through(const Vector3& out, const Vector3& in) const { return std::min(passed(out), passed(in)); }
  float sheen_probability(const Vector3& out, Lobes lobes) const {
    const float a = promise(&sheen_, 1, out, lobes), b = promise(&base_, passed(out), out, lobes);
    return a + b > 0 ? a / (a + b) : 0;
  }

  const SheenScatter& sheen_;
  const Scatter& base_;
  SheenLobe lobe_;
  float weight_;
  bool stochastic_;
};

class SheenShader final : public Shader {
 public:
  static void describe(Description<SheenShader>& d) {
    d.summary(
         "Upright fibres, as of velvet, peaches or dust, which shine where a surface is seen from the side; over another "
         "surface, which gets what they let through, or over black.",
         "Estevez & Kulla 2017, Production friendly microfacet sheen BRDF")
        .member<&SheenShader::color>("color", "1", "fraction of light the fibres reflect, per wavelength", Meaning::reflectance)
        .member<&SheenShader::weight>("weight", "1", "fraction of the surface that has fibres", Meaning::number, soft(0, 1))
        .member<&SheenShader::roughness>("roughness", "1",
                                         "from 0 (upright fibres, a thin bright edge) to 1 (in disorder); below 0.1 as 0.1",
                                         Meaning::number, soft(0, 1))
        .member<&SheenShader::base>("base", "", "what lies under the fibres; nothing: black");
  }

  void prepare() override {
    require_reflectance(*this, "color", color);
    require_scalar(*this, "weight", weight);
    require_scalar(*this, "roughness", roughness);
    SheenLobe(0.5f).mean_albedo();  // computes the table
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const Scatter* below = base ? base->bind(p, w, arena) : nullptr;
    const float covered = scalar_at(*weight, p);
    if (covered <= 0) return below;
    const SheenLobe lobe(scalar_at(*roughness, p));
    const SheenScatter* sheen = arena.make<SheenScatter>(p, below ? below->frame() : Frame(p.shading_normal), lobe,
                                                         reflectance_at(*color, p, w) * covered);
    if (!below) return sheen;
    return arena.make<CoveredScatter>(p, *sheen, lobe, covered, *below, base->stochastic());
  }

  /// The fibres' transmittance for light of the base is taken for `out` alone.
  float albedo_error() const override { return base ? std::max(0.3f, base->albedo_error()) : 0.02f; }
  Lobes possible_lobes() const override { return Lobes(glossy_reflection | (base ? base->possible_lobes() : no_lobes)); }
  Spectrum interior_index(const Wavelengths& w) const override { return base ? base->interior_index(w) : Spectrum(1.0f); }
  bool transmits() const override { return base && base->transmits(); }
  bool reciprocal() const override { return !base || (base->reciprocal() && !base->has_subsurface_exit()); }
  bool stochastic() const override { return base && base->stochastic(); }
  bool has_subsurface_exit() const override { return base && base->has_subsurface_exit(); }
  std::optional<SubsurfaceExit> sample_exit(const SurfacePoint& p, const Scene& scene, const Wavelengths& w,
                                            NumberStream& random, Arena& arena) const override {
    return base ? base->sample_exit(p, scene, w, random, arena) : std::nullopt;
  }

  Ref<ObjectMap> color = constant(0.8f), weight = constant(1.0f), roughness = constant(0.4f);
  Ref<Shader> base;
};

const Register<SheenShader> registered;

}  // namespace
}  // namespace etendue
