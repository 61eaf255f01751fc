#include "nanovdb_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "etendue/core/error.h"
#include "files/regular_file.h"

// A grid's bytes (version 32; the numbers are those of its headers' documentation). Offsets of children count from the node
// that holds them. A node's entries run with z fastest.
//     grid, 672     0 "NanoVDB0" or "NanoVDB1"; 384 matrix from indices to the world (9 doubles); 528 translation (3 doubles);
//                   636 type of values
//     tree, 64      24 offset of the root
//     root          0 box of the active values' indices (6 int32, the last included); 24 how many entries (uint32);
//                   28 the value where there is no entry; then the entries, 32 bytes each:
//                   0 key; 8 offset of the child (int64; 0: none, the value is that of all 4096^3); 20 value
//     upper node    32 mask of the 32^3 entries that are active (bits), 4128 mask of the entries that have children; then the
//                   entries: an offset or a value
//     lower node    32 and 544, the same masks for 16^3 entries; then the entries
//     leaf          its values; for the quantized types: 15 number of bits, 80 least value, 84 step, and 512 whole numbers

namespace etendue {
namespace {

constexpr std::int64_t most_cells = std::int64_t(1) << 30;

/// Sizes and offsets in the grid's bytes for a type of values.
struct Layout {
  int channels;
  size_t root_size, entry_stride, leaf_table, leaf_size;
  int log_bits;  ///< of quantized values, log2 of their number of bits; -1: floats; -2: stored in each leaf
};
Layout layout_of(std::uint32_t type) {
  switch (type) {
    case 1: return {1, 64, 8, 96, 2144, -1};
    case 6: return {3, 96, 16, 128, 6272, -1};
    case 13: return {1, 64, 8, 96, 352, 2};
    case 14: return {1, 64, 8, 96, 608, 3};
    case 15: return {1, 64, 8, 96, 1120, 4};
    case 16: return {1, 64, 8, 96, 96, -2};
    default: throw Error(fmt::format("its values are of type {}; known are floats, rounded or not, and three floats", type));
  }
}

/// Bounds-checked access to the bytes of a grid.
class Bytes {
 public:
  explicit Bytes(const std::vector<unsigned char>& bytes) : bytes_(bytes) {}
  template <class T>
  T at(std::int64_t offset) const {
    T v;
    std::memcpy(&v, range(offset, sizeof v), sizeof v);
    return v;
  }
  /// Pointer to `size` bytes at an offset. Throws Error unless all of them lie within the grid.
  const unsigned char* range(std::int64_t offset, size_t size) const {
    if (offset < 0 || std::uint64_t(offset) > bytes_.size() || size > bytes_.size() - std::uint64_t(offset))
      throw Error("it points beyond its end");
    return bytes_.data() + offset;
  }

 private:
  const std::vector<unsigned char>& bytes_;
};

using Index = std::array<std::int64_t, 3>;

/// From the first to the last index along each axis.
struct IndexBox {
  Index first, last;
  bool empty() const { return first[0] > last[0] || first[1] > last[1] || first[2] > last[2]; }
  IndexBox within(const IndexBox& b) const {
    IndexBox both;
    for (size_t k = 0; k < 3; ++k) {
      both.first[k] = std::max(first[k], b.first[k]);
      both.last[k] = std::min(last[k], b.last[k]);
    }
    return both;
  }
};

class DenseGrid {
 public:
  explicit DenseGrid(const std::vector<unsigned char>& bytes) : bytes_(bytes) {}

