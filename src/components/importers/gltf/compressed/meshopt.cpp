#include "meshopt.h"

#include <algorithm>
#include <array>
#include <vector>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue::gltf {
namespace {

/// Reads bytes in order; throws Error instead of reading beyond the end.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

  const std::uint8_t* take(size_t count) {
    if (count > bytes_.size() - at_) throw Error("its compressed bytes end too early");
    at_ += count;
    return reinterpret_cast<const std::uint8_t*>(bytes_.data()) + at_ - count;
  }
  std::uint8_t byte() { return *take(1); }
  /// Seven bits in each byte, the lowest first; the eighth bit is set if more bytes follow.
  std::uint32_t varint() {
    std::uint32_t value = 0;
    for (int shift = 0; shift < 35; shift += 7) {
      const std::uint8_t next = byte();
      value |= std::uint32_t(next & 127) << shift;
      if (next < 128) return value;
    }
    throw Error("a number in its compressed bytes does not end");
  }
  void require_end() const {
    if (at_ != bytes_.size()) throw Error("it has more compressed bytes than it needs");
  }

 private:
  std::string_view bytes_;
  size_t at_ = 0;
};

/// Zigzag decoding: 0, 1, 2, 3, … stand for 0, -1, 1, -2, …
template <class T>
T from_zigzag(T v) {
  return T((v >> 1) ^ (0 - (v & 1)));
}

// ---- mode ATTRIBUTES -----------------------------------------------------------------------------------------------------

constexpr size_t group = 16, most_in_block = 256;

/// The differences of a group's bytes, `bits` wide. If all bits of one are set, a full byte follows that replaces it.
void read_group(Bytes& bytes, int bits, std::uint8_t* to) {
  if (bits == 0 || bits == 8) {
    if (bits == 0)
      std::fill_n(to, group, std::uint8_t(0));
    else
      std::copy_n(bytes.take(group), group, to);
    return;
  }
  const std::uint8_t* const packed = bytes.take(size_t(2 * bits));
  const int each = 8 / bits, all_ones = (1 << bits) - 1;
  for (int i = 0; i < int(group); ++i) {
    const int place = i % each, shift = bits == 1 ? place : 8 - bits * (place + 1);
    const int value = packed[i / each] >> shift & all_ones;
    to[i] = value == all_ones ? bytes.byte() : std::uint8_t(value);
  }
}

enum Control { narrow, wide, zeros, whole };  // of version 1

/// The differences of one byte of each element in a block.
void read_plane(Bytes& bytes, bool first_version, int control, size_t elements, std::uint8_t* to) {
  if (control == zeros) std::fill_n(to, elements, std::uint8_t(0));
  if (control == whole) std::copy_n(bytes.take(elements), elements, to);
  if (control == zeros || control == whole) return;
  static constexpr int widths[3][4] = {{0, 2, 4, 8}, {0, 1, 2, 4}, {1, 2, 4, 8}};
  const int* const width = widths[first_version ? 0 : 1 + control];
  const size_t groups = (elements + group - 1) / group;
  const std::uint8_t* const head = bytes.take((groups + 3) / 4);
  for (size_t g = 0; g < groups; ++g) read_group(bytes, width[head[g / 4] >> (2 * (g % 4)) & 3], to + g * group);
}

std::uint32_t rotated_right(std::uint32_t v, int by) { return v >> by | v << ((32 - by) & 31); }

using Planes = std::array<std::array<std::uint8_t, most_in_block>, 4>;

/// Reconstructs four bytes of each element from their differences; `last`: the bytes of the previous element, updated to the
/// last.
void add_differences(const Planes& planes, int channel, size_t elements, size_t stride, std::uint8_t* last, std::uint8_t* to) {
  enum Channel { bytes, pairs, exclusive };
  const int kind = channel & 15;
  for (size_t i = 0; i < elements; ++i, to += stride) {
    if (kind == bytes)
      for (size_t k = 0; k < 4; ++k) last[k] = std::uint8_t(last[k] + from_zigzag<std::uint8_t>(planes[k][i]));
    if (kind == pairs)
      for (size_t k = 0; k < 4; k += 2) {
        const auto difference = from_zigzag<std::uint16_t>(std::uint16_t(planes[k][i] | planes[k + 1][i] << 8));
        const auto sum = std::uint16_t((last[k] | last[k + 1] << 8) + difference);
        last[k] = std::uint8_t(sum);
        last[k + 1] = std::uint8_t(sum >> 8);
      }
    if (kind == exclusive) {
      std::uint32_t difference = 0;
      for (size_t k = 0; k < 4; ++k) difference |= std::uint32_t(planes[k][i]) << (8 * k);
      difference = rotated_right(difference, channel >> 4);
      for (size_t k = 0; k < 4; ++k) last[k] ^= std::uint8_t(difference >> (8 * k));
    }
    std::copy_n(last, 4, to);
  }
}

