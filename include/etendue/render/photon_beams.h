#pragma once
// Photon beams: the flux that light subpaths carry through media, stored along their whole segments instead of at the
// scattering vertices (Jarosz, Nowrouzezahrai, Sadeghi & Jensen 2011, "A comprehensive theory of volumetric radiance estimation
// using photon points and beams"; Jarosz, Nowrouzezahrai, Thomas, Sloan & Zwicker 2011, "Progressive photon beams"; Křivánek et
// al. 2014, "Unifying points, beams, and paths").
//
// Let one of n light subpaths enter a medium at o in the direction e with the throughput alpha. Until it is scattered it
// carries alpha T(s) to the point o + s e, with T(s) = exp(-s_t s). So for any h(x, w) the expected value of the sum over the
// beams is the integral of the radiance over the medium:
//     int int L(x, w) h(x, w) dw dx  =  sum over beams  1 / n  int alpha T(s) h(o + s e, e) ds.
// Radiance scattered into a camera ray x(t) = c + t d is
//     L = int T(t) s_s int phase L(x(t), w) dw dt,
// to which a beam without width contributes only if it intersects the ray. Therefore each beam is spread evenly by r to either
// side along u = e x d / sin, the common perpendicular of beam and ray. The beam becomes a sheet that carries, per metre of
// width, the flux alpha T(s) / (2 r). The ray intersects this sheet in one point if its distance from the beam is less than r,
// at the angle between e and d; the integral over dt gives 1 / sin of this angle:
//     L = sum over beams nearer than r   alpha / n  s_s phase(e, d) T(s) T(t) / (2 r sin(e, d)).
// This is a blur in one dimension, so its variance grows as 1 / r, and radii may shrink faster than those of photon points:
//     r_{i+1} = r_i (i + a) / (i + 1).
// The variance of the mean over N steps then falls as N^-a (Knaus & Zwicker 2011, for one dimension), and the bias, of order
// r^2 where light is smooth, as N^(-2 (1 - a)). The factor 1 / sin does not raise the variance: the probability that a beam
// passes the ray within r is proportional to sin.
//
// Beams parallel to the ray, as of sunlight along the view direction, form no sheet. For sin < 0.001 the beam is spread over
// the disc of radius r perpendicular to it instead. The ray is inside this cylinder from t_0 to t_1:
//     L = alpha / n  s_s phase int_{t_0}^{t_1} T(s) T(t) dt / (pi r^2),
// where the integral is estimated at one random t. The variance of this part grows as 1 / r^2, so a > 1/2 is needed for its
// mean over steps to converge.
//
// Wavelengths: all paths of a step share them. alpha, s_s, s_t, and so T, are spectra, and the product above is taken for each
// wavelength. No sampling decision depends on one wavelength alone, except where a beam ends. Up to l_0 every beam continues
// with certainty (a long beam); beyond it the length is sampled (a short beam) with P(s) = exp(-m (s - l_0)), where m is the
// least extinction among the wavelengths that the medium scatters. The surviving beam is weighted with alpha / P(s). No weight
// exceeds T(l_0).

#include "etendue/transport/photons.h"

namespace etendue {

/// A segment of a light subpath in a homogeneous medium.
struct PhotonBeam {
  Spectrum throughput;  ///< alpha at its origin [W/nm]
  Point3 origin;
  float length = 0;                      ///< [m]
  Vector3 direction;                     ///< unit, along which light goes
  float least_extinction = 0;            ///< m [1/m]
  const VolumeShader* volume = nullptr;  ///< the medium's
  std::uint32_t vertices : 29 = 0;  ///< vertices of its subpath before it is scattered; 1: it comes directly from an emitter
  bool hero_only : 1 = false;       ///< it carries the hero wavelength alone
  bool caustic : 1 = false;         ///< it came from the emitter by a specular chain of one vertex or more
  std::int32_t luminaire = -1;      ///< SceneObject::luminaire_index of the emitter
  std::uint16_t state = Photon::no_state;
  PathState path() const { return state == Photon::no_state ? PathState{} : PathState{state}; }  ///< see Photon::path

  const SceneObject* from(const Scene& scene) const { return luminaire < 0 ? nullptr : scene.luminaires()[size_t(luminaire)]; }

