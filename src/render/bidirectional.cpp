#include "etendue/render/bidirectional.h"

#include "etendue/guiding/guided_directions.h"

namespace etendue {
Spectrum bidirectional_radiance(const RenderContext& context, const LightSampler& lights, const Ray& ray, SampleContext& sample,
                                const BidirectionalSettings& settings, const PhotonProcess::Photons* photons,
                                const LearnedGuide* guide) {
  const BidirectionalStrategies& use = settings.strategies;
  const int k = settings.max_depth;
  const bool trains = guide && guide->teaches(sample);
  std::optional<GuidedDirections> directions;
  if (guide) directions.emplace(guide->guide(), trains);

  BidirectionalSubpaths paths(context, lights, sample,
                              {settings.heuristic, settings.weighted, photons ? photons->merging : Merging{}});
  std::vector<Spectrum> by_camera_vertices;  // the radiance by t, if the sample trains a guide
  ContributionSum sum(sample, paths, [&](const PathContribution& c) {
    if (!settings.uses(c.s, c.t)) return false;
    if (!use.connecting() && !paths.has_specular_prefix(c.t)) return false;
    if (trains && c.t >= 2) {
      if (by_camera_vertices.size() <= size_t(c.t)) by_camera_vertices.resize(size_t(c.t) + 1);
      by_camera_vertices[size_t(c.t)] += c.light * c.weight;
    }
    return true;
  });
  if (context.scene.has_fluorescence() && !photons) paths.follow_fluorescence(k - 1, !settings.weighted);
  if (use.from_camera()) paths.from_camera(ray, {k, settings.roulette_depth, directions ? &*directions : nullptr});
  if (use.emitter_hits) sum.add(paths.segment_emission());
  if (use.connecting()) paths.from_luminaire(ray.time, {k - 1, settings.roulette_depth});

  for (int t = 2; t <= paths.camera_vertices() && !sample.aborted(); ++t) {
    if (!use.connecting() && !paths.has_specular_prefix(t)) break;
    if (use.emitter_hits) sum.add(paths.emitter_hits(t));
    const SubpathVertex& z = paths.camera_vertex(t);
    if (!z.connectable()) continue;
    if (photons)
      photons->near(context.scene, z, [&](const Photon& photon, float) {
        if (int(photon.vertices) + t - 1 <= k) sum.add(paths.merge(photon, t));
      });
    if (use.next_event && t <= k && settings.uses(1, t)) sum.add(paths.next_event(t));
    if (!use.connections) continue;
    for (int s = 2; s <= paths.light_vertices() && s + t - 1 <= k && !sample.aborted(); ++s)
      if (settings.uses(s, t) && paths.light_vertex(s).connectable()) sum.add(paths.connect(s, t));
  }
  // A luminaire that the camera sees is an emitter hit, which is better than to connect its point to the lens.
  const int first = use.emitter_hits ? 2 : 1;
  if (use.lens)
    for (int s = first; s <= paths.light_vertices() && s <= k && !sample.aborted(); ++s)
      if (settings.uses(s, 1) && paths.light_vertex(s).connectable()) sum.add(paths.connect_to_lens(s));

  if (trains)
    for (const GuideSample& each : directions->learned(paths.camera_subpath(), by_camera_vertices))
      sample.sink.records.add(each);
  paths.record();
  return sum.radiance;
}

}  // namespace etendue
