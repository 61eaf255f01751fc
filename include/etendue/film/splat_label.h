#pragma once
// SplatLabel: the path length of a splat and, if the image has light groups, the light group of its luminaire, packed into one
// number (the argument `length` of ImageTile::splat).

namespace etendue {

struct SplatLabel {
  static constexpr int group_unit = 1 << 20;  ///< upper limit of path lengths

  int length = 0;  ///< number of segments
  int group = -1;  ///< index in PictureFormat::light_groups; -1: unknown

  int packed() const { return length + (group + 1) * group_unit; }
  static SplatLabel unpacked(int number) {
    if (number < 0) return {number, -1};
    return {number % group_unit, number / group_unit - 1};
  }
};

}  // namespace etendue
