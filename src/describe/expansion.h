#pragma once
// Expansion: limits the number of evaluations that shared components cause.

#include <unordered_map>
#include <vector>

#include "etendue/describe/component.h"

namespace etendue {

/// The components that the members of a component refer to, in reverse order of the members.
std::vector<Component*> components_of(const Component&);

/// A component that is used in several places is one object, and a traversal of the component graph visits it once. The
/// evaluation at a ray hit does not: a sum evaluates both of its maps, which may be the same map, so a chain of n such sums
/// evaluates 2^n maps. Results cannot be cached: components that change coordinates, or need another use of a colour, evaluate
/// the map at another point or for another use, and a look-up with all of these as key costs more than most maps do. So the
/// number of evaluations is limited. It is counted with multiplicity, and the limit does not apply to components that have as
/// many parts because all of them were written.
///
/// Scenes within scenes are not counted: a ray visits only the instances near it, and large forests of instances are their
/// purpose. Shaders and media do not count as parts of their objects, since a ray hits one object at a time.
class Expansion {
 public:
  static constexpr double most = 10000;  ///< largest allowed number of evaluated parts of one component

  /// Throws Error at the component if it has too many parts. Its parts must have been checked before.
  void check(const Component&);

 private:
  /// The parts that are evaluated whenever the component is.
  static std::vector<Component*> asked(const Component&);
  [[noreturn]] void fail(const Component&, double parts, size_t written) const;

  std::unordered_map<const Component*, double> parts_;  // evaluated parts with multiplicity, itself included
  std::unordered_map<const Component*, double> right_;  // largest part count accepted in it or below it, for large ones
};

}  // namespace etendue
