// The potential of wavefront path tracing: the rays of a path tracer, and the shading at their hits, in the order of paths and
// in sorted batches (waves). See docs/decisions/037-waves.md.
//
//     etendue_waves SCENE.etd [SAMPLES [REPEATS [FOLDER...]]]
//
// FOLDER: folders with files that the scene may refer to. All times are CPU times of one thread, the shortest of the repeats.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <stdexcept>
#include <tuple>

#include "bare_rays.h"
#include "etendue/language/language.h"
#include "etendue/render/render.h"
#include "etendue/transport/direct_light.h"

namespace etendue::waves {

double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

namespace {

const Register<RecordingScene> registered;

/// Spreads the lowest ten bits of a number, for a Morton code of three numbers.
std::uint64_t spread_bits(std::uint64_t x) {
  std::uint64_t all = 0;
  for (int i = 0; i < 10; ++i) all |= ((x >> i) & 1) << (3 * i);
  return all;
}

/// The key by which waves sort rays: depth, kind, octant of the direction, and Morton code of the origin.
std::uint64_t key_of(const RecordedRay& r, const Scene& scene) {
  const Vector3 from = (r.ray.origin - scene.centre()) / scene.radius();
  std::uint64_t place = 0, octant = 0;
  for (int k = 0; k < 3; ++k) {
    place |= spread_bits(std::uint64_t(std::clamp(from[k] * 0.5f + 0.5f, 0.0f, 1.0f) * 1023)) << k;
    octant |= std::uint64_t(r.ray.direction[k] > 0) << k;
  }
  return std::uint64_t(std::min(r.depth, 255u)) << 40 | std::uint64_t(r.shadow) << 39 | octant << 32 | place;
}

struct Measured {
  int repeats = 3;
  /// The shortest CPU time of a run [s].
  double shortest(const std::function<void()>& run) const {
    double best = 1e30;
    for (int i = 0; i < repeats; ++i) {
      const double begin = thread_seconds();
      run();
      best = std::min(best, thread_seconds() - begin);
    }
    return best;
  }
};

volatile float kept = 0;  ///< a sink that prevents the compiler from removing computations

/// All computations at a vertex except the path's bookkeeping.
class Shading {
 public:
  Shading(const Scene& scene, const LightSampler& lights, const RenderProcess& process)
      : scene_(scene), lights_(lights), wavelengths_(process.wavelengths(SampleKey(1, 2, 3, 4), 0.3f)) {}

  void operator()(const RecordedRay& r) {
    if (r.shadow || !r.found) return;
    std::uint32_t state = r.path * 747796405u + r.depth * 2891336453u + 1;
    const auto number = [&] { return float((state = state * 1664525u + 1013904223u) >> 8) * 0x1p-24f; };
    PathVertex v;
    v.out = -r.ray.direction;
    scene_.locate(r.ray, r.hit, v.point);
    v.scatter = scattering_at(v.point, v.out, wavelengths_, arena_);
    if (v.scatter) {
      DirectLight direct;
      if (v.scatters_smoothly() && sample_next_event(scene_, lights_, v, 0, wavelengths_, number(), {number(), number()},
                                                     Heuristic::power, direct, ScatteringOf{v}))
        sum_ += direct.light[0];
      if (const auto next = v.scatter->sample(v.out, number(), {number(), number()}, {.lobes = v.lobes}))
        sum_ += next->weight[0];
    }
    arena_.reset();
    kept = sum_;
  }

 private:
  const Scene& scene_;
  const LightSampler& lights_;
  Wavelengths wavelengths_;
  Arena arena_;
  float sum_ = 0;
};

/// The part of a path's state that stays in memory while other paths are processed: copied out and in again for each segment.
struct PathState {
  std::byte bytes[384];
};

/// Records a scene's paths, and measures the costs of their parts.
class Prototype {
 public:
  Prototype(const Ref<Job>& job, int samples, int repeats) : job_(job), samples_(samples), measured_{repeats} {}

  void run() {
    record();
    ask_ours();
    ask_bare();
    shade();
    carry_states();
    tell_bounds();
  }

 private:
  const Scene& scene() const { return *job_->scene; }
  std::unique_ptr<RenderProcess> process_in(const Scene& in) const {
    return job_->renderer->start({in, *job_->camera, *job_->image, *job_->wavelengths, 0});
  }
  size_t paths() const { return size_t(job_->image->width) * size_t(job_->image->height) * size_t(samples_); }
  double per_ray(double seconds) const { return seconds * 1e9 / double(rays_.size()); }
  double per_vertex(double seconds) const { return seconds * 1e9 / double(std::max<size_t>(hits_.size(), 1)); }

