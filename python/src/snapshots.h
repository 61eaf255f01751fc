#pragma once
// Snapshots: prepared copies of parts, which answer questions on arrays. A part must be prepared before it can be asked, and
// stay unchanged while it is asked. A copy stays unchanged whatever Python's other threads and living renders do with the part
// itself; and what was found in it, such as points on surfaces, stays valid for as long as it is referred to.
//
// A snapshot is made when a part is first asked, and again after a member of the part, or of a part within it, was set. The
// interpreter's lock guards everything here.

#include <memory>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "binding.h"
#include "etendue/light_sampler.h"
#include "etendue/scene.h"

namespace etendue::python {

/// The size of the film that a camera is asked for [pixels]; 0 x 0 for all other parts.
struct FilmSize {
  int width = 0, height = 0;
  bool operator==(const FilmSize&) const = default;
};

class Snapshot {
 public:
  /// A copy, which must be prepared before it is asked.
  Snapshot(Component& original, FilmSize);
  void prepare();

  const Component& part() const { return *part_; }
  template <class C>
  const C& as() const {
    return dynamic_cast<const C&>(*part_);
  }
  /// The origin of rendering space, in world space, for scenes and cameras; (0, 0, 0) for all other parts.
  const DoublePoint3& origin() const { return origin_; }
  Point3 from_world(const double* p) const {
    return {float(p[0] - origin_.x), float(p[1] - origin_.y), float(p[2] - origin_.z)};
  }
  DoublePoint3 to_world(const Point3& p) const { return origin_ + DoubleVector3(p - Point3{}); }

  /// The objects of the scene, at any depth: those in the user's description.
  const std::vector<Ref<Component>>& objects() const { return objects_; }
  /// The place in `objects` of an object of the snapshot, or of a proxy of one; -1: none.
  int index_of(const SceneObject&) const;

  /// Whether a part is the one that was copied, or a part within it.
  bool is_of(const Component& part) const { return parts_.contains(&part); }

  /// The number of edits of any part before the copy was made.
  std::uint64_t copied_at() const { return copied_at_; }

  /// A light sampler that is built for this scene: a copy of the given one, or of the one that renderers have by default.
  const LightSampler& light_sampler(nb::handle given) const;

 private:
  void prepare_scene(Scene&);

  const std::uint64_t copied_at_;
  Ref<Component> part_;
  FilmSize film_;
  DoublePoint3 origin_;
  std::vector<Ref<Component>> objects_;
  std::unordered_map<const SceneObject*, int> index_;
  std::unordered_set<const Component*> parts_;
  struct Built {
    std::shared_ptr<const Snapshot> described;  ///< null: the one by default
    Ref<LightSampler> sampler;
  };
  mutable std::vector<Built> built_;
};

/// The snapshot of a part as it is now. Takes long if it has to be made: then the interpreter's lock is released meanwhile.
std::shared_ptr<const Snapshot> snapshot_of(nb::handle part, FilmSize = {});
/// The same for a part of an interface: snapshot_of<Camera>(part, "a camera").
template <class C>
std::shared_ptr<const Snapshot> snapshot_of(nb::handle part, const char* wanted, FilmSize film = {}) {
  component_as<C>(part, wanted);
  return snapshot_of(part, film);
}

/// To be called before a member of a part is set.
void forget_snapshots(const Component&);
/// To be called when the Python object of a part is being destroyed: frees snapshots of parts that nothing else refers to.
void release_snapshots(const Component&);

}  // namespace etendue::python
