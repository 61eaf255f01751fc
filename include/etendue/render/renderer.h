#pragma once
// Renderer (an integrator): an algorithm. It has no bookkeeping: the Job counts, shows progress, saves and stops.

#include <atomic>

#include "etendue/camera.h"
#include "etendue/core/arena.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/film/image_tile.h"
#include "etendue/light_sampler.h"
#include "etendue/sampler.h"
#include "etendue/scene.h"
#include "etendue/transport/path_record.h"
#include "etendue/transport/sample_context.h"
#include "etendue/transport/scene_traits.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {

/// Light that a renderer cannot find in a scene, and what can.
struct Advice {
  std::string lost;     ///< "caustics of the point light 'lamp' through 'ball'"
  std::string instead;  ///< class names of renderers that find it, or what to change; empty: nothing known does
};

/// A range of samples per pixel, [begin, end), and the means to run work over all cores.
class Pass {
 public:
  virtual ~Pass() = default;
  std::uint32_t begin = 0, end = 1;
  const std::atomic<bool>* abort = nullptr;  ///< whether the pass will be discarded; null: it will not

  bool aborted() const { return abort && abort->load(std::memory_order_relaxed); }

  /// Runs `work(item, tile, arena)` for items 0 … count-1 on all threads and merges the tiles in the order of items.
  /// Returns early (with some items left out) when the render is cancelled: the pass is then discarded.
  using Work = void (*)(void* self, std::uint64_t item, ImageTile&, Arena&);
  virtual void run(std::uint64_t count, Work work, void* self) = 0;

  template <class F>
  void run(std::uint64_t count, F&& f) {
    run(
        count,
        [](void* self, std::uint64_t item, ImageTile& tile, Arena& arena) {
          (*static_cast<std::remove_reference_t<F>*>(self))(item, tile, arena);
        },
        &f);
  }
};

class Renderer : public Component {
 public:
  using Interface = Renderer;
  using Parent = Component;
  static void describe(Description<Renderer>&);
  Renderer();

  int samples = 64;  ///< per pixel
  Ref<Sampler> sampler;
  Ref<LightSampler> light_sampler;
  float map_filter = 0;  ///< maps are averaged over so many pixels; a bias

  /// Called once before the first pass of a render.
  virtual void begin(const RenderContext&);
  /// Runs one pass. By default camera paths: for each pixel and sample a ray, `radiance` along it, one contribution.
  virtual void pass(const RenderContext&, Pass&) const;
  /// Radiance [W m^-2 sr^-1 nm^-1] that arrives along a ray, one sample of it.
  virtual Spectrum radiance(const RenderContext&, const Ray&, SampleContext&) const;

  /// One sample of the default pass, as it is in the picture: chooses wavelengths, film point, lens point and time, asks
  /// `radiance`, and says where it fell on the film.
  struct CameraSample {
    Point2 film;
    Spectrum value;
    Wavelengths wavelengths;
  };
  /// What of a sample is to be filled beside its value, and what may end it early: as in SampleContext.
  struct Request {
    Features* features = nullptr;
    PathRecord* record = nullptr;
    std::span<Spectrum> lengths = {};
    std::vector<Splat>* splats = nullptr;
    const std::atomic<bool>* abort = nullptr;
  };
  CameraSample camera_sample(const RenderContext&, int x, int y, std::uint32_t sample, Arena&, const Request&) const;
  CameraSample camera_sample(const RenderContext& context, int x, int y, std::uint32_t sample, Arena& arena) const {
    return camera_sample(context, x, y, sample, arena, Request{});
  }

  /// Whether the algorithm's expectations are exact for any number of samples, or only in the limit.
  virtual bool unbiased() const { return true; }
  /// What makes expectations differ from the truth, in words for the user: what `unbiased` says, and `map_filter`. Empty:
  /// nothing does.
  std::string bias() const;
  /// What it cannot render, in words for the user; empty: nothing is left out.
  virtual std::string limits() const { return {}; }
  /// What it cannot find of the light that a given scene has; empty: nothing is missed. Renderers for which this is empty
  /// must agree.
  virtual std::vector<Advice> misses(const SceneTraits&) const { return {}; }

  /// What it has learned at a pass boundary beside the picture, for checkpoints: the same bytes restore it. Most have
  /// nothing.
  virtual std::vector<std::byte> save_state() const { return {}; }
  virtual void load_state(std::span<const std::byte>) {}
};

}  // namespace etendue
