#pragma once
// SceneObject: the interface of shapes (Shape in pbrt and Mitsuba): intersection, and sampling of points on the surface. It
// also refers to the material, emission and medium of the shape, as pbrt's GeometricPrimitive does.
//
// A new shape must implement `bounds`, `intersect`, `surface_point`, `tangents`, `area` and `sample_area`, and `closed` if its
// surface encloses a volume. All other virtual functions have defaults that are correct for ordinary shapes. A shape that is
// easily described in object space derives from PlacedObject (placed_object.h) instead, which applies the transform and needs
// five functions.
//
// Other interfaces are met by few shapes: InfiniteObject (infinite_object.h) by lights at infinity, MeshFacts (mesh_facts.h) by
// meshes, ObjectContainer (object_container.h) by objects that contain objects.

#include "etendue/core/surface_point.h"
#include "etendue/core/transform.h"
#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/emission_shader.h"
#include "etendue/volume_shader.h"

namespace etendue {

class MeshFacts;
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
  /// The point is on a delta light (a point light, a distant light), which no ray hits; see Extent.
  bool delta = false;
  /// The point is infinitely far away along `direction`.
  bool infinite = false;
  Vector3 direction;  ///< unit, from the reference point `from` to the sampled point; only from sample_visible
  float distance = 0;
};

/// A box around the points that a luminaire emits from, and a cone around the geometric normals, both over all times.
struct LuminaireBounds {
  Bounds3 box;
  NormalCone normals;
};

/// The treatment of light that a shading normal would send through the surface: the mirrored shading-normal correction, or
/// dropped (see scatter_corrections.h).
enum class ShadingNormals : std::uint8_t { folded, clipped };

/// How far an object extends. A point light is the limit of a shrinking sphere with a cross section of 1 m^2: the radiance of
/// its emission, times 1 m^2, is its intensity [W/sr]. The pdf per area is then 1 per m^2 of that cross section, and the pdf
/// per solid angle follows with distance^2, so that radiance over pdf is irradiance as for any other object. Its points have no
/// normal (zero), and there is no cosine at the light. In the same way a distant light is the limit of a disc of 1 sr at
/// infinity, with pdf 1.
enum class Extent : std::uint8_t {
  bounded,       ///< an ordinary surface
  unbounded,     ///< extends without end, as a plane does: rays hit it, but it is excluded from the scene's bounds, and it
                 ///< cannot emit; its own bounds are a box of size SceneObject::endless
  point,         ///< a delta light at a point, which no ray hits; its bounds are empty
  direction,     ///< a delta light at infinity; an InfiniteObject, as those below
  environment,   ///< at infinity in all directions, seen by rays that leave the scene
  surroundings,  ///< no surface, and its inside is all of space (SurroundingObject)
};

/// See the beginning of the file for what subclasses implement.
class SceneObject : public Component {
 public:
  using Interface = SceneObject;
  using Parent = Component;
  static void describe(Description<SceneObject>&);
  SceneObject();
  ~SceneObject() override;

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

  // ---- what a shape must implement ---------------------------------------------------------------------------------------

  /// Bounds in the coordinates of the containing scene, over the whole time the shutter is open.
  virtual Bounds3 bounds() const = 0;
  /// The nearest intersection with t in (0, ray.maximum). On a hit fills `hit` (all of it) and returns true.
  virtual bool intersect(const Ray&, Hit&) const = 0;
  /// Fills these members of the surface point of a hit that `intersect` found, in the coordinates of the containing scene:
  /// position, error, normal, shading_normal, uv, object_position, object_normal, time, object, primitive, u, v. Scene::locate
  /// then transforms the point outwards and sets the footprint and ray_direction; walks set media.
  virtual void surface_point(const Ray&, const Hit&, SurfacePoint&) const = 0;
  /// Fills dpdu and dpdv of a point on this object, in the coordinates of the containing scene. May leave them if either is not
  /// zero.
  virtual void tangents(SurfacePoint&) const = 0;
  /// The area in world space [m^2] at the given time.
  virtual float area(float time = 0) const = 0;
  /// Samples a point on the surface, with its pdf per area [1/m^2].
  virtual SurfaceSample sample_area(Point2 u, float time) const = 0;

