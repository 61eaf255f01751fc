#pragma once
// Memory for what one sample needs: handed out in sequence, taken back all at once, never freed between.

#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>
#include <vector>

namespace etendue {

/// One per thread. Objects must need no destructor.
class Arena {
 public:
  static constexpr size_t block_size = size_t(1) << 16;

  Arena() = default;
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  template <class T, class... Args>
  T* make(Args&&... args) {
    static_assert(std::is_trivially_destructible_v<T>, "arena objects are never destroyed");
    static_assert(sizeof(T) <= block_size);
    return new (allocate(sizeof(T), alignof(T))) T(std::forward<Args>(args)...);
  }

  void reset() {
    used_ = 0;
    if (block_ > 0) take(0);
  }

 private:
  void* allocate(size_t size, size_t alignment) {
    size_t at = (used_ + alignment - 1) & ~(alignment - 1);
    if (at + size > room_) [[unlikely]] {
      take(room_ == 0 ? 0 : block_ + 1);
      at = 0;
    }
    used_ = at + size;
    return begin_ + at;
  }
  /// Goes on in a block.
  [[gnu::noinline]] void take(size_t block) {
    if (block == blocks_.size())
      blocks_.emplace_back(static_cast<std::byte*>(::operator new(block_size, std::align_val_t(64))));
    block_ = block;
    begin_ = blocks_[block].get();
    room_ = block_size;
  }

  struct Free {
    void operator()(std::byte* p) const { ::operator delete(p, std::align_val_t(64)); }
  };
  std::vector<std::unique_ptr<std::byte, Free>> blocks_;
  size_t block_ = 0, used_ = 0, room_ = 0;  // of the block gone on in: its number, bytes handed out, bytes in all
  std::byte* begin_ = nullptr;
};

}  // namespace etendue
