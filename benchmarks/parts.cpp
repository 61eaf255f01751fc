// The costs of the parts of a path: rays, primary samples, wavelengths, colours. Run with --benchmark_filter=… for one of them.

#include <benchmark/benchmark.h>

#include <fmt/format.h>

#include "etendue/core/warp.h"
#include "etendue/describe/color.h"
#include "etendue/language/language.h"
#include "etendue/render/render.h"

namespace {

using namespace etendue;

/// The Cornell box in a given acceleration structure, and random rays inside it.
struct Box {
  Ref<Job> job;
  std::vector<Ray> rays;

  explicit Box(const char* structure) : job(load_job(ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd")) {
    const Ref<Component> scene = Registry::instance().create(structure);
    ref_cast<Scene>(scene)->objects = job->scene->objects;
    job->scene = ref_cast<Scene>(scene);
    prepare_tree(*job);
    const Ref<Sampler> random = ref_cast<Sampler>(Registry::instance().create("IndependentSampler"));
    for (int i = 0; i < 4096; ++i) {
      NumberStream s(*random, SampleKey(1, i, 0, 0));
      Ray ray;
      ray.origin = {0.01f + 0.53f * s.next(), 0.01f + 0.53f * s.next(), 0.01f + 0.53f * s.next()};
      ray.direction = warp::sphere(s.next_pair());
      rays.push_back(ray);
    }
  }
};

void nearest(benchmark::State& state, const char* structure) {
  const Box box(structure);
  size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    Hit hit;
    benchmark::DoNotOptimize(box.job->scene->nearest(box.rays[i++ % box.rays.size()], hit));
  }
}
BENCHMARK_CAPTURE(nearest, embree, "EmbreeScene");
BENCHMARK_CAPTURE(nearest, brute_force, "BruteForceScene");

void any(benchmark::State& state, const char* structure) {
  const Box box(structure);
  size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    Ray ray = box.rays[i++ % box.rays.size()];
    ray.maximum = 0.3f;
    benchmark::DoNotOptimize(box.job->scene->any(ray));
  }
}
BENCHMARK_CAPTURE(any, embree, "EmbreeScene");
BENCHMARK_CAPTURE(any, brute_force, "BruteForceScene");

void pair(benchmark::State& state, const char* name) {
  const Ref<Sampler> sampler = ref_cast<Sampler>(Registry::instance().create(name));
  NumberStream stream(*sampler, SampleKey(1, 2, 3, 4));
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(stream.next_pair());
}
BENCHMARK_CAPTURE(pair, independent, "IndependentSampler");
BENCHMARK_CAPTURE(pair, sobol, "SobolSampler");

Wavelengths some_wavelengths(const char* name = "HeroWavelengths") {
  return ref_cast<WavelengthSampler>(Registry::instance().create(name))->sample(SampleKey(1, 2, 3, 4), 0.3f);
}

void wavelengths(benchmark::State& state, const char* name) {
  const Ref<WavelengthSampler> sampler = ref_cast<WavelengthSampler>(Registry::instance().create(name));
  float u = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(sampler->sample(SampleKey(), u));
    u = u < 0.9f ? u + 0.001f : 0;
  }
}
BENCHMARK_CAPTURE(wavelengths, hero, "HeroWavelengths");
BENCHMARK_CAPTURE(wavelengths, grid, "GridWavelengths");

void spectrum_to_xyz(benchmark::State& state) {
  const Wavelengths w = some_wavelengths();
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(to_xyz(Spectrum(0.5f), w));
}
BENCHMARK(spectrum_to_xyz);

void evaluate(benchmark::State& state, const Color& color) {
  const Wavelengths w = some_wavelengths();
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(color->evaluate(w, ColorUse::reflectance));
}
BENCHMARK_CAPTURE(evaluate, table, table_spectrum({400, 500, 700}, {0.1f, 0.5f, 0.3f}));
BENCHMARK_CAPTURE(evaluate, rgb, rgb_color("srgb", 0.5, 0.2, 0.1));
BENCHMARK_CAPTURE(evaluate, glass, glass_index("N-BK7"));

void path(benchmark::State& state, const char* structure) {
  const Box box(structure);
  const std::unique_ptr<RenderProcess> process = Render(box.job).start_at(0);
  Arena arena;
  std::uint32_t n = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(process->sample(int(n * 37 % 256), int(n * 101 % 256), n, arena));
    ++n;
  }
}
BENCHMARK_CAPTURE(path, embree, "EmbreeScene");
BENCHMARK_CAPTURE(path, brute_force, "BruteForceScene");

}  // namespace
