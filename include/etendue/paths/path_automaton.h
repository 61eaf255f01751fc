#pragma once
// PathAutomaton: one deterministic automaton for several light path expressions, which reads paths from either end.
//
// Each event of an expression is a position p; q -> p if p may follow q (the automaton of Glushkov 1961). A path's first events
// lead to the set F of positions where the part read so far may end: the states of the forward automaton are these sets
// (subset construction, Rabin & Scott 1959). A path's last events, read from the emitter, have the set B of positions after
// which they complete an expression: the states of the backward automaton. A path whose first events have F and whose other
// events have B matches the expressions that have positions in the intersection of F and B. So a path can be cut anywhere, at a
// connection or a merge, and neither part depends on the other.
//
// The states are those that paths can reach: C, then scattering, then one of L, B, O. All are found beforehand, and their
// number is bounded, so that tracing paths needs no locks and takes the same steps in every thread.

#include <span>

#include "etendue/paths/path_expression.h"

namespace etendue {

class PathAutomaton {
 public:
  /// A state of either automaton.
  using State = std::uint16_t;
  /// A set of expressions, as bits.
  using Matches = std::uint32_t;

  PathAutomaton() = default;
  /// `classes`: the sets of labels that objects have, the first of them empty. Throws Error, whose text tells the expression,
  /// if one can match no path, and if the automaton has too many states.
  PathAutomaton(std::span<const PathExpression> expressions, std::span<const PathLabels> classes);

  /// The state after C.
  static constexpr State after_camera = 0;
  /// The state after one more scattering, from the camera.
  State scattered(State before, PathEvent event, int label_class) const {
    return forward_[before * letters_ + letter(event, label_class)];
  }
  /// The expressions that a path matches which ends after a forward state with this event, L, B or O.
  Matches ended(State before, PathEvent event, int label_class) const {
    return ends_[before * letters_ + letter(event, label_class)];
  }

  /// The backward state of such an end alone.
  State end(PathEvent event, int label_class) const { return last_[letter(event, label_class)]; }
  /// The state after one more scattering, from the emitter.
  State scattered_before(State after, PathEvent event, int label_class) const {
    return backward_[after * letters_ + letter(event, label_class)];
  }
  /// The expressions that a path matches whose first events have a forward state, and the others a backward state.
  Matches joined(State first, State rest) const { return joined_[size_t(first) * backward_states_ + rest]; }

  size_t forward_states() const { return forward_states_; }
  size_t backward_states() const { return backward_states_; }

 private:
  size_t letter(PathEvent event, int label_class) const {
    return letter_of_[size_t(label_class) * path_event_count + size_t(event)];
  }

  size_t letters_ = 0, forward_states_ = 0, backward_states_ = 0;
  std::vector<std::uint16_t> letter_of_;  ///< of each class of labels and kind of event: those that no expression tells apart
                                          ///< are one letter
  std::vector<State> forward_, backward_, last_;  ///< by state and letter
  std::vector<Matches> ends_, joined_;
};

}  // namespace etendue
