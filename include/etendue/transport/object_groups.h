#pragma once
// ObjectGroup: objects of a scene under one name, for mattes and for the linking of lights.

#include <string>
#include <string_view>
#include <vector>

#include "etendue/describe/component.h"
#include "etendue/describe/description.h"
#include "etendue/scene.h"

namespace etendue {

/// Objects are chosen by their names, as luminaires are for light groups (docs/decisions/038-light-groups.md): so objects of
/// imported files can be in groups as well, and an edit of an object does not concern the group.
class ObjectGroup final : public Component {
 public:
  using Interface = ObjectGroup;
  using Parent = Component;
  static void describe(Description<ObjectGroup>&);

  std::string name;
  std::vector<std::string> objects;  ///< patterns of names (NamePattern)
};

/// The names from the scene to an object: those of the instances and nested scenes that contain it, outermost first, and its
/// own.
using NamePath = std::vector<std::string>;

/// "chair", "tree_2/leaf", "wheel*": names that follow each other in a NamePath, where * stands for any letters. What is within
/// an instance or scene of such a name matches as well.
class NamePattern {
 public:
  explicit NamePattern(std::string_view text);
  bool matches(const NamePath&) const;
  /// The names that are looked for, in their order.
  const std::vector<std::string>& names() const { return names_; }
  /// Whether a name is what one of `names` stands for.
  static bool fits(std::string_view pattern, std::string_view name);

 private:
  std::vector<std::string> names_;
};

/// Throws Error at a group without a name or without objects, at two groups of the same name, and at a pattern with a name that
/// no object of the scene has.
void require_groups(const std::vector<Ref<ObjectGroup>>&, const Scene&);

}  // namespace etendue