/// The end of the stream: the element before the first, and for each four bytes the kind of differences.
struct Tail {
  std::array<std::uint8_t, 256> last{};
  std::array<std::uint8_t, 64> channels{};
};

Tail read_tail(std::string_view compressed, bool first_version, size_t stride) {
  Tail tail;
  const size_t channels = first_version ? 0 : stride / 4;
  const char* const at = compressed.data() + compressed.size() - stride - channels;
  std::copy_n(at, stride, tail.last.begin());
  std::copy_n(at + stride, channels, tail.channels.begin());
  for (const std::uint8_t channel : tail.channels)
    if ((channel & 15) > 2 || ((channel & 15) < 2 && channel > 15))
      throw Error("its differences are of kind " + std::to_string(channel) + ", which is unknown");
  return tail;
}

std::string decode_attributes(std::string_view compressed, size_t count, size_t stride) {
  if (stride < 4 || stride > 256 || stride % 4 != 0)
    throw Error("a 'byteStride' of " + std::to_string(stride) + ", of vertices it is a multiple of 4 up to 256");
  const auto head = compressed.empty() ? std::uint8_t(0) : std::uint8_t(compressed[0]);
  if (head != 0xa0 && head != 0xa1) throw Error("it does not begin as compressed vertices of version 0 or 1");
  const bool first_version = head == 0xa0;
  const size_t tail_size = first_version ? std::max<size_t>(stride, 32) : std::max<size_t>(stride + stride / 4, 24);
  const size_t in_block = std::min((8192 / stride) & ~(group - 1), most_in_block);
  // Each block has at least the control data for differences that are all 0 (in the first version for four groups).
  const std::uint64_t blocks = (count + in_block - 1) / in_block, groups = (count + group - 1) / group;
  const std::uint64_t least = first_version ? stride * ((groups + 3) / 4) : blocks * (stride / 4);
  if (compressed.size() < 1 + tail_size || compressed.size() - 1 - tail_size < least)
    throw Error(std::to_string(compressed.size()) + " compressed bytes cannot hold its " + std::to_string(count) + " elements");
  Tail tail = read_tail(compressed, first_version, stride);
  require_memory(double(count) * double(stride), "it");
  std::string decoded(count * stride, '\0');
  Bytes bytes(compressed.substr(1, compressed.size() - 1 - tail_size));
  Planes planes;
  for (size_t begin = 0; begin < count; begin += in_block) {
    const size_t elements = std::min(in_block, count - begin);
    const std::uint8_t* const controls = first_version ? nullptr : bytes.take(stride / 4);
    auto* const to = reinterpret_cast<std::uint8_t*>(decoded.data()) + begin * stride;
    for (size_t channel = 0; channel < stride / 4; ++channel) {
      for (size_t k = 0; k < 4; ++k)
        read_plane(bytes, first_version, first_version ? 0 : controls[channel] >> (2 * k) & 3, elements, planes[k].data());
      add_differences(planes, tail.channels[channel], elements, stride, tail.last.data() + 4 * channel, to + 4 * channel);
    }
  }
  bytes.require_end();
  return decoded;
}

// ---- modes TRIANGLES and INDICES -----------------------------------------------------------------------------------------

/// Collects indices of two or four bytes.
class IndexWriter {
 public:
  IndexWriter(size_t count, size_t stride) : stride_(stride) {
    if (stride != 2 && stride != 4) throw Error("a 'byteStride' of " + std::to_string(stride) + ", of indices it is 2 or 4");
    require_memory(double(count) * double(stride), "it");
    bytes_.reserve(count * stride);
  }
  void add(std::uint32_t index) {
    for (size_t k = 0; k < stride_; ++k) bytes_.push_back(char(index >> (8 * k)));
  }
  std::string taken() { return std::move(bytes_); }

 private:
  size_t stride_;
  std::string bytes_;
};

/// A ring buffer of the sixteen most recent items.
template <class T>
class Recent {
 public:
  void push(const T& one) { all_[count_++ % 16] = one; }
  /// 0 is the latest item.
  const T& operator[](size_t back) const {
    if (back >= std::min<size_t>(count_, 16)) throw Error("its triangles name edges or vertices before the first");
    return all_[(count_ - 1 - back) % 16];
  }

 private:
  std::array<T, 16> all_{};
  size_t count_ = 0;
};

class TriangleReader {
 public:
  TriangleReader(Bytes data, const std::uint8_t* table) : data_(data), table_(table) {}

