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

/// The interpolation between the centres of cells, and the continuation outside the unit cube.
enum class VoxelFilter : std::uint8_t { nearest, trilinear };
enum class Beyond : std::uint8_t { clamp, repeat, mirror, empty, cut };

struct VolumeGrid {
  std::array<int, 3> size{1, 1, 1};    ///< cells along x, y and z
  int channels = 1;                    ///< 1 or 3
  std::vector<float> values;           ///< channels, x, y, z: the first runs fastest
  Point3 low{0, 0, 0}, high{1, 1, 1};  ///< the box that the file names

  float largest() const;  ///< the largest absolute value
  /// Writes `channels` numbers at a point of the unit cube's coordinates.
  void look_up(const Point3&, VoxelFilter, Beyond, float* out) const;
};

/// Reads a volume in Mitsuba's format (.vol), a NumPy array (.npy) of shape (nz, ny, nx) or (nz, ny, nx, 3), or a NanoVDB grid
/// (.nvdb) by its name, the first grid if the name is empty. Throws Error whose message is the reason alone.
VolumeGrid read_volume_grid(const std::string& path, const std::string& name = {});
/// These formats, for the descriptions of members.
inline constexpr const char* grid_files =
    "a volume as Mitsuba has them (.vol), a NumPy array (.npy) of shape (nz, ny, nx), or NanoVDB (.nvdb; of an OpenVDB file, "
    "nanovdb_convert makes one)";

// Functions by which components get grids from their members. Errors name the member.

/// The grid of a file that a member names.
VolumeGrid grid_of_file(const Component&, const char* member, const FilePath&, const std::string& name = {});
/// The grid of a member's list of numbers, with one channel or three, and the number of cells along x, y and z.
VolumeGrid grid_of_list(const Component&, const char* member, const std::vector<int>& resolution,
                        const std::vector<float>& values);
/// For densities and albedos, which must not be negative: values slightly below 0, as filters leave them, are set to 0 with a
/// warning; lower values are an error.
void cut_negatives(const Component&, const char* member, VolumeGrid&);
/// Fails unless the box that a file names has a finite, positive volume.
void require_box(const Component&, const char* member, const VolumeGrid&);

}  // namespace etendue
