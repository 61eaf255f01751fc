#pragma once
// Specular chains: the way of light from a target (a point of a luminaire, or a direction to one at infinity) to a vertex b,
// the receiver, by specular vertices s_1 … s_m, of which s_1 is next to b.
//
// The direction w at b and the lobes at s_1 … s_m determine the chain: a ray is traced. Let D(w) be the direction in which it
// leaves s_m, and d(w) the direction from s_m to the target. The chain that ends at the target is a root of
//     r(w) = D(w) - d(w),
// two equations in two unknowns, which Newton's method solves (the specular manifold, with w as its coordinates: Jakob &
// Marschner 2012, "Manifold exploration"; Zeltner, Georgiev & Jakob 2020, "Specular manifold sampling for rendering
// high-frequency caustics and glints", section 4.2; r is the difference of angles of their section 5.1 at the last vertex,
// while the others are fulfilled by tracing the ray).
//
// Derivatives are those of rays (Igehy 1999, "Tracing ray differentials"). With P the last vertex, N its shading normal and Ng
// its geometric one, t the length of a segment and c = -D . N, for a change of w
//     on the way to a surface   dP' = dP + t dD - D ((dP + t dD) . Ng) / (D . Ng)
//     at a mirror               D' = D + 2 c N
//     at a boundary             D' = D / eta + (c / eta - c') N,   c'^2 = 1 - (1 - c^2) / eta^2
// by the product rule, where dN follows from dP. The derivatives of normals are differences between normals at points nearby
// on the same primitive: they exist for all shapes, interpolated normals and bump maps. With R the distance from s_m to the
// target,
//     J = dr/dw = dD + dP / R   (across d)
// is 2 x 2, and the chain spreads a solid angle dw over the area |det J| R^2 dw across d, or at infinity over the solid angle
// |det J| dw.
//
// Not all specular scattering can be followed. Left out are surfaces that have null scattering beside other lobes (masks, thin
// panes), lobes of several directions (gratings), directions that the shading normal's correction has mirrored, total
// reflection at a refracting surface whose shading normal differs from the geometric one, and points where the normal has no
// derivative. Whether a chain can be followed is a function of the chain alone.

#include <array>
#include <optional>

#include "etendue/mesh_facts.h"
#include "etendue/transport/path_vertex.h"

namespace etendue {

/// The specular lobes of a chain's vertices, from the receiver on.
struct ChainLobes {
  static constexpr int longest = 16;
  std::array<Lobe, longest> at{};
  int count = 0;

  void add(Lobe lobe) { at[size_t(count++)] = lobe; }
  bool operator==(const ChainLobes& other) const {
    if (count != other.count) return false;
    for (int i = 0; i < count; ++i)
      if (at[size_t(i)] != other.at[size_t(i)]) return false;
    return true;
  }
};

/// Where a chain leads.
struct ChainTarget {
  Point3 position;    ///< of a finite one
  Vector3 direction;  ///< unit, of one at infinity
  bool infinite = false;
};

/// A chain by which the receiver sees the target.
struct ChainSolution {
  Vector3 direction;  ///< unit, w
  ChainLobes lobes;
  double jacobian[2][2] = {};  ///< J, along the axes of Frame(w) and Frame(d)
  double determinant = 0;
  float distance = 0;  ///< R [m]; of a target at infinity 1

  /// Whether two searches found the same root, up to rounding. Where a chain has two solutions close to each other the
  /// determinant has different signs.
  bool same(const ChainSolution&) const;
};

/// Traces a chain, vertex by vertex.
class ChainTracer {
 public:
  /// Wavelengths, numbers (for the transmittance of heterogeneous media) and arena are those of a sample. Secondary wavelengths
  /// are dropped on a copy.
  ChainTracer(const Scene& scene, const Wavelengths& wavelengths_, NumberStream& numbers, Arena& arena)
      : wavelengths(wavelengths_), scene_(scene), numbers_(numbers), arena_(arena), tracks_(scene.has_interiors()) {}

  /// Starts with the ray that leaves a receiver in a direction.
  void begin(const PathVertex& receiver, const Vector3& direction);
  /// Starts with a ray that left one, and the media along it.
  void begin(const Ray&, const MediumStack&);
  /// Follows the ray to the next surface; those that are hidden by priority or scatter null alone are passed. False: there is
  /// none, or it cannot be part of a chain.
  bool meet();
  /// Scatters the ray at that surface by a specular lobe. False: the surface lacks the lobe, or it cannot be followed.
  bool scatter_by(Lobe);
  /// The specular lobes that scatter light there; without transmission where reflection is total.
  Lobes lobes_here() const;
  /// Whether the ray is in a refracting body.
  bool inside() const { return tracks_ && media_.current() && has_own_index(*media_.current()); }
  /// All of a chain. False: it cannot be followed.
  bool follow(const ChainLobes&);
  /// Whether nothing is between the last vertex and a point of a luminaire (for a target at infinity, in that direction);
  /// multiplies `weight` by the transmittance.
  bool reaches(const SurfacePoint& luminaire, const ChainTarget&);

  /// Whether derivatives are computed: with differences of normals to one side, for steps of Newton's method, or as exactly as
  /// they can be.
  enum class Derivatives : std::uint8_t { none, approximate, exact };
  Derivatives derivatives = Derivatives::none;
  bool attenuates = false;  ///< whether `weight` includes the transmittance of media

  Ray ray;                  ///< leaves the last vertex
  Point3 from;              ///< the last vertex
  Spectrum weight{1.0f};    ///< radiance at the receiver over radiance that comes to the last vertex along the ray
  float share = 1;          ///< the fraction of the hero wavelength's power that the lobes scatter
  Wavelengths wavelengths;  ///< those that are left
  Vector3 position_change[2], direction_change[2];                ///< derivatives of `from` [m] and of the ray's direction by w
  std::array<const SceneObject*, ChainLobes::longest> objects{};  ///< of the vertices
  int vertices = 0;

 private:
  bool pass_null();
  void cross();
  bool differentiate(Lobe, const Vector3& to, float eta);
  bool normal_derivatives(const Frame& tangent, Vector3 change[2]) const;
  bool normal_differences(const Frame& tangent, float step, Vector3 change[2]) const;
  bool normal_on_triangle(const TriangleView&, const Frame& tangent, float step, Vector3 change[2]) const;
  std::optional<SurfacePoint> on_same_primitive(const Vector3& off, float reach) const;
  Normal3 model_normal(SurfacePoint&) const;

  const Scene& scene_;
  NumberStream& numbers_;
  Arena& arena_;
  const bool tracks_;
  MediumStack media_;
  Hit hit_;
  SurfacePoint point_;
  const Scatter* scatter_ = nullptr;
  SurfacePoint left_;  // the last vertex
};

/// r and J of a chain that a tracer has followed with derivatives. `solution` gets all but the direction and the lobes. Returns
/// |r|.
double chain_residual(const ChainTracer&, const ChainTarget&, ChainSolution& solution, double r[2]);

/// Newton's method from a direction. Empty: no root was found. `derivatives`: those at the root.
std::optional<ChainSolution> solve_chain(const Scene&, const PathVertex& receiver, const Wavelengths&, NumberStream&, Arena&,
                                         const Vector3& guess, const ChainLobes&, const ChainTarget&,
                                         ChainTracer::Derivatives derivatives);

}  // namespace etendue