  VolumeGrid read() {
    if (std::memcmp(bytes_.range(0, 8), "NanoVDB0", 8) != 0 && std::memcmp(bytes_.range(0, 8), "NanoVDB1", 8) != 0)
      throw Error("its grid does not begin with \"NanoVDB\"");
    layout_ = layout_of(bytes_.at<std::uint32_t>(636));
    constexpr std::int64_t tree = 672;
    const std::int64_t root =
        offset_from(tree, bytes_.at<std::int64_t>(tree + 24));  // checked wherever something is read there
    for (size_t k = 0; k < 3; ++k) {
      box_.first[k] = bytes_.at<std::int32_t>(root + 4 * std::int64_t(k));
      box_.last[k] = bytes_.at<std::int32_t>(root + 12 + 4 * std::int64_t(k));
    }
    if (box_.empty()) throw Error("its grid holds no active values");
    make_room(root + 28);
    std::int64_t count = bytes_.at<std::uint32_t>(root + 24);
    bytes_.range(root + std::int64_t(layout_.root_size), size_t(count) * 32);
    std::set<std::uint64_t> keys;
    for (std::int64_t entry = root + std::int64_t(layout_.root_size); count > 0; --count, entry += 32) {
      const auto key = bytes_.at<std::uint64_t>(entry);
      if (!keys.insert(key).second) throw Error("two parts of its grid are in one place");
      const auto along = [key](int shift) { return std::int64_t(std::int32_t(std::uint32_t(key >> shift) << 12)); };
      const Index origin{along(42), along(21), along(0)};
      const auto child = bytes_.at<std::int64_t>(entry + 8);
      if (child == 0)
        fill(cube(origin, 4096), entry + 20);
      else
        node(offset_from(root, child), origin, 32, 128);
    }
    return std::move(grid_);
  }

 private:
  static std::int64_t offset_from(std::int64_t base, std::int64_t offset) {
    constexpr std::int64_t most = std::int64_t(1) << 48;
    if (offset > most || offset < -most) throw Error("it points beyond its end");
    return base + offset;
  }
  static IndexBox cube(const Index& origin, std::int64_t side) {
    return {origin, {origin[0] + side - 1, origin[1] + side - 1, origin[2] + side - 1}};
  }

  /// Sets size, box and memory of the dense grid, and fills it with the background value.
  void make_room(std::int64_t background) {
    double cells = 1;
    for (size_t k = 0; k < 3; ++k) cells *= double(box_.last[k] - box_.first[k] + 1);
    const std::string shape = fmt::format("its values span {} x {} x {} cells", box_.last[0] - box_.first[0] + 1,
                                          box_.last[1] - box_.first[1] + 1, box_.last[2] - box_.first[2] + 1);
    if (cells > double(most_cells)) throw Error(fmt::format("{}; at most {} are read", shape, most_cells));
    require_memory(cells * 4 * layout_.channels, shape + ", which");
    double matrix[9], translation[3];
    for (int i = 0; i < 9; ++i) matrix[i] = bytes_.at<double>(384 + 8 * i);
    for (int i = 0; i < 3; ++i) translation[i] = bytes_.at<double>(528 + 8 * i);
    for (size_t k = 0; k < 3; ++k) {
      const double scale = matrix[4 * k];
      for (size_t j = 0; j < 3; ++j)
        if (j != k && !(std::abs(matrix[3 * k + j]) <= 1e-6 * std::abs(scale)))
          throw Error("its grid is turned or sheared against its axes, which is not read here");
      // Values are at the centres of cells, so the box extends half a cell beyond the outermost values.
      double low = scale * (double(box_.first[k]) - 0.5) + translation[k],
             high = scale * (double(box_.last[k]) + 0.5) + translation[k];
      mirrored_[k] = low > high;
      if (mirrored_[k]) std::swap(low, high);
      grid_.low[int(k)] = float(low);
      grid_.high[int(k)] = float(high);
      grid_.size[k] = int(box_.last[k] - box_.first[k] + 1);
    }
    grid_.channels = layout_.channels;
    grid_.values.resize(size_t(cells) * size_t(layout_.channels));
    fill(box_, background);
  }

  float* cell(std::int64_t i, std::int64_t j, std::int64_t k) {
    const std::int64_t index[3] = {i, j, k};
    size_t place = 0;
    for (size_t axis = 3; axis-- > 0;) {
      const std::int64_t n = grid_.size[axis], at = index[axis] - box_.first[axis];
      place = place * size_t(n) + size_t(mirrored_[axis] ? n - 1 - at : at);
    }
    return &grid_.values[place * size_t(layout_.channels)];
  }

