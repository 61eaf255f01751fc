#include "scene_record.h"

#include "etendue/shader.h"

namespace etendue {

void copy_surface_of(const SceneObject& object, SceneObject& proxy) {
  proxy.shader = object.shader;
  proxy.emission = object.emission;
  proxy.interior = object.interior;
  proxy.sides = object.sides;
  proxy.priority = object.priority;
  proxy.shading_normals = object.shading_normals;
  proxy.visible_to_camera = object.visible_to_camera;
  scene_record(proxy).rendering_origin = object.rendering_origin();
  scene_record(proxy).original = &object.original();
}

}  // namespace etendue
