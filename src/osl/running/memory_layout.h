#pragma once
// MemoryLayout: where the values of a group lie in its frame, the one block of memory of a run.
//
// A frame begins with the globals. Symbols and constants have places of their own; temporaries are freed when their statement
// ends, and their places are used again. The image of the frame, which holds the constants and the initial values, is copied
// once for each thread; a run does not change the constants.

#include <cstdint>
#include <span>
#include <vector>

#include "osl/values/type.h"

namespace etendue::osl {

/// Where a value lies: `offset` bytes from the beginning of the frame, its derivatives by x and y `stride` and 2 `stride` bytes
/// behind it. Stride 0: it has none, that is, they are zero.
struct Memory {
  Type type;
  std::uint32_t offset = 0, stride = 0;

  bool derivatives() const { return stride != 0; }
  /// Whether the derivatives follow the value directly, as the library's functions expect it.
  bool contiguous() const { return stride == 0 || stride == type.size(); }
};

class MemoryLayout {
 public:
  static constexpr std::size_t alignment = 64;                ///< of frames [bytes]
  static constexpr std::size_t limit = std::size_t(1) << 28;  ///< largest frame [bytes]

  /// Who reads and writes an area of the frame. Compiled code keeps what is a layer's own in registers, and knows what is
  /// constant.
  enum class Use : unsigned char { shared, own, constant };
  struct Area {
    std::uint32_t offset, size;
    Use use;
  };

  explicit MemoryLayout(std::size_t globals_size) { bytes(globals_size, 1, Use::shared); }

  /// A place for good, with the value zero or "". Throws Error if the frame becomes too large.
  Memory allocate(const Type&, bool derivatives, Use);
  Memory constant(const Type&, std::span<const std::byte> value);
  std::uint32_t bytes(std::size_t size, std::size_t align, Use);

  /// A place until the temporaries of the statement are released.
  Memory temporary(const Type&, bool derivatives);
  std::size_t mark() const { return live_.size(); }
  void release(std::size_t mark);
  /// Later temporaries use no place of earlier ones. Each layer has its own, as it may run in the middle of another's
  /// statement.
  void keep_apart() { free_.clear(); }

  std::span<std::byte> at(const Memory& m) { return std::span(image_).subspan(m.offset, m.type.size()); }
  const std::vector<std::byte>& image() const { return image_; }
  /// In the order of their offsets.
  const std::vector<Area>& areas() const { return areas_; }

  /// Sets a value to zero, or its strings to "".
  static void clear(const Type&, std::byte* value);

 private:
  struct Block {
    std::uint32_t offset, size;
  };
  std::vector<std::byte> image_;
  std::vector<Area> areas_;
  std::vector<Block> live_, free_;
};

}  // namespace etendue::osl
