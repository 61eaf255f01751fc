#include "surface_step.h"

#include "camera_path.h"
#include "division.h"
#include "film/picture_format.h"
#include "transport/first_surface.h"

namespace etendue {

std::vector<SurfaceTile> surfaces_of_step(Schedule& schedule, const RenderContext& context, const Renderer& renderer,
                                          const Step& step, const std::function<SurfaceSeer(SurfaceTile&)>& seer_for) {
  const Division division(context.image, step.samples);
  // Not the renderer's own process, which may choose one time for all paths of a step.
  const RenderProcess usual(renderer, context);
  return schedule.collect<SurfaceTile>(
      division.count(), [&](std::uint64_t item, std::vector<SurfaceTile>& tiles, Arena& arena) {
        const auto [area, first, last, block] = division.item(item);
        SurfaceTile& tile = tiles.emplace_back();
        tile.begin(context.image, area, block);
        const SurfaceSeer see = seer_for(tile);
        for (int y = area.y0; y < area.y1; ++y)
          for (int x = area.x0; x < area.x1; ++x)
            for (SampleKey key(context.seed, x, y, first); key.sample < last; ++key.sample) {
              if (schedule.aborted()) return;
              CameraSample s;
              SampleContext sample{s.wavelengths, {*renderer.sampler, key}, arena, {}};
              CameraRay from;
              const bool passes = begin_camera_path(usual, {x, y, x + 1, y + 1}, key, sample, s, from);
              // What the lens blocks is black in the picture, and shows no surface.
              const bool seen = passes && !from.weight.black();
              tile.add(s.film, x, y, key.sample, seen ? see(from.ray, s, sample) : FirstSurface{});
              arena.reset();
            }
      });
}

std::vector<SurfaceTile> surfaces_of_step(Schedule& schedule, const RenderContext& context, const Renderer& renderer,
                                          const Step& step, const ObjectNames& names,
                                          const std::vector<Ref<ObjectGroup>>& groups) {
  const FirstSurfaces surfaces(context.scene, context.camera, context.image.format()->surfaces, names, groups);
  return surfaces_of_step(schedule, context, renderer, step, [&](SurfaceTile& tile) {
    return
        [&surfaces, &tile, met = FirstSurfaces::Met()](const Ray& ray, const CameraSample& s, SampleContext& sample) mutable {
          return surfaces.see(ray, s.film, sample, met, tile);
        };
  });
}

}  // namespace etendue
