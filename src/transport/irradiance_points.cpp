#include "etendue/transport/irradiance_points.h"

#include <algorithm>

namespace etendue {
namespace {

constexpr size_t points_of_item = 256;
constexpr float same_way = 0.9f;  // minimum cosine between normals of surfaces that are taken as one

/// The irradiance at a photon from the photons near it, including the photon itself: at the position of a photon there is one
/// more than on average, and of the others, whose subpaths are well stratified, about one less.
Spectrum irradiance_at(const IrradiancePoints::Work& work, size_t i, const Vector3& normal) {
  const PhotonMap& map = work.map;
  std::vector<PointTree::Near>& near = PointTree::near_on_this_thread();
  map.tree().nearest(map[i].position, work.farthest, work.nearest, near);
  // The farthest photon gives the radius of the disc; as it lies on its edge, it is not counted.
  const bool all = near.size() == work.nearest;
  const float radius = all ? std::sqrt(near.front().squared) : work.farthest;
  Spectrum sum;
  for (size_t k = all; k < near.size(); ++k) {
    const Photon& p = map[near[k].index];
    if (!p.in_medium && dot(p.out, normal) > 0 && dot(on_side(p.surface_normal(), p.out), normal) > same_way &&
        !photon_occluded(work.scene, map[i].position, normal, work.time, p.position, on_side(p.surface_normal(), p.out),
                         radius))
      sum += p.throughput;
  }
  return sum / float(work.walks * double(pi) * double(radius) * double(radius));
}

}  // namespace

std::uint64_t IrradiancePoints::Work::items() const {
  return (map.size() + every * points_of_item - 1) / (every * points_of_item);
}

void IrradiancePoints::Work::operator()(std::uint64_t item, std::vector<Point>& points, Arena&) const {
  const size_t first = size_t(item) * every * points_of_item, end = std::min(first + every * points_of_item, map.size());
  for (size_t i = first; i < end; i += every) {
    const Photon& p = map[i];
    if (p.in_medium) continue;
    const Vector3 normal = on_side(p.surface_normal(), p.out);
    points.push_back({p.position, normal, irradiance_at(*this, i, normal)});
  }
}

void IrradiancePoints::build(const Work& work, std::vector<Point>&& points) {
  const std::vector<std::uint32_t> order = tree_.build(std::span<const Point>(points), &Point::position);
  points_.clear();
  points_.reserve(points.size());
  for (const std::uint32_t i : order) points_.push_back(points[i]);
  farthest_ = work.farthest;
  scene_ = &work.scene;
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