  /// l_0 m: the optical depth up to which no beam ends.
  static constexpr float certain_depth = 2;
  /// alpha s_s T(s) T(t) / P(s) [W/(m nm)], at the distance s along the beam, seen from the distance t along a camera ray that
  /// stays in the same medium.
  Spectrum light(float s, float t, const VolumeCoefficients&) const;
};

/// The beams of a step: work for Schedule::collect_everywhere<PhotonBeam>(beams.items(), beams).
struct BeamWalks {
  PhotonWalks walks;

  std::uint64_t items() const { return (walks.walks + item_size - 1) / item_size; }
  void operator()(std::uint64_t item, std::vector<PhotonBeam>&, Arena&) const;

 private:
  static constexpr std::uint64_t item_size = 512;
};

/// Stored beams that can be queried by rays: a bounding box tree over pieces of beams.
class BeamMap {
 public:
  /// Builds the tree on all cores, for queries with beams nearer to the ray than `radius` [m].
  void build(std::vector<PhotonBeam>&&, float radius);

  size_t size() const { return beams_.size(); }
  /// [bytes]
  size_t memory() const {
    return beams_.capacity() * sizeof(PhotonBeam) + pieces_.capacity() * sizeof(Piece) + boxes_.capacity() * sizeof(Bounds3);
  }

  /// Calls `visit(beam, s, t, width)` for all beams near the ray's first `reach` [m], in a fixed order: s is the distance along
  /// the beam, t the distance along the ray, and width is 2 r sin, or for parallel beams pi r^2 / (t_1 - t_0) [m].
  template <class Visit>
  void along(const Ray& ray, float reach, NumberStream& numbers, const Visit& visit) const {
    if (pieces_.empty()) return;
    const Vector3& d = ray.direction;
    const Vector3 inverse{1 / d.x, 1 / d.y, 1 / d.z};
    struct Subtree {
      std::uint32_t begin, end;
      std::uint64_t node;
    };
    std::array<Subtree, 64> stack;
    stack[0] = {0, std::uint32_t(pieces_.size()), 0};
    for (int waiting = 1; waiting > 0;) {
      const Subtree at = stack[size_t(--waiting)];
      if (!goes_through(boxes_[at.node], ray.origin, inverse, reach)) continue;
      if (at.end - at.begin > PointTree::leaf) {
        const std::uint32_t middle = at.begin + (at.end - at.begin) / 2;
        stack[size_t(waiting++)] = {middle, at.end, 2 * at.node + 2};
        stack[size_t(waiting++)] = {at.begin, middle, 2 * at.node + 1};
        continue;
      }
      for (std::uint32_t i = at.begin; i < at.end; ++i)
        if (const Passage p = passage(pieces_[i], ray, reach, numbers); p.width > 0)
          visit(beams_[pieces_[i].beam], p.s, p.t, p.width);
    }
  }

 private:
  struct Piece {
    std::uint32_t beam;
    float from, to;  ///< [m] along the beam
  };
  struct Passage {
    float s, t;
    float width = 0;  ///< [m]; 0: the beam does not contribute
  };

  static bool goes_through(const Bounds3& box, const Point3& origin, const Vector3& inverse, float reach) {
    float near = 0, far = reach;
    for (int axis = 0; axis < 3; ++axis) {
      const float a = (box.low[axis] - origin[axis]) * inverse[axis], b = (box.high[axis] - origin[axis]) * inverse[axis];
      // For a ray within a face of the box, a or b is 0 / 0 and the box may count as missed. Nothing is lost: the box is larger
      // by the radius than all beams in it.
      near = std::max(near, std::min(a, b));
      far = std::min(far, std::max(a, b));
    }
    return near <= far;
  }
  Passage passage(const Piece&, const Ray&, float reach, NumberStream&) const;
  Passage passage_of_parallel(const Piece&, const Ray&, float reach, NumberStream&) const;
  void cut(double longest);
  Bounds3 bound(size_t begin, size_t end, size_t node);

  std::vector<PhotonBeam> beams_;
  std::vector<Piece> pieces_;   // in the order of the tree's leaves
  std::vector<Bounds3> boxes_;  // of the tree's nodes, enlarged by the radius on all sides
  float radius_ = 0;            // r [m]
};

}  // namespace etendue
