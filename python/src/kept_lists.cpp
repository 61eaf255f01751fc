#include "kept_lists.h"

#include <nanobind/ndarray.h>

#include <map>
#include <utility>

namespace etendue::python {

namespace {

/// What an array owns: the component, whose list it views, or the list itself once the component has another one.
struct Owner {
  Ref<Component> component;
  std::shared_ptr<void> list;
};

using Key = std::pair<const Component*, const Member*>;

/// The owners of the arrays that view a list now; the interpreter's lock guards them.
std::multimap<Key, Owner*>& viewed() {
  static auto* all = new std::multimap<Key, Owner*>;  // never destroyed: arrays outlive the module
  return *all;
}

struct Entry {
  Key key;
  Owner owner;
};

void forget(void* p) noexcept {
  auto* const entry = static_cast<Entry*>(p);
  const auto [begin, end] = viewed().equal_range(entry->key);
  for (auto at = begin; at != end; ++at)
    if (at->second == &entry->owner) {
      viewed().erase(at);
      break;
    }
  delete entry;
}

nb::dlpack::dtype type_of(ListInMemory::Scalar s) {
  switch (s) {
    case ListInMemory::Scalar::float32: return nb::dtype<float>();
    case ListInMemory::Scalar::float64: return nb::dtype<double>();
    case ListInMemory::Scalar::int32: return nb::dtype<std::int32_t>();
    case ListInMemory::Scalar::uint32: return nb::dtype<std::uint32_t>();
    case ListInMemory::Scalar::int64: return nb::dtype<std::int64_t>();
    case ListInMemory::Scalar::uint64: return nb::dtype<std::uint64_t>();
    case ListInMemory::Scalar::other: break;
  }
  throw Error("a list of numbers of this size cannot be viewed as an array");
}

}  // namespace

nb::object view_of(const Ref<Component>& c, const Member& member) {
  const ListInMemory list = member.view(*c);
  auto* const entry = new Entry{{c.get(), &member}, {c, nullptr}};
  viewed().emplace(entry->key, &entry->owner);
  const nb::capsule owner(entry, forget);
  const size_t shape[2] = {list.rows, size_t(list.width)};
  static const double nothing = 0;  // an empty vector has no memory to point to
  return nb::cast(nb::ndarray<nb::numpy, nb::ro>(list.rows > 0 ? list.data : &nothing, list.width > 1 ? 2 : 1, shape, owner,
                                                 nullptr, type_of(list.scalar)),
                  nb::rv_policy::reference);
}

bool is_viewed(const Component& component, const Member& member) { return viewed().contains({&component, &member}); }

KeptList::KeptList(Component& component, const Member* member) : component_(component) {
  if (!member || !member->exchange || !is_viewed(component, *member)) return;
  member_ = member;
  member_->exchange(component_, kept_);
}

void KeptList::replaced() const {
  if (!member_) return;
  const Key key{&component_, member_};
  const auto [begin, end] = viewed().equal_range(key);
  for (auto at = begin; at != end; ++at) at->second->list = kept_;
  viewed().erase(begin, end);
  kept_.reset();
}

KeptList::~KeptList() {
  if (member_ && kept_) member_->exchange(component_, kept_);
}

}  // namespace etendue::python
