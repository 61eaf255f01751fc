// Checks a shader's samples against its pdf and its energy: chi-square tests and quadrature over cells of the sphere.

#include <fmt/format.h>

#include "shader_trial.h"
#include "sphere_cells.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

using statistics::Mean;

struct Drawn {
  std::vector<Vector3> directions;  ///< of smooth lobes, in the local frame
  std::vector<double> weights;      ///< weights of these at the hero wavelength
  Mean all;                         ///< weights of all samples at the hero wavelength, including specular and absorbed ones
  Mean others[spectrum_size];       ///< the same for each wavelength; valid if no sample is dispersive
  bool dispersive = false;
  int count = 0;
};

Drawn draw(Trial& trial, const Scatter& scatter, const Vector3& out, Lobes lobes, Transport transport, int count) {
  Drawn drawn;
  drawn.count = count;
  for (int i = 0; i < count; ++i) {
    const float choice = trial.uniform();
    const auto s = scatter.sample(out, choice, trial.pair(), {transport, lobes});
    drawn.all.add(s ? double(s->weight[0]) : 0);
    for (int k = 0; k < spectrum_size; ++k) drawn.others[k].add(s ? double(s->weight[k]) : 0);
    drawn.dispersive |= s && s->dispersive;
    if (!s || s->specular()) continue;
    drawn.directions.push_back(scatter.frame().to_local(s->direction));
    drawn.weights.push_back(double(s->weight[0]));
  }
  return drawn;
}

std::string where(const BoundShader& bound, const Vector3& out, Lobes lobes) {
  return fmt::format("{}, out {}", lobe_names(lobes), bound.name(out));
}

/// The number of samples by which the cells are chosen, at any effort: too coarse cells would make the test meaningless.
constexpr int pilots = 6000;
constexpr size_t cell_count = 96;
/// The integrals of the pdf and of f cos by quadrature, and the samples.
struct Measured {
  double pdf = 0, flux = 0;
  Drawn drawn;
};

/// The chi-square test of samples against the pdf; returns the integrals for further tests.
Measured check_pdf(Trial& trial, const BoundShader& bound, const Vector3& out, Lobes lobes, Transport transport,
                   const std::string& check) {
  const Scatter& scatter = *bound.scatter();
  const SphereCells cells(draw(trial, scatter, out, lobes, transport, pilots).directions, cell_count);
  Measured m;
  m.drawn = draw(trial, scatter, out, lobes, transport, trial.samples(20000));
  const int n = m.drawn.count;
  std::vector<double> expected, counts(cells.size());
  for (const Vector3& v : m.drawn.directions) ++counts[cells.cell_of(v)];
  counts.push_back(double(n) - double(m.drawn.directions.size()));  // absorbed or specular
  double p = 0;
  // A pdf with sharp edges may need more quadrature points than most.
  for (double tolerance = 1e-3; tolerance > 1e-5 && !(p > Trial::significance); tolerance /= 10) {
    const auto integrals = cells.integrate<2>(
        [&](const Vector3& local) -> std::array<double, 2> {
          const Vector3 in = scatter.frame().to_world(local);
          const ScatterValue v = scatter.value_and_pdf(out, in, {transport, lobes});
          return {double(v.pdf), double(v.value[0])};
        },
        tolerance, long(1e3 / tolerance));
    m.pdf = m.flux = 0;
    expected.clear();
    for (const auto& [pdf, flux] : integrals) {
      m.pdf += pdf;
      m.flux += flux;
      expected.push_back(pdf * n);
    }
    const double absorbed = std::max(0.0, 1 - m.pdf) * n;  // only as exact as the quadrature
    expected.push_back(std::abs(absorbed - counts.back()) < 2e-3 * n ? counts.back() : absorbed);
    p = statistics::chi_square(counts, expected, 10, 1e-3 * n);
  }
  trial.expect(m.pdf <= 1.005, "the density integrates to at most 1",
               [&] { return fmt::format("{}: {:.5f}", where(bound, out, lobes), m.pdf); });
  trial.expect(p > Trial::significance, check, [&] {
    size_t worst = 0;
    const auto off = [&](size_t i) { return std::abs(counts[i] - expected[i]) / std::sqrt(std::max(expected[i], 1.0)); };
    for (size_t i = 1; i < counts.size(); ++i)
      if (off(i) > off(worst)) worst = i;
    const std::string place =
        worst == cells.size() ? "absorbed or specular" : "around " + bound.name(scatter.frame().to_world(cells.middle(worst)));
    return fmt::format(
        "{}: p = {:.2g}; the density integrates to {:.4f}, {:.4f} of {} samples are smooth; worst: {} samples {}, "
        "expected {:.1f}",
        where(bound, out, lobes), p, m.pdf, double(m.drawn.directions.size()) / n, n, counts[worst], place, expected[worst]);
  });
  return m;
}

/// The transport whose weights are fractions of power, for tests of energy. This is importance. Under shading normals, of the
/// point or of a part of the shader (which then is not reciprocal), it is radiance, measured with the shading normal, except
/// for refraction.
Transport conserved(const Trial& trial, const BoundShader& bound) {
  return bound.turned() || !trial.part<Shader>().reciprocal() ? Transport::radiance : Transport::importance;
}

