#pragma once
// What objects made of triangles share: meshes and polygons.

#include <memory>
#include <mutex>

#include "etendue/scene_object.h"
#include "etendue/shader.h"  // objects own shaders
#include "geometry/light_tree.h"
#include "geometry/moving_triangles.h"
#include "geometry/numbered_parts.h"
#include "mesh_data.h"

namespace etendue {

class EmbreeTriangles;

/// Makes normals unit vectors, or zero, and appends the position that Embree asks for behind the last.
void make_shareable(MeshData&);

/// Where the corners of triangles are at several times. Between these they move in straight lines; before the first and
/// after the last they rest.
struct MeshMotion {
  std::vector<float> times;       ///< [s], increasing; two at least, or none: nothing moves
  std::vector<Point3> positions;  ///< of all corners at the first time, then at the second, and so on; then one more
  std::vector<Normal3> normals;   ///< likewise (without the one more), unit or zero; or none
  bool moves() const { return !times.empty(); }
};

/// A still object keeps its triangles in the coordinates of the containing scene, so that nothing is transformed while
/// rendering; one whose transform moves in its own. Triangles that change their shape are where they are at the time that
/// is asked about. Barycentric coordinates u and v of a hit belong to a triangle's second and third
/// corner.
class TriangleObject : public SceneObject, public NumberedParts {
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
  NormalCone normals() const override;
  bool closed() const override;
  ObjectNotes notes() const override;
  std::uint64_t open_edges() const override;
  std::optional<TriangleView> triangles() const override;
  /// Triangles, whether they move or not.
  std::uint64_t part_count() const override { return mesh_.triangles.size(); }
  /// The triangles when they change their shape and nothing else moves.
  std::optional<MovingTriangleView> moving_triangles() const;
  void prepare_again() override { prepare_light(); }

 protected:
  /// Takes triangles in the object's coordinates; to be called by prepare.
  void adopt(MeshData);
  /// The same, shared with other objects: normals are unit vectors or zero, and the positions have one more at the end, which
  /// Embree asks for. With a motion, positions and normals are those of the motion.
  void adopt(std::shared_ptr<const MeshData>, MeshMotion = {});
  /// The corners of a triangle among those that were adopted, in the order in which u and v mean them.
  const std::array<std::uint32_t, 3>& corner_indices(std::uint32_t primitive) const { return mesh_.triangles[primitive]; }

 private:
  /// Up to this many triangles are tested one by one when a scene does not traverse them itself.
  static constexpr size_t few = 8;

  /// Replaces what was adopted by what a still transform makes of it.
  void bake(const Transform&);

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
  /// A triangle's corners in the coordinates of the containing scene.
  Corners corners(std::uint32_t primitive, float time) const;
  void fill(std::uint32_t primitive, float u, float v, float time, SurfacePoint&) const;
  template <bool moving>
  void fill_at(std::uint32_t primitive, float u, float v, float time, SurfacePoint&) const;
  /// Chooses a triangle by its area in the stored coordinates; `x` becomes a fresh number in [0, 1).
  std::uint32_t choose(float& x, float other) const;
  /// Of a motion the mean over its keys.
  float stored_area(std::uint32_t primitive) const;
  /// The same as seen from a point, by the tree when there is one.
  std::uint32_t choose_visible(const Point3& from, Point2& u, float& chance) const;
  float visible_chance(const Point3& from, std::uint32_t primitive) const;
  void prepare_light();
  void build_light_tree();
  const std::vector<double>& cumulative_areas() const;
  const EmbreeTriangles& accelerator() const;
  TriangleView view() const { return {mesh_.positions.first(vertices_), mesh_.triangles}; }
  /// Still ones as well.
  MovingTriangleView moving_view() const { return {mesh_.positions, vertices_, mesh_.triangles, motion_.times}; }

  struct Plane {
    Normal3 normal;
    float error = 0;   // see SurfacePoint
    float margin = 0;  // what barycentric coordinates of points are at least: see `border`
  };
  static Plane plane_of(const Point3&, const Vector3& e1, const Vector3& e2);

  std::vector<Plane> planes_;  // in the stored coordinates; none for large meshes
  struct {
    std::span<const Point3> positions;  // one more at the end; of a motion those of all keys
    std::span<const std::array<std::uint32_t, 3>> triangles;
    std::span<const Normal3> normals;
    std::span<const Point2> uvs;
  } mesh_;
  // Where the uvs of a triangle are, those of (u, v) themselves when there are none: which objects have uvs and which do not,
  // a branch could not guess.
  const Point2* uvs_ = nullptr;
  const std::array<std::uint32_t, 3>* uv_corners_ = nullptr;
  std::uint32_t uv_mask_ = 0;
  std::shared_ptr<const MeshData> data_;  // as they were adopted
  MeshData changed_;                      // what a still transform made of them
  MeshMotion motion_;
  size_t vertices_ = 0;
  LightTree light_tree_;  // of a still luminaire of many triangles
  double area_ = 0;       // the sum of stored_area [m^2]
  Bounds3 bounds_, stored_bounds_;

  // Made when first asked for: few objects need them.
  struct Lazy {
    std::once_flag table_made, accelerator_made, closed_known;
    std::vector<double> cumulative;  // of the triangles' areas, normalized
    std::unique_ptr<EmbreeTriangles> accelerator;
    bool closed = false;
  };
  std::unique_ptr<Lazy> lazy_;
};

}  // namespace etendue
