#pragma once
// Consequences: what must be prepared again after an edit of some members of a job's components, and nothing more.

#include <map>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "etendue/render/render.h"

namespace etendue {

/// The holders of each component of a job.
class Holders {
 public:
  explicit Holders(const Job&);

  bool knows(const Component& part) const { return held_by_.contains(&part); }
  struct Holder {
    const Component* component;
    const Member* member;  ///< the member that refers to the component
  };
  const std::vector<Holder>& of(const Component& part) const { return held_by_.at(&part); }

 private:
  std::unordered_map<const Component*, std::vector<Holder>> held_by_;
};

/// The effects of an edit on the components of a job.
class Consequences {
 public:
  /// Adds the edit of one member of a component. All edits must be noted before any of them is made.
  void note(const Holders&, Component& part, const Member&, const Value& now);

  /// The effect of the whole edit on the picture.
  Effect effect() const { return effect_; }
  /// Whether only this component, and the job that holds it, is affected.
  bool concern_only(const Component& part) const { return parts_.size() == 2 && parts_.contains(&part); }
  /// Whether the set of the job's components may change.
  bool structure() const { return structure_; }

  /// Prepares the affected components again, and those that are new since `before` for the first time. Passes on exceptions of
  /// prepare.
  void prepare(Job&, const Holders& before) const;

 private:
  void spread(const Holders&, const Component& part, Effect);
  void prepare_parts(Job&, const Holders& before) const;

  std::unordered_map<const Component*, Effect> parts_;
  /// Objects whose transform is edited, with the origin of the outer space of the old transform, which the new one must get,
  /// too.
  std::map<SceneObject*, DoublePoint3> moved_;
  Effect effect_ = Effect::none;
  bool structure_ = false, everything_ = false;
};

}  // namespace etendue
