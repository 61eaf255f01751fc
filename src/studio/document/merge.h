#pragma once
// A job that is rendered, and one that was read from the text as it is now: which edits make the one the other. Parts that stay
// are the same objects, so that what the edits do not concern is kept (Render::edit).

#include <functional>
#include <unordered_map>
#include <vector>

#include "etendue/render/render.h"

namespace etendue::studio {

/// All components that a job holds, each once, holders before what they hold.
std::vector<Ref<Component>> components_of(const Job&);

/// Parts of a new job that stand for old ones: those.
using Pairs = std::unordered_map<const Component*, Component*>;

/// What the merge found out.
struct Merge {
  /// All parts of the new job: some are left by what holds them when that refers to old ones instead, and live on here.
  std::vector<Ref<Component>> parts;
  std::vector<Edit> edits;
  Pairs old_of;
  /// The new parts that stay what they are, in no order.
  std::vector<Ref<Component>> fresh;
  /// Whether what holds what has changed.
  bool structure = false;
};

/// `counterpart` gives the old part that a new one stands for by its place in the text, or null. Where places tell nothing,
/// parts of one class that stand in the same member of parts that belong together do.
Pairs pairs_of(const Job& old, Job& now, const std::function<Component*(const Component&)>& counterpart);

/// The same with the edits that follow. Members of the new job's parts that refer to parts which have an old one are set to
/// those.
Merge merge(const Job& old, Job& now, const std::function<Component*(const Component&)>& counterpart);

}  // namespace etendue::studio
