// Checks a shader's evaluation and sampling direction by direction: finite values, lobe masks, sums of lobes, sample weights.

#include <fmt/format.h>

#include "shader_trial.h"

namespace etendue::conform {
namespace {

std::string text(const Spectrum& s) { return fmt::format("[{:.7g} {:.7g} ...]", s[0], s[1]); }
const char* name(Transport t) { return t == Transport::radiance ? "radiance" : "importance"; }

bool sane(const Spectrum& s) { return s.finite() && s.minimum() >= 0; }

constexpr double grazing[] = {0, 45, 89, 89.9, 89.99, 90, 90.01, 91, 135, 180};

/// Checks that no value is infinite, negative or NaN for any directions and random numbers.
void check_finite(Trial& trial, const BoundShader& bound) {
  const Scatter& scatter = *bound.scatter();
  std::vector<Vector3> directions;
  const double azimuth = 2 * M_PI * double(trial.uniform());
  for (const double angle : grazing)
    for (const double turn : {0.0, 0.5, 1.0}) directions.push_back(bound.at_angle(angle, azimuth + turn * M_PI));
  const std::string finite = "values and densities are finite and not negative, at grazing angles too";
  for (const Vector3& out : directions) {
    for (const Vector3& in : directions)
      for (const Transport transport : {Transport::radiance, Transport::importance}) {
        const ScatterValue v = scatter.value_and_pdf(out, in, {.transport = transport});
        const Spectrum e = scatter.evaluate(out, in, {.transport = transport});
        const float d = scatter.pdf(out, in, {.transport = transport});
        trial.expect(sane(v.value) && sane(e) && v.pdf >= 0 && v.pdf < infinity && d >= 0 && d < infinity, finite, [&] {
          return fmt::format("out {}, in {}, {}: value {}, density {}", bound.name(out), bound.name(in), name(transport),
                             text(e), d);
        });
      }
    const Spectrum albedo = scatter.albedo(out);
    trial.expect(sane(albedo) && albedo.maximum() < 1.01f, "the albedo's estimate lies between 0 and 1",
                 [&] { return fmt::format("{} at {}", text(albedo), bound.name(out)); });
  }
  for (const Vector3& out : directions)
    for (const float choice : {0.0f, 0.5f, one_minus_epsilon})
      for (const float x : {0.0f, 0.5f, one_minus_epsilon})
        for (const float y : {0.0f, 0.5f, one_minus_epsilon})
          for (const Transport transport : {Transport::radiance, Transport::importance}) {
            const auto s = scatter.sample(out, choice, {x, y}, {.transport = transport});
            if (!s) continue;
            trial.expect(sane(s->weight) && s->pdf > 0 && s->pdf < infinity && std::abs(length(s->direction) - 1) < 1e-4f &&
                             s->eta > 0 && s->eta < infinity,
                         "samples are finite, for extreme random numbers too", [&] {
                           return fmt::format(
                               "out {}, choice {}, u ({}, {}), {}: direction ({}, {}, {}), weight {}, density {}",
                               bound.name(out), choice, x, y, name(transport), s->direction.x, s->direction.y, s->direction.z,
                               text(s->weight), s->pdf);
                         });
          }
}

/// A direction for `in`: sampled for `out`, or with equal probability uniform.
Vector3 partner(Trial& trial, const Scatter& scatter, const Vector3& out) {
  if (trial.uniform() < 0.5f)
    if (const auto s = scatter.sample(out, trial.uniform(), trial.pair())) return s->direction;
  return trial.direction();
}

void check_masks(Trial& trial, const BoundShader& bound) {
  const Scatter& scatter = *bound.scatter();
  const Lobes absent = Lobes(all_lobes & ~scatter.lobes());
  for (int i = trial.samples(400); i > 0; --i) {
    const Vector3 out = trial.direction(), in = partner(trial, scatter, out);
    const float choice = trial.uniform();
    const Point2 u = trial.pair();
    trial.expect(scatter.evaluate(out, in, {.lobes = absent}).black() && scatter.pdf(out, in, {.lobes = absent}) == 0 &&
                     !scatter.sample(out, choice, u, {.lobes = absent}) && scatter.albedo(out, absent).black(),
                 "lobes that are absent give nothing", [&] {
                   return fmt::format("asked for {}: out {}, in {}", lobe_names(absent), bound.name(out), bound.name(in));
                 });
    for (const Lobes lobes : subsets_of(scatter.lobes() & smooth_lobes)) {
      const Spectrum whole = scatter.evaluate(out, in, {.lobes = lobes});
      Spectrum sum;
      for (Lobes rest = lobes; rest != 0; rest &= Lobes(rest - 1))
        sum += scatter.evaluate(out, in, {.lobes = Lobes(rest & Lobes(-rest))});
      trial.expect(agree(whole, sum, 1e-3f, false, [] { return Spectrum(); }), "lobes together are the sum of single lobes",
                   [&] {
                     return fmt::format("{}: {} together, {} as a sum; out {}, in {}", lobe_names(lobes), text(whole),
                                        text(sum), bound.name(out), bound.name(in));
                   });
      const bool reflection = dot(bound.point().normal, out) * dot(bound.point().normal, in) > 0;
      if ((lobes & (reflection ? reflection_lobes : transmission_lobes)) == 0)
        trial.expect(whole.black() && scatter.pdf(out, in, {.lobes = lobes}) == 0,
                     "reflection and transmission keep to their sides",
                     [&] { return fmt::format("{}: out {}, in {}", lobe_names(lobes), bound.name(out), bound.name(in)); });
    }
  }
}

/// Compares one sample with evaluation in its direction.
void check_sample(Trial& trial, const BoundShader& bound, const Vector3& out, const ScatterSample& s, Transport transport,
                  Lobes lobes) {
  const Scatter& scatter = *bound.scatter();
  const auto where = [&] {
    return fmt::format("asked for {}, {}: out {}, in {} by {}", lobe_names(lobes), name(transport), bound.name(out),
                       bound.name(s.direction), lobe_names(s.lobe));
  };
  const Normal3 n = bound.point().normal;
  trial.expect(std::has_single_bit(unsigned(s.lobe)) && (s.lobe & lobes) != 0, "a sample is of one lobe that was asked for",
               where);
  const bool crossed = dot(n, out) * dot(n, s.direction) < 0;
  trial.expect(crossed == s.transmitted(), "reflection and transmission keep to their sides", where);
  trial.expect(s.transmitted() || s.eta == 1, "reflection has a relative index of 1", where);
  if (s.lobe == null_scattering)
    trial.expect(length(s.direction + out) < 1e-5f && s.eta == 1 && !s.dispersive, "what passes through goes straight on",
                 where);
  if (s.specular()) {
    trial.expect(s.pdf <= 1.0001f, "a specular sample's density is a probability",
                 [&] { return fmt::format("{}: {}", where(), s.pdf); });
    return;
  }
  const auto value = [&](const Vector3& in) { return scatter.evaluate(out, in, {transport, lobes}); };
  const auto pdf = [&](const Vector3& in) { return Spectrum(scatter.pdf(out, in, {transport, lobes})); };
  const Spectrum f = value(s.direction);
  const float p = pdf(s.direction)[0];
  const ScatterValue both = scatter.value_and_pdf(out, s.direction, {transport, lobes});
  trial.expect(agree(both.value, f, 1e-3f, false, [&] { return rounding_of(value, s.direction); }) &&
                   agree(both.pdf, p, 1e-3f, true, [&] { return rounding_of(pdf, s.direction); }),
               "value_and_density is evaluate and density", [&] {
                 return fmt::format("{}: value {} and {}, density {} and {}", where(), text(both.value), text(f), both.pdf, p);
               });
  trial.expect(agree(Spectrum(s.pdf), Spectrum(p), 2e-3f, true, [&] { return rounding_of(pdf, s.direction); }),
               "a sample's density is that of its direction",
               [&] { return fmt::format("{}: {} from sample, {} from density", where(), s.pdf, p); });
  const Spectrum carried = s.weight * s.pdf, wanted = value(s.direction);
  trial.expect(agree(carried, wanted, 4e-3f, s.dispersive,
                     [&] { return rounding_of(value, s.direction) + s.weight * rounding_of(pdf, s.direction); }),
               "a sample's weight is value over density",
               [&] { return fmt::format("{}: weight {} instead of {}", where(), text(s.weight), text(wanted / s.pdf)); });
  const float reverse = scatter.pdf(s.direction, out, {transport, lobes});
  trial.expect(reverse >= 0 && reverse < infinity, "the reverse density is finite",
               [&] { return fmt::format("{}: {}", where(), reverse); });
}

void check_samples(Trial& trial, const BoundShader& bound, bool estimates) {
  const Scatter& scatter = *bound.scatter();
  for (const Lobes lobes : subsets_of(scatter.lobes()))
    for (const Transport transport : {Transport::radiance, Transport::importance})
      for (int i = trial.samples(200); i > 0; --i) {
        const Vector3 out = trial.uniform() < 0.8f
                                ? trial.direction()
                                : bound.at_angle(90 + 6 * (double(trial.uniform()) - 0.5), 6 * double(trial.uniform()));
        const float choice = trial.uniform();
        const Point2 u = trial.pair();
        const auto s = scatter.sample(out, choice, u, {transport, lobes});
        if (!s) continue;
        if (!trial.expect(sane(s->weight) && s->pdf > 0, "samples are finite, for extreme random numbers too",
                          [&] { return "out " + bound.name(out); }))
          continue;
        if (!estimates) check_sample(trial, bound, out, *s, transport, lobes);
      }
}

}  // namespace

void check_shader_values(Trial& trial, const BoundShader& plain, const BoundShader& tilted) {
  const bool estimates = trial.part<Shader>().stochastic();
  for (const BoundShader* bound : {&plain, &tilted}) {
    check_finite(trial, *bound);
    if (!estimates) check_masks(trial, *bound);
    check_samples(trial, *bound, estimates);
  }
}

}  // namespace etendue::conform
