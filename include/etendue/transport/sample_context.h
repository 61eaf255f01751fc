#pragma once
// What is at hand where paths are made.

#include <algorithm>
#include <atomic>
#include <span>
#include <vector>

#include "etendue/camera.h"
#include "etendue/core/arena.h"
#include "etendue/film/image_tile.h"
#include "etendue/sampler.h"
#include "etendue/scene.h"
#include "etendue/transport/path_record.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {

/// What a render works on. All of it is prepared and does not change while a pass runs.
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
  Spectrum value;  ///< the estimate of radiance on the film, for one path over the whole film (importance integrates to 1)
  Wavelengths wavelengths;
  int length = 0;  ///< segments of the path
};

/// What one sample of a camera-path renderer has at hand.
struct SampleContext {
  Wavelengths& wavelengths;  ///< may lose its secondary ones along the path
  SampleStream& random;
  Arena& arena;                      ///< emptied after the sample
  Features* features = nullptr;      ///< to be filled at the first surface when not null
  PathRecord* record = nullptr;      ///< to be filled when not null: someone replays this sample
  std::span<Spectrum> lengths = {};  ///< radiance by path length, when someone wants it; see `note_length`
  std::vector<Splat>* splats = nullptr;
  const std::atomic<bool>* abort = nullptr;  ///< whether nobody waits for the sample any more; null: somebody does

  /// Whether the sample may be given up, with any result: it will not be looked at. A path or a tree of rays can take hours
  /// (between white walls, with a large `max_depth`), so whatever goes round in one asks now and then.
  bool aborted() const { return abort && abort->load(std::memory_order_relaxed); }

  /// Says that `value`, a part of the radiance returned, came by a path of so many segments (1: a luminaire seen by the
  /// camera). Renderers that call this for all they return can be compared length by length.
  void note_length(int length, const Spectrum& value) {
    if (!lengths.empty()) [[unlikely]]
      lengths[std::min(size_t(length), lengths.size()) - 1] += value;
  }
  /// Brings light to a point of the film (beside the value `radiance` returns).
  void splat(Point2 film, const Spectrum& value, const Wavelengths& w, int length) {
    if (splats) splats->push_back({film, value, w, length});
  }
};

}  // namespace etendue
