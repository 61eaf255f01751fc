#pragma once
// TriangleObject: base class of shapes made of triangles, such as meshes and polygons.

#include <memory>
#include <mutex>

#include "etendue/mesh_facts.h"
#include "geometry/light_tree.h"
#include "geometry/moving_triangles.h"
#include "geometry/numbered_parts.h"
#include "mesh_data.h"

namespace etendue {

class EmbreeTriangles;

/// Normalizes normals (or sets them to zero), and appends the padding position that Embree requires.
void make_shareable(MeshData&);

/// Vertex positions at several keyframes. Between keys, vertices move linearly; before the first and after the last key they
/// rest.
struct MeshMotion {
  std::vector<float> times;       ///< [s], increasing; at least two, or none if nothing moves
  std::vector<Point3> positions;  ///< of all vertices at the first key, then at the second, and so on; then one as padding
  std::vector<Normal3> normals;   ///< likewise, without padding; unit or zero; or empty
  bool moves() const { return !times.empty(); }
};

/// An object with a static transform stores its triangles in the coordinates of the containing scene, so that nothing is
/// transformed during rendering; an object with an animated transform stores them in object space. Vertices of deforming meshes
/// are interpolated at the time of the ray. The barycentric coordinates u and v of a hit belong to a triangle's second and
/// third corner.
class TriangleObject : public SceneObject, public MeshFacts, public NumberedParts {
 public:
  TriangleObject();
  ~TriangleObject() override;

  Bounds3 bounds() const override { return bounds_; }
  bool intersect(const Ray&, Hit&) const override;
  bool occludes(const Ray&) const override;
  void surface_point(const Ray&, const Hit&, SurfacePoint&) const override;
  void tangents(SurfacePoint&) const override;
  float area(float time) const override;
  SurfaceSample sample_area(Point2 u, float time) const override;
  float area_pdf(const SurfacePoint&) const override;
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override;
  float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint&) const override;
  LuminaireBounds luminaire_bounds() const override { return {bounds_, normals()}; }
  bool closed() const override;
  const MeshFacts* mesh_facts() const override { return this; }
  MeshNotes notes() const override;
  std::uint64_t open_edges() const override;
  std::optional<TriangleView> triangles() const override;
  /// The number of triangles, moving or not.
  std::uint64_t part_count() const override { return mesh_.triangles.size(); }
  /// The triangles of a deforming mesh with a static transform.
  std::optional<MovingTriangleView> moving_triangles() const;
  void prepare_again() override { prepare_light(); }

 protected:
  /// Takes over triangles in object space; to be called by prepare.
  void adopt(MeshData);
  /// The same for a mesh shared with other objects: its normals must be unit vectors or zero, and its positions must have the
  /// padding that Embree requires (make_shareable). With a motion, the motion's positions and normals are used.
  void adopt(std::shared_ptr<const MeshData>, MeshMotion = {});
  /// The vertex indices of a triangle, in the order to which u and v refer.
  const std::array<std::uint32_t, 3>& corner_indices(std::uint32_t primitive) const { return mesh_.triangles[primitive]; }

 private:
  /// Up to this number of triangles are tested one by one, unless a scene traverses them itself.
  static constexpr size_t few = 8;

  /// Applies a static transform to the stored triangles.
  void bake(const Transform&);

  NormalCone normals() const;
  struct Corners {
    Point3 p[3];
  };
  /// Whether anything changes with time.
  bool moves() const { return transform.animated() || motion_.moves(); }
  using Moment = MovingTriangleView::Moment;
  Moment moment(float time) const { return moving_view().moment(time); }
  Corners stored_corners(std::uint32_t primitive, const Moment& m) const {
    const auto& t = mesh_.triangles[primitive];
    const MovingTriangleView view = moving_view();
    return {{view.position(t[0], m), view.position(t[1], m), view.position(t[2], m)}};
  }
  Vector3 stored_normal(std::uint32_t corner, const Moment&) const;
  float motion_error(std::uint32_t primitive, const Moment&, const Normal3&) const;
  /// A triangle's vertices in the coordinates of the containing scene.
  Corners corners(std::uint32_t primitive, float time) const;
  void fill(std::uint32_t primitive, float u, float v, float time, SurfacePoint&) const;
  template <bool moving>
  void fill_at(std::uint32_t primitive, float u, float v, float time, SurfacePoint&) const;
  /// Chooses a triangle in proportion to its area in the stored coordinates; `x` is rescaled for reuse as a random number in
  /// [0, 1).
  std::uint32_t choose(float& x, float other) const;
  /// A triangle's area in the stored coordinates; for a deforming mesh the mean over its keys.
  float stored_area(std::uint32_t primitive) const;
  /// Chooses a triangle for a reference point, by the light tree if there is one; `chance` receives the probability.
  std::uint32_t choose_visible(const Point3& from, Point2& u, float& chance) const;
  float visible_chance(const Point3& from, std::uint32_t primitive) const;
  void prepare_light();
  void build_light_tree();
  const std::vector<double>& cumulative_areas() const;
  const EmbreeTriangles& accelerator() const;
  TriangleView view() const { return {mesh_.positions.first(vertices_), mesh_.triangles}; }
  /// The triangles with the motion's keys, if any.
  MovingTriangleView moving_view() const { return {mesh_.positions, vertices_, mesh_.triangles, motion_.times}; }

  struct Plane {
    Normal3 normal;
    float error = 0;   // see SurfacePoint::error
    float margin = 0;  // least barycentric coordinate of points: see `border`
  };
  static Plane plane_of(const Point3&, const Vector3& e1, const Vector3& e2);

  std::vector<Plane> planes_;  // in the stored coordinates; empty for large or deforming meshes
  struct {
    std::span<const Point3> positions;  // with padding; for a deforming mesh those of all keys
    std::span<const std::array<std::uint32_t, 3>> triangles;
    std::span<const Normal3> normals;
    std::span<const Point2> uvs;
  } mesh_;
  // The uvs and the uv indices of triangles; without uvs they point to constant tables that give (u, v) itself. This avoids a
  // branch that would be mispredicted, as some objects have uvs and others do not.
  const Point2* uvs_ = nullptr;
  const std::array<std::uint32_t, 3>* uv_corners_ = nullptr;
  std::uint32_t uv_mask_ = 0;
  std::shared_ptr<const MeshData> data_;  // the mesh as adopted
  MeshData changed_;                      // copies changed by a static transform
  MeshMotion motion_;
  size_t vertices_ = 0;
  LightTree light_tree_;  // for a static luminaire of many triangles
  double area_ = 0;       // the sum of stored_area [m^2]
  Bounds3 bounds_, stored_bounds_;

  // Computed at the first use, since few objects need them.
  struct Lazy {
    std::once_flag table_made, accelerator_made, closed_known;
    std::vector<double> cumulative;  // cumulative areas of the triangles, normalized
    std::unique_ptr<EmbreeTriangles> accelerator;
    bool closed = false;
  };
  std::unique_ptr<Lazy> lazy_;
};

}  // namespace etendue
