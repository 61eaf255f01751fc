#pragma once
// Photons: the vertices of light subpaths, stored where they are scattered (Jensen 1996, "Global illumination using photon
// maps").
//
// Of n light subpaths, a photon p carries the flux alpha_p [W/nm], the throughput of its subpath. The light scattered at x is
// estimated from all photons within the radius r, as if they had arrived at x:
//     L(x, w) = sum_p f(x, w, w_p) alpha_p / (n pi r^2)                     on surfaces,
//     L(x, w) = sum_p phase(x, w, w_p) alpha_p / (n 4/3 pi r^3)             in media, where alpha_p includes s_s of x_p
// (Jensen 2001, sections 7.1 and 10.2.2). The bias is a blur of width r, and the variance comes from the small number of
// photons. With areas pi r^2 (in media volumes) that shrink from step to step i = 1, 2, … as
//     r_{i+1}^2 = r_i^2 (i + a) / (i + 1),   0 < a < 1,
// the mean over the steps converges to the exact radiance: its variance falls as N^-a, its bias as N^-(1-a) (Knaus & Zwicker
// 2011, "Progressive photon mapping: a probabilistic approach").
//
// Photons and the paths that gather them must agree in wavelengths and time: all paths of a step share both.

#include "etendue/transport/bidirectional_weight.h"
#include "etendue/transport/light_groups.h"
#include "etendue/transport/point_tree.h"
#include "etendue/transport/projection_map.h"

namespace etendue {

/// Photons and beams store the number of their subpath's vertices in 29 bits, beside flags.
inline constexpr std::uint32_t vertices_mask = (1u << 29) - 1;

struct Photon {
  Point3 position;
  Vector3 out;                              ///< unit, to the vertex before
  std::array<std::int16_t, 3> normal = {};  ///< of the surface, times 32767
  std::uint16_t state = no_state;           ///< see `path`
  Spectrum throughput;                      ///< alpha_p, flux [W/nm]
  PhotonWeight weight;                      ///< computed if PhotonWalks::against is set
  std::uint32_t vertices : 29 = 0;          ///< of its subpath before it; 1: the light comes directly from a luminaire
  bool hero_only : 1 = false;               ///< it carries the hero wavelength alone
  bool in_medium : 1 = false;
  bool caustic : 1 = false;     ///< between it and the luminaire there are specular vertices only, and at least one
  std::int32_t luminaire = -1;  ///< SceneObject::luminaire_index of the luminaire; -1: none

  static constexpr std::uint16_t no_state = 0xffff;
  /// With light path expressions, the backward state of its subpath before it. Where that is a distribution, there is a photon
  /// for each state, with that part of the flux.
  PathState path() const { return state == no_state ? PathState{} : PathState{state}; }

  const SceneObject* from(const Scene& scene) const { return luminaire < 0 ? nullptr : scene.luminaires()[size_t(luminaire)]; }

