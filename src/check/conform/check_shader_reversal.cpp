// Reciprocity of shaders, and that transport of importance is the adjoint of transport of radiance.
//
// With measures by the geometric normal ng, importance carried from a to b must be what radiance carried from b to a is (Veach
// 1997, sections 5.2 and 5.3, equations 5.17 to 5.19): with v(a, b) = f(a, b) |b . ns|, the values of Scatter,
//     v_importance(a, b) / |b . ng| = v_radiance(b, a) / |a . ng|,
// for reflection and, as it contains the squared indices, refraction. Without a shading normal it is f_importance(a, b) =
// f_radiance(b, a); and f_radiance(a, b) (n_b / n_a)^2 = f_radiance(b, a) is reciprocity across refraction.

#include <fmt/format.h>

#include "shader_trial.h"

namespace etendue::conform {
namespace {

std::string text(const Spectrum& s) { return fmt::format("[{:.7g} {:.7g} ...]", s[0], s[1]); }

struct Pair {
  Vector3 a, b;
  bool sampled = false;
  float eta = 1;            ///< index of b's medium over that of a's at the hero wavelength, known if sampled
  bool hero_alone = false;  ///< other wavelengths are refracted in other directions
};

/// Two directions that a sample connects, or two random ones.
Pair draw_pair(Trial& trial, const Scatter& scatter, Lobes lobes) {
  Pair pair{trial.direction(), trial.direction()};
  if (trial.uniform() < 0.7f)
    if (const auto s = scatter.sample(pair.a, trial.uniform(), trial.pair(), {.lobes = lobes})) {
      pair.b = s->direction;
      pair.sampled = true;
      pair.eta = s->eta;
      pair.hero_alone = s->dispersive;
    }
  return pair;
}

void check_adjoint(Trial& trial, const BoundShader& bound, const std::string& check) {
  const Scatter& scatter = *bound.scatter();
  const Normal3 ng = bound.point().normal;
  for (const Lobes lobes : subsets_of(scatter.lobes() & smooth_lobes))
    for (int i = trial.samples(300); i > 0; --i) {
      const Pair pair = draw_pair(trial, scatter, lobes);
      // Both sides are multiplied by both cosines with ng, to avoid divisions.
      const auto importance = [&](const Vector3& a, const Vector3& b) {
        return scatter.evaluate(a, b, {Transport::importance, lobes}) * std::abs(dot(ng, a));
      };
      const auto radiance = [&](const Vector3& a, const Vector3& b) {
        return scatter.evaluate(b, a, {.lobes = lobes}) * std::abs(dot(ng, b));
      };
      const Spectrum from_light = importance(pair.a, pair.b), from_camera = radiance(pair.a, pair.b);
      trial.expect(agree(from_light, from_camera, 3e-3f, pair.hero_alone,
                         [&] {
                           return rounding_of([&](const Vector3& v) { return importance(pair.a, v); }, pair.b) +
                                  rounding_of([&](const Vector3& v) { return radiance(v, pair.b); }, pair.a);
                         }),
                   check, [&] {
                     return fmt::format("{}: {} as importance, {} as radiance the other way; a {}, b {}", lobe_names(lobes),
                                        text(from_light), text(from_camera), bound.name(pair.a), bound.name(pair.b));
                   });
    }
}

/// Reciprocity across refraction holds at each wavelength with its own relative index. A sample gives only the hero's, so each
/// wavelength is made the hero in turn (see RelativeIndex). Where a lobe refracts by several indices at once, as in a mixture,
/// only pairs that a sample connects are compared, at the hero wavelength.
void check_reciprocity(Trial& trial, const BoundShader& bound) {
  const Scatter& scatter = *bound.scatter();
  for (const Lobes lobes : subsets_of(scatter.lobes() & smooth_lobes)) {
    const bool reflection = (lobes & transmission_lobes) == 0;
    if (!reflection && !std::has_single_bit(unsigned(lobes))) continue;  // the index of several lobes together is not known
    const RelativeIndex index = reflection ? RelativeIndex() : RelativeIndex(trial, bound, lobes);
    for (int i = trial.samples(300); i > 0; --i) {
      const Pair pair = draw_pair(trial, scatter, lobes);
      const Spectrum* known = reflection ? nullptr : index.from(dot(bound.point().normal, pair.a) > 0);
      if (!reflection && !known && !pair.sampled) continue;
      const Spectrum eta = known ? *known : Spectrum(pair.eta);
      // f times both cosines, to avoid divisions.
      const auto value = [&](const Vector3& a, const Vector3& b) {
        return scatter.evaluate(a, b, {.lobes = lobes}) * scatter.cosine(a);
      };
      const Spectrum ab = value(pair.a, pair.b) * eta * eta, ba = value(pair.b, pair.a);
      trial.expect(agree(ab, ba, 3e-3f, pair.hero_alone || (!reflection && (!known || index.dispersive())),
                         [&] {
                           return rounding_of([&](const Vector3& v) { return value(pair.a, v); }, pair.b) +
                                  rounding_of([&](const Vector3& v) { return value(v, pair.a); }, pair.b);
                         }),
                   "f is reciprocal", [&] {
                     return fmt::format("{}: {} one way, {} the other; a {}, b {}, relative index {}", lobe_names(lobes),
                                        text(ab), text(ba), bound.name(pair.a), bound.name(pair.b), text(eta));
                   });
    }
  }
}

/// What a specular lobe scatters from one direction to another. A lobe may scatter into several directions, and into one
/// direction in several ways.
struct Connection {
  double power = 0;  ///< the fraction of power at the hero wavelength
  float eta = 0;     ///< index of the medium of `in` over that of `out`; 0: `in` is never sampled
};

Connection connection(const Scatter& scatter, const Vector3& out, const Vector3& in, Lobes lobe) {
  constexpr int tries = 1024;
  Connection c;
  for (int i = 0; i < tries; ++i) {
    const Point2 u{float(i * 389 % tries) / tries, float(i * 61 % tries) / tries};
    const auto s = scatter.sample(out, (float(i) + 0.5f) / tries, u, {.lobes = lobe});
    if (!s || length(s->direction - in) > 1e-3f) continue;
    c.power += double(s->weight[0] * square(s->eta)) / tries;
    c.eta = s->eta;
  }
  return c;
}

/// Specular scattering is reversible, with equal fractions of power both ways; radiance also scales with the squared relative
/// index.
void check_specular(Trial& trial, const BoundShader& bound) {
  const Scatter& scatter = *bound.scatter();
  for (Lobes rest = scatter.lobes() & specular_lobes; rest != 0; rest &= Lobes(rest - 1)) {
    const Lobes lobe = rest & Lobes(-rest);
    for (int i = 0; i < 100; ++i) {
      const Vector3 out = trial.direction();
      const float choice = trial.uniform();
      const Point2 u = trial.pair();
      const auto s = scatter.sample(out, choice, u, {.lobes = lobe});
      if (!s) continue;
      const auto where = [&] {
        return fmt::format("{}: out {}, in {}", lobe_names(lobe), bound.name(out), bound.name(s->direction));
      };
      // At grazing angles rounding errors dominate.
      if (scatter.cosine(out) < 0.02f || scatter.cosine(s->direction) < 0.02f) continue;
      if (const auto t = scatter.sample(out, choice, u, {Transport::importance, lobe}); t && !bound.turned())
        trial.expect(t->direction == s->direction &&
                         agree(s->weight * square(s->eta), t->weight, 2e-3f, s->dispersive, [] { return Spectrum(); }),
                     "radiance and importance differ by the squared index", [&] {
                       return fmt::format("{}: weights {} and {}, relative index {}", where(), text(s->weight), text(t->weight),
                                          s->eta);
                     });
      const Connection there = connection(scatter, out, s->direction, lobe),
                       back = connection(scatter, s->direction, out, lobe);
      if (there.power < 0.01 && back.power < 0.01) continue;  // so rarely sampled that the reverse may not have been found
      trial.expect(std::abs(back.eta * s->eta - 1) < 1e-3f, "specular paths lead back", where);
      trial.expect(std::abs(there.power - back.power) < 0.01 * std::max(there.power, back.power) + 5e-3,
                   "specular paths carry the same both ways",
                   [&] { return fmt::format("{}: {} and {} back", where(), there.power, back.power); });
    }
  }
}

}  // namespace

void check_shader_reversal(Trial& trial, const BoundShader& plain, const BoundShader& tilted) {
  check_adjoint(trial, plain, "importance is the adjoint of radiance");
  check_adjoint(trial, tilted, "importance is the adjoint of radiance under shading normals");
  if (!trial.part<Shader>().reciprocal()) return;
  check_reciprocity(trial, plain);
  check_specular(trial, plain);
}

}  // namespace etendue::conform
