#pragma once
// What a renderer that is written in Python works with: many camera paths at once, as arrays.

#include <memory>
#include <vector>

#include "etendue/render/renderer.h"
#include "etendue/transport/medium_stack.h"
#include "parts.h"

namespace etendue::python {

/// The paths of one call of a renderer's `radiance`. Python may keep the objects that refer to it: after the call they throw.
struct PathBatch {
  const RenderContext& context;
  const LightSampler& light_sampler;
  Arena& arena;
  std::vector<NumberStream> numbers;
  std::vector<Wavelengths> wavelengths;
  std::vector<Point2> film;                  ///< empty: not known
  std::vector<PathSink> sinks;               ///< of each path
  const std::atomic<bool>* abort = nullptr;  ///< true: the results are no longer needed
  bool open = true;

  size_t size() const { return wavelengths.size(); }
  bool aborted() const { return abort && abort->load(std::memory_order_relaxed); }
};
using Batch = std::shared_ptr<PathBatch>;

/// One ray for each path of a batch.
struct RayList {
  Batch batch;
  std::vector<Ray> rays;
  std::vector<MediumStack> media;   ///< around each ray's origin; empty: media are not tracked
  std::vector<std::uint8_t> alive;  ///< paths that have ended have no ray
};

/// The radiance along the rays [W m^-2 sr^-1 nm^-1], as the method of the part computes it. The batch is closed afterwards.
std::vector<Spectrum> python_radiance(const PythonPart&, RayList);

/// The camera rays of a batch, with the media around the camera.
RayList camera_rays(const Batch&, std::vector<Ray>);

}  // namespace etendue::python
