#pragma once
// SplatLabel: what a film must know of a splat to add it to its layers, packed into one number (the argument `length` of
// ImageTile::splat): the path length, the light group of its luminaire, and the light path expressions that its path matches.

#include <algorithm>
#include <bit>
#include <cstdint>

namespace etendue {

struct SplatLabel {
  static constexpr int longest = 255;  ///< larger path lengths are stored as this one, if there is more than a length

  int length = 0;                   ///< number of segments
  int group = -1;                   ///< index in PictureFormat::light_groups; -1: unknown
  std::uint32_t matches = unknown;  ///< a bit for each of PictureFormat::path_layers
  static constexpr std::uint32_t unknown = ~0u;

  // A number with more than a length has bit 30; then, from the lowest, 8 bits for the length, as many as the groups and -1
  // need, and a bit for each expression and one that says that they are known.
  static constexpr int length_bits = 8, flag = 1 << 30;
  static constexpr int bits_of(size_t groups) { return int(std::bit_width(groups)); }
  /// How many expressions there may be beside so many groups.
  static constexpr size_t most_expressions(size_t groups) { return size_t(30 - length_bits - bits_of(groups) - 1); }

  /// `groups`: the number of light groups of the picture.
  int packed(size_t groups) const {
    if (group < 0 && matches == unknown) return length;
    const int at = length_bits + bits_of(groups);
    const std::uint32_t paths = matches == unknown ? 0 : 2 * matches + 1;
    return int(std::uint32_t(flag | std::min(length, longest) | ((group + 1) << length_bits)) | (paths << at));
  }
  static SplatLabel unpacked(int number, size_t groups) {
    if (number < 0 || !(number & flag)) return {number, -1, unknown};
    const int bits = bits_of(groups);
    const auto paths = std::uint32_t(number & (flag - 1)) >> (length_bits + bits);
    return {number & longest, ((number >> length_bits) & ((1 << bits) - 1)) - 1, paths & 1 ? paths / 2 : unknown};
  }
};

}  // namespace etendue
