#pragma once
// The corners of an OBJ file's faces as vertices.

#include <cstdint>
#include <string>
#include <vector>

#include "obj_lines.h"

namespace etendue {

/// Vertices by (position, uv, normal): those of one position form a chain, mostly of length one.
class Vertices {
 public:
  static constexpr std::uint32_t none = 0xffffffffu;
  explicit Vertices(size_t positions) : first_(positions, none) {}

  std::uint32_t find(std::uint32_t position, std::uint32_t uv, std::uint32_t normal) {
    for (std::uint32_t i = first_[position]; i != none; i = corners_[i].next)
      if (corners_[i].uv == uv && corners_[i].normal == normal) return i;
    corners_.push_back({position, uv, normal, first_[position]});
    return first_[position] = std::uint32_t(corners_.size() - 1);
  }

  struct Corner {
    std::uint32_t position, uv, normal, next;
  };
  const std::vector<Corner>& corners() const { return corners_; }

 private:
  std::vector<std::uint32_t> first_;
  std::vector<Corner> corners_;
};

inline std::uint32_t read_index(Lines& lines, size_t so_far, size_t all, const char* what) {
  const std::int64_t given = lines.integer();
  const std::int64_t index = given < 0 ? std::int64_t(so_far) + given : given - 1;
  if (given == 0) lines.error(std::string("the index of a ") + what + " is 0; they count from 1");
  if (index < 0 || index >= std::int64_t(all))
    lines.error(std::string("refers to ") + what + " " + std::to_string(given) + " of " +
                std::to_string(given < 0 ? so_far : all));
  return std::uint32_t(index);
}

}  // namespace etendue
