#pragma once
// What arguments of closures of facets have in common: the distribution's name, and thin films. For the files of this folder
// that define such closures.

#include "closure_rows.h"

namespace etendue::osl {

/// The distribution that argument i names; a warning if it is not known.
MicrofacetDistribution::Kind distribution_named(const Gathering&, const ClosureComponent&, size_t i);

/// The film of the optional arguments thinfilm_thickness [nm] and thinfilm_ior.
struct Film {
  float thickness = 0, index = 1.5f;
};
/// Of no thickness, with a warning, where paths carry bands instead of wavelengths.
Film film_of(const Gathering&, const ClosureComponent&);
/// A film on a smooth boundary: the house's ThinFilm. A film on facets: their Fresnel reflectance is that of the film.
/// `v.index` and `v.extinction` are those of the base, which light enters unless it is `opaque`.
void add_film(Gathering&, const SurfacePoint&, const MicrofacetDistribution&, const Film&, SlotValues v, bool opaque,
              const Spectrum& color, Lobes);

}  // namespace etendue::osl