  std::array<std::uint32_t, 3> triangle(std::uint8_t code) {
    const int high = code >> 4, low = code & 15;
    if (high == 15) return new_triangle(low);
    const auto [a, b] = edges_[size_t(high)];
    std::uint32_t c = 0;
    if (low == 0) c = next_++;
    if (low > 0 && low < 13) c = vertices_[size_t(low)];
    if (low == 13) c = --last_;
    if (low == 14) c = ++last_;
    if (low == 15) c = explicit_index();
    if (low == 0 || low > 12) vertices_.push(c);
    edges_.push({c, b});
    edges_.push({a, c});
    return {a, b, c};
  }
  void require_end() const { data_.require_end(); }

 private:
  // Four bits for each of b and c: a new vertex, a recent vertex, or an explicit index that follows.
  std::array<std::uint32_t, 3> new_triangle(int low) {
    const bool by_table = low < 14;
    const std::uint8_t how = by_table ? table_[low] : data_.byte();
    if (!by_table && how == 0) next_ = 0;
    const std::uint32_t a = low == 15 ? explicit_index() : next_++;
    const std::uint32_t b = corner(how >> 4), c = corner(how & 15);
    edges_.push({b, a});
    edges_.push({c, b});
    edges_.push({a, c});
    vertices_.push(a);
    if (is_new(how >> 4)) vertices_.push(b);
    if (is_new(how & 15)) vertices_.push(c);
    return {a, b, c};
  }
  static bool is_new(int how) { return how == 0 || how == 15; }
  std::uint32_t corner(int how) {
    if (how == 0) return next_++;
    return how == 15 ? explicit_index() : vertices_[size_t(how - 1)];
  }
  std::uint32_t explicit_index() { return last_ += from_zigzag<std::uint32_t>(data_.varint()); }

  Bytes data_;
  const std::uint8_t* table_;
  Recent<std::pair<std::uint32_t, std::uint32_t>> edges_;
  Recent<std::uint32_t> vertices_;
  std::uint32_t next_ = 0, last_ = 0;
};

/// The stream: a header byte, a code for each triangle, data of the codes, and a table of sixteen bytes.
std::string decode_triangles(std::string_view compressed, size_t count, size_t stride) {
  constexpr size_t table_size = 16;
  if (count % 3 != 0) throw Error("its 'count' of " + std::to_string(count) + " is no multiple of 3");
  if (compressed.empty() || std::uint8_t(compressed[0]) != 0xe1) throw Error("it does not begin as compressed triangles");
  if (compressed.size() < 1 + table_size || compressed.size() - 1 - table_size < count / 3)
    throw Error(std::to_string(compressed.size()) + " compressed bytes cannot hold its " + std::to_string(count / 3) +
                " triangles");
  const std::string_view table = compressed.substr(compressed.size() - table_size);
  for (size_t i = 0; i < table_size; ++i)
    if ((table[i] & 15) == 15 || (table[i] >> 4 & 15) == 15 || (i >= 14 && table[i] != 0))
      throw Error("its table of codes is not right");
  const std::string_view codes = compressed.substr(1, count / 3);
  TriangleReader reader(Bytes(compressed.substr(1 + codes.size(), compressed.size() - 1 - codes.size() - table_size)),
                        reinterpret_cast<const std::uint8_t*>(table.data()));
  IndexWriter indices(count, stride);
  for (const char code : codes)
    for (const std::uint32_t corner : reader.triangle(std::uint8_t(code))) indices.add(corner);
  reader.require_end();
  return indices.taken();
}

/// The stream: a header byte, differences from one of two previous indices, and four unused bytes.
std::string decode_indices(std::string_view compressed, size_t count, size_t stride) {
  constexpr size_t tail = 4;
  if (compressed.empty() || std::uint8_t(compressed[0]) != 0xd1) throw Error("it does not begin as compressed indices");
  if (compressed.size() < 1 + tail || compressed.size() - 1 - tail < count)
    throw Error(std::to_string(compressed.size()) + " compressed bytes cannot hold its " + std::to_string(count) + " indices");
  Bytes bytes(compressed.substr(1, compressed.size() - 1 - tail));
  IndexWriter indices(count, stride);
  std::uint32_t last[2] = {0, 0};
  for (size_t i = 0; i < count; ++i) {
    const std::uint32_t code = bytes.varint();
    indices.add(last[code & 1] += from_zigzag<std::uint32_t>(code >> 1));
  }
  bytes.require_end();
  return indices.taken();
}

}  // namespace

std::string decode_meshopt(std::string_view compressed, const MeshoptLayout& layout) {
  if (layout.count > UINT32_MAX) throw Error("it has more than 2^32 elements");
  switch (layout.mode) {
    case MeshoptMode::triangles: return decode_triangles(compressed, layout.count, layout.stride);
    case MeshoptMode::indices: return decode_indices(compressed, layout.count, layout.stride);
    default: break;
  }
  std::string bytes = decode_attributes(compressed, layout.count, layout.stride);
  undo_meshopt_filter(layout.filter, layout.count, layout.stride, bytes.data());
  return bytes;
}

}  // namespace etendue::gltf
