#include "point_memory.h"

#include <algorithm>
#include <new>

#include "etendue/core/error.h"

namespace etendue::osl {

void PointMemory::Free::operator()(std::byte* p) const { ::operator delete(p, std::align_val_t(64)); }

void* PointMemory::allocate(std::size_t size, std::size_t alignment) {
  total_ += size;
  if (total_ > limit) throw Error("the closures of one point take more than 64 MB");
  for (;; ++block_, used_ = 0) {
    if (block_ == blocks_.size()) {
      const std::size_t bytes = std::max(block_size, size);
      blocks_.push_back(
          {std::unique_ptr<std::byte, Free>(static_cast<std::byte*>(::operator new(bytes, std::align_val_t(64)))), bytes});
    }
    const std::size_t at = (used_ + alignment - 1) / alignment * alignment;
    if (at + size > blocks_[block_].size) continue;
    used_ = at + size;
    return blocks_[block_].bytes.get() + at;
  }
}

}  // namespace etendue::osl
