#pragma once
// Accessors: typed arrays of numbers or vectors in the buffers of a glTF file.

#include <cstdint>
#include <vector>

#include "document.h"

namespace etendue::gltf {

/// Size of a component type, given by glTF's code [bytes]. Throws Error for an unknown type.
size_t size_of_component(int component);

struct Accessor {
  Accessor(const Document&, size_t index);

  size_t count = 0, width = 0;  ///< number of elements, and components of each
  int component = 0;            ///< component type, by glTF's code
  bool normalized = false;

  /// All numbers, element after element. Throws Error if the file's data is damaged.
  std::vector<float> floats() const;
  /// The same, written to an array of `count * width` floats.
  void floats(float* to) const;
  /// Whether its elements are single unsigned integers that are not normalized.
  bool whole_numbers() const;
  /// The numbers as unsigned integers.
  std::vector<std::uint32_t> indices() const;

 private:
  template <class Take>
  void elements(Take take) const;
  template <class Take>
  void sparse(Take take) const;

  const Document& document_;
  const Json* json_;
  size_t index_;
};

}  // namespace etendue::gltf
