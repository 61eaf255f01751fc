#pragma once
// RenderProcess: a renderer at work. It goes in steps, each a range of samples of every pixel (a pass over the picture); what
// it holds may change between them (photons, chains, a guide), and it has no bookkeeping: counting, showing, saving, stopping
// and replaying is not its business.

#include <cstddef>
#include <span>
#include <vector>

#include "etendue/render/schedule.h"
#include "etendue/transport/sample_context.h"

namespace etendue {

class Renderer;

/// [begin, end) of steps or samples.
struct IndexRange {
  std::uint32_t begin = 0, end = 0;
  bool operator==(const IndexRange&) const = default;
};

/// A part of a render that is done as a whole: a pass over the picture.
struct Step {
  std::uint32_t number = 0;  ///< from 0, by its samples: the same however a render is divided among machines
  IndexRange samples;        ///< of every pixel
};

/// What a path from the camera brings to its own place on the film.
struct CameraSample {
  Point2 film;
  Spectrum value;
  Wavelengths wavelengths;
};

/// What of a path is to be filled beside its value, and what may end it early: as in SampleContext.
struct PathRequest {
  PathObserver observe = {};
  std::vector<Splat>* splats = nullptr;
  const std::atomic<bool>* abort = nullptr;
  void* records = nullptr;
};

/// Its members change within prepare_step and step alone, outside of the work that a schedule runs; `radiance`, `path` and
/// `sample` are called from many threads at once. A step that was given up leaves nothing: the process is thrown away, and a
/// fresh one gets the state that was saved before the step, and prepares it again.
class RenderProcess {
 public:
  /// The renderer and all that the context refers to must outlive it.
  RenderProcess(const Renderer&, const RenderContext&);
  virtual ~RenderProcess();
  RenderProcess(const RenderProcess&) = delete;
  RenderProcess& operator=(const RenderProcess&) = delete;

  const Renderer& renderer;
  const RenderContext context;

  /// Makes what the samples of a step need: called before the step, and before a sample of it is replayed. It must depend on
  /// the description, the seed, the step, and where Renderer::steps_depend says so on the steps before it, alone.
  virtual void prepare_step(Schedule&, const Step&) {}
  /// Renders so many samples of every pixel. By default camera paths: for each pixel and sample a `path`, one contribution.
  virtual void step(Schedule&, const Step&);
  /// Radiance [W m^-2 sr^-1 nm^-1] that arrives along a camera ray, one sample of it; by default Renderer::radiance.
  virtual Spectrum radiance(const Ray&, SampleContext&) const;

  /// What it has learned in the steps so far. Asked between steps only, and given to fresh processes alone: with the same bytes
  /// the next steps are the same. Bytes that are none of its own are refused by an Error. Most have nothing; what a process
  /// makes in prepare_step alone need not be saved.
  virtual std::vector<std::byte> save_state() const { return {}; }
  virtual void load_state(std::span<const std::byte>) {}

  /// The wavelengths of a path, by default the sampler's. A process whose paths share light (photons, reservoirs) may give all
  /// of a step the same.
  virtual Wavelengths wavelengths(SampleKey key, float u) const { return context.wavelengths.sample(key, u); }

  /// When a path is [s], by default whenever the shutter is open. The same holds here: light that paths share is of one moment.
  virtual float time(float u) const { return context.camera.shutter_time(u); }

  /// A path as a function of numbers: where on the film, within an area of it, through which point of the lens, when, with
  /// which wavelengths, and then all that `radiance` draws. Whoever gives other numbers gets another path of this algorithm: a
  /// Metropolis sampler may hold any of them. The arena is empty afterwards.
  CameraSample path(const PixelArea& area, const NumberSource&, SampleKey, Arena&, const PathRequest& = {}) const;
  /// The path of one sample of a pixel, as it is in the picture: what a replay shows. An algorithm whose samples are no such
  /// paths (chains, for one) shows what it can of them, or throws Error with the reason.
  virtual CameraSample sample(int x, int y, std::uint32_t number, Arena&, const PathRequest& = {}) const;

 protected:
  /// The default step, and what its paths noted (SampleContext::record), in a fixed order: for algorithms that learn from the
  /// paths they show.
  template <class T>
  std::vector<T> film_paths(Schedule& schedule, const Step& step) {
    std::vector<std::vector<T>> some(path_items(step));
    film_paths(
        schedule, step,
        [](void* all, std::uint64_t item) -> void* { return &(*static_cast<std::vector<std::vector<T>>*>(all))[size_t(item)]; },
        &some);
    std::vector<T> all;
    for (std::vector<T>& one : some)
      all.insert(all.end(), std::make_move_iterator(one.begin()), std::make_move_iterator(one.end()));
    return all;
  }

 private:
  using RecordsOf = void* (*)(void* all, std::uint64_t item);
  size_t path_items(const Step&) const;
  void film_paths(Schedule&, const Step&, RecordsOf, void* all);
};

}  // namespace etendue