  /// Sets all cells of a box to one value.
  void fill(const IndexBox& where, std::int64_t value) {
    const IndexBox box = where.within(box_);
    if (box.empty()) return;
    float v[3] = {};
    std::memcpy(v, bytes_.range(value, 4 * size_t(layout_.channels)), 4 * size_t(layout_.channels));
    for (std::int64_t k = box.first[2]; k <= box.last[2]; ++k)
      for (std::int64_t j = box.first[1]; j <= box.last[1]; ++j)
        for (std::int64_t i = box.first[0]; i <= box.last[0]; ++i) std::copy_n(v, layout_.channels, cell(i, j, k));
  }

  /// Copies a node of side^3 entries, each a cube of `step`^3 cells. Only entries that overlap the box are visited, so that the
  /// time is bounded by the size of the dense grid.
  void node(std::int64_t at, const Index& origin, std::int64_t side, std::int64_t step) {
    const IndexBox box = cube(origin, side * step).within(box_);
    if (box.empty()) return;
    const std::int64_t bits = side * side * side / 8, children = at + 32 + bits;
    const std::int64_t table = side == 32 ? at + 8256 : at + 1088;
    const auto entry_of = [&](std::int64_t index, size_t axis) { return (index - origin[axis]) / step; };
    for (std::int64_t i = entry_of(box.first[0], 0); i <= entry_of(box.last[0], 0); ++i)
      for (std::int64_t j = entry_of(box.first[1], 1); j <= entry_of(box.last[1], 1); ++j)
        for (std::int64_t k = entry_of(box.first[2], 2); k <= entry_of(box.last[2], 2); ++k) {
          const std::int64_t n = (i * side + j) * side + k, entry = table + n * std::int64_t(layout_.entry_stride);
          const Index inner{origin[0] + i * step, origin[1] + j * step, origin[2] + k * step};
          if (!(bytes_.at<unsigned char>(children + n / 8) >> (n % 8) & 1))
            fill(cube(inner, step), entry);
          else if (side == 32)
            node(offset_from(at, bytes_.at<std::int64_t>(entry)), inner, 16, 8);
          else
            leaf(offset_from(at, bytes_.at<std::int64_t>(entry)), inner);
        }
  }

  void leaf(std::int64_t at, const Index& origin) {
    const IndexBox box = cube(origin, 8).within(box_);
    const bool rounded = layout_.log_bits != -1;
    const int log_bits = layout_.log_bits == -2 ? bytes_.at<unsigned char>(at + 15) >> 5 : layout_.log_bits;
    if (log_bits > 4) throw Error("it says an impossible number of bits of its values");
    const size_t bits = rounded ? size_t(1) << log_bits : 32;
    const unsigned char* table =
        bytes_.range(at + std::int64_t(layout_.leaf_table), rounded ? 64 * bits : 2048 * size_t(layout_.channels));
    const float least = rounded ? bytes_.at<float>(at + 80) : 0, step = rounded ? bytes_.at<float>(at + 84) : 0;
    for (std::int64_t k = box.first[2]; k <= box.last[2]; ++k)
      for (std::int64_t j = box.first[1]; j <= box.last[1]; ++j)
        for (std::int64_t i = box.first[0]; i <= box.last[0]; ++i) {
          const auto n = size_t(((i - origin[0]) * 8 + j - origin[1]) * 8 + k - origin[2]);
          float* const to = cell(i, j, k);
          if (rounded)
            *to = least + step * float(whole_number(table, n, bits));
          else
            std::memcpy(to, table + 4 * n * size_t(layout_.channels), 4 * size_t(layout_.channels));
        }
  }
  /// The n-th of whole numbers of 1 to 16 bits, packed into bytes from the lowest bit on.
  static unsigned whole_number(const unsigned char* table, size_t n, size_t bits) {
    if (bits == 16) return table[2 * n] | unsigned(table[2 * n + 1]) << 8;
    return unsigned(table[n * bits / 8] >> (n * bits % 8)) & ((1u << bits) - 1);
  }

  Bytes bytes_;
  Layout layout_{};
  IndexBox box_{};
  std::array<bool, 3> mirrored_{};
  VolumeGrid grid_;
};

}  // namespace

VolumeGrid dense_grid(const std::vector<unsigned char>& bytes) { return DenseGrid(bytes).read(); }

}  // namespace etendue
