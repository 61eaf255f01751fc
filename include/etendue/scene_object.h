#pragma once
// SceneObject (a shape): where surfaces are, and how to choose points on them.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "etendue/core/ray.h"
#include "etendue/core/transform.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/emission_shader.h"
#include "etendue/volume_shader.h"

namespace etendue {

class Shader;

/// Directions within an angle of an axis: a bound of an object's normals.
struct NormalCone {
  Vector3 axis{0, 0, 1};  ///< unit
  float cosine = -1;      ///< of the angle; -1: any direction
};

/// A few hits: what lies in one place.
struct HitList {
  static constexpr int capacity = 8;
  Hit hits[capacity];
  int size = 0;
  /// More than `capacity` are forgotten.
  void add(const Hit& hit) {
    if (size < capacity) hits[size++] = hit;
  }
};

/// A point chosen on an object.
struct SurfaceSample {
  SurfacePoint point;
  float pdf = 0;  ///< per area [1/m^2] from sample_area; per solid angle [1/sr] from sample_visible; 0: nothing was found
  /// On an object without extent (a point light, a distant light), which no ray meets; see SceneObject::delta.
  bool delta = false;
  /// The point is infinitely far along `direction` from where it was asked for.
  bool infinite = false;
  Vector3 direction;  ///< unit, from the asking point; only from sample_visible
  float distance = 0;
};

/// Triangles in the coordinates of the containing scene, for scenes that traverse them directly. Embree reads 16 bytes at
/// each position: behind the last one, four more must be readable.
struct TriangleView {
  std::span<const Point3> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// A number for the name of an attribute of surfaces, the same as long as the program runs: maps and objects ask for it when
/// they are prepared, so that no names are compared while rendering.
int attribute_number(const std::string& name);

/// What is told to a user about an object, beside what its members say.
struct ObjectNotes {
  bool without_uv = false;              ///< of a mesh: it has no surface coordinates, so each triangle has its own
  std::vector<std::string> attributes;  ///< names of what its vertices have for AttributeMap
  std::vector<std::string> materials;   ///< names of materials that its file uses, and that are not read
};

class SceneObject : public Component {
 public:
  using Interface = SceneObject;
  using Parent = Component;
  static void describe(Description<SceneObject>&);

  /// From the object's own coordinates to those of the scene it is in. It counts these from a point near to what is seen, and
  /// the own ones from whatever the object chooses in `prepare` (see AnimatedTransform): so objects give bounds, hits and
  /// points as the renderer counts, from what their transform makes of own places.
  AnimatedTransform transform;
  Ref<Shader> shader;            ///< null: black
  Ref<EmissionShader> emission;  ///< null: no luminaire
  Ref<VolumeShader> interior;    ///< null: vacuum inside
  Sides sides = Sides::both;     ///< which sides scatter light; the other lets what goes straight on pass, and absorbs the rest
  int priority = 0;              ///< where objects overlap, the one of highest priority fills the space
  ShadingNormals shading_normals = ShadingNormals::folded;  ///< what becomes of light they would send through the surface
  bool visible_to_camera = true;                            ///< false: for rays of the camera it is not there

  bool luminaire() const { return bool(emission); }

  /// Bounds in the coordinates of the containing scene, over the whole time the shutter is open.
  virtual Bounds3 bounds() const = 0;
  /// The nearest intersection with t in (0, ray.maximum). On a hit fills `hit` (all of it) and returns true.
  virtual bool intersect(const Ray&, Hit&) const = 0;
  /// Whether anything lies on the ray.
  virtual bool occludes(const Ray& ray) const {
    Hit hit;
    return intersect(ray, hit);
  }
  /// Adds every hit on a short ray, where many surfaces may lie in one place. By default the nearest one.
  virtual void all_hits(const Ray& ray, HitList& list) const {
    Hit hit;
    if (intersect(ray, hit)) list.add(hit);
  }
  /// All that is known of the surface where a hit was found by a ray, tangents excepted.
  virtual void surface_point(const Ray&, const Hit&, SurfacePoint&) const = 0;
  /// Fills dpdu and dpdv of a point on this object.
  virtual void tangents(SurfacePoint&) const = 0;

