// The time to build each acceleration structure, and its rays per second on one thread: scene/<world>/<structure>/<rays>. A
// table of all benchmarks that ran is printed at the end. Run with --benchmark_filter=scene/… for some of them.

#include <benchmark/benchmark.h>

#include <fmt/format.h>

#include <chrono>
#include <map>
#include <memory>

#include "etendue/core/warp.h"
#include "etendue/language/language.h"
#include "etendue/render/job.h"
#include "etendue/sampler.h"

namespace {

using namespace etendue;

constexpr const char* worlds[] = {"cornell_box", "sphere_mesh_1e5", "terrain_1e6", "spheres_1e3"};
constexpr const char* structures[] = {"BruteForceScene", "EmbreeScene", "BvhScene", "OctreeScene", "GridScene"};
constexpr const char* queries[] = {"nearest coherent", "nearest random", "any coherent", "any random"};

template <class T>
Ref<T> make_part(const std::string& name) {
  return ref_cast<T>(Registry::instance().create(name));
}

/// A triangle mesh over a grid of quads, two triangles each; `place` gives the point at (u, v) in [0, 1]^2.
template <class Place>
Ref<SceneObject> surface(int columns, int rows, const Place& place) {
  std::vector<double> positions, triangles;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= columns; ++i) {
      const Point3 p = place(float(i) / float(columns), float(j) / float(rows));
      positions.insert(positions.end(), {double(p.x), double(p.y), double(p.z)});
      if (i == columns || j == rows) continue;
      const double k = double(j * (columns + 1) + i), above = k + columns + 1;
      triangles.insert(triangles.end(), {k, k + 1, above + 1, k, above + 1, above});
    }
  Ref<SceneObject> mesh = make_part<SceneObject>("TriangleMesh");
  set(*mesh, "positions", Value(Numbers{std::move(positions), 1, Dimension::none}));
  set(*mesh, "triangles", Value(Numbers{std::move(triangles), 1, Dimension::none}));
  return mesh;
}

std::vector<Ref<SceneObject>> objects_of(const std::string& world) {
  if (world == "cornell_box") return load_job(ETENDUE_SOURCE_DIR "/scenes/cornell_box.etd")->scene->objects;
  if (world == "sphere_mesh_1e5")
    return {surface(320, 160, [](float u, float v) {
      const float around = 2 * pi * u, down = pi * v;
      return Point3{std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down)};
    })};
  if (world == "terrain_1e6")
    return {surface(708, 708, [](float u, float v) {
      float z = 0;
      for (int octave = 0; octave < 6; ++octave) {
        const float f = float(3 << octave);
        z += 0.4f / f * std::sin(f * (2 * u + v) + float(octave)) * std::cos(f * (2 * v - u) + 2 * float(octave));
      }
      return Point3{2 * u - 1, 2 * v - 1, z};
    })};
  std::vector<Ref<SceneObject>> spheres;
  const Ref<Sampler> random = make_part<Sampler>("IndependentSampler");
  for (int i = 0; i < 1000; ++i) {
    NumberStream s(*random, SampleKey(2, i, 0, 0));
    spheres.push_back(make_part<SceneObject>("Sphere"));
    set(*spheres.back(), "radius", Value(Number{0.02 + 0.06 * double(s.next())}));
    spheres.back()->transform = Transform::translate({2 * s.next() - 1, 2 * s.next() - 1, 2 * s.next() - 1});
  }
  return spheres;
}

/// A world in an acceleration structure, and rays in it.
struct Bench {
  static constexpr size_t side = 256;

  Ref<Scene> scene;
  double build_seconds = 0;
  std::vector<Ray> coherent, random;