  /// Traces all paths, recorded or not; returns the CPU time [s].
  double follow(const Scene& in, const RecordingScene* recording) const {
    const std::unique_ptr<RenderProcess> process = process_in(in);
    Arena arena;
    std::uint32_t number = 0;
    const double begin = thread_seconds();
    for (int y = 0; y < job_->image->height; ++y)
      for (int x = 0; x < job_->image->width; ++x)
        for (int s = 0; s < samples_; ++s) {
          if (recording) recording->begin_path(number++);
          kept = process->sample(x, y, std::uint32_t(s), arena).value[0];
        }
    return thread_seconds() - begin;
  }

  void record() {
    const auto recording = make<RecordingScene>();
    recording->objects = scene().objects;
    recording->asked = job_->scene;
    recording->prepare();
    follow(*recording, recording.get());
    rays_ = std::move(recording->rays);
    if (rays_.empty()) throw std::runtime_error("the renderer asks the scene for no rays");
    for (const RecordedRay& r : rays_)
      if (!r.shadow && r.found) hits_.push_back(r);
    whole_ = infinity;
    for (int i = 0; i < measured_.repeats; ++i) whole_ = std::min(whole_, follow(scene(), nullptr));
    const auto shadows = std::count_if(rays_.begin(), rays_.end(), [](const RecordedRay& r) { return r.shadow; });
    fmt::print("{} paths, {:.2f} rays each, {:.0f} % of them shadow rays; {:.0f} ns a path, {:.0f} ns a ray\n", paths(),
               double(rays_.size()) / double(paths()), 100.0 * double(shadows) / double(rays_.size()),
               whole_ * 1e9 / double(paths()), per_ray(whole_));
    sort();
  }

  /// Rays are copied in sorted order, so that they are traced in the order of memory.
  void sort() {
    in_waves_ = rays_;
    std::stable_sort(in_waves_.begin(), in_waves_.end(), [](const RecordedRay& a, const RecordedRay& b) {
      return std::pair(a.depth, a.shadow) < std::pair(b.depth, b.shadow);
    });
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    sorting_ = measured_.shortest([&] {
      keys.clear();
      for (std::uint32_t i = 0; i < rays_.size(); ++i) keys.emplace_back(key_of(rays_[i], scene()), i);
      std::sort(keys.begin(), keys.end());
    });
    for (const auto& [key, i] : keys) in_sorted_waves_.push_back(rays_[i]);
  }

  void ask_ours() {
    const auto ask = [&](const std::vector<RecordedRay>& asked) {
      return measured_.shortest([&] {
        size_t met = 0;
        for (const RecordedRay& r : asked) {
          Hit hit;
          met += r.shadow ? scene().any(r.ray) : scene().nearest(r.ray, hit);
        }
        kept = float(met);
      });
    };
    own_ = ask(rays_);
    const double waves = ask(in_waves_), sorted = ask(in_sorted_waves_);
    best_ = std::min({own_, waves, sorted});
    fmt::print("our structure [ns a ray]: as paths go {:.0f}, in waves {:.0f}, in sorted waves {:.0f}\n", per_ray(own_),
               per_ray(waves), per_ray(sorted));
  }

  void ask_bare() {
    const BareTriangles bare(scene());
    if (bare.objects_left_out) fmt::print("{} objects are not among the bare triangles\n", bare.objects_left_out);
    using Manner = BareTriangles::Manner;
    for (const auto& [name, manner] : {std::pair{"single", Manner::single}, std::pair{"streams of 256", Manner::stream},
                                       std::pair{"packets of 8", Manner::eight}, std::pair{"packets of 16", Manner::sixteen}}) {
      fmt::print("bare Embree, {} [ns a ray]:", name);
      for (const auto& [in, asked] : {std::pair{"as paths go", &rays_}, std::pair{"in waves", &in_waves_},
                                      std::pair{"in sorted waves", &in_sorted_waves_}}) {
        double least = infinity;
        for (const bool coherent : {false, true})
          least = std::min(least, measured_.shortest([&] { kept = float(bare.ask(*asked, manner, coherent)); }));
        if (manner == Manner::single && asked == &rays_) bare_ = least;
        best_ = std::min(best_, least);
        fmt::print(" {} {:.0f},", in, per_ray(least));
      }
      fmt::print("\n");
    }
    const auto found = std::count_if(rays_.begin(), rays_.end(), [](const RecordedRay& r) { return r.found; });
    fmt::print("of the rays {:.3f} % meet something there, {:.3f} % here\n",
               100.0 * double(bare.ask(rays_, Manner::single, false)) / double(rays_.size()),
               100.0 * double(found) / double(rays_.size()));
  }

