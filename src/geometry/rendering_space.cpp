#include "rendering_space.h"

#include <unordered_map>

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
  Plan(Scene& scene, const DoublePoint3& centre, float time) : scene_(scene), centre_(centre), time_(time) {
    look_into(scene);
    for (auto& [owner, space] : spaces_) {
      SceneObject* const end = end_of(owner);
      if (end != owner) spaces_.at(end).members += space.members;
    }
  }

  void tell() {
    scene_.transform.count_from({}, centre_);
    for (auto& [owner, space] : spaces_) {
      const DoublePoint3 here = centre(owner);
      if (owner != &scene_) owner->transform.count_from(owner->transform.outer(), here);
      const bool alone = spaces_.at(end_of(owner)).members == 1;
      owner->follows_scene = alone && space.places.size() == 1;
      if (auto* nested = dynamic_cast<Scene*>(owner)) {
        nested->chooses_centre.reset();
        if (alone && !counts_with_renderer(owner)) nested->chooses_centre = time_;
      }
      for (SceneObject* part : owner->placed_within()) {
        if (!part) continue;
        SceneObject* const within = space_brought_by(*part);
        part->transform.count_from(here, within ? centre(within) : DoublePoint3{});
        if (!part->infinite()) part->world_centre = centre_;  // the points of an infinite object are directions
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
    for (SceneObject* part : owner.placed_within()) {
      if (!part) continue;
      if (const auto [first, fresh] = stands_in_.try_emplace(part, &owner); !fresh) join(first->second, &owner);
      SceneObject* within = part;
      if (const auto* instance = dynamic_cast<const Instance*>(part)) within = instance->scene.get();
      if (!within || (within == part && part->placed_within().empty())) continue;
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

  /// Whether its origin is the renderer's origin, transformed into this space.
  bool counts_with_renderer(SceneObject* owner) const {
    SceneObject* const end = end_of(owner);
    if (end == end_of(&scene_)) return true;
    const Space& space = spaces_.at(owner);
    return spaces_.at(end).members == 1 && space.places.size() == 1 && counts_with_renderer(space.places[0].in);
  }

  DoublePoint3 centre(SceneObject* owner) const {
    SceneObject* const end = end_of(owner);
    if (end == end_of(&scene_)) return centre_;
    const Space& space = spaces_.at(owner);
    if (spaces_.at(end).members > 1 || space.places.size() != 1) return {};
    const Transform t = space.places[0].by->transform.written(time_);
    const DoublePoint3 found = t.valid() ? t.back(centre(space.places[0].in)) : DoublePoint3{};
    return is_finite(found) ? found : DoublePoint3{};
  }

  Scene& scene_;
  DoublePoint3 centre_;
  float time_;
  std::unordered_map<SceneObject*, Space> spaces_;
  std::unordered_map<SceneObject*, SceneObject*> stands_in_;
};

}  // namespace

void count_from(Scene& scene, const DoublePoint3& centre, float time) { Plan(scene, centre, time).tell(); }

}  // namespace etendue