  Bench(const std::string& world, const std::string& structure) {
    scene = make_part<Scene>(structure);
    scene->objects = objects_of(world);
    prepare_tree(*scene);
    const auto begin = std::chrono::steady_clock::now();
    scene->prepare();
    build_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();

    const float size = scene->radius() / std::sqrt(3.0f);
    const Point3 from = scene->centre() + size * Vector3{0.3f, -2.8f, 1.1f};
    const Vector3 forward = normalize(scene->centre() - from), right = normalize(cross(forward, {0, 0, 1}));
    const Vector3 up = cross(right, forward);
    const Ref<Sampler> numbers = make_part<Sampler>("IndependentSampler");
    for (size_t i = 0; i < side * side; ++i) {
      const float x = 0.8f * (float(i % side) / side - 0.5f), y = 0.8f * (float(i / side) / side - 0.5f);
      Ray ray;
      ray.origin = from;
      ray.direction = normalize(forward + x * right + y * up);
      coherent.push_back(ray);
      NumberStream s(*numbers, SampleKey(1, int(i), 0, 0));
      ray.origin = scene->centre() + size * Vector3{2 * s.next() - 1, 2 * s.next() - 1, 2 * s.next() - 1};
      ray.direction = warp::sphere(s.next_pair());
      random.push_back(ray);
    }
  }

  /// Only one world is kept in memory at a time: they are large.
  static const Bench& of(const std::string& world, const std::string& structure) {
    static std::unique_ptr<Bench> bench;
    static std::string made;
    if (made != world + structure) {
      bench.reset();
      bench = std::make_unique<Bench>(world, structure);
      made = world + structure;
    }
    return *bench;
  }
};

/// For each world and structure: seconds to build, then the highest rates [1/s] by query. Printed when the program ends.
struct Table {
  std::map<std::pair<size_t, size_t>, std::array<double, 5>> rows;

  ~Table() {
    if (rows.empty()) return;
    fmt::print("\n| world | structure | build [s] | {} |\n|---|---|---|---|---|---|---|\n", fmt::join(queries, " | "));
    for (const auto& [key, row] : rows) {
      fmt::print("| {} | {} | {:.3f}", worlds[key.first], structures[key.second], row[0]);
      for (size_t i = 1; i < row.size(); ++i) fmt::print(" | {:.2f}", row[i] / 1e6);
      fmt::print(" |\n");
    }
    fmt::print("\nMillions of rays a second, one thread.\n");
  }
};
Table table;

/// CPU time of this thread [s], independent of other load of the machine.
double thread_time() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

void scene(benchmark::State& state, size_t world, size_t structure, size_t query) {
  const Bench& bench = Bench::of(worlds[world], structures[structure]);
  const std::vector<Ray>& rays = query % 2 ? bench.random : bench.coherent;
  const float reach = query < 2 ? infinity : bench.scene->radius() * (query % 2 ? 0.3f : 1.6f);
  size_t i = 0;
  const double begin = thread_time();
  for ([[maybe_unused]] auto _ : state) {
    Ray ray = rays[i++ % rays.size()];
    ray.maximum = reach;
    Hit hit;
    benchmark::DoNotOptimize(query < 2 ? bench.scene->nearest(ray, hit) : bench.scene->any(ray));
  }
  const double rate = double(state.iterations()) / (thread_time() - begin);
  state.counters["Mrays/s"] = rate / 1e6;
  auto& row = table.rows.try_emplace({world, structure}, std::array<double, 5>{}).first->second;
  row[0] = bench.build_seconds;
  if (state.iterations() >= 1000) row[1 + query] = std::max(row[1 + query], rate);
}

const bool registered = [] {
  for (size_t w = 0; w < std::size(worlds); ++w)
    for (size_t s = 0; s < std::size(structures); ++s) {
      if (s == 0 && w != 0) continue;  // brute force takes minutes
      for (size_t q = 0; q < std::size(queries); ++q)
        benchmark::RegisterBenchmark(fmt::format("scene/{}/{}/{}", worlds[w], structures[s], queries[q]).c_str(), scene, w, s,
                                     q);
    }
  return true;
}();

}  // namespace
