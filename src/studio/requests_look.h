#pragma once
// Requests that look at what is rendered, from several files.

#include "requests.h"

namespace etendue::studio {

/// A moving camera's coarse picture counts other pixels than those that are asked about: it is fine from now on.
void make_fine(Studio&);
/// Some of the photons that the renderer holds.
Json photons(const Call&);
/// What its guide has learned where a pixel looks.
Json lobes(const Call&);

}  // namespace etendue::studio
