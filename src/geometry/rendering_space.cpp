#include "rendering_space.h"

#include <unordered_map>

#include "etendue/object_container.h"
#include "scene_record.h"

namespace etendue {
namespace {

/// The object space of an object that contains other objects, such as a nested scene.
struct Space {
  /// A placement of this space: the object `by` places it in the object space of `in`.
  struct Place {
    const SceneObject* by;
    SceneObject* in;
  };
  std::vector<Place> places;
  SceneObject* group;  ///< union-find parent of spaces that share an object and therefore have the same origin; the root points
                       ///< to itself
  int members = 1;     ///< size of the group, valid at its root
};

class Plan {
 public:
  Plan(Scene& scene, const DoublePoint3& origin, float time) : scene_(scene), rendering_origin_(origin), time_(time) {
    look_into(scene);
    for (auto& [owner, space] : spaces_) {
      SceneObject* const end = end_of(owner);
      if (end != owner) spaces_.at(end).members += space.members;
    }
  }

  void apply() {
    scene_.transform.set_origins({}, rendering_origin_);
    for (auto& [owner, space] : spaces_) {
      const DoublePoint3 here = origin_of(owner);
      if (owner != &scene_) owner->transform.set_inner_origin(here);
      const bool alone = spaces_.at(end_of(owner)).members == 1;
      scene_record(*owner).follows_scene = alone && space.places.size() == 1;
      if (auto* nested = dynamic_cast<Scene*>(owner)) {
        std::optional<float>& chooses_origin_at = SceneRecordAccess::chooses_origin_at(*nested);
        chooses_origin_at.reset();
        if (alone && !follows_rendering_origin(owner)) chooses_origin_at = time_;
      }
      for (SceneObject* part : objects_within(*owner)) {
        if (!part) continue;
        SceneObject* const within = space_brought_by(*part);
        part->transform.set_origins(here, within ? origin_of(within) : DoublePoint3{});
        if (!part->infinite())  // the points of an infinite object are directions
          scene_record(*part).rendering_origin = rendering_origin_;
      }
    }
  }

 private:
  /// The owner of the space that an object places in another one; null if the object contains no others.
  SceneObject* space_brought_by(SceneObject& object) const {
    SceneObject* owner = &object;
    if (const auto* instance = dynamic_cast<const Instance*>(&object)) owner = instance->scene.get();
    return spaces_.contains(owner) ? owner : nullptr;
  }

  void look_into(SceneObject& owner) {
    if (!spaces_.try_emplace(&owner, Space{{}, &owner}).second) return;
    for (SceneObject* part : objects_within(owner)) {
      if (!part) continue;
      if (const auto [first, fresh] = stands_in_.try_emplace(part, &owner); !fresh) join(first->second, &owner);
      SceneObject* within = part;
      if (const auto* instance = dynamic_cast<const Instance*>(part)) within = instance->scene.get();
      if (!within || (within == part && objects_within(*part).empty())) continue;
      look_into(*within);
      // An object listed by several owners counts as one placement, since its owners are joined and have the same origin.
      std::vector<Space::Place>& places = spaces_.at(within).places;
      if (std::ranges::none_of(places, [&](const Space::Place& p) { return p.by == part; })) places.push_back({part, &owner});
    }
  }

  SceneObject* end_of(SceneObject* owner) const {
    while (spaces_.at(owner).group != owner) owner = spaces_.at(owner).group;
    return owner;
  }
  void join(SceneObject* a, SceneObject* b) { spaces_.at(end_of(a)).group = end_of(b); }

  /// Whether the origin of an owner's space is that of rendering space, transformed into it.
  bool follows_rendering_origin(SceneObject* owner) const {
    SceneObject* const end = end_of(owner);
    if (end == end_of(&scene_)) return true;
    const Space& space = spaces_.at(owner);
    return spaces_.at(end).members == 1 && space.places.size() == 1 && follows_rendering_origin(space.places[0].in);
  }

  DoublePoint3 origin_of(SceneObject* owner) const {
    SceneObject* const end = end_of(owner);
    if (end == end_of(&scene_)) return rendering_origin_;
    const Space& space = spaces_.at(owner);
    if (spaces_.at(end).members > 1 || space.places.size() != 1) return {};
    const Transform t = space.places[0].by->transform.written(time_);
    const DoublePoint3 found = t.valid() ? t.back(origin_of(space.places[0].in)) : DoublePoint3{};
    return is_finite(found) ? found : DoublePoint3{};
  }

  Scene& scene_;
  DoublePoint3 rendering_origin_;
  float time_;
  std::unordered_map<SceneObject*, Space> spaces_;
  std::unordered_map<SceneObject*, SceneObject*> stands_in_;
};

}  // namespace

void set_rendering_origin(Scene& scene, const DoublePoint3& origin, float time) { Plan(scene, origin, time).apply(); }

}  // namespace etendue
