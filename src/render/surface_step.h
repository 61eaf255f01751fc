#pragma once
// The layers of a picture that show surfaces: for each sample of a step, what its camera ray meets first.

#include <functional>

#include "etendue/render/renderer.h"
#include "etendue/transport/object_groups.h"
#include "film/surface_tile.h"
#include "transport/object_names.h"

namespace etendue {

/// Follows the camera rays of the samples that a step renders of every pixel, in tiles that lie and are ordered as those of its
/// light. Film points, lens points and times are those that the renderer's sampler gives the paths of a path tracer: so the
/// result does not depend on the renderer.
std::vector<SurfaceTile> surfaces_of_step(Schedule&, const RenderContext&, const Renderer&, const Step&, const ObjectNames&,
                                          const std::vector<Ref<ObjectGroup>>&);

/// Finds a surface that a camera ray meets, by the primary samples that follow those of the ray.
using SurfaceSeer = std::function<FirstSurface(const Ray&, const CameraSample&, SampleContext&)>;
/// The same with another answer to what a ray sees: `seer_for` makes one for each tile, on the thread that fills it.
std::vector<SurfaceTile> surfaces_of_step(Schedule&, const RenderContext&, const Renderer&, const Step&,
                                          const std::function<SurfaceSeer(SurfaceTile&)>& seer_for);

}  // namespace etendue
