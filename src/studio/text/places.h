#pragma once
// Places in a text as browsers count them: in units of UTF-16, where characters beyond the basic plane count two.

#include <string>
#include <vector>

#include "etendue/core/error.h"

namespace etendue::studio {

class Places {
 public:
  explicit Places(const std::string& text);
  /// UTF-16 units before a byte.
  size_t units(size_t byte) const;
  /// The byte at which a unit begins; npos when the text has none of this number, or it lies within a character.
  size_t byte(size_t unit) const;
  /// The byte of a line and a column in characters, both from 1; the nearest when there is none.
  size_t byte(const Location&) const;
  size_t size() const { return units_; }

 private:
  static constexpr size_t step = 1024;
  const std::string text_;
  std::vector<size_t> marks_;  // units before each multiple of `step` bytes; empty for ASCII
  std::vector<size_t> lines_;  // where each line begins
  size_t units_ = 0;
};

}  // namespace etendue::studio
