#pragma once
// Write access to what the job and the scene record about an object (SceneObject::SceneRecord).

#include "etendue/scene.h"

namespace etendue {

struct SceneRecordAccess {
  static SceneObject::SceneRecord& record(SceneObject& object) { return object.scene_record_; }
  static std::optional<float>& chooses_origin_at(Scene& scene) { return scene.chooses_origin_at_; }
};

inline auto& scene_record(SceneObject& object) { return SceneRecordAccess::record(object); }

/// Makes `proxy` a proxy of `object`: copies its surface, emission, interior and visibility, but not its transform, and records
/// its origin of rendering space and its original.
void copy_surface_of(const SceneObject& object, SceneObject& proxy);

}  // namespace etendue
