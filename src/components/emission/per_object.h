#pragma once
// A number that belongs to each object which has an emission: found when the object is first met, then remembered.

#include <atomic>
#include <memory>

#include "etendue/scene_object.h"

namespace etendue {

/// Objects are not prepared yet when the emission they carry is, so what depends on both is found later, while rendering,
/// by whichever thread comes first. It is the same whoever finds it, and nobody waits.
///
/// Slots lie in tables, each eight times as long as the one before and made when that fills up: a lamp may stand in a million
/// places. An object's slot is the first that was free among a few in the first table, a few in the second and so on; slots
/// are never given back, so all threads come to the same.
class PerObject {
 public:
  PerObject() = default;
  PerObject(const PerObject&) = delete;
  PerObject& operator=(const PerObject&) = delete;
  ~PerObject() { clear(); }

  /// Forgets all. Not while rendering.
  void forget() {
    if (!used_.exchange(false)) return;
    clear();
    table(0);
  }
  /// Takes memory now for what will surely be asked for.
  void expect() { table(0); }

  /// The number of an object; find() computes it, and gives a number that is not negative.
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
          return known >= 0 ? known : find();  // another thread is finding it
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
    return find();  // more objects than slots: slow, and right
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
