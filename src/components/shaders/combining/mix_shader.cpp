// MixShader: a weighted mean of two shaders.

#include "components/shaders/part_choice.h"
#include "components/shaders/scalar_map.h"
#include "etendue/polarizing_scatter.h"

namespace etendue {
namespace {

// f = (1 - a) f1 + a f2. The mixture is evaluated: `bind` does not choose one of the two at random.
//
// Shading normals. The parts may have different ones (a bumped part). Each part's public calls return f |cos| by its own
// normal, and these values are summed. The adjoint stays right, as it is linear in them (scatter_corrections.h).
//
// Sampling. A part is chosen with probability P_k, in proportion to its share times its albedo, and samples a direction. Either
// part could have sampled it, so the pdf is P_1 p_1 + P_2 p_2 and the weight
//     ((1 - a) f1 |cos| + a f2 |cos|) / (P_1 p_1 + P_2 p_2),
// the balance heuristic. For a specular sample the weight is the part's own, times its share over P_k. If a part is stochastic,
// its p_k is not the true pdf of its samples, and dividing by it would be wrong: a sample then counts for its own part alone,
// with weight share * weight / P_k. The pdf returned is the same sum nevertheless: MIS weights only need the same function in
// all places.
class MixScatter final : public Scatter, public PolarizingScatter {
 public:
  MixScatter(const SurfacePoint& p, const Scatter* first, const Scatter* second, float amount, bool stochastic)
      : Scatter(p, Lobes((first ? first->lobes() : no_lobes) | (second ? second->lobes() : no_lobes))),
        parts_{first, second},
        shares_{1 - amount, amount},
        stochastic_(stochastic) {
    // If one part has a perturbed shading normal, images of normals show that one.
    frame_ = first && (!second || !(first->frame().n == p.shading_normal)) ? first->frame() : second->frame();
  }

  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const override {
    const float probability[2] = {first_probability(out, context.lobes), 1 - first_probability(out, context.lobes)};
    ScatterValue sum;
    for (int k = 0; k < 2; ++k) {
      if (!parts_[k] || !parts_[k]->has(context.lobes)) continue;
      const ScatterValue v = parts_[k]->value_and_pdf(out, in, context);
      sum.value += v.value * shares_[k];
      sum.pdf += probability[k] * v.pdf;
    }
    return sum;
  }

  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const override {
    // Null scattering of both parts has the same direction: the sum is returned, without choosing.
    if (context.lobes == null_scattering)
      return straight_on(out,
                         shares_[0] * straight_fraction(parts_[0], out, context.transport) +
                             shares_[1] * straight_fraction(parts_[1], out, context.transport),
                         1);
    const float first = first_probability(out, context.lobes);
    const int k = choice < first ? 0 : 1;
    if (!parts_[k]) return std::nullopt;
    std::optional<ScatterSample> s = parts_[k]->sample(out, left_of_choice(choice, first), u, context);
    if (!s) return s;
    const float probability = k == 0 ? first : 1 - first;
    const Scatter* other = parts_[1 - k];
    if (s->specular() || !other || !other->has(context.lobes)) {
      s->weight *= shares_[k] / probability;
      s->pdf *= probability;
      return s;
    }
    const ScatterValue v = other->value_and_pdf(out, s->direction, context);
    const float pdf = probability * s->pdf + (1 - probability) * v.pdf;
    if (stochastic_)
      s->weight *= shares_[k] / probability;
    else
      s->weight = (s->weight * (shares_[k] * s->pdf) + v.value * shares_[1 - k]) / pdf;
    s->pdf = pdf;
    return s;
  }

  Spectrum world_albedo(const Vector3& out, Lobes lobes) const override {
    Spectrum sum;
    for (int k = 0; k < 2; ++k)
      if (parts_[k]) sum += parts_[k]->albedo(out, lobes) * shares_[k];
    return sum;
  }

