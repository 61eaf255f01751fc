#include "etendue/render/photon_process.h"

#include <algorithm>

namespace etendue {
namespace {

/// The chance of a photon to be kept, so that about `most` are. When walks cannot make as many, all are; else as many as some
/// walks of other numbers made tell.
double chance_to_keep(Schedule& schedule, const PhotonWalks& walks, std::uint64_t most) {
  if (double(walks.walks) * walks.limits.longest <= double(most)) return 1;
  PhotonWalks some = walks;
  some.walks = std::min<std::uint64_t>(walks.walks, 1 << 14);
  some.step = ~walks.step;
  const size_t made = schedule.collect<Photon>(some.items(), some).size();
  const double expected = double(made) * double(walks.walks) / double(some.walks);
  return std::min(1.0, double(most) / std::max(expected, 1.0));
}

}  // namespace

void PhotonProcess::make_photons(Schedule& schedule, const Step& step, const Request& request) {
  const SampleKey key(context.seed, -1, -1, step.number);
  NumberStream numbers(*renderer.sampler, key);
  shares_ = true;
  wavelengths_ = context.wavelengths.sample(key, numbers.next());
  time_ = context.camera.shutter_time(numbers.next());

  const ImageBuffer& image = context.image;
  PhotonWalks walks{context, *renderer.light_sampler, *renderer.sampler, step.number, wavelengths_, time_, {}, {}};
  walks.walks = request.walks > 0 ? request.walks : std::uint64_t(image.width) * std::uint64_t(image.height);
  walks.limits = request.limits;
  walks.fewest_vertices = request.fewest_vertices;
  walks.abort = schedule.abort;
  walks.kept = chance_to_keep(schedule, walks, request.most);

  const double n = double(walks.walks) * walks.kept, shrunk = shrunk_area(step.number, request.shrinking);
  surface_radius_ = float(request.radius * std::sqrt(shrunk));
  medium_radius_ = float(request.radius * std::cbrt(shrunk));
  merging_ = {n * double(pi) * double(surface_radius_) * double(surface_radius_),
              n * 4 / 3 * double(pi) * std::pow(double(medium_radius_), 3)};
  const StrategyWeights against{request.heuristic, true, merging_};
  if (request.weighted) walks.against = &against;
  photons_ = {};
  photons_.build(schedule.collect<Photon>(walks.items(), walks));
}

}  // namespace etendue
