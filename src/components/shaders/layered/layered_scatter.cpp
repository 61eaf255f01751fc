// LayeredScatter: the BSDF of two layers.
//
// f is the reflection f_E by the face E on the side of `out`, plus the light that was between the layers, which LayerStack
// estimates.
//
// Sampling draws one of E's lobes. A sample that E reflects counts for f_E; one that E transmits starts a walk between the
// layers and counts for the rest. The weights are unbiased estimates of each part's f |cos| over the true pdf, for any test
// function g: the mean of weight * g(direction) is the integral of f |cos| g. The true pdf of walks is unknown. The pdf that
// `pdf` returns and samples carry is P_E p_E + P_T q, with p_E exact and q an approximation of the walks' pdf, which uses
// random numbers hashed from both directions: the same directions always give the same value. Multiple importance sampling with
// w_1 = p / (p + l) for samples and w_2 = l / (p + l) for next event estimation with pdf l only requires w_1 + w_2 = 1 at each
// direction: the sum is then the integral of (w_1 + w_2) f |cos| g, whatever function p is.

#include "layered_scatter.h"

#include "components/shaders/part_choice.h"

namespace etendue {

Lobes lobes_between(Lobes near, Lobes far, bool scatters) {
  if (!(near & transmission_lobes)) return no_lobes;
  constexpr Lobes specular_in = specular_transmission | null_scattering, smooth_in = smooth_lobes & transmission_lobes;
  constexpr Lobes smooth_back = smooth_lobes & reflection_lobes;
  const bool diffuse = scatters || ((near | far) & diffuse_lobes), both_pass = near & far & null_scattering;
  const bool bent = scatters || (near & smooth_in) || ((far & smooth_back) && (near & reflection_lobes)) ||
                    ((far & reflection_lobes) && (near & smooth_back));
  Lobes lobes = no_lobes;
  if (scatters || ((far & reflection_lobes) && (bent || (far & smooth_back))))
    lobes |= diffuse ? diffuse_reflection : glossy_reflection;
  if ((near & specular_in) && (far & specular_reflection)) lobes |= specular_reflection;
  if (far & transmission_lobes) {
    if (bent || (far & smooth_in)) lobes |= diffuse ? diffuse_transmission : glossy_transmission;
    if (both_pass) lobes |= null_scattering;
    const bool refracts = ((near | far) & specular_transmission) || (near & far & specular_reflection);
    if ((near & specular_in) && (far & specular_in) && refracts) lobes |= specular_transmission;
  }
  return lobes;
}

LayeredScatter::LayeredScatter(const SurfacePoint& p, const LayerStack* const* front, const LayerStack* const* back, int stacks,
                               int walks, std::uint64_t seed, Lobes lobes)
    : Scatter(p, lobes), stacks_(stacks), walks_(walks), seed_(seed) {
  for (int i = 0; i < stacks; ++i) {
    sides_[0][i] = front[i];
    sides_[1][i] = back[i];
  }
  const Frame &top = front[0]->face(0).frame(), &bottom = front[0]->face(1).frame();
  frame_ = top.n == p.shading_normal ? bottom : top;  // that of a layer with a perturbed shading normal, if there is one
}

LayeredScatter::Question::Question(const LayerStack& stack, const Vector3& out, Lobes lobes) {
  const int side = stack.side(out);
  const Scatter& near = stack.face(side);
  possible = lobes_between(near.lobes(), stack.face(1 - side).lobes(), stack.medium().scatters());
  between = possible & lobes;
  face = Lobes((lobes & reflection_lobes) | (between ? transmission_lobes : no_lobes));
}

HashedRandom LayeredScatter::numbers(Use use, const Vector3& out, const Vector3& other, Transport transport) const {
  HashedRandom random(seed_ ^ (2 * std::uint64_t(use) + std::uint64_t(transport)));
  random.add(out, other.x);
  random.add(other.y, other.z);
  return random;
}

float LayeredScatter::pdf_between(const LayerStack& stack, const Vector3& out, const Vector3& in,
                                  ScatterContext context) const {
  HashedRandom random = numbers(Use::pdf, out, in, context.transport);
  const Scatter& near = stack.face(stack.side(out));
  float goes_in = 1;
  if (near.has(context.lobes & reflection_lobes)) {
    const float all = near.albedo(out, context.lobes).average();
    goes_in = std::max(all > 0 ? near.albedo(out, transmission_lobes).average() / all : 0, 0.01f);
  }
  return goes_in * stack.pdf(out, in, context.transport, random);
}

ScatterValue LayeredScatter::world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const {
  const LayerStack* const* stacks = seen_from(out);
  const LayerStack& stack = *stacks[0];
  const Scatter& face = stack.face(stack.side(out));
  const Question q(stack, out, context.lobes);
  const bool same_side = stack.side(out) == stack.side(in);
  ScatterValue sum;
  if (same_side && face.has(context.lobes & reflection_lobes & smooth_lobes)) {
    sum.value = face.evaluate(out, in, {context.transport, Lobes(context.lobes & reflection_lobes)});
    sum.pdf = face.pdf(out, in, {context.transport, q.face});
  }
  if (!(q.between & smooth_lobes & (same_side ? reflection_lobes : transmission_lobes))) return sum;
  Spectrum between;
  for (int i = 0; i < stacks_; ++i) {
    HashedRandom random = numbers(Use::estimate, out, in, context.transport);
    Spectrum estimate;
    for (int walk = 0; walk < walks_; ++walk) estimate += stacks[i]->estimate(out, in, context.transport, random);
    if (i == 0)
      between = estimate;
    else
      between.set(i, estimate[0]);
  }
  sum.value += between / float(walks_);
  sum.pdf += pdf_between(stack, out, in, {context.transport, q.face});
  if (!sum.value.finite()) sum.value = {};
  return sum;
}

std::optional<ScatterSample> LayeredScatter::world_sample(const Vector3& out, float choice, Point2 u,
                                                          ScatterContext context) const {
  const LayerStack& stack = *seen_from(out)[0];
  const int side = stack.side(out);
  const Scatter& face = stack.face(side);
  if (context.lobes == null_scattering) {  // without a random choice, on which shadow rays rely
    const Spectrum both =
        straight_fraction(&face, out, context.transport) * straight_fraction(&stack.face(1 - side), out, context.transport);
    return straight_on(out, both * stack.transmittance(out, 1), 1);
  }
  const Question q(stack, out, context.lobes);
  std::optional<ScatterSample> s = face.sample(out, choice, u, {context.transport, q.face});
  if (!s) return s;
  const bool walked = s->transmitted();
  if (walked) {
    HashedRandom random = numbers(Use::walk, out, {choice, u.x, u.y}, context.transport);
    LayerWalk walk;
    if (!stack.walk(out, *s, context.transport, random, walk) || !walk.weight.finite()) return std::nullopt;
    const bool reflected = stack.side(walk.direction) == side;
    const Lobes one_side = reflected ? reflection_lobes : transmission_lobes;
    const Lobes smooth = q.possible & smooth_lobes & one_side;
    const Lobe lobe = walk.smooth     ? Lobe(smooth)
                      : walk.straight ? null_scattering
                                      : (reflected ? specular_reflection : specular_transmission);
    if (!(q.between & lobe)) return std::nullopt;
    s = ScatterSample{walk.direction, walk.weight, walk.probability, lobe, walk.eta, walk.dispersive};
  }
  if (!s->specular()) {
    const bool same_side = stack.side(s->direction) == side;
    if (walked) s->pdf = same_side ? face.pdf(out, s->direction, {context.transport, q.face}) : 0;
    if (q.between & smooth_lobes & (same_side ? reflection_lobes : transmission_lobes))
      s->pdf += pdf_between(stack, out, s->direction, {context.transport, q.face});
  }
  return s;
}

Spectrum LayeredScatter::world_albedo(const Vector3& out, Lobes lobes) const {
  const LayerStack& stack = *seen_from(out)[0];
  const Question q(stack, out, lobes);
  Spectrum sum = stack.face(stack.side(out)).albedo(out, lobes & reflection_lobes);
  if (q.between == no_lobes) return sum;
  const LayerStack::Albedo a = stack.albedo(out);
  if (q.between & smooth_lobes & reflection_lobes) sum += a.smooth[0];
  if (q.between & smooth_lobes & transmission_lobes) sum += a.smooth[1];
  if (q.between & specular_reflection) sum += a.specular[0];
  // a.specular[1] contains null scattering, which is subtracted from it and added separately if requested.
  if (q.between & (specular_transmission | null_scattering)) {
    Spectrum straight;
    if (q.possible & null_scattering) straight = world_sample(out, 0, {}, {Transport::importance, null_scattering})->weight;
    if (q.between & null_scattering) sum += straight;
    if (q.between & specular_transmission) sum += max(a.specular[1] - straight, 0);
  }
  return sum;
}

}  // namespace etendue
