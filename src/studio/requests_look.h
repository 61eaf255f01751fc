#pragma once
// Requests that inspect the render, implemented in several files.

#include "requests.h"

namespace etendue::studio {

/// Switches from the low-resolution picture of a moving camera to full resolution, so that pixel coordinates refer to the
/// latter.
void make_fine(Studio&);
/// A subset of the renderer's photons.
Json photons(const Call&);
/// The pdf learned by the guide at the surface point seen in a pixel.
Json lobes(const Call&);

}  // namespace etendue::studio
