#pragma once
// Light in participating media: how far it gets, and in which media a point lies.
//
// Along a ray through a medium with extinction s = s_a + s_s and emission e, radiance is (Chandrasekhar 1950)
//     L = int_0^d T(t) [ e + s_s int p L_i dw ] dt + T(d) L(d),        T(t) = exp(- int_0^t s).
// A random walk draws the distance t to its next scattering. s differs between the wavelengths of a path, so t is drawn
// for one of them, k, chosen with probability w_k, and all use the density of the mixture (Veach & Guibas's balance
// heuristic; Wilkie et al. 2014, "Hero wavelength spectral sampling"):
//     p(t) = sum_k w_k s_k T_k(t),     P(no scattering before d) = sum_k w_k T_k(d),
// with weights s_s,j T_j / p and T_j / P for wavelength j. With w_k in proportion to the path's throughput at k the sum of
// the throughputs changes by absorption alone, however long the walk: one walk is what the balance heuristic over whole
// paths would give (Miller, Georgiev & Jarosz 2019, "A null-scattering path integral formulation of light transport").

#include "etendue/sampler.h"
#include "etendue/scene.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {

/// What fills the space inside a set of objects; null: vacuum.
inline const VolumeShader* volume_of(const MediumStack& media) {
  const SceneObject* object = media.current();
  return object ? object->interior.get() : nullptr;
}

/// The fraction of light that gets `distance` [m] (may be infinite) along a ray in a medium.
Spectrum transmittance(const VolumeShader&, const Ray&, float distance, const Wavelengths&);

/// The radiance [W m^-2 sr^-1 nm^-1] a medium itself sends from the next `distance` of a ray to its origin.
Spectrum emitted_along(const VolumeShader&, const Ray&, float distance, const Wavelengths&);

/// How a walk gets through a medium.
struct FreeFlight {
  bool scattered = false;
  float distance = 0;  ///< to the scattering, or all the way [m]
  Spectrum weight;     ///< what the throughput is multiplied by; includes the scattering coefficient
};

/// Draws how far a walk gets along a ray before it is scattered, at most `reach` [m]. `throughput` is the walk's so far.
FreeFlight sample_free_flight(const VolumeShader&, const Ray&, float reach, const Spectrum& throughput, const Wavelengths&,
                              SampleStream&);

/// The objects around a point that paths can enter and whose surfaces are closed.
void media_at_slowly(const Scene&, const Point3&, float time, MediumStack&);
inline void media_at(const Scene& scene, const Point3& p, float time, MediumStack& media) {
  if (scene.maybe_inside(p)) media_at_slowly(scene, p, time, media);
}

}  // namespace etendue
