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
//
// Where s differs from place to place the integral has no closed form. Matter that only lets light go straight on is added,
// n = m - s for a bound m of s, so that the whole is the same everywhere with extinction m: distances t with density
// m exp(-m t) then lead from one tentative collision to the next (Woodcock et al. 1965; Miller et al. 2019).
//     T(d)          the product of n / m over the collisions before d: its mean is T (ratio tracking, Novák et al. 2014).
//     A walk        at each collision is scattered, with probability P = S / (S + N), or goes on, where
//                   S = sum_k w_k s_s,k,  N = sum_k w_k n_k, with the weights (s_s,j / m) / P and (n_j / m) / (1 - P).
//     Emission      adds (the walk's weight so far) e / m at each collision, whose density is m exp(-m t).

#include "etendue/numbers.h"
#include "etendue/scene.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {

/// What fills the inside of an object.
class Medium {
 public:
  Medium(const VolumeShader* v = nullptr, const SceneObject* o = nullptr) : volume(v), object(o) {}

  const VolumeShader* volume = nullptr;  ///< null: vacuum
  const SceneObject* object = nullptr;   ///< whose inside it is: the medium counts in its coordinates
  explicit operator bool() const { return volume != nullptr; }

  /// The same point or ray in the coordinates of the object; points of a ray keep their distances t.
  Point3 own(const Point3& p, float time) const;
  Ray own(const Ray&) const;

  VolumeCoefficients coefficients(const Point3& p, float time, const Wavelengths& w) const {
    return volume->coefficients(counted(p, time), time, w);
  }
  /// See VolumeShader; directions are those of the scene.
  float phase(const Point3& p, float time, const Vector3& out, const Vector3& in) const {
    return volume->phase(counted(p, time), out, in);
  }
  Vector3 sample_phase(const Point3& p, float time, const Vector3& out, Point2 u, float& pdf) const {
    return volume->sample_phase(counted(p, time), out, u, pdf);
  }

 private:
  Point3 counted(const Point3& p, float time) const { return volume->homogeneous() ? p : own(p, time); }
};

/// What fills the space inside a set of objects.
inline Medium medium_in(const MediumStack& media) {
  const SceneObject* object = media.current();
  return object ? Medium{object->interior.get(), object} : Medium{};
}

/// How far a ray that meets nothing goes through a medium [m]: to where it leaves the bounds of the object that holds it. Such
/// a ray has slipped through an edge or a corner of the object's surface, and is outside without knowing. Infinite where the
/// object is. Of what surrounds all others: as far as it goes.
float within_object(const Medium&, const Ray&);

/// An unbiased estimate of the fraction of light that gets `distance` [m] (may be infinite) along a ray in a medium; exact, and
/// without numbers, in a homogeneous one.
Spectrum transmittance(const Medium&, const Ray&, float distance, const Wavelengths&, NumberStream&);

/// A fixed value near that fraction, the same from both ends: for weights that compare strategies, which must not depend on
/// which of them made a path. Exact in homogeneous media.
Spectrum weighting_transmittance(const Medium&, const Ray&, float distance, const Wavelengths&);

/// How a walk gets through a medium.
struct FreeFlight {
  bool scattered = false;
  float distance = 0;  ///< to the scattering, or all the way [m]
  Spectrum weight;     ///< what the throughput is multiplied by; includes the scattering coefficient
  Spectrum emitted{};  ///< an estimate of the radiance that the medium sends from the next `reach` to the origin
};

/// Draws how far a walk gets along a ray before it is scattered, at most `reach` [m]. `throughput` is the walk's so far.
FreeFlight sample_free_flight(const Medium&, const Ray&, float reach, const Spectrum& throughput, const Wavelengths&,
                              NumberStream&);

/// The objects around a point that paths can enter and whose surfaces are closed.
void media_at_slowly(const Scene&, const Point3&, float time, MediumStack&);
inline void media_at(const Scene& scene, const Point3& p, float time, MediumStack& media) {
  if (const SceneObject* around = scene.surroundings()) media.surround(*around);
  if (scene.maybe_inside(p)) media_at_slowly(scene, p, time, media);
}

}  // namespace etendue
