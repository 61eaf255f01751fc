// Checks of every participating medium.

#include <fmt/format.h>

#include "conformance.h"
#include "etendue/transport/medium.h"
#include "etendue/volume_shader.h"
#include "shader_trial.h"
#include "sphere_cells.h"
#include "statistics.h"

namespace etendue::conform {
namespace {

Point3 somewhere(Trial& trial) {
  const auto x = [&] { return 4 * trial.uniform() - 2; };
  const float a = x(), b = x();
  return {a, b, x()};
}

void check_coefficients(Trial& trial, const VolumeShader& volume) {
  const Wavelengths w = spread_wavelengths(lerp(trial.uniform(), 400, 700));
  const Spectrum majorant = volume.majorant(w);
  const VolumeCoefficients first = volume.coefficients({}, 0, w);
  for (int i = trial.samples(2000); i > 0; --i) {
    const Point3 p = somewhere(trial);
    const VolumeCoefficients c = volume.coefficients(p, 0, w);
    const auto where = [&] {
      return fmt::format("at ({}, {}, {}): absorption {}, scattering {}, majorant {}", p.x, p.y, p.z, c.absorption[0],
                         c.scattering[0], majorant[0]);
    };
    trial.expect(c.absorption.finite() && c.scattering.finite() && c.emission.finite() && c.absorption.minimum() >= 0 &&
                     c.scattering.minimum() >= 0 && c.emission.minimum() >= 0,
                 "coefficients are finite and not negative", where);
    trial.expect((c.extinction() - majorant).maximum() <= 1e-5f * majorant.maximum(), "the majorant bounds the extinction",
                 where);
    trial.expect(volume.emits() || c.emission.black(), "a medium that says it does not emit does not", where);
    if (volume.homogeneous())
      trial.expect((c.extinction() - first.extinction()).black() && (c.emission - first.emission).black(),
                   "a homogeneous medium is the same everywhere", where);
  }
}

void check_phase(Trial& trial, const VolumeShader& volume) {
  for (int i = 0; i < 4; ++i) {
    const Point3 p = somewhere(trial);
    const Vector3 out = trial.direction();
    const Frame frame{Normal3(out)};
    const auto draw = [&](int count) {
      std::vector<Vector3> list;
      for (; count > 0; --count) {
        float pdf = 0;
        const Vector3 in = volume.sample_phase(p, out, trial.pair(), pdf);
        trial.expect(std::abs(length(in) - 1) < 1e-4f && pdf > 0 && pdf < infinity, "sampled directions are unit vectors",
                     [&] { return fmt::format("({}, {}, {}), density {}", in.x, in.y, in.z, pdf); });
        const auto phase = [&](const Vector3& v) { return Spectrum(volume.phase(p, out, v)); };
        trial.expect(agree(Spectrum(pdf), phase(in), 2e-3f, true, [&] { return rounding_of(phase, in); }),
                     "a sample's density is the phase function",
                     [&] { return fmt::format("density {}, phase function {}", pdf, phase(in)[0]); });
        const float back = volume.phase(p, in, out);
        trial.expect(agree(Spectrum(back), phase(in), 2e-3f, true, [&] { return rounding_of(phase, in); }),
                     "the phase function is reciprocal",
                     [&] { return fmt::format("{} one way, {} the other", phase(in)[0], back); });
        list.push_back(frame.to_local(in));
      }
      return list;
    };
    const SphereCells cells(draw(trial.samples(8000)), 96);
    const auto integrals = cells.integrate<1>(
        [&](const Vector3& local) -> std::array<double, 1> { return {double(volume.phase(p, out, frame.to_world(local)))}; });
    const std::vector<Vector3> drawn = draw(trial.samples(32000));
    std::vector<double> expected, counts(cells.size());
    double sum = 0;
    for (const auto& [share] : integrals) {
      sum += share;
      expected.push_back(share * double(drawn.size()));
    }
    for (const Vector3& v : drawn) ++counts[cells.cell_of(v)];
    trial.expect(std::abs(sum - 1) < 3e-3, "the phase function integrates to 1", [&] { return fmt::format("{:.5f}", sum); });
    const double p_value = statistics::chi_square(counts, expected, 10);
    trial.expect(p_value > Trial::significance, "sampled directions follow the phase function",
                 [&] { return fmt::format("p = {:.2g}", p_value); });
  }
}

/// exp(-int sigma_t) by the midpoint rule, independent of the transport code. Also checks that the extinction does not exceed
/// the majorant.
Spectrum integrated_transmittance(Trial& trial, const VolumeShader& volume, const Ray& ray, float reach, const Wavelengths& w) {
  constexpr int points = 2000;
  const Spectrum bound = volume.majorant(w);
  Spectrum depth;
  for (int i = 0; i < points; ++i) {
    const Spectrum s = volume.coefficients(ray(reach * (float(i) + 0.5f) / points), ray.time, w).extinction();
    depth += s / points;
    for (int k = 0; k < spectrum_size; ++k)
      trial.expect(s[k] <= bound[k] * 1.00001f, "the extinction is nowhere above its bound",
                   [&] { return fmt::format("{} at {} nm, the bound is {}", s[k], w[k], bound[k]); });
  }
  return map(depth, [reach](float s) { return s > 0 ? std::exp(-s * reach) : 1.0f; });
}

/// The mean weight of unscattered free flights is the transmittance T; that of scattered ones, in a homogeneous medium, is the
/// single-scattering albedo times 1 - T.
void check_free_flight(Trial& trial, const VolumeShader& volume) {
  const Wavelengths w = spread_wavelengths(lerp(trial.uniform(), 400, 700));
  const Ref<Sampler> sampler = ref_cast<Sampler>(Registry::instance().create("IndependentSampler"));
  const float majorant = volume.majorant(w).maximum();
  const Ref<SceneObject> inside = ref_cast<SceneObject>(Registry::instance().create("Sphere"));
  const Medium medium{&volume, inside.get()};
  std::uint32_t sample = 0;
  const std::uint64_t seed = trial.random();
  for (const float depth : {0.2f, 1.0f, 4.0f}) {
    const float reach = majorant > 0 ? depth / majorant : depth;
    Ray ray;
    ray.origin = somewhere(trial);
    ray.direction = trial.direction();
    const Spectrum expected = integrated_transmittance(trial, volume, ray, reach, w);
    const Spectrum throughput(1.0f);
    std::array<statistics::Mean, spectrum_size> through, scattered, fraction;
    for (int i = trial.samples(40000); i > 0; --i) {
      NumberStream stream(*sampler, SampleKey(seed, 0, 0, sample++));
      const FreeFlight flight = sample_free_flight(medium, ray, reach, throughput, w, stream);
      trial.expect(flight.weight.finite() && flight.weight.minimum() >= 0 && flight.distance >= 0 && flight.distance <= reach,
                   "free flights are finite and end in reach", [&] { return fmt::format("{} of {}", flight.distance, reach); });
      const Spectrum passed = transmittance(medium, ray, reach, w, stream);
      for (size_t k = 0; k < spectrum_size; ++k) {
        fraction[k].add(double(passed[int(k)]));
        through[k].add(flight.scattered ? 0 : double(flight.weight[int(k)]));
        scattered[k].add(flight.scattered ? double(flight.weight[int(k)]) : 0);
      }
    }
    const VolumeCoefficients c = volume.coefficients(ray.origin, 0, w);
    for (size_t k = 0; k < spectrum_size; ++k) {
      const double t = double(expected[int(k)]), s = double(c.extinction()[int(k)]);
      const auto near = [&](const statistics::Mean& m, double value, const char* what) {
        trial.expect(
            std::abs(m.mean() - value) < Trial::significant_errors * m.error() + 10 * m.largest() / double(m.count()) + 1e-5,
            "free flights agree with the transmittance", [&] {
              return fmt::format("{} within {} m: {:.5f} ± {:.5f} by walks, {:.5f} expected", what, reach, m.mean(), m.error(),
                                 value);
            });
      };
      near(through[k], t, "unscattered");
      near(fraction[k], t, "let through");
      if (volume.homogeneous()) {
        near(scattered[k], s > 0 ? double(c.scattering[int(k)]) / s * (1 - t) : 0, "scattered");
        trial.expect(std::abs(t - std::exp(-s * double(reach))) < 1e-4, "the transmittance is exp(-extinction distance)",
                     [&] { return fmt::format("{} over {} m with extinction {}", t, reach, s); });
      }
    }
  }
}

void check_volume(Trial& trial) {
  const VolumeShader& volume = trial.part<VolumeShader>();
  check_coefficients(trial, volume);
  check_phase(trial, volume);
  check_free_flight(trial, volume);
}

const RegisterCheck<VolumeShader> registered(check_volume);

}  // namespace
}  // namespace etendue::conform
