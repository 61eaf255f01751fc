#pragma once
// Beams of photons: what walks from luminaires carry through media, kept as the whole way and not as the points where it is
// scattered (Jarosz, Nowrouzezahrai, Sadeghi & Jensen 2011, "A comprehensive theory of volumetric radiance estimation using
// photon points and beams"; Jarosz, Nowrouzezahrai, Thomas, Sloan & Zwicker 2011, "Progressive photon beams"; Křivánek et al.
// 2014, "Unifying points, beams, and paths").
//
// Of n walks, one goes into a medium at o in the direction e, carrying alpha. Before it is scattered it brings alpha T(s) to
// the place o + s e, with T(s) = exp(-s_t s). So for any h(x, w) the integral of light over the medium is in the mean
//     int int L(x, w) h(x, w) dw dx  =  sum over beams  1 / n  int alpha T(s) h(o + s e, e) ds.
// Radiance scattered into a ray of the camera x(t) = c + t d is
//     L = int T(t) s_s int phase L(x(t), w) dw dt,
// which a beam, having no width, contributes to only when it meets the ray. Therefore it is spread evenly by r to either side
// along u = e x d / sin, the line across both, which makes it a sheet in which light goes at alpha T(s) / (2 r) per metre of
// width. The ray goes through that sheet at one place, if the beam and the ray pass each other at less than r, and at the angle
// whose sine is that between e and d; int dt of it is 1 / sin:
//     L = sum over beams that pass at less than r   alpha / n  s_s phase(e, d) T(s) T(t) / (2 r sin(e, d)).
// This blurs along one dimension, so its variance grows as 1 / r and radii may shrink faster than those of points:
//     r_{i+1} = r_i (i + a) / (i + 1)
// leaves the mean over steps a variance that falls as N^-a (Knaus & Zwicker 2011, for one dimension) and a bias, of r^2 where
// light is smooth, as N^(-2 (1 - a)). 1 / sin does no harm: the chance to pass the ray within r is in proportion to sin.
//
// Beams that are parallel to the ray, as of the sun seen from below, form no sheet. With sin < 0.001 the beam is spread over
// the disc of radius r across it instead, and the ray lies within it from t_0 to t_1:
//     L = alpha / n  s_s phase int_{t_0}^{t_1} T(s) T(t) dt / (pi r^2),
// the integral being estimated at one t. Of these, if there are any, the variance grows as 1 / r^2, so a > 1/2 is needed for
// its mean to fall.
//
// Wavelengths. All paths of a step share them; alpha, s_s, s_t, and so T, are those of each, and the product above is. Nothing
// is drawn for one wavelength that others would have to make up for, except where a beam ends: as far as l_0 it goes for sure
// (a long beam), from there on by chance (a short one), with P(s) = exp(-m (s - l_0)) for m the least extinction of the
// wavelengths that the medium scatters; what is left of it counts alpha / P(s). No weight exceeds T(l_0).

#include "etendue/transport/photons.h"

namespace etendue {

/// Goes through a medium that is the same everywhere.
struct PhotonBeam {
  Spectrum throughput;  ///< alpha at its origin [W/nm]
  Point3 origin;
  float length = 0;                      ///< [m]
  Vector3 direction;                     ///< unit, along which light goes
  float least_extinction = 0;            ///< m [1/m]
  const VolumeShader* volume = nullptr;  ///< the medium's
  std::uint32_t vertices : 29 = 0;       ///< of its walk before what it is scattered at; 1: it comes straight from a luminaire
  bool single : 1 = false;               ///< it holds the hero wavelength alone
  bool caustic : 1 = false;              ///< it came from the luminaire by specular scattering alone, once or more
  std::int32_t luminaire = -1;           ///< SceneObject::luminaire_index of that

  const SceneObject* from(const Scene& scene) const { return luminaire < 0 ? nullptr : scene.luminaires()[size_t(luminaire)]; }

  /// l_0 m: what the chance to end begins after.
  static constexpr float certain_depth = 2;
  /// alpha s_s T(s) T(t) / P(s) [W/(m nm)], seen from a distance t along a ray that is in the same medium all the way.
  Spectrum light(float s, float t, const VolumeCoefficients&) const;
};

/// The beams of a step: work for Schedule::collect<PhotonBeam>(beams.items(), beams).
struct BeamWalks {
  PhotonWalks walks;

  std::uint64_t items() const { return (walks.walks + item_size - 1) / item_size; }
  void operator()(std::uint64_t item, std::vector<PhotonBeam>&, Arena&) const;

 private:
  static constexpr std::uint64_t item_size = 512;
};

/// Beams that can be asked for by rays that pass them: a tree of boxes around pieces of them.
class BeamMap {
 public:
  /// Builds it on all cores, for rays that pass at less than `radius` [m].
  void build(std::vector<PhotonBeam>&&, float radius);

  size_t size() const { return beams_.size(); }
  /// [bytes]
  size_t memory() const {
    return beams_.capacity() * sizeof(PhotonBeam) + pieces_.capacity() * sizeof(Piece) + boxes_.capacity() * sizeof(Bounds3);
  }

  /// Calls `visit(beam, s, t, width)` for all that pass the ray's first `reach` [m], in a fixed order; at the distances s along
  /// the beam and t along the ray, with 2 r sin or pi r^2 / (t_1 - t_0) [m].
  template <class Visit>
  void along(const Ray& ray, float reach, NumberStream& numbers, const Visit& visit) const {
    if (pieces_.empty()) return;
    const Vector3& d = ray.direction;
    const Vector3 inverse{1 / d.x, 1 / d.y, 1 / d.z};
    struct Range {
      std::uint32_t begin, end;
      std::uint64_t node;
    };
    std::array<Range, 64> stack;
    stack[0] = {0, std::uint32_t(pieces_.size()), 0};
    for (int waiting = 1; waiting > 0;) {
      const Range at = stack[size_t(--waiting)];
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
    float from, to;  ///< [m] along it
  };
  struct Passage {
    float s, t;
    float width = 0;  ///< [m]; 0: they do not pass
  };

  static bool goes_through(const Bounds3& box, const Point3& origin, const Vector3& inverse, float reach) {
    float near = 0, far = reach;
    for (int axis = 0; axis < 3; ++axis) {
      const float a = (box.low[axis] - origin[axis]) * inverse[axis], b = (box.high[axis] - origin[axis]) * inverse[axis];
      // Of a ray that lies in the side of a box one of them is 0 / 0, and the box may count as missed. That loses nothing: it
      // is larger by the radius than all beams in it.
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
  std::vector<Piece> pieces_;   // in the tree's order
  std::vector<Bounds3> boxes_;  // of its nodes, larger by the radius on all sides
  float radius_ = 0;            // r [m]
};

}  // namespace etendue
