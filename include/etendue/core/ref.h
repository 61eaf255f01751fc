#pragma once
// Ref: shared ownership of components, by an intrusive reference count, so that a Ref can be made from a plain pointer.

#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>

namespace etendue {

template <class T>
class Ref {
 public:
  Ref() = default;
  Ref(std::nullptr_t) {}  // NOLINT: null is a Ref to nothing
  explicit Ref(T* p) : p_(p) {
    if (p_) p_->reference();
  }
  Ref(const Ref& b) : Ref(b.p_) {}
  Ref(Ref&& b) noexcept : p_(std::exchange(b.p_, nullptr)) {}
  template <class U>
    requires std::is_convertible_v<U*, T*>
  Ref(const Ref<U>& b) : Ref(b.get()) {}  // NOLINT: converts as pointers do
  ~Ref() {
    if (p_) p_->release();
  }
  Ref& operator=(Ref b) noexcept {
    std::swap(p_, b.p_);
    return *this;
  }

  T* get() const { return p_; }
  T& operator*() const { return *p_; }
  T* operator->() const { return p_; }
  explicit operator bool() const { return p_ != nullptr; }
  friend bool operator==(const Ref& a, const Ref& b) { return a.p_ == b.p_; }

 private:
  T* p_ = nullptr;
};

template <class T, class... Args>
Ref<T> make(Args&&... args) {
  return Ref<T>(new T(std::forward<Args>(args)...));
}

/// A Ref to a derived type, or null if the object is not of that type.
template <class T, class U>
Ref<T> ref_cast(const Ref<U>& r) {
  return Ref<T>(dynamic_cast<T*>(r.get()));
}

}  // namespace etendue
