#pragma once
// What a renderer cannot find of the light in a scene, and which renderers can.

#include <span>
#include <string>
#include <vector>

#include "etendue/render/job.h"

namespace etendue {

/// "PathTracer cannot find caustics of 'lamp' by 'ball'; BidirectionalPathTracer can"
std::string advice_text(const std::string& renderer, const Advice&);
/// One such line for everything a job's renderer misses, and one for its bias. The job must be prepared, here and below.
std::vector<std::string> advice_lines(const Job&);
/// Prints them as warnings on standard error.
void advise(const Job&);

/// Names of the known renderers that, with their defaults, miss nothing in a scene.
std::vector<std::string> renderers_that_find_all(const SceneTraits&);

/// "4: 1 point light, 2 area lights, 1 environment; 2 in nested scenes": how many luminaires there are, by kind, those of
/// nested scenes in each place where these stand.
std::string luminaires_text(const Scene&, const SceneTraits&);

}  // namespace etendue
