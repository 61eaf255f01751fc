// Costs of shaders with default members: nanoseconds to bind a shader to a point, to evaluate and sample the result, and to
// compute its pdf. Shaders that need a file get a synthetic one, those that need another shader a Lambertian. At the end a
// table lists the shortest times of all repetitions, and their ratios to those of Lambertian:
//     etendue_benchmarks --benchmark_filter=shader/ --benchmark_repetitions=10 --benchmark_min_time=0.01

#include <benchmark/benchmark.h>

#include <fmt/format.h>
#include <time.h>

#include <array>
#include <map>
#include <memory>

#include "check/conform/fixtures/fixtures.h"
#include "etendue/core/arena.h"
#include "etendue/core/warp.h"
#include "etendue/language/language.h"
#include "etendue/sampler.h"
#include "etendue/scene_object.h"
#include "etendue/shader.h"
#include "etendue/wavelength_sampler.h"

namespace {

using namespace etendue;

template <class T>
Ref<T> make(const char* name) {
  return ref_cast<T>(Registry::instance().create(name));
}

/// A shader with its required members. The top layer of a LayeredShader must transmit.
Ref<Shader> with_needs(const ClassInfo& info, const conform::Fixtures& files) {
  const Ref<Component> made = info.create();
  for (const Member& m : info.members)
    if (m.kind == Kind::file) {
      set(*made, m.name, Value(FilePath{files.file_for(info, m), ""}));
    } else if (m.required && m.component_class == "Shader") {
      set(*made, m.name, Value(Registry::instance().create(m.name == "top" ? "Dielectric" : "Lambertian")));
    }
  prepare_tree(*made);
  return ref_cast<Shader>(made);
}

/// A shader, a point on a sphere that has it, and random directions: `out` outside, `in` on all sides that the shader scatters
/// to.
struct Bench {
  static constexpr size_t count = 1024;
  struct Query {
    Vector3 out, in;
    float choice = 0;
    Point2 u;
  };

  Bench(const ClassInfo& info, const conform::Fixtures& files)
      : shader(with_needs(info, files)), sphere(make<SceneObject>("Sphere")) {
    prepare_tree(*sphere);
    sphere->shader = shader;
    point = sphere->sample_area({0.3f, 0.6f}, 0).point;
    sphere->tangents(point);
    w = make<WavelengthSampler>("HeroWavelengths")->sample(SampleKey(1, 2, 3, 4), 0.3f);
    const bool through = (shader->possible_lobes() & transmission_lobes) != 0;
    const Ref<Sampler> random = make<Sampler>("IndependentSampler");
    const Frame frame(point.normal);
    for (size_t i = 0; i < count; ++i) {
      NumberStream s(*random, SampleKey(1, int(i), 0, 0));
      Query& q = queries[i];
      q.out = frame.to_world(warp::cosine_hemisphere(s.next_pair()));
      q.in = through ? warp::sphere(s.next_pair()) : frame.to_world(warp::cosine_hemisphere(s.next_pair()));
      q.choice = s.next();
      q.u = s.next_pair();
    }
  }

  /// Created once for each class, as some read large files.
  static const Bench& of(const ClassInfo& info) {
    static const conform::Fixtures files;
    static std::map<std::string, std::unique_ptr<Bench>> made;
    std::unique_ptr<Bench>& bench = made[info.name];
    if (!bench) bench = std::make_unique<Bench>(info, files);
    return *bench;
  }

  Ref<Shader> shader;
  Ref<SceneObject> sphere;
  SurfacePoint point;
  Wavelengths w;
  std::array<Query, count> queries;
};

constexpr const char* operations[] = {"bind", "evaluate", "sample", "density"};

constexpr double never = 1e30;

/// The shortest times [ns] by class; printed when the program ends.
struct Table {
  std::map<std::string, std::array<double, 4>> times;

  ~Table() {
    const auto unit = times.find("Lambertian");
    if (unit == times.end()) return;
    fmt::print("\n| shader | bind | evaluate | sample | density |\n|---|---|---|---|---|\n");
    for (const auto& [name, of] : times) {
      fmt::print("| `{}`", name);
      for (size_t i = 0; i < 4; ++i)
        fmt::print("{}", of[i] < never ? fmt::format(" | {:.0f} ({:.1f})", of[i], of[i] / unit->second[i]) : " | ");
      fmt::print(" |\n");
    }
  }
};
Table table;

/// CPU time of this thread [ns], independent of other load of the machine.
double thread_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) * 1e9 + double(t.tv_nsec);
}

template <class F>
void repeat(benchmark::State& state, const ClassInfo& info, size_t operation, F&& f) {
  size_t i = 0;
  const double begin = thread_time();
  for ([[maybe_unused]] auto _ : state) f(i++ % Bench::count);
  if (state.iterations() < 100) return;  // too short for a reliable time
  auto& shortest = table.times.try_emplace(info.name, std::array{never, never, never, never}).first->second[operation];
  shortest = std::min(shortest, (thread_time() - begin) / double(state.iterations()));
}

void shader(benchmark::State& state, const ClassInfo& info, size_t operation) {
  const Bench& bench = Bench::of(info);
  Arena arena;
  if (operation == 0)
    return repeat(state, info, operation, [&](size_t) {
      arena.reset();
      benchmark::DoNotOptimize(bench.shader->bind(bench.point, bench.w, arena));
    });
  const Scatter* scatter = bench.shader->bind(bench.point, bench.w, arena);
  if (!scatter) return state.SkipWithError("scatters nothing");
  repeat(state, info, operation, [&](size_t i) {
    const Bench::Query& q = bench.queries[i];
    if (operation == 1) benchmark::DoNotOptimize(scatter->evaluate(q.out, q.in));
    if (operation == 2) benchmark::DoNotOptimize(scatter->sample(q.out, q.choice, q.u));
    if (operation == 3) benchmark::DoNotOptimize(scatter->pdf(q.out, q.in));
  });
}

const bool registered = [] {
  const Registry& registry = Registry::instance();
  for (const ClassInfo* info : registry.subclasses(*registry.find("Shader")))
    for (size_t i = 0; i < 4; ++i)
      benchmark::RegisterBenchmark(fmt::format("shader/{}/{}", info->name, operations[i]).c_str(), shader, *info, i);
  return true;
}();

}  // namespace
