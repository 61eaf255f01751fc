#pragma once
// Accessors: lists of numbers or vectors in the buffers of a glTF file.

#include <cstdint>
#include <vector>

#include "document.h"

namespace etendue::gltf {

/// Bytes of a number of a type, by glTF's code. Throws Error when there is no such type.
size_t size_of_component(int component);

struct Accessor {
  Accessor(const Document&, size_t index);

  size_t count = 0, width = 0;  ///< elements, and numbers of each
  int component = 0;            ///< type of a number, by glTF's code
  bool normalized = false;

  /// All numbers, element after element. Throws Error when it has another width than one of these.
  std::vector<float> floats() const;
  /// The same straight to where `count * width` floats have room.
  void floats(float* to) const;
  /// Whether its numbers are whole ones, not negative, and mean that.
  bool whole_numbers() const;
  /// As whole numbers, not negative.
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
