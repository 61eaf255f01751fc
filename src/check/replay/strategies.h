#pragma once
// What each strategy of a renderer brings to the picture, apart from the others: for bidirectional path tracing the pyramid of
// Veach's thesis (1997, figure 10.3), with a picture for each number of vertices from either end.

#include <functional>
#include <string>
#include <vector>

#include "etendue/render/render.h"

namespace etendue {

/// One strategy's share of the light of paths of one length.
struct StrategyPicture {
  std::string strategy;        ///< as PathRecord::Contribution names it
  int length = 0;              ///< segments from the lens to the luminaire; 0: not said
  Image weighted, unweighted;  ///< X Y Z, as it counts, and by itself: before weights of multiple importance sampling
};

/// Renders `samples` samples of every pixel with records, from the first on. Any renderer whose samples are those of pixels and
/// which notes what it contributes (SampleContext::note) has them; the sum of the weighted ones is the picture that a box
/// filter of one pixel makes of these samples. Throws Error when a renderer notes nothing. `going_on` is told the fraction that
/// is done, one call at a time; when it returns false the rest is left out.
std::vector<StrategyPicture> strategy_pictures(const Render&, std::uint32_t samples,
                                               const std::function<bool(double fraction)>& going_on);

}  // namespace etendue
