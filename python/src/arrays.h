#pragma once
// Arrays of NumPy that own their numbers.

#include <nanobind/ndarray.h>

#include <initializer_list>
#include <vector>

#include "binding.h"

namespace etendue::python {

/// An array that takes over the values; the product of the sizes is their number.
template <class T>
nb::object array_from(std::vector<T> values, std::initializer_list<size_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const nb::capsule owner(kept, [](void* p) noexcept { delete static_cast<std::vector<T>*>(p); });
  static T nothing{};  // an empty vector has no memory to point to
  return nb::cast(nb::ndarray<nb::numpy, T>(kept->empty() ? &nothing : kept->data(), shape.size(), shape.begin(), owner),
                  nb::rv_policy::reference);
}

}  // namespace etendue::python
