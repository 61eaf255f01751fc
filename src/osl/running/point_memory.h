#pragma once
// PointMemory: memory for the closures of one point, all freed at once. For Services::allocate.

#include <cstddef>
#include <memory>
#include <vector>

namespace etendue::osl {

class PointMemory {
 public:
  static constexpr std::size_t limit = std::size_t(1) << 26;  ///< [bytes] of one point

  /// Throws Error beyond the limit: a shader that adds closures in an endless loop is stopped.
  void* allocate(std::size_t size, std::size_t alignment);
  /// Frees all; keeps the blocks for the next point.
  void reset() { block_ = used_ = total_ = 0; }

 private:
  static constexpr std::size_t block_size = std::size_t(1) << 14;
  struct Free {
    void operator()(std::byte* p) const;
  };
  struct Block {
    std::unique_ptr<std::byte, Free> bytes;
    std::size_t size;
  };
  std::vector<Block> blocks_;
  std::size_t block_ = 0, used_ = 0, total_ = 0;
};

}  // namespace etendue::osl
