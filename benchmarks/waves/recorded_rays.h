#pragma once
// The rays of a path tracer, recorded in the order of its scene queries.

#include <cstdint>
#include <vector>

#include "etendue/render/job.h"
#include "etendue/render/process.h"
#include "etendue/render/renderer.h"
#include "etendue/scene.h"

namespace etendue::waves {

/// A ray of a path, and its hit.
struct RecordedRay {
  Ray ray;
  Hit hit;
  std::uint32_t path = 0;
  std::uint32_t depth = 0;  ///< number of earlier rays of its kind in the path
  bool shadow = false, found = false;
};

/// A scene that records its queries and forwards them to another scene, which is already prepared.
class RecordingScene final : public Scene {
 public:
  static void describe(Description<RecordingScene>& d) { d.summary("Notes the rays that another scene is asked for."); }

  Ref<Scene> asked;
  mutable std::vector<RecordedRay> rays;
  mutable std::uint32_t path = 0, nearest_so_far = 0, shadows_so_far = 0;

  void begin_path(std::uint32_t number) const {
    path = number;
    nearest_so_far = shadows_so_far = 0;
  }

  bool find_nearest(const Ray& ray, Hit& hit) const override {
    const bool found = asked->nearest(ray, hit);
    rays.push_back({ray, found ? hit : Hit{}, path, nearest_so_far++, false, found});
    return found;
  }
  bool find_any(const Ray& ray) const override {
    const bool found = asked->any(ray);
    rays.push_back({ray, {}, path, shadows_so_far++, true, found});
    return found;
  }
  // Queries for all hits along a ray, to locate a point within media, are no rays of the path.
  void find_all(const Ray& ray, HitList& list) const override { asked->all(ray, list); }

 protected:
  void build(std::span<const SceneObject* const>) override {}
};

/// CPU time of the thread [s], independent of other load of the machine.
double thread_seconds();

}  // namespace etendue::waves
