#pragma once
// ReadsAhead: an interface for components whose `prepare` reads files, so that files are read in parallel.

namespace etendue {

/// A second base class of such a component. Before any component is prepared, prepare_tree calls read_ahead of all of them in
/// parallel.
class ReadsAhead {
 public:
  virtual ~ReadsAhead() = default;
  /// Reads the files that `prepare` will need, and keeps them until then. It may use only the component's own members, and is
  /// called from any thread. Exceptions are dropped: `prepare` detects the same error again, and reports it with its location.
  virtual void read_ahead() = 0;
};

}  // namespace etendue
