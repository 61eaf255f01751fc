#pragma once
// The beginning of a camera path, which every process that renders camera paths shares.

#include "etendue/render/renderer.h"

namespace etendue {

/// Takes the first primary samples of a path: its film point within the area, its lens point, time, wavelengths, and from these
/// its camera ray with its weight. `sample` refers to the wavelengths of `s`. False: the lens blocks the ray, and nothing else
/// needs the path: the sample is black.
inline bool begin_camera_path(const RenderProcess& process, const PixelArea& area, SampleKey key, SampleContext& sample,
                              CameraSample& s, CameraRay& from) {
  const Camera& camera = process.context.camera;
  const Renderer& renderer = process.renderer;
  NumberStream& numbers = sample.numbers;
  const Point2 within = numbers.next_pair();
  s.film = {float(area.x0) + within.x * float(area.width()), float(area.y0) + within.y * float(area.height())};
  const Point2 lens = camera.has_lens() ? numbers.next_pair() : (numbers.skip(2), Point2{});
  const bool still = !(camera.shutter_close > camera.shutter_open);
  const float at = still ? (numbers.skip(), camera.shutter_open) : process.time(numbers.next());
  s.wavelengths = process.wavelengths(key, numbers.next());
  if (!camera.sample_ray(s.film, lens, at, s.wavelengths, from)) {
    // The lens blocks the ray, so the sample is black. The algorithm's splats from light subpaths do not pass through this ray,
    // and records do not depend on it: these are still computed.
    if (!renderer.splats() && !sample.sink.record) return false;
    from.ray = camera.ray(s.film, lens, at);
    from.weight = {};
  }
  from.ray.width *= renderer.map_filter;
  from.ray.spread *= renderer.map_filter;
  from.ray.of_camera = true;
  return true;
}

}  // namespace etendue
