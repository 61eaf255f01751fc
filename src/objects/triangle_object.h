#pragma once
// What objects made of triangles share: meshes and polygons.

#include <memory>
#include <mutex>

#include "etendue/scene_object.h"
#include "etendue/shader.h"  // objects own shaders
#include "lightsamplers/light_tree.h"
#include "mesh_data.h"

namespace etendue {

class EmbreeTriangles;

/// A still object keeps its triangles in the coordinates of the containing scene, so that nothing is transformed while
/// rendering; a moving one in its own. Barycentric coordinates u and v of a hit belong to a triangle's second and third
/// corner.
class TriangleObject : public SceneObject {
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
  float area_density(const SurfacePoint&) const override;
  SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const override;
  float visible_density(const Point3& from, const Vector3& direction, const SurfacePoint&) const override;
  NormalCone normals() const override;
  bool closed() const override;
  std::optional<TriangleView> triangles() const override;

 protected:
  /// Takes triangles in the object's coordinates; to be called by prepare.
  void adopt(MeshData);

 private:
  struct Corners {
    Point3 p[3];
  };
  /// A triangle's corners in the coordinates of the containing scene.
  Corners corners(std::uint32_t primitive, float time) const;
  void fill(std::uint32_t primitive, float u, float v, float time, SurfacePoint&) const;
  /// Chooses a triangle by its area in the stored coordinates; `x` becomes a fresh number in [0, 1).
  std::uint32_t choose(float& x, float other) const;
  float stored_area(std::uint32_t primitive) const;
  /// The same as seen from a point, by the tree when there is one.
  std::uint32_t choose_visible(const Point3& from, Point2& u, float& chance) const;
  float visible_chance(const Point3& from, std::uint32_t primitive) const;
  void build_light_tree();
  const std::vector<double>& cumulative_areas() const;
  const EmbreeTriangles& accelerator() const;
  TriangleView view() const { return {{mesh_.positions.data(), vertices_}, mesh_.triangles}; }

  struct Plane {
    Normal3 normal;
    float error = 0;  // see SurfacePoint
  };
  static Plane plane_of(const Point3&, const Vector3& e1, const Vector3& e2);

  std::vector<Plane> planes_;  // in the stored coordinates; none for large meshes
  MeshData mesh_;              // its positions have one more at the end: padding, which Embree asks for
  size_t vertices_ = 0;
  LightTree light_tree_;  // of a still luminaire of many triangles
  double area_ = 0;       // in the stored coordinates [m^2]
  Bounds3 bounds_, stored_bounds_;

  // Made when first asked for: few objects need them.
  struct Lazy {
    std::once_flag table_made, accelerator_made, closed_known;
    std::vector<double> cumulative;  // of the triangles' areas, normalised
    std::unique_ptr<EmbreeTriangles> accelerator;
    bool closed = false;
  };
  std::unique_ptr<Lazy> lazy_;
};

}  // namespace etendue
