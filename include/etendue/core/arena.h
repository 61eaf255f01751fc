#pragma once
// Memory for what one sample needs: handed out in sequence, taken back in the opposite order or all at once.

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

  template <class T, class... Args>
  T* make(Args&&... args) {
    static_assert(std::is_trivially_destructible_v<T>, "arena objects are never destroyed");
    static_assert(sizeof(T) <= block_size);
    return new (allocate(sizeof(T), alignof(T))) T(std::forward<Args>(args)...);
  }

  void reset() { rewind({}); }

  /// How far the arena is used. A path notes it where it begins, and goes back to it at each vertex whose predecessors are no
  /// longer needed: it then takes the memory of one vertex, however long it grows.
  struct Mark {
    size_t block = 0, used = 0;
  };
  Mark mark() const { return {block_, used_}; }
  /// Takes back all that was handed out since the mark.
  void rewind(const Mark& mark) {
    block_ = mark.block;
    used_ = mark.used;
  }

 private:
  void* allocate(size_t size, size_t alignment) {
    size_t at = (used_ + alignment - 1) & ~(alignment - 1);
    if (blocks_.empty() || at + size > block_size) {
      if (!blocks_.empty()) ++block_;
      if (block_ == blocks_.size())
        blocks_.emplace_back(static_cast<std::byte*>(::operator new(block_size, std::align_val_t(64))));
      at = 0;
    }
    used_ = at + size;
    return blocks_[block_].get() + at;
  }

  struct Free {
    void operator()(std::byte* p) const { ::operator delete(p, std::align_val_t(64)); }
  };
  std::vector<std::unique_ptr<std::byte, Free>> blocks_;
  size_t block_ = 0, used_ = 0;
};

/// Takes back, at its end, what was handed out while it lived.
class ArenaScope {
 public:
  explicit ArenaScope(Arena& arena) : arena_(arena), begun_(arena.mark()) {}
  ~ArenaScope() { arena_.rewind(begun_); }
  ArenaScope(const ArenaScope&) = delete;
  ArenaScope& operator=(const ArenaScope&) = delete;

 private:
  Arena& arena_;
  const Arena::Mark begun_;
};

}  // namespace etendue
