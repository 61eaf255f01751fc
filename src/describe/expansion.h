#pragma once
// What shared parts amount to where each of their places counts.

#include <unordered_map>
#include <vector>

#include "etendue/describe/component.h"

namespace etendue {

/// The components that the members of a component refer to, in reverse order of the members.
std::vector<Component*> components_of(const Component&);

/// A component that stands in several places is one object, and whatever goes over the graph of components visits it once. Not
/// so what happens at a hit: a sum asks both its maps, which may be one and the same map, and so on; a chain of n sums of this
/// kind asks 2^n times. Values cannot be kept from one place for another: a map is asked for at another point, for another use,
/// by those that change the coordinates or need a factor, and a look-up by all of these costs more than most maps do. So there
/// is a bound. It counts each place, as evaluation does, and does not apply to what has as many parts because they were
/// written.
///
/// Scenes within scenes are not counted: a ray visits of them what it comes near, and a forest of forests is what they are for.
/// The shaders and media of objects do not count as parts of the objects, of which a ray meets one at a time.
class Expansion {
 public:
  static constexpr double most = 10000;  ///< parts that one component may amount to

  /// Throws an Error at the component when it has more parts. All that it refers to was checked before.
  void check(const Component&);

 private:
  /// The parts that are asked each time the component is.
  static std::vector<Component*> asked(const Component&);
  [[noreturn]] void fail(const Component&, double parts, size_t written) const;

  std::unordered_map<const Component*, double> parts_;  // each in all its places, the component itself among them
  std::unordered_map<const Component*, double> right_;  // of large ones, how many were found right, in it or below it
};

}  // namespace etendue
