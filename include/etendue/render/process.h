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
};

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

  /// What it has learned in the steps so far, for checkpoints: the same bytes restore it. Most have nothing.
  virtual std::vector<std::byte> save_state() const { return {}; }
  virtual void load_state(std::span<const std::byte>) {}

  /// A path as a function of numbers: where on the film, within an area of it, through which point of the lens, when, with
  /// which wavelengths, and then all that `radiance` draws. Whoever gives other numbers gets another path of this algorithm: a
  /// Metropolis sampler may hold any of them.
  CameraSample path(const PixelArea& area, const NumberSource&, SampleKey, Arena&, const PathRequest& = {}) const;
  /// The path of one sample of a pixel, as it is in the picture: what a replay shows. An algorithm whose samples are no such
  /// paths (chains, for one) shows what it can of them, or throws Error with the reason.
  virtual CameraSample sample(int x, int y, std::uint32_t number, Arena&, const PathRequest& = {}) const;
};

}  // namespace etendue
