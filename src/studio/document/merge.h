#pragma once
// Merge: finds the edits that turn a rendered job into one that was read from the present text. Components that remain are the
// same objects, so that what the edits do not affect is kept (Render::edit).

#include <functional>
#include <unordered_map>
#include <vector>

#include "etendue/render/render.h"

namespace etendue::studio {

/// All components of a job, each once, holders before the components they hold.
std::vector<Ref<Component>> components_of(const Job&);

/// The old component for each new one that is paired with one.
using Pairs = std::unordered_map<const Component*, Component*>;

/// The result of a merge.
struct Merge {
  /// All components of the new job. Some are no longer referenced when their holder refers to an old component instead; they
  /// are kept alive here.
  std::vector<Ref<Component>> parts;
  std::vector<Edit> edits;
  Pairs old_of;
  /// The new components without an old one, in no order.
  std::vector<Ref<Component>> fresh;
  /// Whether the component graph has changed.
  bool structure = false;
};

/// `counterpart` returns the old component for a new one by its location in the text, or null. Without a location, components
/// of the same class in the same member of paired components are paired.
Pairs pairs_of(const Job& old, Job& now, const std::function<Component*(const Component&)>& counterpart);

/// Pairs the components and derives the edits. References in the new job to paired components are replaced by references to the
/// old ones.
Merge merge(const Job& old, Job& now, const std::function<Component*(const Component&)>& counterpart);

}  // namespace etendue::studio
