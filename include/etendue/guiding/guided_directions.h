#pragma once
// GuidedDirections: a guide that samples the directions of stored subpaths (transport/subpath.h) and returns their pdfs for
// multiple importance sampling weights.

#include <span>
#include <vector>

#include "etendue/guiding/guided_scattering.h"
#include "etendue/transport/subpath.h"

namespace etendue {

class GuidedDirections final : public CameraDirections {
 public:
  /// `notes`: whether the sampled directions are recorded for `learned`.
  GuidedDirections(const Guide& guide, bool notes) : guide_(guide), noting_(notes) {}

  Choice sample(const Walk<false>&, float choice, Point2 u) override;
  float pdf(const PathVertex&, const Vector3& out, const Vector3& in, float scatter) const override;

  /// The training samples of a subpath, which must be the only one that was sampled. `arrived[t]` is the light of all paths
  /// with t vertices of the subpath, with the weights of the strategies. So the guide leads to the light that this subpath has
  /// to find, and not to light that strategies with more vertices from the luminaire find better. At each vertex X = mean over
  /// the wavelengths of (light that passes the next vertex) / T.
  std::vector<GuideSample> learned(std::span<const SubpathVertex> walk, std::span<const Spectrum> arrived) const;

 private:
  const Guide& guide_;
  const bool noting_;
  std::vector<GuideSample> notes_;  // for walk[1], walk[2], …
};

}  // namespace etendue
