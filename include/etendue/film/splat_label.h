#pragma once
// What a splat says of the path that brought it: its length, and, where a picture keeps light groups, which group its luminaire
// is in. Both stand in the one number that splats carry.

namespace etendue {

struct SplatLabel {
  static constexpr int group_unit = 1 << 20;  ///< paths are shorter than that

  int length = 0;  ///< segments
  int group = -1;  ///< of PictureFormat::light_groups; -1: nobody told

  int packed() const { return length + (group + 1) * group_unit; }
  static SplatLabel unpacked(int number) {
    if (number < 0) return {number, -1};
    return {number % group_unit, number / group_unit - 1};
  }
};

}  // namespace etendue
