#pragma once
// What is at hand where paths are made.

#include <atomic>
#include <vector>

#include "etendue/camera.h"
#include "etendue/core/arena.h"
#include "etendue/film/image_tile.h"
#include "etendue/numbers.h"
#include "etendue/scene.h"
#include "etendue/transport/observer.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {

/// What a render works on. All of it is prepared and does not change while a step runs.
struct RenderContext {
  const Scene& scene;
  const Camera& camera;
  const ImageBuffer& image;
  const WavelengthSampler& wavelengths;
  std::uint64_t seed = 0;
};

/// Light that a sample brings to another place of the film than its own: from a path that began at a luminaire.
struct Splat {
  Point2 film;
  Spectrum value;  ///< what one path brings to the mean radiance over the whole film, as importance integrates to 1:
                   ///< ImageTile::splat
  Wavelengths wavelengths;
  int length = 0;  ///< segments of the path
};

/// What one sample of a camera-path renderer has at hand.
struct SampleContext {
  Wavelengths& wavelengths;  ///< may lose its secondary ones along the path
  NumberStream numbers;
  Arena& arena;  ///< emptied after the sample; a CameraWalk takes back at each vertex what was made since it began
  PathObserver observe = {};
  std::vector<Splat>* splats = nullptr;
  const std::atomic<bool>* abort = nullptr;  ///< whether nobody waits for the sample any more; null: somebody does
  void* records = nullptr;                   ///< see record()

  /// Notes something for the algorithm's own process, which called RenderProcess::film_paths<T>: a training sample, a
  /// reservoir. Nothing happens when nobody collects: in a replay.
  template <class T>
  void record(T&& one) {
    if (records) static_cast<std::vector<std::remove_cvref_t<T>>*>(records)->push_back(std::forward<T>(one));
  }

  /// Whether the sample may be given up, with any result: it will not be looked at. A path or a tree of rays can take hours
  /// (between white walls, with a large `max_depth`), so whatever goes round in one asks now and then.
  bool aborted() const { return abort && abort->load(std::memory_order_relaxed); }

  /// Brings light to a point of the film (beside the value `radiance` returns).
  void splat(Point2 film, const Spectrum& value, const Wavelengths& w, int length) {
    if (splats) splats->push_back({film, value, w, length});
  }
};

}  // namespace etendue
