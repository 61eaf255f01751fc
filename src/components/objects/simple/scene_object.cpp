// SceneObject: members and default implementations shared by all shapes.

#include "etendue/scene_object.h"

#include "etendue/shader.h"

namespace etendue {

void SceneObject::describe(Description<SceneObject>& d) {
  d.summary(
       "A shape with its place, its material and its light. Its surface coordinates (u, v), over which images lie, are said "
       "with "
       "each shape, in its own coordinates, before its transform; seen from the front with v upwards, u grows to the right, so "
       "an "
       "image is not mirrored there.")
      .group("Placement")
      .member<&SceneObject::transform>("transform", "", "from the object's own coordinates to those of the scene it is in",
                                       Effect::rebuild)
      .group("Material")
      .member<&SceneObject::shader>("shader", "", "how its surface scatters light; none: black")
      .member<&SceneObject::emission>("emission", "", "how it emits light; none: it does not")
      .member<&SceneObject::interior>("interior", "", "the medium inside; none: vacuum")
      .member<&SceneObject::sides>(
          "sides", "",
          "which sides scatter light; with one alone, the other side absorbs what would be scattered there, and no light is "
          "refracted or let through diffusely. What goes straight on, through holes of a mask, thin panes or the bounds of a "
          "medium, does so from either side",
          choices("front", "back", "both"))
      .member<&SceneObject::priority>("priority", "1", "where objects overlap, the one of highest priority fills the space")
      .member<&SceneObject::shading_normals>(
          "shading_normals", "",
          "what becomes of light that normals which are interpolated, bumped or read from an image would send through the "
          "surface: folded, it is turned back to the side it belongs to and nothing is lost; clipped, it is lost",
          choices("folded", "clipped"))
      .group("Visibility")
      .member<&SceneObject::visible_to_camera>(
          "visible_to_camera", "",
          "whether the camera sees it; if not, its light, its shadow and its image in mirrors are there all the same. Pictures "
          "are made so, the world is not",
          Effect::rebuild);
}

// Here, as the destructors of the members need the complete class Shader.
SceneObject::SceneObject() = default;
SceneObject::~SceneObject() = default;

SurfaceSample SceneObject::sample_visible(const Point3& from, Point2 u, float time) const {
  SurfaceSample s = sample_area(u, time);
  if (s.pdf == 0 || s.delta || s.infinite) return s;
  const Vector3 to = s.point.position - from;
  const float d2 = length_squared(to);
  s.distance = std::sqrt(d2);
  s.direction = d2 > 0 ? to / s.distance : Vector3{0, 0, 1};
  const float cosine = std::abs(dot(s.point.normal, s.direction));
  s.pdf = cosine > 0 && d2 > 0 ? s.pdf * d2 / cosine : 0;
  return s;
}

float SceneObject::visible_pdf(const Point3& from, const Vector3& direction, const SurfacePoint& p) const {
  const float cosine = std::abs(dot(p.normal, direction));
  return cosine > 0 ? area_pdf(p) * distance_squared(p.position, from) / cosine : 0;
}

static const Register<SceneObject> registered;

}  // namespace etendue
