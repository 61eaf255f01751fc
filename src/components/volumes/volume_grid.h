#pragma once
// VolumeGrid: numbers on a regular grid in the unit cube, interpolated between the middles of its cells.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "etendue/core/vector.h"
#include "etendue/describe/component.h"
#include "etendue/describe/value.h"

namespace etendue {

/// What is between the middles of cells, and what lies outside the unit cube.
enum class VoxelFilter : std::uint8_t { nearest, trilinear };
enum class Beyond : std::uint8_t { clamp, repeat, mirror, empty, cut };

struct VolumeGrid {
  std::array<int, 3> size{1, 1, 1};    ///< cells along x, y and z
  int channels = 1;                    ///< 1 or 3
  std::vector<float> values;           ///< channels, x, y, z: the first runs fastest
  Point3 low{0, 0, 0}, high{1, 1, 1};  ///< the box that the file names

  float largest() const;  ///< of either sign
  /// Writes `channels` numbers at a point of the unit cube's coordinates.
  void look_up(const Point3&, VoxelFilter, Beyond, float* out) const;
};

/// Reads a volume in Mitsuba's format (.vol), a NumPy array (.npy) of shape (nz, ny, nx) or (nz, ny, nx, 3), or a grid of
/// NanoVDB (.nvdb) by its name, the first when that is empty. Throws Error with the reason alone.
VolumeGrid read_volume_grid(const std::string& path, const std::string& name = {});
/// What is said of such files.
inline constexpr const char* grid_files =
    "a volume as Mitsuba has them (.vol), a NumPy array (.npy) of shape (nz, ny, nx), or NanoVDB (.nvdb; of an OpenVDB file, "
    "nanovdb_convert makes one)";

// What components have grids from. Errors are of their members.

/// Of a member that names a file.
VolumeGrid grid_of_file(const Component&, const char* member, const FilePath&, const std::string& name = {});
/// Of a list of numbers in the member, one channel or three, and how many there are along x, y and z.
VolumeGrid grid_of_list(const Component&, const char* member, const std::vector<int>& resolution,
                        const std::vector<float>& values);
/// Densities and albedos are not negative: what is a little below 0, as filters leave it, becomes 0, told.
void cut_negatives(const Component&, const char* member, VolumeGrid&);
/// The box that a file names must have a volume when it counts.
void require_box(const Component&, const char* member, const VolumeGrid&);

}  // namespace etendue
