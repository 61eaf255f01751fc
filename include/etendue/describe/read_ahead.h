#pragma once
// Components whose `prepare` reads files.

namespace etendue {

/// A second base of such a component: before anything is prepared, prepare_tree has all of them read at the same time.
class ReadsAhead {
 public:
  virtual ~ReadsAhead() = default;
  /// Reads what `prepare` is going to ask for, and keeps it until then. It looks at nothing but the component's own members, is
  /// called from any thread, and leaves what is wrong to `prepare`, which finds it again and knows the place: what it throws
  /// is dropped.
  virtual void read_ahead() = 0;
};

}  // namespace etendue
