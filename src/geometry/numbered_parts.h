#pragma once
// Shapes that consist of many parts, whose hits return the number of the part.

#include <cstdint>

namespace etendue {

/// Interface by which a CSG solid queries an operand's number of parts, to give the parts of all its operands distinct numbers.
class NumberedParts {
 public:
  /// The `primitive` of hits and surface points is below this number.
  virtual std::uint64_t part_count() const = 0;

 protected:
  ~NumberedParts() = default;
};

}  // namespace etendue
