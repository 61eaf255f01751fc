#pragma once
// PhotonDirections: the directions of the photons near a point, as a guide to the incident light (Jensen 1995, "Importance
// driven path tracing using the photon map"). Around the direction of each of the nearest photons there is a cone of solid
// angle W; a cone is chosen in proportion to the flux P_k of its photon, normalized to a sum of 1, and a direction sampled
// uniformly in it:
//     p(w) = sum_k P_k [w in cone k] / W   [1/sr].

#include <array>

#include "etendue/core/warp.h"
#include "etendue/transport/photons.h"

namespace etendue {

class PhotonDirections {
 public:
  /// Uses the photons within `radius` of x that came to the side of the surface on which the walk came.
  PhotonDirections(const PhotonMap& map, const PathVertex& vertex, float radius) {
    std::vector<PointTree::Near>& near = PointTree::near_on_this_thread();
    map.tree().nearest(vertex.point.position, radius, most, near);
    const Vector3 normal = on_side(Vector3(vertex.point.normal), vertex.out);
    for (const PointTree::Near& each : near) {
      const Photon& photon = map[each.index];
      if (photon.in_medium || !(dot(normal, photon.out) > 0)) continue;
      photons_[count_] = &photon;
      sum_ += carried_[count_] = std::max(photon.throughput.average(), 0.0f);
      ++count_;
    }
  }
  bool empty() const { return !(sum_ > 0); }

  Vector3 sample(float choice, Point2 u) const {
    float rest = choice * sum_;
    size_t k = 0;
    while (k + 1 < count_ && rest >= carried_[k]) rest -= carried_[k++];
    return Frame(Normal3(photons_[k]->out)).to_world(warp::cone(u, opening));
  }
  /// [1/sr]
  float pdf(const Vector3& direction) const {
    float met = 0;
    for (size_t k = 0; k < count_; ++k)
      if (dot(direction, photons_[k]->out) >= 1 - opening) met += carried_[k];
    return met / sum_ * warp::cone_pdf(opening);
  }

 private:
  static constexpr size_t most = 24;
  static constexpr float opening = 0.06f;  // 1 - cosine of a cone's half angle: 20 degrees
  std::array<const Photon*, most> photons_;
  std::array<float, most> carried_;
  size_t count_ = 0;
  float sum_ = 0;
};

}  // namespace etendue
