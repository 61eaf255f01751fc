#pragma once
// PerObject: a lock-free cache of one number for each object that has an emission, computed when it is first needed.

#include <atomic>
#include <memory>

#include "etendue/scene_object.h"

namespace etendue {

/// Emissions are prepared before the objects that carry them, so a number that depends on both is computed later, while
/// rendering, by the first thread that needs it. All threads compute the same number, and none waits for another.
///
/// Slots lie in hash tables, each eight times as long as the one before and allocated when a probe of the one before finds no
/// free slot: a lamp may have a million instances. An object's slot is the first one that was free among the 16 slots probed in
/// the first table, then in the second and so on; slots are never released, so all threads find the same slot.
class PerObject {
 public:
  PerObject() = default;
  PerObject(const PerObject&) = delete;
  PerObject& operator=(const PerObject&) = delete;
  ~PerObject() { clear(); }

  /// Removes all numbers. Must not be called while rendering.
  void forget() {
    if (!used_.exchange(false)) return;
    clear();
    table(0);
  }
  /// Allocates the first table now, before rendering.
  void expect() { table(0); }

  /// The number of an object. find() computes it and must return a number that is not negative.
  template <class F>
  double get(const SceneObject& object, const F& find) const {
    const size_t first = size_t(mix_bits(reinterpret_cast<std::uintptr_t>(&object)));
    for (size_t t = 0; t < tables; ++t) {
      Slot* slots = table(t);
      for (size_t i = 0; i < tries; ++i) {
        Slot& slot = slots[(first + i) % length(t)];
        const SceneObject* owner = slot.object.load(std::memory_order_acquire);
        if (owner == &object) {
          const double known = slot.number.load(std::memory_order_acquire);
          return known >= 0 ? known : find();  // another thread has the slot but has not stored the number yet
        }
        if (owner != nullptr) continue;
        const double found = find();
        if (slot.object.compare_exchange_strong(owner, &object) || owner == &object) {
          slot.number.store(found, std::memory_order_release);
          used_.store(true, std::memory_order_relaxed);
          return found;
        }
      }
    }
    return find();  // no slot is free: computed at every call, slow but correct
  }

 private:
  static constexpr size_t tables = 5, tries = 16;
  static constexpr size_t length(size_t t) { return size_t(1024) << (3 * t); }
  struct Slot {
    std::atomic<const SceneObject*> object{nullptr};
    std::atomic<double> number{-1};
  };

  Slot* table(size_t t) const {
    Slot* there = tables_[t].load(std::memory_order_acquire);
    if (there) [[likely]]
      return there;
    auto made = std::make_unique<Slot[]>(length(t));
    return tables_[t].compare_exchange_strong(there, made.get()) ? made.release() : there;
  }
  void clear() {
    for (std::atomic<Slot*>& table : tables_) delete[] table.exchange(nullptr);
  }

  mutable std::atomic<bool> used_{false};
  mutable std::atomic<Slot*> tables_[tables] = {};
};

}  // namespace etendue
