#include "mixture.h"

#include "components/shaders/part_choice.h"

namespace etendue::osl {

namespace {

Lobes lobes_of(const MixturePart* parts, int count) {
  Lobes all = no_lobes;
  for (int k = 0; k < count; ++k) all |= parts[k].present(all_lobes);
  return all;
}

Spectrum smaller(const Spectrum& a, const Spectrum& b) {
  Spectrum s;
  for (int i = 0; i < spectrum_size; ++i) s.set(i, std::min(a[i], b[i]));
  return s;
}

/// An address that no other thread has now.
const void* this_thread() {
  thread_local char own;
  return &own;
}

}  // namespace

Mixture::Mixture(const SurfacePoint& p, const MixturePart* parts, Seen* seen, int count, bool may_exceed)
    : Scatter(p, lobes_of(parts, count)),
      parts_(parts),
      seen_(seen),
      maker_(this_thread()),
      count_(count),
      may_exceed_(may_exceed) {
  // Images of normals show that of the first part.
  if (count > 0) frame_ = parts[0].scatter->frame();
}

Spectrum Mixture::albedo_of(int part, const Vector3& v, Lobes lobes) const {
  if (maker_ != this_thread()) return parts_[part].scatter->albedo(v, lobes);
  Seen& seen = seen_[part];
  for (int i = 0; i < 2; ++i)
    if (seen.lobes[i] == lobes && seen.from[i] == v) {
      seen.last = i;
      return seen.albedo[i];
    }
  const int i = 1 - seen.last;
  seen.last = i, seen.from[i] = v, seen.lobes[i] = lobes;
  return seen.albedo[i] = parts_[part].scatter->albedo(v, lobes);
}

Spectrum Mixture::factor(int part, const Vector3& v, const Cover* until) const {
  Spectrum w = parts_[part].weight;
  for (const Cover* c = parts_[part].covers; c != until; c = c->next) {
    Spectrum reflected;
    for (int k = c->begin; k < c->end; ++k)
      if (const Lobes lobes = parts_[k].present(reflection_lobes)) reflected += factor(k, v, c->next) * albedo_of(k, v, lobes);
    w *= max(Spectrum(1.0f) - reflected / max(c->weight, 1e-6f), 0);
  }
  return w;
}

Spectrum Mixture::sum_of_albedos(const Vector3& out, Lobes asked) const {
  Spectrum sum;
  for (int k = 0; k < count_; ++k)
    if (const Lobes lobes = parts_[k].present(asked)) sum += factor(k, out) * albedo_of(k, out, lobes);
  return sum;
}

Spectrum Mixture::limit(const Vector3& v) const {
  return map(sum_of_albedos(v, lobes_), [](float a) { return a > 1 ? 1 / a : 1; });
}
Spectrum Mixture::limit(const Vector3& out, const Vector3& in) const {
  return may_exceed_ ? smaller(limit(out), limit(in)) : Spectrum(1.0f);
}

bool Mixture::probabilities(const Vector3& out, ScatterContext context, float* p) const {
  constexpr float unforeseen = 0.01f;  // as in `promise`
  float sum = 0;
  for (int k = 0; k < count_; ++k) {
    const Lobes lobes = parts_[k].present(context.lobes);
    p[k] = 0;
    if (!lobes) continue;
    const Spectrum share = context.transport == Transport::radiance ? factor(k, out) : parts_[k].weight;
    p[k] = share.average() * (albedo_of(k, out, lobes).average() + unforeseen);
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
    const Lobes lobes = parts_[k].present(context.lobes);
    if (!(lobes & smooth_lobes)) continue;
    const ScatterValue v = parts_[k].scatter->value_and_pdf(out, in, {context.transport, lobes});
    if (!v.value.black()) sum.value += factor(k, leaves) * v.value;
    sum.pdf += p[k] * v.pdf;
  }
  if (may_exceed_ && !sum.value.black()) sum.value *= limit(out, in);
  return sum;
}

// Null scattering of all parts has the same direction: the sum is returned, without choosing.
std::optional<ScatterSample> Mixture::sample_straight(const Vector3& out, Transport transport) const {
  Spectrum sum;
  for (int k = 0; k < count_; ++k)
    if (parts_[k].lobes & null_scattering)
      sum += factor(k, transport == Transport::radiance ? out : -out) * straight_fraction(parts_[k].scatter, out, transport);
  return straight_on(out, sum * limit(out, -out), 1);
}

std::optional<ScatterSample> Mixture::world_sample(const Vector3& out, float choice, Point2 u, ScatterContext context) const {
  if (context.lobes == null_scattering) return sample_straight(out, context.transport);
  float p[most_parts];
  if (!probabilities(out, context, p)) return std::nullopt;
  int k = 0;
  float below = 0;
  while (k + 1 < count_ && (choice >= below + p[k] || p[k] == 0)) below += p[k++];
  while (k > 0 && p[k] == 0) below -= p[--k];
  const MixturePart& part = parts_[k];
  const float rest = clamp((choice - below) / p[k], 0, one_minus_epsilon);
  std::optional<ScatterSample> s = part.scatter->sample(out, rest, u, {context.transport, Lobes(context.lobes & part.lobes)});
  if (!s) return s;
  const Vector3& leaves = context.transport == Transport::radiance ? out : s->direction;
  const Spectrum limited = limit(out, s->direction);
  if (s->specular()) {
    s->weight *= factor(k, leaves) * limited / p[k];
    s->pdf *= p[k];
    return s;
  }
  Spectrum value = s->weight * s->pdf * factor(k, leaves);
  float pdf = p[k] * s->pdf;
  for (int j = 0; j < count_; ++j) {
    const Lobes lobes = parts_[j].present(context.lobes);
    if (j == k || !(lobes & smooth_lobes)) continue;
    const ScatterValue v = parts_[j].scatter->value_and_pdf(out, s->direction, {context.transport, lobes});
    if (!v.value.black()) value += factor(j, leaves) * v.value;
    pdf += p[j] * v.pdf;
  }
  if (!(pdf > 0)) return std::nullopt;
  s->weight = value * limited / pdf;
  s->pdf = pdf;
  return s;
}

Spectrum Mixture::world_albedo(const Vector3& out, Lobes lobes) const {
  const Spectrum sum = sum_of_albedos(out, lobes);
  return may_exceed_ ? sum * limit(out) : sum;
}

}  // namespace etendue::osl