  void shade() {
    const std::unique_ptr<RenderProcess> process = process_in(scene());
    Shading shade(scene(), *job_->renderer->light_sampler, *process);
    const auto shade_all = [&](const std::vector<RecordedRay>& met_by) {
      return measured_.shortest([&] {
        for (const RecordedRay& r : met_by) shade(r);
      });
    };
    const double both = measured_.shortest([&] {
      size_t n = 0;
      for (const RecordedRay& r : rays_) {
        Hit hit;
        n += r.shadow ? scene().any(r.ray) : scene().nearest(r.ray, hit);
        shade(r);
      }
      kept = float(n);
    });
    std::vector<RecordedRay> by_shader = hits_;
    std::sort(by_shader.begin(), by_shader.end(), [](const RecordedRay& a, const RecordedRay& b) {
      const auto key = [](const RecordedRay& r) {
        return std::tuple(r.hit.object->shader.get(), r.hit.object, r.hit.primitive);
      };
      return key(a) < key(b);
    });
    shaded_ = both - own_;
    shaded_sorted_ = shade_all(by_shader);
    fmt::print("shading [ns a vertex]: between rays {:.0f}, in batches {:.0f}, in batches of one shader {:.0f}\n",
               per_vertex(shaded_), per_vertex(shade_all(hits_)), per_vertex(shaded_sorted_));
  }

  void carry_states() {
    std::vector<PathState> states(std::min<size_t>(paths(), 1 << 16));
    traffic_ = measured_.shortest([&] {
      PathState here;
      for (size_t i = 0; i < hits_.size(); ++i) {
        PathState& there = states[(i * 7919) % states.size()];
        here = there;
        here.bytes[i % sizeof here.bytes] = std::byte(i);
        there = here;
      }
    });
    fmt::print("sorting {:.0f} ns a ray, a path's state out and in {:.0f} ns a segment\n", per_ray(sorting_),
               per_vertex(traffic_));
  }

  void tell_bounds() const {
    fmt::print("of a path: rays {:.0f} %, shading {:.0f} %, the rest {:.0f} %\n", 100 * own_ / whole_, 100 * shaded_ / whole_,
               100 * (1 - (own_ + shaded_) / whole_));
    fmt::print("to the bare rays one by one: {:.2f} the rays, {:.2f} all\n", own_ / bare_, whole_ / bare_);
    const double left = whole_ - (own_ - best_) - std::max(0.0, shaded_ - shaded_sorted_);
    fmt::print("waves at most, with sorting and traffic for nothing: {:.2f} times as fast; with both {:.2f}\n", whole_ / left,
               whole_ / (left + sorting_ + traffic_));
  }

  Ref<Job> job_;
  int samples_;
  Measured measured_;
  std::vector<RecordedRay> rays_, in_waves_, in_sorted_waves_,
      hits_;  ///< rays_: in the order of paths; hits_: those with a hit
  // Total CPU times [s].
  double whole_ = 0;  ///< of tracing the paths
  double own_ = 0;    ///< of the rays in our acceleration structure, in the order of paths
  double bare_ = 0;   ///< of the rays among bare triangles, one by one
  double best_ = 0;   ///< of the rays in the fastest way
  double shaded_ = 0, shaded_sorted_ = 0, sorting_ = 0, traffic_ = 0;
};

int run(int count, char** arguments) {
  const auto number = [&](int i, int otherwise) { return count > i ? std::atoi(arguments[i]) : otherwise; };
  const int samples = number(2, 2), repeats = number(3, 3);
  if (samples < 1 || repeats < 1) throw std::runtime_error("at least one sample and one repeat are needed");
  LoadOptions options;
  for (int i = 4; i < count; ++i) options.import.allowed_folders.emplace_back(arguments[i]);
  const Ref<Job> job = load_job(arguments[1], options);
  const Render render(job);  // prepares it
  Prototype(job, samples, repeats).run();
  return 0;
}

}  // namespace
}  // namespace etendue::waves

int main(int count, char** arguments) {
  if (count < 2) {
    fmt::print(stderr, "etendue_waves SCENE.etd [SAMPLES [REPEATS [FOLDER...]]]\n");
    return 2;
  }
  try {
    return etendue::waves::run(count, arguments);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
}