  // ---- what depends on the shape ------------------------------------------------------------------------------------------

  /// Whether the surface encloses a volume, and so has an inside and an outside. Needed for media and refraction.
  virtual bool closed() const { return false; }
  /// The pdf [1/m^2] of sample_area for a point. By default uniform.
  virtual float area_pdf(const SurfacePoint& p) const { return 1 / area(p.time); }
  /// An upper bound of the area's relative error; 0: the area is computed in closed form.
  virtual float area_error(float /*time*/ = 0) const { return 0; }
  /// Lights without extent or at infinity, and surfaces without end, return another value.
  virtual Extent extent() const { return Extent::bounded; }

  // ---- what makes rendering faster ----------------------------------------------------------------------------------------

  /// Whether the ray is occluded by the object.
  virtual bool occludes(const Ray& ray) const {
    Hit hit;
    return intersect(ray, hit);
  }
  /// Samples a point that may be visible from `from` (other objects are ignored), with its pdf per solid angle [1/sr] at
  /// `from`. By default sample_area, converted: p_omega = p_area * distance^2 / |cos|.
  virtual SurfaceSample sample_visible(const Point3& from, Point2 u, float time) const;
  /// The pdf [1/sr] of sample_visible for a point, seen from `from` in `direction` (unit).
  virtual float visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint&) const;
  /// For the choice among many luminaires; the box is empty for luminaires at infinity. By default `bounds` and any normal.
  virtual LuminaireBounds luminaire_bounds() const { return {bounds(), {}}; }

  // ---- what other parts of the renderer find out about a shape of several surfaces ----------------------------------------

  /// Adds all hits along a short ray to the list, to find coincident surfaces. By default the nearest hit only.
  virtual void all_hits(const Ray& ray, HitList& list) const {
    Hit hit;
    if (intersect(ray, hit)) list.add(hit);
  }
  /// Triangles, vertex attributes and notes of a mesh; null for other objects.
  virtual const MeshFacts* mesh_facts() const { return nullptr; }

  // ---- answers that follow from those above -------------------------------------------------------------------------------

  bool luminaire() const { return bool(emission); }
  /// Whether the object lies at infinity: it is never intersected, and its bounds are empty.
  bool infinite() const { return extent() >= Extent::direction; }
  bool unbounded() const { return extent() == Extent::unbounded; }
  /// Whether the object is a delta light, which no ray hits.
  bool delta() const {
    const Extent e = extent();
    return e == Extent::point || e == Extent::direction;
  }
  bool surrounds() const { return extent() == Extent::surroundings; }
  static constexpr float endless = 1e9f;  ///< half the size of an unbounded object's box [m]

  // ---- what the job and the scene have recorded about the object ----------------------------------------------------------

  /// The origin of rendering space, in world space; (0, 0, 0) for an object at infinity, whose points are directions.
  const DoublePoint3& rendering_origin() const { return scene_record_.rendering_origin; }
  /// Index in the list of luminaires of the outermost scene; -1: not in the list.
  int luminaire_index() const { return scene_record_.luminaire_index; }
  /// The object in the user's description. Differs from this object if this is a proxy: for one of several instances, or with a
  /// replaced shader.
  const SceneObject& original() const { return scene_record_.original ? *scene_record_.original : *this; }

 private:
  friend struct SceneRecordAccess;
  struct SceneRecord {
    DoublePoint3 rendering_origin;
    const SceneObject* original = nullptr;  ///< null: the object itself
    int luminaire_index = -1;
    bool follows_scene = false;  ///< contained objects use the origin of the containing scene, as the object occurs in one
                                 ///< place only
  };
  SceneRecord scene_record_;
};

/// A point's position in world space, as in the user's description.
inline DoublePoint3 world_position(const SurfacePoint& p) {
  return p.object ? DoublePoint3(p.position) + (p.object->rendering_origin() - DoublePoint3{}) : DoublePoint3(p.position);
}

}  // namespace etendue
