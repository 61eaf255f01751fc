#pragma once
// Places: positions in a text as browsers count them, in UTF-16 units: characters outside of the basic plane count two.

#include <string>
#include <vector>

#include "etendue/core/error.h"

namespace etendue::studio {

class Places {
 public:
  explicit Places(const std::string& text);
  /// The number of UTF-16 units before a byte.
  size_t units(size_t byte) const;
  /// The byte where a UTF-16 unit begins; npos if there is no such unit, or it is within a character.
  size_t byte(size_t unit) const;
  /// The byte at a line and a column in characters, both from 1; the nearest one if the location does not exist.
  size_t byte(const Location&) const;
  size_t size() const { return units_; }

 private:
  static constexpr size_t step = 1024;
  const std::string text_;
  std::vector<size_t> marks_;  // UTF-16 code units before each multiple of `step` bytes; empty for ASCII
  std::vector<size_t> lines_;  // byte position of each line's beginning
  size_t units_ = 0;
};

}  // namespace etendue::studio
