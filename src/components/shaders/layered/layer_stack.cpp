// Light transport between two layers.
//
// The light that leaves is a sum over paths: in through the face E on the side of `out`, any number of reflections at both
// faces and scatterings in the medium, and out through the face X on the side of `in` (N is the face opposite E):
//     f(out, in) |cos| = sum over k of the integral of K_E(out, w_1) T(w_1) K_2(-w_1, w_2) T(w_2) ... K_X(-w_k, in),
// with K = f |cos| of a face or, per depth, scattering coefficient times phase function of the medium over |cos w|, and T the
// transmittance exp(-extinction dz / |cos w|) (Guo et al. 2018, eqs. 6 to 10). Each face is evaluated by its public calls in
// world directions, for radiance or importance alike: these include its factors for refraction and shading normals, whose
// product is that of the whole. In the medium, where path lengths are computed with the shading normal, importance gets the
// factor of shading normals (Veach 1997, eq. 5.19) at each scattering, so that the adjoint is right throughout.
//
// walk() follows one such path from `out`. At each face any lobe is sampled, and the path ends when it is transmitted outside:
// the product of the weights is an unbiased estimate for the direction in which it left, whatever the pdf of that direction is.
//
// estimate() is for a given `in`. Paths are classified by their last non-specular event, number s of k + 1.
//   s < k + 1: after event s light reaches X by a specular chain, which `in` determines. The chain is traced back from `in`,
//     through X and on by specular reflections, as a list of segments. Each vertex of a walk from `out` is connected to all
//     segments that end at its face (or cross its depth), with the value of scattering into them.
//   s = k + 1, X itself, with a specular event k: the walk from `out` samples w_k, and X is evaluated.
//   s = k + 1 with a non-specular event k: two techniques are possible, sampling w_k at event k with pdf p, or sampling the
//     segment back from X with pdf q. They are weighted by the balance heuristic, p / (p + q) and q / (p + q). This only
//     requires that p and q are the same functions in both places, so faces may be stochastic.
// Inside, the walk samples reflections only: light that leaves is counted by the connections. Back from `in` the faces are
// sampled by the adjoint, f*: f*(in, d) |cos d| / |d.ng| = f(d, in) |cos in| / |in.ng|, so a segment carries the product of its
// weights times |in.ng| / |d.ng|. This is relied on for reciprocal faces only: of a face that is not reciprocal only specular
// lobes are traced back, and paths of the second and third kind are sampled from the side of `out` alone.

#include "layer_stack.h"

