#pragma once
// Warnings about the parts of a scene's light transport that a renderer cannot sample, with the renderers that can.

#include <span>
#include <string>
#include <vector>

#include "etendue/render/job.h"

namespace etendue {

/// "PathTracer cannot find caustics of 'lamp' by 'ball'; BidirectionalPathTracer can"
std::string advice_text(const std::string& renderer, const Advice&);
/// Returns one such line for each kind of light that a job's renderer misses, and one for its bias. Here and below the job must
/// be prepared.
std::vector<std::string> advice_lines(const Job&);
/// Prints them as warnings on standard error.
void advise(const Job&);

/// Names of the known renderers that, with their defaults, miss nothing in a scene.
std::vector<std::string> renderers_that_find_all(const SceneTraits&);

/// "4: 1 point light, 2 area lights, 1 environment; 2 in nested scenes": the number of luminaires by kind. The luminaires of a
/// nested scene are counted once for each of its instances.
std::string luminaires_text(const Scene&, const SceneTraits&);

}  // namespace etendue
