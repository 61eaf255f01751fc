#pragma once
// RenderProcess: a renderer at work. It runs in steps, each a range of samples of every pixel (a pass over the picture). Its
// own state may change between steps (photons, chains, a guide). It does no bookkeeping: counting, display, saving, stopping
// and replay are the task of Render.

#include <cstddef>
#include <functional>
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

/// A part of a render that is finished or dropped as a whole: a pass over the picture.
struct Step {
  std::uint32_t number = 0;  ///< from 0, determined by its samples: the same however a render is distributed over machines
  IndexRange samples;        ///< of every pixel
};

/// The contribution of a camera path to its own film point.
struct CameraSample {
  Point2 film;
  Spectrum value;
  Wavelengths wavelengths;
};

/// Members change only within prepare_step and step, and there only outside of the work that a schedule runs; `radiance`,
/// `path` and `sample` are called from many threads at once. A step that is aborted leaves nothing: the process is destroyed, a
/// fresh process loads the state that was saved before the step, and prepares the step again.
class RenderProcess {
 public:
  /// The renderer and all that the context refers to must outlive it.
  RenderProcess(const Renderer&, const RenderContext&);
  virtual ~RenderProcess();
  RenderProcess(const RenderProcess&) = delete;
  RenderProcess& operator=(const RenderProcess&) = delete;

  const Renderer& renderer;
  const RenderContext context;

  /// Computes what the samples of a step need. Called before the step, and before one of its samples is replayed. The result
  /// may depend only on the description, the seed and the step, and, where Renderer::steps_depend is true, on the earlier
  /// steps.
  virtual void prepare_step(Schedule&, const Step&) {}
  /// Renders the samples of every pixel that the step covers. By default these are camera paths: one `path` and one
  /// contribution for each pixel and sample.
  virtual void step(Schedule&, const Step&);
  /// A one-sample estimate of the radiance [W m^-2 sr^-1 nm^-1] along a camera ray; by default Renderer::radiance.
  virtual Spectrum radiance(const Ray&, SampleContext&) const;

  /// The state learned in the steps so far. Called between steps only, and loaded only into fresh processes: with the same
  /// bytes the next steps are the same. load_state throws Error for bytes that are not a state of this process. Most processes
  /// have no state; what prepare_step alone computes need not be saved.
  virtual std::vector<std::byte> save_state() const { return {}; }
  virtual void load_state(std::span<const std::byte>) {}

  /// The wavelengths of a path, by default from the sampler. A process whose paths share light (photons, reservoirs) may return
  /// the same wavelengths for all paths of a step.
  virtual Wavelengths wavelengths(SampleKey key, float u) const { return context.wavelengths.sample(key, u); }

  /// The time of a path [s], by default anywhere in the shutter interval. A process whose paths share light may return one time
  /// for all paths of a step, too.
  virtual float time(float u) const { return context.camera.shutter_time(u); }

  /// A path as a function of primary samples: these give the film point within an area, the lens point, the time, the
  /// wavelengths, and then all choices in `radiance`. Other numbers give another path of the same algorithm, so a Metropolis
  /// sampler may mutate each of them. The arena is empty afterwards.
  /// If the area is a crop, the value counts as a splat times the crop's share of the whole image.
  CameraSample path(const PixelArea& area, const NumberSource&, SampleKey, Arena&, const PathSink& = {}) const;
  /// The path of one sample of a pixel, as it is in the picture: for replay. An algorithm whose samples are not such paths
  /// (Markov chains, for one) returns the nearest it can, or throws Error with the reason.
  virtual CameraSample sample(int x, int y, std::uint32_t number, Arena&, const PathSink& = {}) const;

 protected:
  /// Runs the default step and returns what its paths recorded (RecordList), in a fixed order: for algorithms that
  /// learn from the paths they display.
  template <class T>
  std::vector<T> film_paths(Schedule& schedule, const Step& step) {
    const PathWork work = path_work(schedule, step);
    return schedule.film_and_collect<T>(path_items(step), [&](std::uint64_t item, ImageTile& tile, std::vector<T>& records,
                                                              Arena& arena) { work(item, tile, RecordList(records), arena); });
  }

 private:
  std::uint64_t path_items(const Step&) const;
  /// Renders the camera paths of one item of a step, which append to the records.
  using PathWork = std::function<void(std::uint64_t item, ImageTile&, RecordList records, Arena&)>;
  PathWork path_work(const Schedule&, const Step&) const;
};

}  // namespace etendue