/// Whether these lobes are dispersive in any direction. Where the hero wavelength is not refracted, or is not deflected, no
/// sample is marked as dispersive, but other wavelengths may carry more than the hero.
bool ever_dispersive(Trial& trial, const Scatter& scatter, Lobes lobes) {
  for (int i = 0; i < 300; ++i) {
    const Vector3 out = trial.direction();
    const float choice = trial.uniform();
    const auto s = scatter.sample(out, choice, trial.pair(), {.lobes = lobes});
    if (s && s->dispersive) return true;
  }
  return false;
}

/// Checks that the shader's albedo is, within its stated error, the mean weight of samples. This is an unbiased estimate of the
/// integral of f cos (plus specular lobes), with a known standard error. Fractions of power are compared, because the albedo is
/// defined by power.
void check_albedo(Trial& trial, const BoundShader& bound, const Vector3& out, Lobes lobes, const Drawn& drawn) {
  const double angle = bound.angle(out), bias = double(trial.part<Shader>().albedo_error());
  if (angle > 85 && angle < 95) return;  // the error is not bounded there
  // The error is relative to the albedo of all lobes: for a lobe that scatters next to nothing the relative error may be large.
  const Spectrum said = bound.scatter()->albedo(out, lobes), all = bound.scatter()->albedo(out);
  // A dispersive path follows its hero wavelength, so its weights say nothing about the other wavelengths.
  const bool hero_alone = drawn.dispersive || ever_dispersive(trial, *bound.scatter(), lobes);
  for (int k = 0; k < (hero_alone ? 1 : spectrum_size); ++k) {
    const Mean& mean = drawn.others[k];
    // Tolerance for rounding, and for the tables of energy lost between microfacets, on which the weights depend as well.
    constexpr double least = 2e-3;
    const double margin = Trial::significant_errors * mean.error() + 10 * mean.largest() / drawn.count + least;
    trial.expect(
        std::abs(double(said[k]) - mean.mean()) < margin + bias * std::max(double(all[k]), mean.mean()),
        "the albedo is that of the samples", [&] {
          return fmt::format(
              "{}: said to be {:.5f} with an error of at most {:.3g} of the whole, samples have {:.5f} ± {:.5f}, at {:.0f} nm",
              where(bound, out, lobes), said[k], bias, mean.mean(), mean.error(), bound.wavelengths()[k]);
        });
  }
}

/// Tests samples, pdf and energy for one direction and set of lobes.
void check_direction(Trial& trial, const BoundShader& bound, const Vector3& out, Lobes lobes) {
  const Shader& shader = trial.part<Shader>();
  const Transport transport = conserved(trial, bound);
  const Measured m = check_pdf(trial, bound, out, lobes, transport, "samples follow the density");
  if (transport == Transport::radiance && (lobes & transmission_lobes & ~null_scattering)) return;
  const double albedo = m.flux + bound.specular_fraction(out, lobes);
  const Mean& mean = m.drawn.all;
  const double margin = Trial::significant_errors * mean.error() + 10 * mean.largest() / m.drawn.count + 3e-3;
  trial.expect(std::abs(mean.mean() - albedo) < margin, "samples carry what evaluation says", [&] {
    return fmt::format("{}: the mean weight is {:.5f} ± {:.5f}, f cos integrates to {:.5f}", where(bound, out, lobes),
                       mean.mean(), mean.error(), albedo);
  });
  trial.expect(albedo < 1.005, "no more light leaves than arrives",
               [&] { return fmt::format("{}: {:.5f}", where(bound, out, lobes), albedo); });
  if (shader.lossless() && lobes == bound.scatter()->lobes())
    trial.expect(albedo > 0.995, "a lossless shader absorbs nothing",
                 [&] { return fmt::format("{}: {:.5f}", where(bound, out, lobes), albedo); });
  check_albedo(trial, bound, out, lobes, m.drawn);
}

/// Whether a shader contains a stochastic one, whose values are estimates: then each evaluation needs very many of the inner
/// one.
bool rests_on_estimates(const Component& shader) {
  for (const Member& m : shader.class_info().members) {
    if (m.kind != Kind::component || m.list) continue;
    const Value value = get(shader, m.name);
    const auto* inner = value.as<Ref<Component>>();
    const auto* base = inner ? dynamic_cast<const Shader*>(inner->get()) : nullptr;
    if (base && (base->stochastic() || rests_on_estimates(*base))) return true;
  }
  return false;
}

/// For shaders that are not reciprocal: directions are sampled as for radiance, and weighted by the adjoint.
void check_adjoint_samples(Trial& trial, const BoundShader& bound, const Vector3& out) {
  const Lobes lobes = bound.scatter()->lobes() & smooth_lobes;
  const Measured m = check_pdf(trial, bound, out, lobes, Transport::importance, "samples of importance follow the density");
  const Mean& mean = m.drawn.all;
  const double margin = Trial::significant_errors * mean.error() + 10 * mean.largest() / m.drawn.count + 3e-3;
  trial.expect(std::abs(mean.mean() - m.flux) < margin, "samples of importance carry what evaluation says", [&] {
    return fmt::format("{}: the mean weight is {:.5f} ± {:.5f}, f cos integrates to {:.5f}", where(bound, out, lobes),
                       mean.mean(), mean.error(), m.flux);
  });
}

