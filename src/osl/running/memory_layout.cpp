#include "memory_layout.h"

#include <algorithm>
#include <cstring>

#include "etendue/core/error.h"
#include "osl/values/interned_string.h"

namespace etendue::osl {

std::uint32_t MemoryLayout::bytes(std::size_t size, std::size_t align, Use use) {
  const std::size_t offset = (image_.size() + align - 1) / align * align;
  if (size > limit || offset + size > limit) throw Error("the variables of the shaders take more than 256 MB");
  image_.resize(offset + size);
  areas_.push_back({std::uint32_t(offset), std::uint32_t(size), use});
  return std::uint32_t(offset);
}

Memory MemoryLayout::allocate(const Type& type, bool derivatives, Use use) {
  const std::size_t size = type.size();
  Memory m{type, bytes(size * (derivatives ? 3 : 1), std::max<std::size_t>(type.alignment(), 4), use),
           derivatives ? std::uint32_t(size) : 0};
  clear(type, image_.data() + m.offset);
  return m;
}

Memory MemoryLayout::constant(const Type& type, std::span<const std::byte> value) {
  const Memory m = allocate(type, false, Use::constant);
  std::memcpy(image_.data() + m.offset, value.data(), std::min(value.size(), type.size()));
  return m;
}

Memory MemoryLayout::temporary(const Type& type, bool derivatives) {
  // Blocks of equal size are interchangeable: all are aligned alike.
  const std::size_t align = std::max<std::size_t>(type.alignment(), 8);
  const std::size_t needed = (type.size() * (derivatives ? 3 : 1) + align - 1) / align * align;
  Block block{0, std::uint32_t(std::min(needed, limit))};
  const auto old =
      std::find_if(free_.begin(), free_.end(), [&](const Block& b) { return b.size == needed && b.offset % align == 0; });
  if (old != free_.end()) {
    block = *old;
    free_.erase(old);
  } else {
    block.offset = bytes(needed, align, Use::own);
  }
  live_.push_back(block);
  clear(type, image_.data() + block.offset);
  return {type, block.offset, derivatives ? std::uint32_t(type.size()) : 0};
}

void MemoryLayout::release(std::size_t mark) {
  free_.insert(free_.end(), live_.begin() + std::ptrdiff_t(mark), live_.end());
  live_.resize(mark);
}

void MemoryLayout::clear(const Type& type, std::byte* value) {
  std::memset(value, 0, type.size());
  if (type.base != Base::string && !type.is_structure()) return;
  const std::size_t step = type.element_size();
  for (int i = 0; i < type.elements(); ++i, value += step) {
    if (type.base == Base::string)
      *reinterpret_cast<const String**>(value) = empty_string();
    else
      for (const Field& field : type.structure->fields) clear(field.type, value + field.offset);
  }
}

}  // namespace etendue::osl
