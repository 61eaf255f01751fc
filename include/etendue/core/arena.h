#pragma once
// Arena: a memory arena (pbrt's MemoryArena) for the objects of one sample. Memory is allocated sequentially, and freed in
// reverse order or all at once.

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

  /// A position in the arena. A path stores its mark at the start, and rewinds to it at each vertex whose predecessors are no
  /// longer needed: it then uses the memory of one vertex, whatever its length.
  struct Mark {
    size_t block = 0, used = 0;
  };
  Mark mark() const { return {block_, used_}; }
  /// Frees everything allocated since the mark.
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

/// Frees in its destructor everything that was allocated during its lifetime.
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
