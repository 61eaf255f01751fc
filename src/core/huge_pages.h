#pragma once
// HugePages: an allocator for large arrays that are read in random order.

#include <sys/mman.h>

#include <cstdlib>
#include <new>
#include <vector>

namespace etendue {

/// Asks the kernel for pages of 2 MB. A ray reads nodes and triangles from all over an array, and with pages of 4 kB nearly
/// each of them misses the processor's cache of page addresses (the TLB), which covers some MB; the address is then looked up
/// in memory, before what is there. Only a wish (madvise): without such pages all else is the same.
template <class T>
struct HugePages {
  using value_type = T;
  static constexpr size_t page = size_t(1) << 21;

  HugePages() = default;
  template <class U>
  HugePages(const HugePages<U>&) {}  // NOLINT: implicit, as allocators are

  T* allocate(size_t count) {
    if (count > (~size_t(0) - page) / sizeof(T)) throw std::bad_alloc();
    size_t bytes = count * sizeof(T);
    if (!large(bytes)) return static_cast<T*>(::operator new(bytes, std::align_val_t(alignof(T))));
    bytes = (bytes + page - 1) / page * page;
    void* const memory = ::operator new(bytes, std::align_val_t(page));
    madvise(memory, bytes, MADV_HUGEPAGE);
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t count) {
    ::operator delete(memory, std::align_val_t(large(count * sizeof(T)) ? page : alignof(T)));
  }
  bool operator==(const HugePages&) const { return true; }

 private:
  /// From half a page on, so that at most half of the memory is not used.
  static bool large(size_t bytes) { return bytes >= page / 2; }
};

template <class T>
using HugeVector = std::vector<T, HugePages<T>>;

}  // namespace etendue
