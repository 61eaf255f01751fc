#pragma once
// SceneObject: the interface of shapes (Shape in pbrt and Mitsuba): intersection, and sampling of points on the surface. It
// also refers to the material, emission and medium of the shape, as pbrt's GeometricPrimitive does.
//
// A new shape must implement `bounds`, `intersect`, `surface_point`, `tangents`, `area` and `sample_area`. Important optional
// functions: `closed` if the surface encloses a volume (needed for media and refraction), `occludes` (faster shadow rays),
// `area_pdf` if sample_area is not uniform, `sample_visible` with `visible_pdf` (better next event estimation), `normals`
// (better choice of luminaires). Shapes that are infinite, unbounded or delta lights override the functions of these names. All
// other virtual functions have defaults for ordinary shapes.

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

/// A cone of directions, which bounds an object's normals.
struct NormalCone {
  Vector3 axis{0, 0, 1};  ///< unit
  float cosine = -1;      ///< of the half angle; -1: any direction
};

/// The hits at one location, where surfaces coincide.
struct HitList {
  static constexpr int capacity = 8;
  Hit hits[capacity];
  int size = 0;
  /// Hits beyond `capacity` are dropped.
  void add(const Hit& hit) {
    if (size < capacity) hits[size++] = hit;
  }
};

/// A point sampled on an object.
struct SurfaceSample {
  SurfacePoint point;
  float pdf = 0;  ///< per area [1/m^2] from sample_area; per solid angle [1/sr] from sample_visible; 0: no point was found
  /// The point is on a delta light (a point light, a distant light), which no ray hits; see SceneObject::delta.
  bool delta = false;
  /// The point is infinitely far away along `direction`.
  bool infinite = false;
  Vector3 direction;  ///< unit, from the reference point `from` to the sampled point; only from sample_visible
  float distance = 0;
};

/// Triangles in the coordinates of the containing scene, for accelerators that intersect them directly. Embree reads 16 bytes
/// at each position, so four more bytes after the last position must be readable.
struct TriangleView {
  std::span<const Point3> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
};

/// The number of a surface attribute's name, constant while the program runs. Maps and objects look it up in `prepare`, so that
/// no names are compared while rendering.
int attribute_number(const std::string& name);

/// Notes about an object that are reported to the user, in addition to its members.
struct ObjectNotes {
  bool without_uv = false;              ///< the mesh has no surface coordinates (uv), so each triangle has its own
  std::vector<std::string> attributes;  ///< names of the vertex attributes that AttributeMap can read
  std::vector<std::string> materials;   ///< names of materials in the mesh's file, which are not read
};

/// See the beginning of the file for what subclasses implement.
class SceneObject : public Component {
 public:
  using Interface = SceneObject;
  using Parent = Component;
  static void describe(Description<SceneObject>&);

  /// From object space to the space of the containing scene. Both spaces may have shifted origins (see AnimatedTransform): that
  /// of the scene lies near the objects in view (rendering space), that of object space is chosen by the object in `prepare`.
  /// Objects compute bounds, hits and points through this transform, so these are in rendering space automatically.
  AnimatedTransform transform;
  Ref<Shader> shader;            ///< null: black
  Ref<EmissionShader> emission;  ///< null: the object is no luminaire
  Ref<VolumeShader> interior;    ///< null: vacuum inside
  Sides sides = Sides::both;     ///< the sides that scatter; the other side has null scattering only, and absorbs the rest
  int priority = 0;              ///< where objects overlap, the one of highest priority fills the space (nested dielectrics)
  ShadingNormals shading_normals = ShadingNormals::folded;  ///< treatment of light sent through the surface by shading normals
  bool visible_to_camera = true;                            ///< false: camera rays ignore the object

  bool luminaire() const { return bool(emission); }

  /// Bounds in the coordinates of the containing scene, over the whole time the shutter is open.
  virtual Bounds3 bounds() const = 0;
  /// The nearest intersection with t in (0, ray.maximum). On a hit fills `hit` (all of it) and returns true.
  virtual bool intersect(const Ray&, Hit&) const = 0;
  /// Whether the ray is occluded by the object.
  virtual bool occludes(const Ray& ray) const {
    Hit hit;
    return intersect(ray, hit);
  }
  /// Adds all hits along a short ray to the list, to find coincident surfaces. By default the nearest hit only.
  virtual void all_hits(const Ray& ray, HitList& list) const {
    Hit hit;
    if (intersect(ray, hit)) list.add(hit);
  }
  /// Fills these members of the surface point of a hit that `intersect` found, in the coordinates of the containing scene:
  /// position, error, normal, shading_normal, uv, object_position, object_normal, time, object, primitive, u, v. Scene::locate
  /// then transforms the point outwards and sets the footprint and ray_direction; walks set media.
  virtual void surface_point(const Ray&, const Hit&, SurfacePoint&) const = 0;
  /// Fills dpdu and dpdv of a point on this object, in the coordinates of the containing scene. May leave them if either is not
  /// zero.
  virtual void tangents(SurfacePoint&) const = 0;