  Vector3 surface_normal() const { return Vector3{float(normal[0]), float(normal[1]), float(normal[2])} / 32767.0f; }
};

/// The wavelengths of a walk that gathers photons.
struct GatheringWavelengths {
  const Wavelengths& wavelengths;
  bool hero_only = false;  ///< it carries the hero alone, with the weight of the dropped ones
  int lane = -1;           ///< the index of that wavelength among the step's wavelengths; -1: it is the first
  float branches = 1;      ///< the number of branches that the walk was split into, one per wavelength; 1: not split
};
/// Light in the wavelengths of such a walk. If light (`hero_only`: it has the hero alone) and walk have both dropped
/// wavelengths, both contain the factor spectrum_size, which must be applied once only.
Spectrum in_wavelengths(const Spectrum& light, bool hero_only, const GatheringWavelengths&);
/// alpha_p.
inline Spectrum in_wavelengths(const Photon& photon, const GatheringWavelengths& walk) {
  return in_wavelengths(photon.throughput, photon.hero_only, walk);
}

/// The light of a photon that a vertex near it scatters: f alpha [W/(sr nm)] on a surface, phase alpha / s_s [W m/(sr nm)] in a
/// medium, since the throughput of the walk that reached the vertex includes s_s as well. The caller divides by n pi r^2 or n
/// 4/3 pi r^3.
Spectrum scattered_from_photon(const PathVertex& at, const Photon&, const GatheringWavelengths&);

/// The normal of a surface on the side of a direction.
inline Vector3 on_side(const Vector3& normal, const Vector3& direction) {
  return dot(normal, direction) > 0 ? normal : -normal;
}

/// Whether a surface separates two nearby points, so that light at one does not arrive at the other: a wall on a floor that two
/// rooms share. The ray starts and ends at a tenth of `radius` (their maximum distance) above both surfaces, on the side of the
/// normals, so that the curvature of the surface itself occludes little; the smaller the radius, the less. In media the normals
/// are zero.
bool photon_occluded(const Scene&, const Point3& a, const Vector3& normal_a, float time, const Point3& b,
                     const Vector3& normal_b, float radius);
/// The same for a photon within `radius` of a vertex.
inline bool photon_occluded(const Scene& scene, const PathVertex& vertex, const Photon& photon, float radius) {
  if (photon.in_medium)
    return photon_occluded(scene, vertex.point.position, {}, vertex.point.time, photon.position, {}, radius);
  return photon_occluded(scene, vertex.point.position, on_side(Vector3(vertex.point.normal), photon.out), vertex.point.time,
                         photon.position, on_side(photon.surface_normal(), photon.out), radius);
}

/// Photons with a search structure over their positions.
class PhotonMap {
 public:
  /// Builds it on all cores. During the build this takes two fifths of the photons' memory, afterwards a seventh.
  void build(std::vector<Photon>&&);

  size_t size() const { return photons_.size(); }
  /// [bytes]
  size_t memory() const { return photons_.capacity() * sizeof(Photon) + tree_.memory(); }

  /// Calls `visit(photon)` for all photons within `radius`, in a fixed order.
  template <class Visit>
  void within(const Point3& centre, float radius, const Visit& visit) const {
    tree_.within(centre, radius, [&](std::uint32_t i, float) { visit(photons_[i]); });
  }
  const PointTree& tree() const { return tree_; }
  const Photon& operator[](size_t i) const { return photons_[i]; }

 private:
  std::vector<Photon> photons_;
  PointTree tree_;
};

/// The photons that are stored.
enum class PhotonKinds : std::uint8_t { all, caustics, no_caustics };

/// Traces the light subpaths of a step and stores their photons: work for Schedule::collect<Photon>(walks.items(), walks).
struct PhotonWalks {
  const RenderContext& context;
  const LightSampler& lights;
  const NumberSource& numbers;
  std::uint32_t step = 0;  ///< number of the step: each has other subpaths
  Wavelengths wavelengths;
  float time = 0;           ///< [s]
  std::uint64_t walks = 0;  ///< n
  SubpathLimits limits;
  PhotonKinds kinds = PhotonKinds::all;
  const ProjectionMap* targets = nullptr;    ///< light is emitted towards these objects only; null: everywhere
  int fewest_vertices = 1;                   ///< minimum number of vertices before a photon: 2 leaves out direct light
  int fewest_in_media = 1;                   ///< the same in media
  bool in_homogeneous_media = true;          ///< whether photons are stored in homogeneous media
  const StrategyWeights* against = nullptr;  ///< photons get weights against these other strategies; null: none
  double kept = 1;  ///< the probability with which a photon is stored; if below 1, n must be multiplied by it as well
  const std::atomic<bool>* abort = nullptr;
  const LightGroups* groups = nullptr;  ///< with light path expressions: photons get states

  std::uint64_t items() const { return (walks + item_size - 1) / item_size; }
  void operator()(std::uint64_t item, std::vector<Photon>&, Arena&) const;

 private:
  static constexpr std::uint64_t item_size = 512;
};

/// The median width of a pixel at the first surface [m], as a unit for radii. Depends on the scene description alone.
float seen_pixel_width(const RenderContext&);

/// (r_i / r_1)^2 of step i = number + 1: the product of (k + a) / (k + 1) for k = 1 … i - 1.
double shrunk_area(std::uint32_t number, double a);

}  // namespace etendue
