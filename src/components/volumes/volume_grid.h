#pragma once
// VolumeGrid: numbers on a regular grid in the unit cube, interpolated between the middles of its cells.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "etendue/core/vector.h"

namespace etendue {

/// What is between the middles of cells, and what lies outside the unit cube.
enum class VoxelFilter : std::uint8_t { nearest, trilinear };
enum class Beyond : std::uint8_t { clamp, repeat, mirror, empty, cut };

struct VolumeGrid {
  std::array<int, 3> size{1, 1, 1};    ///< cells along x, y and z
  int channels = 1;                    ///< 1 or 3
  std::vector<float> values;           ///< channels, x, y, z: the first runs fastest
  Point3 low{0, 0, 0}, high{1, 1, 1};  ///< the box that the file names

  float largest() const;
  /// Writes `channels` numbers at a point of the unit cube's coordinates.
  void look_up(const Point3&, VoxelFilter, Beyond, float* out) const;
};

/// Reads a volume in Mitsuba's format (.vol) or a NumPy array (.npy) of shape (nz, ny, nx) or (nz, ny, nx, 3). Throws Error
/// with the reason alone.
VolumeGrid read_volume_grid(const std::string& path);

}  // namespace etendue
