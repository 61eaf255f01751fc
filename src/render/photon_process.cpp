#include "etendue/render/photon_process.h"

#include <algorithm>

namespace etendue {
namespace {

/// The probability to store a photon, so that about `most` are stored. It is 1 if the subpaths cannot produce more than `most`;
/// otherwise the expected number is estimated from a pilot run of some subpaths with other random numbers, `made(subpaths)`.
template <class Made>
double chance_to_keep(const PhotonWalks& walks, std::uint64_t most, const Made& made) {
  if (double(walks.walks) * walks.limits.longest <= double(most)) return 1;
  PhotonWalks some = walks;
  some.walks = std::min<std::uint64_t>(walks.walks, 1 << 14);
  some.step = ~walks.step;
  const double expected = double(made(some)) * double(walks.walks) / double(some.walks);
  return std::min(1.0, double(most) / std::max(expected, 1.0));
}

}  // namespace

void PhotonProcess::share(const Step& step) {
  const SampleKey key(context.seed, -1, -1, step.number);
  NumberStream numbers(*renderer.sampler, key);
  shares_ = true;
  wavelengths_ = context.wavelengths.sample(key, numbers.next());
  time_ = context.camera.shutter_time(numbers.next());
}

PhotonWalks PhotonProcess::walks(const Schedule& schedule, const Step& step, const Request& request) const {
  const ImageBuffer& image = context.image;
  return {.context = context,
          .lights = *renderer.light_sampler,
          .numbers = *renderer.sampler,
          .step = step.number,
          .wavelengths = wavelengths_,
          .time = time_,
          .walks = request.walks > 0 ? request.walks : std::uint64_t(image.width) * std::uint64_t(image.height),
          .limits = request.limits,
          .kinds = request.kinds,
          .targets = request.targets,
          .fewest_vertices = request.fewest_vertices,
          .fewest_in_media = request.fewest_in_media,
          .in_homogeneous_media = request.in_homogeneous_media,
          .abort = schedule.abort};
}

PhotonProcess::Photons PhotonProcess::make_photons(Schedule& schedule, const Step& step, const Request& request) const {
  PhotonWalks walks = this->walks(schedule, step, request);
  const LightGroups groups(context.scene, context.image);
  walks.groups = &groups;
  walks.kept = chance_to_keep(walks, request.most,
                              [&](const PhotonWalks& some) { return schedule.collect<Photon>(some.items(), some).size(); });

  Photons photons;
  photons.walks = double(walks.walks) * walks.kept;
  const double shrunk = shrunk_area(step.number, request.shrinking);
  const double r = request.radius * std::sqrt(shrunk), in_medium = request.radius * std::cbrt(shrunk);
  photons.surface_radius = float(r);
  photons.medium_radius = float(in_medium);
  photons.merging = {photons.walks * double(pi) * r * r,
                     photons.walks * 4 / 3 * double(pi) * in_medium * in_medium * in_medium};
  const StrategyWeights against{request.weighted ? *request.weighted : Heuristic::power, true, photons.merging};
  if (request.weighted) walks.against = &against;
  photons.map.build(schedule.collect<Photon>(walks.items(), walks));
  return photons;
}

// The photons of a map are stored in spatial order, so every n-th of them gives a subset distributed over space as all of them
// are.
ShownPhotons PhotonProcess::some_of(std::initializer_list<const Photons*> maps, size_t most) const {
  ShownPhotons shown;
  for (const Photons* photons : maps) shown.all += photons->map.size();
  const size_t step = std::max<size_t>(1, (shown.all + most - 1) / std::max<size_t>(most, 1));
  for (const Photons* photons : maps)
    for (size_t i = step / 2; i < photons->map.size() && shown.some.size() < most; i += step) {
      const Photon& p = photons->map[i];
      Wavelengths w = wavelengths_;
      if (p.hero_only) w.drop_secondary();
      const Xyz power = to_xyz(p.throughput, w);
      const double n = photons->walks;
      shown.some.push_back(
          {p.position, -p.out, {power.x / n, power.y / n, power.z / n}, int(p.vertices), p.caustic, p.in_medium});
    }
  return shown;
}

PhotonProcess::Beams PhotonProcess::make_beams(Schedule& schedule, const Step& step, const Request& request) const {
  BeamWalks of{walks(schedule, step, request)};
  const LightGroups groups(context.scene, context.image);
  of.walks.groups = &groups;
  of.walks.kept = chance_to_keep(of.walks, request.most, [&](const PhotonWalks& some) {
    const BeamWalks few{some};
    return schedule.collect_everywhere<PhotonBeam>(few.items(), few).size();
  });
  Beams beams;
  beams.walks = double(of.walks.walks) * of.walks.kept;
  beams.radius = float(request.radius * shrunk_area(step.number, request.shrinking));
  beams.map.build(schedule.collect_everywhere<PhotonBeam>(of.items(), of), beams.radius);
  return beams;
}

}  // namespace etendue
