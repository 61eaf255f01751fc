#include "mattes.h"

#include <atomic>

#include "etendue/describe/reflection.h"
#include "images/surface_mattes.h"
#include "render/parallel_schedule.h"
#include "render/surface_step.h"

namespace etendue {

std::vector<Cryptomatte> render_mattes(const Render& render, int threads, const std::function<bool(double)>& go_on) {
  const Job& job = render.job();
  const Ref<ImageBuffer> image = ref_cast<ImageBuffer>(copy(*job.image));
  image->layers.clear();
  for (size_t kind = 0; kind < matte_kinds; ++kind)
    if (kind != size_t(MatteKind::group) || !job.groups.empty()) image->layers.emplace_back(matte_layers[kind]);
  prepare_tree(*image);
  const RenderContext context{*job.scene, *job.camera, *image, *job.wavelengths, job.seed};
  const ObjectNames names(*job.scene);
  Film unseen(*image);
  const std::atomic<bool> never{false};
  ParallelSchedule schedule(unseen, threads, never);
  SurfaceFilm film(*image);
  const auto samples = std::uint32_t(job.renderer->samples);
  const std::uint32_t each = samples_per_step(image->area());
  for (std::uint32_t first = 0; first < samples; first += each) {
    const IndexRange part{first, std::min(first + each, samples)};
    film.take(surfaces_of_step(schedule, context, *job.renderer, {first / each, part}, names, job.groups));
    film.end_step();
    if (!go_on(double(part.end) / samples)) return {};
  }
  return mattes_of(*film.snapshot());
}

}  // namespace etendue
