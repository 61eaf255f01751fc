#pragma once
// Photons: vertices of walks from luminaires, kept where they scatter (Jensen 1996, "Global illumination using photon maps").
//
// A photon p of n walks carries alpha_p, what its walk brings to its place over the walk's density. Where the light at x is
// wanted, all photons within r are taken to have come there:
//     L(x, w) = sum_p f(x, w, w_p) alpha_p / (n pi r^2)                     on surfaces,
//     L(x, w) = sum_p phase(x, w, w_p) alpha_p / (n 4/3 pi r^3)             in media, where alpha_p holds s_s of x_p
// (Jensen 2001, sections 7.1 and 10.2.2). The error is a blur of width r, a bias, and the chance of few photons, a variance.
// With areas pi r^2 (in media volumes) that shrink from step to step i = 1, 2, … as
//     r_{i+1}^2 = r_i^2 (i + a) / (i + 1),   0 < a < 1,
// the mean over steps goes to the truth: its variance falls as N^-a, its bias as N^-(1-a) (Knaus & Zwicker 2011, "Progressive
// photon mapping: a probabilistic approach").
//
// Photons and what they light must be of one colour and one moment: all paths of a step share their wavelengths and their time.

#include "etendue/transport/bidirectional_weight.h"
#include "etendue/transport/point_tree.h"
#include "etendue/transport/projection_map.h"

namespace etendue {

struct Photon {
  Point3 position;
  Vector3 out;                              ///< unit, to the vertex it came from
  std::array<std::int16_t, 3> normal = {};  ///< of the surface, times 32767
  Spectrum throughput;                      ///< alpha_p, flux [W/nm]
  PhotonWeight weight;                      ///< where it was asked for
  std::uint32_t vertices : 29 = 0;          ///< of its walk before it; 1: it came straight from a luminaire
  bool single : 1 = false;                  ///< it holds the hero wavelength alone
  bool in_medium : 1 = false;
  bool caustic : 1 = false;     ///< it came from the luminaire by specular scattering alone, once or more
  std::int32_t luminaire = -1;  ///< SceneObject::luminaire_index of that

  const SceneObject* from(const Scene& scene) const { return luminaire < 0 ? nullptr : scene.luminaires()[size_t(luminaire)]; }

  Vector3 surface_normal() const { return Vector3{float(normal[0]), float(normal[1]), float(normal[2])} / 32767.0f; }
};

/// What a walk carries that photons are to light: which wavelengths they have in common.
struct Carrying {
  const Wavelengths& wavelengths;
  bool single = false;  ///< the hero alone, which made up for the others
  int lane = -1;        ///< of the step's wavelengths that one; -1: the first
  float branches = 1;   ///< of how many such walks, one for each of so many wavelengths, this is one
};
/// Light as such a walk sees it: both have made up for the wavelengths they dropped, and once is enough. `single`: the light is
/// of the hero alone.
Spectrum carried(const Spectrum& light, bool single, const Carrying&);
/// alpha_p.
inline Spectrum carried(const Photon& p, const Carrying& to) { return carried(p.throughput, p.single, to); }

/// What of a photon's light goes on from a vertex near it: f alpha [W/(sr nm)] on a surface; in a medium phase alpha / s_s
/// [W m/(sr nm)], since the throughput of the walk that came there holds s_s, too. To be divided by n pi r^2 or n 4/3 pi r^3.
Spectrum scattered_from_photon(const PathVertex& at, const Photon&, const Carrying&);

/// A surface's normal on the side of a direction.
inline Vector3 on_side(const Vector3& normal, const Vector3& direction) {
  return dot(normal, direction) > 0 ? normal : -normal;
}

/// Whether something stands between two near places, so that light of the one does not come to the other: a wall on a floor
/// that two rooms share. Looked at from a tenth of `radius`, their distance at most, above both surfaces on the side of the
/// normals, so that their own shape hides little; the smaller the radius, the less. In media normals are zero.
bool photon_occluded(const Scene&, const Point3& a, const Vector3& normal_a, float time, const Point3& b,
                     const Vector3& normal_b, float radius);
/// The same of a photon within `radius` of a vertex.
inline bool photon_occluded(const Scene& scene, const PathVertex& v, const Photon& p, float radius) {
  if (p.in_medium) return photon_occluded(scene, v.point.position, {}, v.point.time, p.position, {}, radius);
  return photon_occluded(scene, v.point.position, on_side(Vector3(v.point.normal), p.out), v.point.time, p.position,
                         on_side(p.surface_normal(), p.out), radius);
}

/// Photons that can be asked for by their places.
class PhotonMap {
 public:
  /// Builds it on all cores. Takes a third of the photons' memory for itself while it does, and a seventh after.
  void build(std::vector<Photon>&&);

  size_t size() const { return photons_.size(); }
  /// [bytes]
  size_t memory() const { return photons_.capacity() * sizeof(Photon) + tree_.memory(); }

  /// Calls `visit(photon)` for all nearer than `radius`, in a fixed order.
  template <class Visit>
  void within(const Point3& p, float radius, const Visit& visit) const {
    tree_.within(p, radius, [&](std::uint32_t i, float) { visit(photons_[i]); });
  }
  const PointTree& tree() const { return tree_; }
  const Photon& operator[](size_t i) const { return photons_[i]; }

 private:
  std::vector<Photon> photons_;
  PointTree tree_;
};

/// Which photons are kept.
enum class PhotonKinds : std::uint8_t { all, caustics, no_caustics };

/// The photons of a step: work for Schedule::collect<Photon>(walks.items(), walks).
struct PhotonWalks {
  const RenderContext& context;
  const LightSampler& lights;
  const NumberSource& numbers;
  std::uint32_t step = 0;  ///< its number: each has other walks
  Wavelengths wavelengths;
  float time = 0;           ///< [s]
  std::uint64_t walks = 0;  ///< n
  SubpathLimits limits;
  PhotonKinds kinds = PhotonKinds::all;
  const ProjectionMap* targets = nullptr;    ///< light goes towards these alone
  int fewest_vertices = 1;                   ///< before a photon: 2 leaves out those straight from luminaires
  int fewest_in_media = 1;                   ///< the same in media
  bool in_homogeneous_media = true;          ///< whether they are kept in media that are the same everywhere
  const StrategyWeights* against = nullptr;  ///< photons have weights against these other strategies; null: none
  double kept = 1;  ///< the chance of a photon to be kept; with fewer photons n counts that part of the walks
  const std::atomic<bool>* abort = nullptr;

  std::uint64_t items() const { return (walks + item_size - 1) / item_size; }
  void operator()(std::uint64_t item, std::vector<Photon>&, Arena&) const;

 private:
  static constexpr std::uint64_t item_size = 512;
};

/// The median width of a pixel where it is first seen [m]: what radii are measured by. Depends on the description alone.
float seen_pixel_width(const RenderContext&);

/// (r_i / r_1)^2 of step i = number + 1: the product of (k + a) / (k + 1) for k = 1 … i - 1.
double shrunk_area(std::uint32_t number, double a);

}  // namespace etendue