namespace etendue {
namespace {

/// The greatest number of events of a walk: in a thick medium without absorption, light is scattered often.
constexpr int longest = 4096;
constexpr Lobes smooth_transmission = smooth_lobes & transmission_lobes;

/// Russian roulette; `squared_index` undoes the change of radiance by refraction.
bool survives(Spectrum& carried, float squared_index, HashedRandom& random) {
  const float survival = carried.maximum() * squared_index;
  if (!(survival > 0)) return false;
  if (survival >= 1) return true;
  if (random.next() >= survival) return false;
  carried /= survival;
  return true;
}

}  // namespace

/// A segment of the path traced back from `in`, from one face to the other.
struct LayerStack::Edge {
  Vector3 direction;  ///< away from the face where the segment begins
  Spectrum carried;
  int begin = 0;  ///< the face
  float pdf = 0;  ///< [1/sr] of the direction, sampled among smooth lobes; 0: it is specular
  int end() const { return 1 - begin; }
  /// The balance heuristic's weight of a connection to this segment, where the walk would sample its direction with pdf p.
  float weight(float p) const { return pdf > 0 ? pdf / (pdf + p) : 1; }
};

struct LayerStack::Edges {
  static constexpr int most = 16;
  Edge list[most];
  int count = 0;
  const Edge* begin() const { return list; }
  const Edge* end() const { return list + count; }
};

Spectrum LayerStack::transmittance(const Vector3& direction, float part) const {
  if (!medium_.shader) return Spectrum(1.0f);
  return exp(medium_.extinction() * (-part * slant(direction)));
}

float LayerStack::adjoint_factor(Transport transport, const Vector3& a, const Vector3& b) const {
  if (transport == Transport::radiance || normal_ == shading_normal_) return 1;
  const float up = std::abs(dot(shading_normal_, a) * dot(normal_, b)),
              down = std::abs(dot(normal_, a) * dot(shading_normal_, b));
  return down > 0 ? up / down : 0;
}

/// The transmission lobes of a face that may be sampled from outside, in reverse.
Lobes LayerStack::reversible(int side) const {
  return faces_[side].reciprocal ? transmission_lobes : Lobes(specular_transmission | null_scattering);
}

void LayerStack::trace_back(const Vector3& in, Transport transport, HashedRandom& random, Edges& edges) const {
  const Transport back = adjoint(transport);
  int at = side(in);
  float choice = random.next();
  std::optional<ScatterSample> s = face(at).sample(in, choice, random.next_pair(), {back, reversible(at)});
  Spectrum carried(std::abs(dot(normal_, in)));
  float squared_index = 1;
  while (s) {
    carried *= s->weight;
    if (back == Transport::radiance) squared_index *= s->eta * s->eta;
    const float cosine = std::abs(dot(normal_, s->direction));
    if (!(cosine > 0) || carried.black()) return;
    edges.list[edges.count++] = {s->direction, carried / cosine, at, s->specular() ? 0 : s->pdf};
    at = 1 - at;
    if (!s->specular() || edges.count == Edges::most || !face(at).has(specular_reflection)) return;
    carried *= transmittance(s->direction, 1);
    if (!survives(carried, squared_index, random)) return;
    const Vector3 from = -s->direction;
    choice = random.next();
    s = face(at).sample(from, choice, random.next_pair(), {back, specular_reflection});
  }
}

// The depth of the next scattering along w is sampled for one wavelength, chosen in proportion to the throughputs; all are
// divided by the pdf of the mixture, as on long distances (transport/medium.h). True: scattered before the face is reached.
bool LayerStack::fly(const Vector3& w, float& z, Spectrum& carried, HashedRandom& random) const {
  const int towards = side(w);
  const float reach = towards == 0 ? z : 1 - z;
  if (!medium_.scatters()) {
    carried *= transmittance(w, reach);
    z = float(towards);
    return false;
  }
  const Spectrum per_depth = medium_.extinction() * slant(w);
  const Spectrum share = carried / std::max(carried.average() * spectrum_size, 1e-30f);
  float choice = random.next();
  int k = 0;
  while (k + 1 < spectrum_size && choice >= share[k]) choice -= share[k++];
  const float depth = -std::log1p(-random.next()) / std::max(per_depth[k], 1e-30f);
  const bool scattered = depth < reach;
  const Spectrum left = exp(per_depth * -std::min(depth, reach));
  const Spectrum mixture = share * left * (scattered ? per_depth : Spectrum(1.0f));
  const float pdf = mixture.average() * spectrum_size;
  if (!(pdf > 0)) {
    carried = {};
    return false;
  }
  carried *= left * (1 / pdf);
  if (scattered) carried *= medium_.scattering * slant(w);
  z = scattered ? clamp(towards == 0 ? z - depth : z + depth, 0, 1) : float(towards);
  return scattered;
}

bool LayerStack::walk(const Vector3& out, const ScatterSample& entering, Transport transport, HashedRandom& random,
                      LayerWalk& walk) const {
  walk.weight = entering.weight;
  walk.probability = entering.pdf;
  walk.eta = entering.eta;
  walk.smooth = !entering.specular();
  walk.straight = entering.lobe == null_scattering;
  walk.dispersive = entering.dispersive;
  Vector3 w = entering.direction;
  float z = float(side(out));
  for (int event = 0; event < longest; ++event) {
    if (event > 3 && !survives(walk.weight, transport == Transport::radiance ? square(walk.eta) : 1, random)) return false;
    if (fly(w, z, walk.weight, random)) {
      float pdf = 0;
      const Vector3 next = medium_.shader->sample_phase(medium_.position, -w, random.next_pair(), pdf);
      walk.weight *= adjoint_factor(transport, -w, next);
      w = next;
      walk.smooth = true;
      continue;
    }
    if (walk.weight.black()) return false;
    const float choice = random.next();
    const auto s = face(side(w)).sample(-w, choice, random.next_pair(), {.transport = transport});
    if (!s) return false;
    walk.weight *= s->weight;
    walk.probability *= std::min(s->pdf, 1.0f);
    walk.eta *= s->eta;
    walk.smooth |= !s->specular();
    walk.straight &= s->lobe == null_scattering;
    walk.dispersive |= s->dispersive;
    w = s->direction;
    if (s->transmitted()) {
      walk.direction = w;
      return true;
    }
  }
  return false;
}

Spectrum LayerStack::estimate(const Vector3& out, const Vector3& in, Transport transport, HashedRandom& random) const {
  Spectrum sum;
  const int exit = side(in);
  const Scatter& leaving = face(exit);
  int at = side(out);
  if (!face(at).has(transmission_lobes) || !leaving.has(transmission_lobes)) return sum;
  Edges edges;
  trace_back(in, transport, random, edges);

  const bool evaluates = leaving.has(smooth_transmission);
  const auto leave = [&](const Spectrum& carried, const Vector3& w, float z, float pdf) {
    if (!evaluates || side(w) != exit) return;
    Spectrum f = leaving.evaluate(-w, in, {transport, transmission_lobes});
    if (f.black()) return;
    const float back = pdf > 0 ? leaving.pdf(in, -w, {adjoint(transport), reversible(exit)}) : 0;
    if (pdf > 0) f *= pdf / (pdf + back);
    sum += carried * f * transmittance(w, std::abs(float(exit) - z));
  };

  Spectrum carried(1.0f);
  Vector3 from = out;
  Lobes lobes = transmission_lobes;
  float z = float(at), squared_index = 1;
  for (int event = 0; event < longest;) {
    const Scatter& here = face(at);
    if (here.has(lobes & smooth_lobes))
      for (const Edge& edge : edges) {
        if (edge.end() != at) continue;
        const ScatterValue v = here.value_and_pdf(from, -edge.direction, {transport, lobes});
        if (v.value.black()) continue;
        sum += carried * v.value * edge.carried * transmittance(edge.direction, 1) * edge.weight(v.pdf);
      }
    const float choice = random.next();
    const auto s = here.sample(from, choice, random.next_pair(), {transport, lobes});
    if (!s) return sum;
    carried *= s->weight;
    if (transport == Transport::radiance) squared_index *= s->eta * s->eta;
    Vector3 w = s->direction;
    leave(carried, w, z, s->specular() ? 0 : s->pdf);

    while (fly(w, z, carried, random) && ++event < longest) {
      for (const Edge& edge : edges) {
        const float phase = medium_.shader->phase(medium_.position, -w, -edge.direction);
        const float factor = phase * adjoint_factor(transport, -w, -edge.direction) * edge.weight(phase);
        sum += carried * edge.carried * transmittance(edge.direction, std::abs(float(edge.begin) - z)) * factor;
      }
      float pdf = 0;
      const Vector3 next = medium_.shader->sample_phase(medium_.position, -w, random.next_pair(), pdf);
      carried *= adjoint_factor(transport, -w, next);
      w = next;
      leave(carried, w, z, pdf);
      if (event > 1 && !survives(carried, squared_index, random)) return sum;
    }
    if (event > 1 && !survives(carried, squared_index, random)) return sum;
    at = side(w);
    from = -w;
    lobes = reflection_lobes;
    ++event;
  }
  return sum;
}

// Two parts: light that enters, is reflected or transmitted once by N, and leaves; and light that returns to N, for which a
// diffuse pdf stands. A direction inside is sampled from `out` through E, and one from `in` through X; N has a pdf between
// them, which refraction on the way out changes by dw / d(in) = |in.n| / (eta^2 |w.n|) (Snell's law).
float LayerStack::pdf(const Vector3& out, const Vector3& in, Transport transport, HashedRandom& random) const {
  const Scatter &entering = face(side(out)), &leaving = face(side(in));
  const bool through = side(out) != side(in);
  const float even = std::max(leaving.cosine(in), 1e-4f) * inverse_pi;
  float choice = random.next();
  const auto from = entering.sample(out, choice, random.next_pair(), {transport, transmission_lobes});
  if (!from) return even;
  const auto fraction = [](const Scatter& s, const Vector3& v, Lobes part) {
    const float all = s.albedo(v).average();
    return all > 0 ? s.albedo(v, part).average() / all : 0;
  };
  const Scatter& behind = face(1 - side(out));
  const float share = std::max(fraction(behind, -from->direction, through ? transmission_lobes : reflection_lobes), 0.02f);
  float direct = 0;
  if (through && leaving.has(smooth_transmission)) {
    direct = leaving.pdf(-from->direction, in, {.transport = transport});
  } else {
    choice = random.next();
    if (const auto to = leaving.sample(in, choice, random.next_pair(), {adjoint(transport), transmission_lobes})) {
      const float spread =
          std::abs(dot(normal_, in)) / (square(to->eta) * std::max(std::abs(dot(normal_, to->direction)), 1e-4f));
      direct = through ? share * entering.pdf(out, -to->direction, {transport, transmission_lobes})
                       : behind.pdf(-from->direction, -to->direction, {.transport = transport});
      direct *= spread;
    }
  }
  // The less light crosses the medium directly, the greater is the weight of the diffuse pdf.
  const float clear = transmittance(from->direction, 1).average();
  const bool scatters = medium_.scatters();
  const float directly = direct > 0 ? (scatters ? 0.8f * clear : 0.8f) : 0;
  return directly * direct + (1 - directly) * share * even;
}

}  // namespace etendue
