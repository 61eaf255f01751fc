#include "etendue/guiding/guided_directions.h"

#include "etendue/transport/walk.h"

namespace etendue {

CameraDirections::Choice GuidedDirections::sample(const Walk<false>& walk, float choice, Point2 u) {
  const GuidedScattering guided(guide_, walk.vertex, walk.vertex.out);
  GuidedScattering::Choice way = guided.sample(choice, u, [&](float lobe) { return walk.sample_direction(lobe, u); });
  if (noting_) {
    GuideSample& note = notes_.emplace_back();
    note.position = walk.vertex.point.position;
    note.region = guided.region();
    note.scatter = way.scatter;
    if (way.next) {
      note.direction = way.next->direction;
      note.specular = guided.alone(*way.next);
    }
  }
  return {way.next, way.more};
}

float GuidedDirections::pdf(const PathVertex& v, const Vector3& out, const Vector3& in, float scatter) const {
  return GuidedScattering(guide_, v, out).pdf(in, scatter);
}

std::vector<GuideSample> GuidedDirections::learned(std::span<const SubpathVertex> walk,
                                                   std::span<const Spectrum> arrived) const {
  std::vector<GuideSample> samples;
  Spectrum light;
  // From the end, so that `light` is that of all paths that contain the next vertex.
  for (size_t k = walk.size(); k-- > 1;) {
    if (k + 2 < arrived.size()) light += arrived[k + 2];
    if (k + 1 >= walk.size() || k > notes_.size()) continue;
    GuideSample s = notes_[k - 1];
    float sum = 0, distance_met = 0;
    int carried = 0;
    const Spectrum& throughput = walk[k].throughput;
    for (int i = 0; i < spectrum_size; ++i)
      if (throughput[i] > 0) {
        sum += std::max(light[i], 0.0f) / throughput[i];
        ++carried;
      }
    if (!(sum > 0)) continue;
    s.found = sum / float(carried);
    // Behind specular vertices the distance of a source is the length of the path to it.
    for (size_t m = k + 1; m < walk.size(); ++m) {
      distance_met +=
          walk[m].kind == PathVertex::Kind::escape ? infinity : distance(walk[m - 1].point.position, walk[m].point.position);
      if (!walk[m].leaves_specularly) break;
    }
    s.nearness = 1 / distance_met;
    samples.push_back(s);
  }
  return samples;
}

}  // namespace etendue
