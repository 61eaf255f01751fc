#pragma once
// GuidedDirections: a guide as what chooses the directions of walks that are kept (transport/subpath.h), and tells their
// densities to weights.

#include <span>
#include <vector>

#include "etendue/guiding/guided_scattering.h"
#include "etendue/transport/subpath.h"

namespace etendue {

class GuidedDirections final : public CameraDirections {
 public:
  /// Notes, if asked to, what a walk chose.
  GuidedDirections(const Guide& guide, bool notes) : guide_(guide), noting_(notes) {}

  Choice sample(const Walk<false>&, float choice, Point2 u) override;
  float pdf(const PathVertex&, const Vector3& out, const Vector3& in, float scatter) const override;

  /// What the guide is to learn from a walk, the only one that was sampled: `arrived[t]` is the light of all paths that have t
  /// vertices of it, weighted as in the picture. So the guide leads to what this walk is to find, and not to what is better
  /// found from the luminaires: at each vertex X = mean over wavelengths of (light by way of the next vertex) / T.
  std::vector<GuideSample> learned(std::span<const SubpathVertex> walk, std::span<const Spectrum> arrived) const;

 private:
  const Guide& guide_;
  const bool noting_;
  std::vector<GuideSample> notes_;  // of walk[1], walk[2], …
};

}  // namespace etendue
