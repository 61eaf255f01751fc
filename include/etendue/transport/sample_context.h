#pragma once
// RenderContext and SampleContext: the arguments of every function that traces a path.

#include "etendue/camera.h"
#include "etendue/core/arena.h"
#include "etendue/film/image_tile.h"
#include "etendue/numbers.h"
#include "etendue/scene.h"
#include "etendue/transport/path_sink.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {

/// The description that is rendered. All of it is prepared, and constant while a step runs.
struct RenderContext {
  const Scene& scene;
  const Camera& camera;
  const ImageBuffer& image;
  const WavelengthSampler& wavelengths;
  std::uint64_t seed = 0;
};

/// The state of one sample while its path is traced.
struct SampleContext {
  Wavelengths& wavelengths;  ///< of the path; the secondary ones are dropped where it becomes dispersive
  NumberStream numbers;      ///< the primary samples of the path
  Arena& arena;              ///< emptied after the sample; a CameraWalk frees at each vertex what was allocated since it began
  PathSink sink = {};        ///< receives all results besides the radiance

  bool aborted() const { return sink.aborted(); }
};

}  // namespace etendue
