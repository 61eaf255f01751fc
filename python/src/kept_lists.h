#pragma once
// Lists of numbers that Python's arrays view without a copy. An array that views a list stays valid when the member is set
// anew: the list it views is then kept for as long as the array lives.

#include <memory>

#include "binding.h"

namespace etendue::python {

/// A read-only array of the member's list, shape (rows,) or (rows, width), which shares the component's memory.
nb::object view_of(const Ref<Component>&, const Member&);
/// Whether an array views the list that the member has now.
bool is_viewed(const Component&, const Member&);

/// Guards the arrays of one member while the member is set. Made before; `replaced` is called when the new value is in place.
/// Without that call, because the value was refused, the old list is put back.
class KeptList {
 public:
  /// `member` may be null, or no list of numbers: then nothing is done.
  KeptList(Component&, const Member*);
  ~KeptList();
  KeptList(const KeptList&) = delete;
  KeptList& operator=(const KeptList&) = delete;
  void replaced() const;

 private:
  Component& component_;
  const Member* member_ = nullptr;  // null: no array views the list
  mutable std::shared_ptr<void> kept_;
};

}  // namespace etendue::python
