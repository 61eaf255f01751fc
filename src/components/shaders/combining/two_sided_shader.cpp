// TwoSidedShader: one shader for the front of a surface and another for the back.

#include "components/shaders/part_choice.h"
#include "etendue/polarizing_scatter.h"

namespace etendue {
namespace {

// Neither part transmits light, so a pair of directions lies on one side, and f is that of this side's part: nothing is chosen
// at random, and pdfs and adjoints are those of the part. Sides are those of the geometric normal, whatever shading normals the
// parts have.
class TwoSidedScatter final : public Scatter, public PolarizingScatter {
 public:
  TwoSidedScatter(const SurfacePoint& p, const Scatter* front, const Scatter* back)
      : Scatter(p, Lobes((front ? front->lobes() : no_lobes) | (back ? back->lobes() : no_lobes))),
        towards_front_(p.normal),
        front_(front),
        back_(back) {
    // If one part has a perturbed shading normal, images of normals show that one.
    frame_ = front && (!back || !(front->frame().n == p.shading_normal)) ? front->frame() : back->frame();
  }

  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override {
    const Scatter* const part = seen_from(out);
    return part ? part->value_and_pdf(out, in, context) : ScatterValue{};
  }

  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override {
    const Scatter* const part = seen_from(out);
    return part ? part->sample(out, choice, u, context) : std::nullopt;
  }

  Spectrum world_albedo(const Vector3& out, Lobes lobes) const override {
    const Scatter* const part = seen_from(out);
    return part ? part->albedo(out, lobes) : Spectrum();
  }
  bool polarization(const Vector3& out, const Vector3& in, Lobes lobes, Polarization& event) const override {
    const Scatter* const part = seen_from(out);
    return part && polarization_of(*part, out, in, lobes, event);
  }

 private:
  const Scatter* seen_from(const Vector3& out) const { return dot(out, towards_front_) > 0 ? front_ : back_; }

  Normal3 towards_front_;
  const Scatter *front_, *back_;  // null: black
};

class TwoSidedShader final : public Shader {
 public:
  static void describe(Description<TwoSidedShader>& d) {
    d.summary(
         "One surface in front, where the object's normals point, and another behind. Neither may let light through: for a "
         "surface with holes, put this into a MaskShader.")
        .member<&TwoSidedShader::front>("front", "", "what is seen from the side the normals point to", required)
        .member<&TwoSidedShader::back>("back", "", "what is seen from the other side", required);
  }

  void prepare() override {
    for (const auto& [name, part] : {std::pair("front", &front), std::pair("back", &back)}) {
      if (!*part) fail(name, "a shader is needed");
      if ((*part)->possible_lobes() & transmission_lobes)
        fail(name, "lets light through, and what it lets through would meet another surface on the other side");
    }
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    if (front == back) return front->bind(p, w, arena);
    const Scatter* const one = front->bind(p, w, arena);
    const Scatter* const two = back->bind(p, w, arena);
    return one || two ? arena.make<TwoSidedScatter>(p, one, two) : nullptr;
  }

  Lobes possible_lobes() const override { return front->possible_lobes() | back->possible_lobes(); }
  bool lossless() const override { return front->lossless() && back->lossless(); }
  bool reciprocal() const override { return front->reciprocal() && back->reciprocal(); }
  bool stochastic() const override { return front->stochastic() || back->stochastic(); }
  float albedo_error() const override { return std::max(front->albedo_error(), back->albedo_error()); }

  Ref<Shader> front, back;
};

const Register<TwoSidedShader> registered;

}  // namespace
}  // namespace etendue
