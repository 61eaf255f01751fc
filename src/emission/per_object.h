#pragma once
// A number that belongs to each object which has an emission: found when the object is first met, then remembered.

#include <atomic>
#include <memory>

#include "etendue/scene_object.h"

namespace etendue {

/// Objects are not prepared yet when the emission they carry is, so what depends on both is found later, while rendering,
/// by whichever thread comes first. It is the same whoever finds it, and nobody waits.
class PerObject {
 public:
  /// Forgets all. Not while rendering.
  void reset() { slots_ = std::make_unique<Slot[]>(count); }

  /// The number of an object; find() computes it, and gives a number that is not negative.
  template <class F>
  double get(const SceneObject& object, const F& find) const {
    const size_t first = size_t(mix_bits(reinterpret_cast<std::uintptr_t>(&object)));
    for (size_t i = 0; i < count; ++i) {
      Slot& slot = slots_[(first + i) % count];
      const SceneObject* owner = slot.object.load(std::memory_order_acquire);
      if (owner == &object) {
        const double known = slot.number.load(std::memory_order_acquire);
        return known >= 0 ? known : find();  // another thread is finding it
      }
      if (owner != nullptr) continue;
      const double found = find();
      if (slot.object.compare_exchange_strong(owner, &object) || owner == &object) {
        slot.number.store(found, std::memory_order_release);
        return found;
      }
    }
    return find();  // more objects than slots: slow, and right
  }

 private:
  static constexpr size_t count = 1024;
  struct Slot {
    std::atomic<const SceneObject*> object{nullptr};
    std::atomic<double> number{-1};
  };
  std::unique_ptr<Slot[]> slots_;
};

}  // namespace etendue
