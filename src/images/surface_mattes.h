#pragma once
// The mattes of a picture, from the surfaces that its samples meet first.

#include "cryptomatte.h"
#include "film/surface_film.h"

namespace etendue {

/// The kinds that the picture has as layers, each with all its coverages: the sums of the weights of the samples that see a
/// name, over those of all samples.
std::vector<Cryptomatte> mattes_of(const SurfaceSnapshot&);

/// Adds the mattes to a picture of the same pixels as channels and metadata, with as many coverages as its layers ask for.
void add_mattes(Image&, const SurfaceSnapshot&);

}  // namespace etendue
