// MaskShader: a surface with holes, drawn by a map or too fine to resolve (opacity).

#include "components/shaders/part_choice.h"
#include "components/shaders/scalar_map.h"
#include "etendue/polarizing_scatter.h"

namespace etendue {
namespace {

// With opacity a, f = a f_below, and the fraction 1 - a of light gets null scattering, which involves no cosine and no normal:
// it is the same for radiance and importance, and the same from both sides.
//
// Sampling chooses between null scattering and the shader below, in proportion to 1 - a and a times the albedo below. Null
// scattering by the shader below belongs to the second. If only null scattering is requested nothing is chosen: the weight is
// the whole fraction, 1 - a + a t with t that of the shader below, on which shadow rays rely.
class MaskScatter final : public Scatter, public PolarizingScatter {
 public:
  MaskScatter(const SurfacePoint& p, const Scatter* below, float opacity)
      : Scatter(p, Lobes((below ? below->lobes() : no_lobes) | null_scattering)), below_(below), opacity_(opacity) {
    if (below) frame_ = below->frame();
  }

  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override {
    if (!below_ || !below_->has(context.lobes & smooth_lobes)) return {};
    const ScatterValue v = below_->value_and_pdf(out, in, context);
    return {v.value * opacity_, v.pdf * (1 - straight_probability(out, context.lobes))};
  }

  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override {
    const float open = 1 - opacity_;
    if (context.lobes == null_scattering)
      return straight_on(out, Spectrum(open) + opacity_ * straight_fraction(below_, out, context.transport), 1);
    const float straight = straight_probability(out, context.lobes);
    if (choice < straight) return straight_on(out, Spectrum(open / straight), straight);
    if (!below_) return std::nullopt;
    std::optional<ScatterSample> s = below_->sample(out, left_of_choice(choice, straight), u, context);
    if (!s) return s;
    s->weight *= opacity_ / (1 - straight);
    s->pdf *= 1 - straight;
    return s;
  }

  Spectrum world_albedo(const Vector3& out, Lobes lobes) const override {
    Spectrum sum;
    if (below_) sum = below_->albedo(out, lobes) * opacity_;
    if (lobes & null_scattering) sum += Spectrum(1 - opacity_);
    return sum;
  }

  /// Light through holes stays as it is.
  bool polarization(const Vector3& out, const Vector3& in, Lobes lobes, Polarization& event) const override {
    if (lobes != null_scattering) return below_ && polarization_of(*below_, out, in, lobes, event);
    PolarizationMean mean(out, in);
    const Vector3 x = any_perpendicular(out);
    mean.add(Spectrum(1 - opacity_), {Mueller::identity(), x, x});
    if (below_) add_part(mean, *below_, out, in, lobes, opacity_ * straight_fraction(below_, out, Transport::radiance));
    return mean.mean(event);
  }

 private:
  float straight_probability(const Vector3& out, Lobes lobes) const {
    if (!(lobes & null_scattering)) return 0;
    const float open = 1 - opacity_;
    return open / (open + promise(below_, opacity_, out, lobes));
  }

  const Scatter* below_;  // null: black
  float opacity_;         // less than 1
};

class MaskShader final : public Shader {
 public:
  static void describe(Description<MaskShader>& d) {
    d.summary("A shader with holes in it: where opacity is less than 1, the rest of the light goes straight on.")
        .member<&MaskShader::shader>("shader", "", "the surface where it is there", required)
        .member<&MaskShader::opacity>("opacity", "1", "fraction of the surface that is there", Meaning::number, soft(0, 1));
  }

  void prepare() override {
    if (!shader) fail("shader", "a shader is needed");
    require_scalar(*this, "opacity", opacity);
    const Color all = opacity->constant();
    opaque_ = all && opacity->scalar(SurfacePoint()) >= 1;
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const float a = scalar_at(*opacity, p);
    if (a >= 1) return shader->bind(p, w, arena);
    return arena.make<MaskScatter>(p, a > 0 ? shader->bind(p, w, arena) : nullptr, a);
  }

  Lobes possible_lobes() const override {
    return Lobes(shader->possible_lobes() | (opaque_ ? no_lobes : Lobes(null_scattering)));
  }
  Spectrum interior_index(const Wavelengths& w) const override { return shader->interior_index(w); }
  bool transmits() const override { return !opaque_ || shader->transmits(); }
  bool lossless() const override { return shader->lossless(); }
  // As in MixShader: a subsurface exit does not depend on the opacity at the exit point.
  bool reciprocal() const override { return shader->reciprocal() && !(has_subsurface_exit() && !opacity->constant()); }
  bool stochastic() const override { return shader->stochastic(); }
  float albedo_error() const override { return shader->albedo_error(); }
  bool has_subsurface_exit() const override { return shader->has_subsurface_exit(); }
  std::optional<SubsurfaceExit> sample_exit(const SurfacePoint& p, const Scene& scene, const Wavelengths& w,
                                            NumberStream& random, Arena& arena) const override {
    return shader->sample_exit(p, scene, w, random, arena);
  }

  Ref<Shader> shader;
  Ref<ObjectMap> opacity = constant(0.5f);

 private:
  bool opaque_ = false;
};

const Register<MaskShader> registered;

}  // namespace
}  // namespace etendue
