#pragma once
// What an edit of some members of a job's parts forces to be prepared again, and no more.

#include <map>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "etendue/render/render.h"

namespace etendue {

/// Who holds whom among the parts of a job.
class Holders {
 public:
  explicit Holders(const Job&);

  bool knows(const Component& part) const { return held_by_.contains(&part); }
  struct Holder {
    const Component* component;
    const Member* member;  ///< by which it holds
  };
  const std::vector<Holder>& of(const Component& part) const { return held_by_.at(&part); }

 private:
  std::unordered_map<const Component*, std::vector<Holder>> held_by_;
};

/// How an edit of members concerns the parts of a job.
class Consequences {
 public:
  /// Notes that a member of a part is edited. To be told of all edits before any is made.
  void note(const Holders&, Component& part, const Member&, const Value& now);

  /// Of the whole edit, as it concerns the picture.
  Effect effect() const { return effect_; }
  /// Whether nothing but this part, and the job that holds it, is concerned.
  bool concern_only(const Component& part) const { return parts_.size() == 2 && parts_.contains(&part); }
  /// Whether which parts the job has may change.
  bool structure() const { return structure_; }

  /// Prepares again what is concerned, and for the first time what is new to `before`. Throws what preparing throws.
  void prepare(Job&, const Holders& before) const;

 private:
  void spread(const Holders&, const Component& part, Effect);
  void prepare_parts(Job&, const Holders& before) const;

  std::unordered_map<const Component*, Effect> parts_;
  /// Objects whose transform is edited, and the point it counted from outside: a new one has to be told.
  std::map<SceneObject*, DoublePoint3> moved_;
  Effect effect_ = Effect::none;
  bool structure_ = false, everything_ = false;
};

}  // namespace etendue