  /// World area [m^2], at the given time.
  virtual float area(float time = 0) const = 0;
  /// A bound of the area's relative error; 0: a formula gives it.
  virtual float area_error(float /*time*/ = 0) const { return 0; }
  /// A point by area, with its density [1/m^2].
  virtual SurfaceSample sample_area(Point2 u, float time) const = 0;
  /// The density [1/m^2] with which sample_area gives a point.
  virtual float area_pdf(const SurfacePoint& p) const { return 1 / area(p.time); }
  /// A point that may be seen from `from` (only this object is considered), with its density [1/sr] there. By default
  /// by area, converted: p_omega = p_area * distance^2 / |cos|.
  virtual SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const;
  /// The density [1/sr] with which sample_visible gives a point, seen from `from` in `direction` (unit).
  virtual float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint&) const;

  /// Where light of a luminaire begins, over all times; nowhere for one at infinity.
  virtual Bounds3 luminaire_bounds() const { return bounds(); }
  /// A bound of the geometric normals, over all times.
  virtual NormalCone normals() const { return {}; }

  /// Encloses a volume: has an inside and an outside.
  virtual bool closed() const { return false; }
  /// Lies at infinity: never intersected, seen by rays that leave the scene; has no bounds.
  virtual bool infinite() const { return false; }
  /// Goes on for ever, as a plane does: rays meet it, but the size of the scene does not count it, and it cannot emit. Its
  /// bounds are a box as large as `endless`.
  virtual bool unbounded() const { return false; }
  static constexpr float endless = 1e9f;  ///< [m]
  /// Has no surface, and all of space for its inside; of those at infinity, which it is told of.
  virtual bool surrounds() const { return false; }
  /// Of such an object: how far its inside goes along a ray that meets nothing [m].
  virtual float surrounding_reach(const Ray&) const { return infinity; }
  /// Has no extent, so no ray ever meets it. A point stands for a sphere with a cross section of 1 m^2, shrunk: what its
  /// emission calls radiance, times 1 m^2, is its intensity [W/sr]; densities by area are then 1 per m^2 of that cross
  /// section, and densities by solid angle follow by distance^2, so that radiance over density is irradiance as for
  /// any other object. Its points have no normal (zero): directions are not measured against it. In the same way a single
  /// direction stands for a disc of 1 sr at infinity, with density 1.
  virtual bool delta() const { return false; }
  /// Tells an object at infinity the sphere around all finite ones; by Scene::prepare.
  virtual void enclose(const Point3& /*centre*/, float /*radius*/) {}
  /// The object as triangles, when that is what it is and it does not move.
  virtual std::optional<TriangleView> triangles() const { return std::nullopt; }
  /// Up to four numbers at a point of this object, such as a mesh's colour there. `number` is attribute_number of their name.
  /// Returns how many; 0: the object has none by this name.
  virtual int attribute(int /*number*/, const SurfacePoint&, float* /*values*/) const { return 0; }

  virtual ObjectNotes notes() const { return {}; }
  /// Of a mesh: how many edges belong to one triangle alone, where its surface ends. Takes time.
  virtual std::uint64_t open_edges() const { return 0; }

  /// The object the user wrote, when this one stands for it: in one of several places, or with another shader.
  virtual const SceneObject& original() const { return *this; }
  /// All that members say of another object's surface, light and inside is said of this one, which stands for it.
  void stand_for(const SceneObject&);

  /// Objects that stand within this one's own coordinates: those of a scene, the operands of a solid.
  virtual std::vector<SceneObject*> placed_within() const { return {}; }
  /// Which point of the world, in its coordinates, the renderer counts from. Set by the Job, as the points the transform counts
  /// from are.
  DoublePoint3 world_centre;
  /// Whether what stands within counts from where this object's scene does, as it is in one place only. Set with those.
  bool follows_scene = false;

  /// Place among the luminaires of the scene the renderer sees; -1: none. Set by Scene::prepare.
  int luminaire_index = -1;
};

/// A point's place in the coordinates of the world, as the user wrote them.
inline DoublePoint3 world_position(const SurfacePoint& p) {
  return p.object ? DoublePoint3(p.position) + (p.object->world_centre - DoublePoint3{}) : DoublePoint3(p.position);
}

}  // namespace etendue
