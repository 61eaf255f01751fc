// DisplacedMesh: triangles displaced by maps.

#include "displacement.h"
#include "etendue/describe/registry.h"
#include "etendue/object_container.h"
#include "geometry/scene_record.h"
#include "triangle_object.h"

namespace etendue {
namespace {

class DisplacedMesh final : public TriangleObject, public ObjectContainer {
 public:
  static void describe(Description<DisplacedMesh>& d) {
    d.summary(
         "Another object's triangles, divided into smaller ones and moved along its normals, or anywhere, as maps say; the "
         "result "
         "has the normals of its new shape. All that lies in one place moves alike, so that nothing gapes. Surface coordinates "
         "are those of the other object.",
         "Cook 1984, \"Shade trees\"")
        .group("Shape")
        .member<&DisplacedMesh::surface>(
            "surface", "",
            "what is moved: an object of triangles, such as a TriangleMesh or a SubdivisionSurface. Its shader, emission and "
            "interior are not used; its transform is, before the maps",
            Effect::rebuild)
        .member<&DisplacedMesh::displacement>(
            "displacement", "1",
            "how far outwards along the shading normal: scale (displacement - midlevel). A map sees the surface before it is "
            "moved and without this object's transform, and takes means over a triangle's size if it can",
            Effect::rebuild, Meaning::number)
        .member<&DisplacedMesh::offset>("offset", "1",
                                        "three maps: how far along x, y and z: scale (offset - midlevel), in addition; none: "
                                        "nothing. Those of an image are "
                                        "ImageMaps of its channels (\"R\", \"G\" and \"B\")",
                                        Effect::rebuild, Meaning::number)
        .member<&DisplacedMesh::offset_space>(
            "offset_space", "",
            "what x, y and z are. object: the axes before this object's transform; tangent: where u grows, across it where v "
            "grows, and the normal",
            choices("object", "tangent"), Effect::rebuild, when("offset"))
        .member<&DisplacedMesh::scale>("scale", "m", "multiplies the maps; before the transform", Effect::rebuild, soft(-1, 1))
        .member<&DisplacedMesh::midlevel>("midlevel", "1", "the value of a map that moves nothing", Effect::rebuild, soft(0, 1))
        .group("Fineness")
        .member<&DisplacedMesh::levels>("levels", "1", "how many times all edges of triangles are halved first", range(0, 8),
                                        Effect::rebuild)
        .member<&DisplacedMesh::edge_length>(
            "edge_length", "m",
            "edges longer than this are halved further, before the surface is moved and before the transform; 0: none",
            at_least(0), Effect::rebuild, soft(0.001, 10), logarithmic)
        .member<&DisplacedMesh::smooth_angle>(
            "smooth_angle", "rad",
            "edges at which the surface's normals turn by more than this stay hard; 0: all of the new shape is shaded flat",
            range(0, M_PI), Effect::rebuild);
  }

  void prepare() override {
    check();
    const std::optional<TriangleView> view = still_triangles(*surface);
    if (!view || view->triangles.empty())
      fail("surface", surface->transform.animated() ? "its transform must not move: move the DisplacedMesh"
                                                    : surface->class_info().name + " has no triangles");
    if (surface->shader || surface->emission || surface->interior)
      warn("DisplacedMesh.surface: its shader, emission and interior are not used; they belong to the DisplacedMesh",
           location_of("surface"));
    // For maps, world space is the space that contains the surface.
    scene_record(*surface).rendering_origin = surface->transform.outer_origin();
    Displacement by;
    by.surface = surface.get();
    by.height = displacement.get();
    by.offset = offset;
    by.along_tangents = offset_space == Space::tangent;
    by.scale = scale;
    by.midlevel = midlevel;
    by.smooth_cosine = std::cos(smooth_angle) - 1e-5f;
    try {
      triangles_ = std::make_unique<DividedTriangles>(*view);
      if (!triangles_->divide(levels, edge_length))
        warn("DisplacedMesh: edges remain that are longer than edge_length", location_of("edge_length"));
      MeshData mesh = displace(*triangles_, by);
      mesh.centre = surface->transform.outer_origin();
      if (!(smooth_angle > 0)) mesh.normals = {};
      triangles_->keep_places();
      keep_usable(mesh);
      adopt(std::move(mesh));
    } catch (const Error& error) {
      fail("", error.what());
    } catch (const std::bad_alloc&) {
      fail("levels", "not enough memory for so many triangles");
    }
  }

  std::vector<SceneObject*> placed_within() const override { return {surface.get()}; }

  /// The attribute of the original surface at the undisplaced point.
  int attribute(int number, const SurfacePoint& p, float* values) const override {
    const std::uint32_t triangle = kept_.empty() ? p.primitive : kept_[p.primitive];
    // If a static transform mirrors, the orientation of triangles was reversed: their second and third corners are exchanged.
    const bool turned = !transform.animated() && transform.still().flips();
    const DividedTriangles::Place place = triangles_->place(triangle, turned ? p.v : p.u, turned ? p.u : p.v);
    SurfacePoint before = p;
    before.object = surface.get();
    before.primitive = place.triangle;
    before.u = place.u;
    before.v = place.v;
    const MeshFacts* facts = surface->mesh_facts();
    return facts ? facts->attribute(number, before, values) : 0;
  }

  enum class Space : std::uint8_t { object, tangent };

  Ref<SceneObject> surface = ref_cast<SceneObject>(Registry::instance().create("Polygon"));
  Ref<ObjectMap> displacement = constant(0);
  std::vector<Ref<ObjectMap>> offset;
  Space offset_space = Space::object;
  float scale = 1, midlevel = 0;
  int levels = 0;
  float edge_length = 0, smooth_angle = 0.7f;

 private:
  void check() const {
    if (!surface) fail("surface", "a surface is needed");
    if (!displacement) fail("displacement", "a map is needed");
    if (!offset.empty() && offset.size() != 3)
      fail("offset", "three maps are needed, for x, y and z, but " + std::to_string(offset.size()) + " are given");
    for (const Ref<ObjectMap>& map : offset)
      if (!map) fail("offset", "a map is needed for each axis");
    if (!std::isfinite(scale)) fail("scale", "must be a finite number");
    if (!std::isfinite(midlevel)) fail("midlevel", "must be a finite number");
    if (!(edge_length >= 0 && edge_length < infinity)) fail("edge_length", "must be a finite number, 0 or more");
    if (!(smooth_angle >= 0 && smooth_angle <= pi)) fail("smooth_angle", "must lie between 0 and 180 deg");
  }

  /// Removes triangles that the maps have made degenerate, and stores the indices of the rest.
  void keep_usable(MeshData& mesh) {
    const size_t count = mesh.triangles.size();
    std::vector<std::array<std::uint32_t, 3>> all = mesh.triangles;
    drop_unusable(mesh, origin && !origin->name.empty() ? origin->name : "DisplacedMesh");
    kept_.clear();
    if (mesh.triangles.size() == count) return;
    kept_.reserve(mesh.triangles.size());
    for (size_t i = 0; kept_.size() < mesh.triangles.size(); ++i)
      if (all[i] == mesh.triangles[kept_.size()]) kept_.push_back(std::uint32_t(i));
  }

  std::unique_ptr<DividedTriangles> triangles_;  // only the position of each triangle in the original surface
  std::vector<std::uint32_t> kept_;              // indices of the kept triangles, if some were removed
};

const Register<DisplacedMesh> registered;

}  // namespace
}  // namespace etendue