constexpr double angles[] = {0, 25, 50, 75, 86, 89.5, 95, 120, 155};

}  // namespace

void check_shader_sampling(Trial& trial, const BoundShader& plain, const BoundShader& tilted) {
  const auto azimuth = [&] { return 2 * M_PI * double(trial.uniform()); };
  for (const Lobes lobes : subsets_of(plain.scatter()->lobes())) {
    if (lobes == plain.scatter()->lobes()) {
      for (const double angle : angles) check_direction(trial, plain, plain.at_angle(angle, azimuth()), lobes);
    } else {
      const double angle = 85 * double(trial.uniform());
      const bool behind = trial.uniform() < 0.5f;
      check_direction(trial, plain, plain.at_angle(behind ? 180 - angle : angle, azimuth()), lobes);
      if (trial.effort() != Effort::quick)
        check_direction(trial, plain, plain.at_angle(behind ? angle : 180 - angle, azimuth()), lobes);
    }
  }
  if (!trial.part<Shader>().reciprocal() && !plain.turned() && plain.scatter()->has(smooth_lobes))
    for (const double angle : {20.0, 65.0, 140.0}) check_adjoint_samples(trial, plain, plain.at_angle(angle, azimuth()));
  // Under a tilted shading normal, directions on the wrong side of the surface are mirrored back, so no energy is lost.
  for (const double angle : {30.0, 70.0, 88.0, 130.0})
    check_direction(trial, tilted, tilted.at_angle(angle, azimuth()), tilted.scatter()->lobes());
}

// Compares the mean of evaluate over directions uniform in a cell, times the cell's solid angle, with the weights of the
// samples in the cell: both estimate the integral of f cos over the cell.
void check_shader_estimates(Trial& trial, const BoundShader& bound) {
  const Scatter& scatter = *bound.scatter();
  const Transport transport = conserved(trial, bound);
  const int share = rests_on_estimates(trial.part<Shader>()) ? 16 : 1;
  for (const double angle : angles) {
    const Vector3 out = bound.at_angle(angle, 2 * M_PI * double(trial.uniform()));
    const Lobes lobes = scatter.lobes();
    const Drawn pilot = draw(trial, scatter, out, lobes, transport, pilots);
    const SphereCells cells(pilot.directions, 24);
    const Drawn drawn = draw(trial, scatter, out, lobes, transport, trial.samples(40000 / share));
    std::vector<Mean> weights(cells.size());
    for (size_t i = 0; i < drawn.directions.size(); ++i) weights[cells.cell_of(drawn.directions[i])].add(drawn.weights[i]);
    const int asked = trial.samples(3000 / share);
    for (size_t cell = 0; cell < cells.size(); ++cell) {
      Mean values;
      for (int i = 0; i < asked; ++i) {
        const Point2 u = trial.pair();
        const Vector3 in = scatter.frame().to_world(cells.uniform(cell, double(u.x), double(u.y)));
        values.add(double(scatter.evaluate(out, in, {transport, lobes})[0]) * cells.solid_angle(cell));
      }
      Mean& w = weights[cell];
      w.add_zeros(drawn.count - w.count());
      const double margin = Trial::significant_errors * std::hypot(values.error(), w.error()) + 0.02 * values.mean() +
                            10 * (values.largest() / asked + drawn.all.largest() / drawn.count) + 1e-4;
      trial.expect(std::abs(values.mean() - w.mean()) < margin, "samples carry what evaluation says, on the average", [&] {
        return fmt::format("{}, around {}: evaluate {:.5f} ± {:.5f}, samples {:.5f} ± {:.5f}", where(bound, out, lobes),
                           bound.name(scatter.frame().to_world(cells.middle(cell))), values.mean(), values.error(), w.mean(),
                           w.error());
      });
    }
    if (transport == Transport::radiance && (lobes & transmission_lobes & ~null_scattering)) continue;
    const double slack = Trial::significant_errors * drawn.all.error() + 5e-3;
    trial.expect(drawn.all.mean() < 1 + slack, "no more light leaves than arrives", [&] {
      return fmt::format("{}: {:.5f} ± {:.5f}", where(bound, out, lobes), drawn.all.mean(), drawn.all.error());
    });
    if (trial.part<Shader>().lossless())
      trial.expect(drawn.all.mean() > 1 - slack, "a lossless shader absorbs nothing", [&] {
        return fmt::format("{}: {:.5f} ± {:.5f}", where(bound, out, lobes), drawn.all.mean(), drawn.all.error());
      });
    if (transport == Transport::importance) check_albedo(trial, bound, out, lobes, drawn);
  }
}

}  // namespace etendue::conform