  /// The area in world space [m^2] at the given time.
  virtual float area(float time = 0) const = 0;
  /// An upper bound of the area's relative error; 0: the area is computed in closed form.
  virtual float area_error(float /*time*/ = 0) const { return 0; }
  /// Samples a point on the surface, with its pdf per area [1/m^2].
  virtual SurfaceSample sample_area(Point2 u, float time) const = 0;
  /// The pdf [1/m^2] of sample_area for a point.
  virtual float area_pdf(const SurfacePoint& p) const { return 1 / area(p.time); }
  /// Samples a point that may be visible from `from` (other objects are ignored), with its pdf per solid angle [1/sr] at
  /// `from`. By default sample_area, converted: p_omega = p_area * distance^2 / |cos|.
  virtual SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const;
  /// The pdf [1/sr] of sample_visible for a point, seen from `from` in `direction` (unit).
  virtual float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint&) const;

  /// Bounding box of the points that a luminaire emits from, over all times; empty for luminaires at infinity.
  virtual Bounds3 luminaire_bounds() const { return bounds(); }
  /// A cone that bounds the geometric normals, over all times.
  virtual NormalCone normals() const { return {}; }

  /// Whether the surface encloses a volume, and so has an inside and an outside.
  virtual bool closed() const { return false; }
  /// Whether the object lies at infinity: it is never intersected, and seen by rays that leave the scene. Its bounds are empty.
  virtual bool infinite() const { return false; }
  /// Whether the surface extends without end, as a plane does: rays hit it, but it is excluded from the scene's bounds, and it
  /// cannot emit. Its own bounds are a box of size `endless`.
  virtual bool unbounded() const { return false; }
  static constexpr float endless = 1e9f;  ///< [m]
  /// Whether the object has no surface, and its inside is all of space (class Surroundings: fog around the scene). Such an
  /// object is also `infinite`, so that `enclose` is called for it.
  virtual bool surrounds() const { return false; }
  /// For such an object: the distance along an unoccluded ray at which its inside ends [m].
  virtual float surrounding_reach(const Ray&) const { return infinity; }
  /// Whether the object is a delta light, which no ray hits. A point light is the limit of a shrinking sphere with a cross
  /// section of 1 m^2: the radiance of its emission, times 1 m^2, is its intensity [W/sr]. The pdf per area is then 1 per m^2
  /// of that cross section, and the pdf per solid angle follows with distance^2, so that radiance over pdf is irradiance as for
  /// any other object. Its points have no normal (zero), and there is no cosine at the light. In the same way a distant light
  /// is the limit of a disc of 1 sr at infinity, with pdf 1.
  virtual bool delta() const { return false; }
  /// Sets the bounding sphere of all finite objects. Called by Scene::prepare for objects at infinity.
  virtual void enclose(const Point3& /*centre*/, float /*radius*/) {}
  /// The triangles of a mesh that does not move; empty for other objects.
  virtual std::optional<TriangleView> triangles() const { return std::nullopt; }
  /// Stores an attribute's values at a point of this object, such as the vertex colour of a mesh: at most four. `number` is the
  /// attribute_number of its name. Returns the count of values; 0: the object has no attribute of this name.
  virtual int attribute(int /*number*/, const SurfacePoint&, float* /*values*/) const { return 0; }

  virtual ObjectNotes notes() const { return {}; }
  /// For a mesh: the number of boundary edges, which belong to one triangle only. Slow.
  virtual std::uint64_t open_edges() const { return 0; }

  /// The object in the user's description. Differs from this object if this is a proxy: for one of several instances, or with a
  /// replaced shader.
  virtual const SceneObject& original() const { return *this; }
  /// Makes this object a proxy: copies the members for surface, emission and interior from the original object.
  void stand_for(const SceneObject&);

  /// The objects whose transforms are relative to this one's object space: those of a scene, the operands of constructive solid
  /// geometry.
  virtual std::vector<SceneObject*> placed_within() const { return {}; }
  /// The origin of rendering space, in world space. Set by the Job, with the origins of the transform.
  DoublePoint3 world_centre;
  /// Whether the contained objects use the origin of the containing scene, as this object occurs in one place only. Set by the
  /// Job together with the origins.
  bool follows_scene = false;

  /// Index in the list of luminaires of the outermost scene; -1: not in the list. Set by Scene::prepare.
  int luminaire_index = -1;
};

/// A point's position in world space, as in the user's description.
inline DoublePoint3 world_position(const SurfacePoint& p) {
  return p.object ? DoublePoint3(p.position) + (p.object->world_centre - DoublePoint3{}) : DoublePoint3(p.position);
}

}  // namespace etendue
