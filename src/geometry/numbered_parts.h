#pragma once
// Objects whose hits name one of many parts.

#include <cstdint>

namespace etendue {

/// What a solid must know of an operand to keep its parts apart from those of others.
class NumberedParts {
 public:
  /// Hits and points name parts below this number in `primitive`.
  virtual std::uint64_t part_count() const = 0;

 protected:
  ~NumberedParts() = default;
};

}  // namespace etendue
