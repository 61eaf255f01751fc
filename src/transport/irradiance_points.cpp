#include "etendue/transport/irradiance_points.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace etendue {
namespace {

constexpr float same_way = 0.9f;  // minimum cosine between normals of surfaces that are taken as one

/// The irradiance at a photon from the photons near it, including the photon itself: at the position of a photon there is one
/// more than on average, and of the others, whose subpaths are well stratified, about one less.
Spectrum irradiance_at(const Scene& scene, const PhotonMap& map, size_t i, const Vector3& normal,
                       const IrradiancePoints::Estimate& estimate) {
  std::vector<PointTree::Near>& near = PointTree::near_on_this_thread();
  map.tree().nearest(map[i].position, estimate.farthest, estimate.nearest, near);
  // The farthest photon gives the radius of the disc; as it lies on its edge, it is not counted.
  const bool all = near.size() == estimate.nearest;
  const float radius = all ? std::sqrt(near.front().squared) : estimate.farthest;
  Spectrum sum;
  for (size_t k = all; k < near.size(); ++k) {
    const Photon& p = map[near[k].index];
    if (!p.in_medium && dot(p.out, normal) > 0 && dot(on_side(p.surface_normal(), p.out), normal) > same_way &&
        !photon_occluded(scene, map[i].position, normal, estimate.time, p.position, on_side(p.surface_normal(), p.out), radius))
      sum += p.throughput;
  }
  return sum / float(estimate.walks * double(pi) * double(radius) * double(radius));
}

}  // namespace

void IrradiancePoints::find(const Scene& scene, const PhotonMap& map, const Estimate& estimate) {
  std::vector<Point> points((map.size() + every - 1) / every);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, points.size(), 256), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t n = range.begin(); n < range.end(); ++n) {
      const Photon& p = map[n * every];
      if (p.in_medium) continue;
      const Vector3 normal = on_side(p.surface_normal(), p.out);
      points[n] = {p.position, normal, irradiance_at(scene, map, n * every, normal, estimate)};
    }
  });
  std::erase_if(points, [](const Point& p) { return p.normal == Vector3{}; });  // photons in media
  std::vector<Point3> places;
  for (const Point& p : points) places.push_back(p.position);
  points_.clear();
  for (const std::uint32_t i : tree_.build(places)) points_.push_back(points[i]);
  farthest_ = estimate.farthest;
  scene_ = &scene;
}

const Spectrum* IrradiancePoints::at(const PathVertex& v) const {
  constexpr size_t most = 8;
  const Vector3 normal = on_side(Vector3(v.point.normal), v.out);
  std::vector<PointTree::Near>& near = PointTree::near_on_this_thread();
  tree_.nearest(v.point.position, farthest_, most, near);
  std::sort_heap(near.begin(), near.end());
  for (const PointTree::Near& each : near)
    if (const Point& p = points_[each.index];
        dot(p.normal, normal) > same_way &&
        !photon_occluded(*scene_, v.point.position, normal, v.point.time, p.position, p.normal, std::sqrt(each.squared)))
      return &p.value;
  return nullptr;
}

}  // namespace etendue
