#pragma once
// Participating media: transmittance, free-flight sampling, and the medium at a point.
//
// Along a ray through a medium with extinction s = s_a + s_s and emission e, the radiance is (Chandrasekhar 1950)
//     L = int_0^d T(t) [ e + s_s int p L_i dw ] dt + T(d) L(d),        T(t) = exp(- int_0^t s).
// A walk samples the distance t to its next scattering event. s differs between the wavelengths of a path, so t is sampled for
// one of them, k, chosen with probability w_k, and all use the pdf of the mixture (the balance heuristic of Veach & Guibas;
// Wilkie et al. 2014, "Hero wavelength spectral sampling"):
//     p(t) = sum_k w_k s_k T_k(t),     P(no scattering before d) = sum_k w_k T_k(d),
// with weights s_s,j T_j / p and T_j / P for wavelength j. If w_k is in proportion to the path's throughput at k, the sum of
// the throughputs changes by absorption alone, however long the walk: one walk has the weight that the balance heuristic over
// whole paths gives (Miller, Georgiev & Jarosz 2019, "A null-scattering path integral formulation of light transport").
//
// In a heterogeneous medium the integral of s has no closed form. Fictitious matter with null scattering is added, with the
// coefficient n = m - s for a majorant m of s, so that the total extinction is m everywhere. Distances t with the pdf m exp(-m
// t) then lead from one tentative collision to the next (delta tracking: Woodcock et al. 1965; Miller et al. 2019).
//     T(d)          the product of n / m over the collisions before d: its mean is T (ratio tracking, Novák et al. 2014).
//     A walk        at each collision is scattered, with probability P = S / (S + N), or continues, where
//                   S = sum_k w_k s_s,k,  N = sum_k w_k n_k, with the weights (s_s,j / m) / P and (n_j / m) / (1 - P).
//     Emission      adds (the walk's weight so far) e / m at each collision, since their density per distance is m.

#include "etendue/numbers.h"
#include "etendue/scene.h"
#include "etendue/transport/medium_stack.h"

namespace etendue {

/// The medium inside an object.
class Medium {
 public:
  Medium(const VolumeShader* volume_ = nullptr, const SceneObject* object_ = nullptr) : volume(volume_), object(object_) {}

  const VolumeShader* volume = nullptr;  ///< null: vacuum
  const SceneObject* object = nullptr;   ///< the object whose interior this is; the coefficients are given in its object space
  explicit operator bool() const { return volume != nullptr; }

  /// The same point or ray in the object's space; points of a ray keep their parameters t.
  Point3 own(const Point3& position, float time) const;
  Ray own(const Ray&) const;

  VolumeCoefficients coefficients(const Point3& position, float time, const Wavelengths& wavelengths) const {
    return volume->coefficients(volume_point(position, time), time, wavelengths);
  }
  /// See VolumeShader; directions are in world space.
  float phase(const Point3& position, float time, const Vector3& out, const Vector3& in) const {
    return volume->phase(volume_point(position, time), out, in);
  }
  Vector3 sample_phase(const Point3& position, float time, const Vector3& out, Point2 u, float& pdf) const {
    return volume->sample_phase(volume_point(position, time), out, u, pdf);
  }

 private:
  /// The point that is passed to the volume shader.
  Point3 volume_point(const Point3& position, float time) const {
    return volume->homogeneous() ? position : own(position, time);
  }
};

/// The medium at the top of a stack.
inline Medium medium_in(const MediumStack& media) {
  const SceneObject* object = media.current();
  return object ? Medium{object->interior.get(), object} : Medium{};
}

/// The distance that a ray which hits nothing travels in a medium [m]: to the bounding box of the object. Such a ray left the
/// object through an edge or a corner of its surface without a hit. Infinite if the object is. For the surroundings of the
/// scene: up to their end.
float within_object(const Medium&, const Ray&);

/// An unbiased estimate of the transmittance over `distance` [m] (may be infinite) along a ray in a medium; exact, and without
/// random numbers, if the medium is homogeneous.
Spectrum transmittance(const Medium&, const Ray&, float distance, const Wavelengths&, NumberStream&);

/// A deterministic approximation of the transmittance, the same from both ends, for multiple importance sampling weights: these
/// must not depend on the strategy that made the path. Exact in homogeneous media.
Spectrum weighting_transmittance(const Medium&, const Ray&, float distance, const Wavelengths&);

/// The result of sampling a distance in a medium.
struct FreeFlight {
  bool scattered = false;
  float distance = 0;  ///< to the scattering event, or all the way [m]
  Spectrum weight;     ///< of the throughput: s_s T / p(t) if scattered, T / P if not
  Spectrum emitted{};  ///< an estimate of the radiance that the medium emits over the distance `reach` towards the origin
};

/// Samples the distance along a ray to the next scattering event, at most `reach` [m]. `throughput` is that of the walk so far:
/// it gives the probabilities w_k.
FreeFlight sample_free_flight(const Medium&, const Ray&, float reach, const Spectrum& throughput, const Wavelengths&,
                              NumberStream&);

/// Fills the stack with the closed objects around a point that paths can enter.
void media_at_slowly(const Scene&, const Point3&, float time, MediumStack&);
inline void media_at(const Scene& scene, const Point3& position, float time, MediumStack& media) {
  if (const SceneObject* around = scene.surroundings()) media.surround(*around);
  if (scene.maybe_inside(position)) media_at_slowly(scene, position, time, media);
}

}  // namespace etendue