  // Specular lobes of both parts that have the same direction, as those of two mirrors, count by their albedos, whichever was
  // sampled: the mean of the samples is then right.
  bool polarization(const Vector3& out, const Vector3& in, Lobes lobes, Polarization& event) const override {
    PolarizationMean mean(out, in);
    for (int k = 0; k < 2; ++k) {
      const Scatter* const part = parts_[k];
      if (!part || !part->has(lobes)) continue;
      add_part(mean, *part, out, in, lobes,
               shares_[k] * (lobes & smooth_lobes       ? part->evaluate(out, in, {.lobes = lobes})
                             : lobes == null_scattering ? straight_fraction(part, out, Transport::radiance)
                                                        : part->albedo(out, lobes)));
    }
    return mean.mean(event);
  }

 private:
  float first_probability(const Vector3& out, Lobes lobes) const {
    const float first = promise(parts_[0], shares_[0], out, lobes), second = promise(parts_[1], shares_[1], out, lobes);
    return first + second > 0 ? first / (first + second) : 0;
  }

  const Scatter* parts_[2];  // null: black
  float shares_[2];
  bool stochastic_;
};

class MixShader final : public Shader {
 public:
  static void describe(Description<MixShader>& d) {
    d.summary("Some of one surface and some of another, mixed finer than can be seen, or from place to place by a map.")
        .member<&MixShader::first>("first", "", "the surface where amount is 0; nothing: black", required)
        .member<&MixShader::second>("second", "", "the surface where amount is 1", required)
        .member<&MixShader::amount>("amount", "1", "fraction of the surface that is the second one", Meaning::number,
                                    soft(0, 1));
  }

  void prepare() override {
    if (!first) fail("first", "a shader is needed");
    if (!second) fail("second", "a shader is needed");
    require_scalar(*this, "amount", amount);
    // sample_exit does not receive the part by which the light entered, so only one part may let light in.
    const bool one = first->has_subsurface_exit(), two = second->has_subsurface_exit();
    constexpr Lobes inwards = transmission_lobes & ~null_scattering;
    if ((one && two) || (one && (second->possible_lobes() & inwards)) || (two && (first->possible_lobes() & inwards)))
      fail(one ? "second" : "first",
           "lets light into the body too, and the other part leads it out elsewhere: only one of the two can");
  }

  const Scatter* bind(const SurfacePoint& p, const Wavelengths& w, Arena& arena) const override {
    const float a = scalar_at(*amount, p);
    if (a <= 0 || first == second) return first->bind(p, w, arena);
    if (a >= 1) return second->bind(p, w, arena);
    const Scatter* one = first->bind(p, w, arena);
    const Scatter* two = second->bind(p, w, arena);
    if (!one && !two) return nullptr;
    return arena.make<MixScatter>(p, one, two, a, stochastic());
  }

  Lobes possible_lobes() const override { return first->possible_lobes() | second->possible_lobes(); }
  Spectrum interior_index(const Wavelengths& w) const override { return interior_index_of(*first, *second, w); }
  bool transmits() const override { return first->transmits() || second->transmits(); }
  bool lossless() const override { return first->lossless() && second->lossless(); }
  // Subsurface scattering is weighted by the amount at the entry point and not at the exit point: if the amount is not
  // constant, these differ.
  bool reciprocal() const override {
    return first->reciprocal() && second->reciprocal() && !(has_subsurface_exit() && !amount->constant());
  }
  bool stochastic() const override { return first->stochastic() || second->stochastic(); }
  float albedo_error() const override { return std::max(first->albedo_error(), second->albedo_error()); }
  bool has_subsurface_exit() const override { return first->has_subsurface_exit() || second->has_subsurface_exit(); }
  std::optional<SubsurfaceExit> sample_exit(const SurfacePoint& p, const Scene& scene, const Wavelengths& w,
                                            NumberStream& random, Arena& arena) const override {
    return (first->has_subsurface_exit() ? first : second)->sample_exit(p, scene, w, random, arena);
  }

  Ref<Shader> first, second;
  Ref<ObjectMap> amount = constant(0.5f);
};

const Register<MixShader> registered;

}  // namespace
}  // namespace etendue
