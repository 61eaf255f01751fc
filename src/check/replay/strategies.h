#pragma once
// The contribution of each strategy of a renderer to the image: for bidirectional path tracing the pyramid of Veach's thesis
// (1997, figure 10.3), with an image for each pair of numbers of vertices from the light and from the camera.

#include <functional>
#include <string>
#include <vector>

#include "etendue/render/render.h"

namespace etendue {

/// The contribution of one strategy by paths of one length.
struct StrategyPicture {
  std::string strategy;        ///< as PathRecord::Contribution names it
  int length = 0;              ///< segments from the lens to the luminaire; 0: not recorded
  Image weighted, unweighted;  ///< X Y Z, with and without the weights of multiple importance sampling
};

/// Renders the first `samples` samples of every pixel with records. This works for any renderer whose samples belong to pixels
/// and which records its contributions (SampleContext::note). The sum of the weighted images is the image of these samples with
/// a box filter of one pixel. Throws Error if the renderer records no contributions. `going_on` is called with the fraction
/// that is done, one call at a time; when it returns false, the remaining samples are left out.
std::vector<StrategyPicture> strategy_pictures(const Render&, std::uint32_t samples,
                                               const std::function<bool(double fraction)>& going_on);

}  // namespace etendue
