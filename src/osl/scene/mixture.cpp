#include "mixture.h"

#include "components/shaders/part_choice.h"

namespace etendue::osl {

namespace {

Lobes lobes_of(const MixturePart* parts, int count) {
  Lobes all = no_lobes;
  for (int k = 0; k < count; ++k) all |= Lobes(parts[k].scatter->lobes() & parts[k].lobes);
  return all;
}

/// The requested lobes of a part.
ScatterContext asked_of(const MixturePart& part, ScatterContext context) {
  return {context.transport, Lobes(context.lobes & part.lobes)};
}

}  // namespace

Mixture::Mixture(const SurfacePoint& p, const MixturePart* parts, int count)
    : Scatter(p, lobes_of(parts, count)), parts_(parts), count_(count) {
  // Images of normals show that of the first part.
  if (count > 0) frame_ = parts[0].scatter->frame();
}

// The albedos of rough boundaries are estimates, exact to 0.05: reflection and refraction as two parts may seem to sum to more
// than 1 by that.
float Mixture::limit() {
  const float tolerance = lobes_ & glossy_transmission ? 0.05f : 0;
  Spectrum most;
  for (const float side : {1.0f, -1.0f}) {
    if (side < 0 && !(lobes_ & transmission_lobes)) break;
    for (const float cosine : {1.0f, 0.5f, 0.2f}) {
      const Vector3 local{safe_sqrt(1 - cosine * cosine), 0, side * cosine};
      const Spectrum seen = world_albedo(Frame(normal_).to_world(local), lobes_);
      for (int i = 0; i < spectrum_size; ++i) most.set(i, std::max(most[i], seen[i]));
    }
  }
  for (int i = 0; i < spectrum_size; ++i)
    if (most[i] > 1 + tolerance) scale_.set(i, 1 / most[i]);
  return most.maximum() > 1 + tolerance ? most.maximum() : 1;
}

Spectrum Mixture::factor(const MixturePart& part, const Vector3& v, const Cover* until) const {
  Spectrum w = part.weight;
  for (const Cover* c = part.covers; c != until; c = c->next) {
    Spectrum reflected;
    for (int k = c->begin; k < c->end; ++k)
      reflected += factor(parts_[k], v, c->next) * parts_[k].scatter->albedo(v, Lobes(reflection_lobes & parts_[k].lobes));
    w *= max(Spectrum(1.0f) - reflected / max(c->weight, 1e-6f), 0);
  }
  return w;
}

bool Mixture::probabilities(const Vector3& out, ScatterContext context, float* p) const {
  float sum = 0;
  for (int k = 0; k < count_; ++k) {
    const MixturePart& part = parts_[k];
    const Lobes own = Lobes(context.lobes & part.lobes);
    const Spectrum share = context.transport == Transport::radiance ? factor(part, out) : part.weight;
    p[k] = own ? promise(part.scatter, share.average(), out, own) : 0;
    sum += p[k];
  }
  if (!(sum > 0)) return false;
  for (int k = 0; k < count_; ++k) p[k] /= sum;
  return true;
}

ScatterValue Mixture::world_value_and_pdf(const Vector3& out, const Vector3& in, ScatterContext context) const {
  float p[most_parts];
  ScatterValue sum;
  if (!probabilities(out, context, p)) return sum;
  const Vector3& leaves = context.transport == Transport::radiance ? out : in;
  for (int k = 0; k < count_; ++k) {
    const MixturePart& part = parts_[k];
    const ScatterContext asked = asked_of(part, context);
    if (!part.scatter->has(asked.lobes)) continue;
    const ScatterValue v = part.scatter->value_and_pdf(out, in, asked);
    if (!v.value.black()) sum.value += factor(part, leaves) * v.value;
    sum.pdf += p[k] * v.pdf;
  }
  sum.value *= scale_;
  return sum;
}

std::optional<ScatterSample> Mixture::world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const {
  // Null scattering of all parts has the same direction: the sum is returned, without choosing.
  if (context.lobes == null_scattering) {
    Spectrum sum;
    for (int k = 0; k < count_; ++k)
      if (parts_[k].lobes & null_scattering)
        sum += factor(parts_[k], context.transport == Transport::radiance ? out : -out) *
               straight_fraction(parts_[k].scatter, out, context.transport);
    return straight_on(out, sum * scale_, 1);
  }
  float p[most_parts];
  if (!probabilities(out, context, p)) return std::nullopt;
  int k = 0;
  float below = 0;
  while (k + 1 < count_ && (choice >= below + p[k] || p[k] == 0)) below += p[k++];
  while (k > 0 && p[k] == 0) below -= p[--k];
  const MixturePart& part = parts_[k];
  const float rest = clamp((choice - below) / p[k], 0, one_minus_epsilon);
  std::optional<ScatterSample> s = part.scatter->sample(out, rest, u, asked_of(part, context));
  if (!s) return s;
  const Vector3& leaves = context.transport == Transport::radiance ? out : s->direction;
  if (s->specular()) {
    s->weight *= factor(part, leaves) * scale_ / p[k];
    s->pdf *= p[k];
    return s;
  }
  Spectrum value = s->weight * s->pdf * factor(part, leaves);
  float pdf = p[k] * s->pdf;
  for (int j = 0; j < count_; ++j) {
    const ScatterContext asked = asked_of(parts_[j], context);
    if (j == k || !parts_[j].scatter->has(asked.lobes)) continue;
    const ScatterValue v = parts_[j].scatter->value_and_pdf(out, s->direction, asked);
    if (!v.value.black()) value += factor(parts_[j], leaves) * v.value;
    pdf += p[j] * v.pdf;
  }
  if (!(pdf > 0)) return std::nullopt;
  s->weight = value * scale_ / pdf;
  s->pdf = pdf;
  return s;
}

Spectrum Mixture::world_albedo(const Vector3& out, Lobes lobes) const {
  Spectrum sum;
  for (int k = 0; k < count_; ++k) {
    const Lobes own = Lobes(lobes & parts_[k].lobes);
    if (parts_[k].scatter->has(own)) sum += factor(parts_[k], out) * parts_[k].scatter->albedo(out, own);
  }
  return sum * scale_;
}

}  // namespace etendue::osl
