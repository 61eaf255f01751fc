#include "volume_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "etendue/core/error.h"
#include "files/regular_file.h"
#include "files/whole_file.h"
#include "images/numpy_array.h"
#include "nanovdb_file.h"

namespace etendue {
namespace {

constexpr std::uint64_t most_cells = std::uint64_t(1) << 31;

/// The cell in [0, n) that cell i of an axis of n cells continues; -1: none, the value is 0.
int wrapped(int i, int n, Beyond beyond) {
  if (i >= 0 && i < n) return i;
  switch (beyond) {
    case Beyond::clamp:
    case Beyond::cut: return i < 0 ? 0 : n - 1;
    case Beyond::repeat: return ((i % n) + n) % n;
    case Beyond::mirror: {
      const int k = ((i % (2 * n)) + 2 * n) % (2 * n);
      return k < n ? k : 2 * n - 1 - k;
    }
    case Beyond::empty: break;
  }
  return -1;
}

// The header: "VOL", version 3 (a byte), encoding, cells along x, y, z and channels (int32), the box's corners (6 floats); then
// the values, channels fastest, then x. All little endian.
VolumeGrid read_vol(const std::string& path) {
  RegularFile file(path);
  char magic[4];
  std::int32_t numbers[5];
  float box[6];
  constexpr std::uint64_t header = sizeof magic + sizeof numbers + sizeof box;
  if (file.size() < header) throw Error("it is too short for a volume");
  file.read(magic, sizeof magic);
  if (std::memcmp(magic, "VOL", 3) != 0) throw Error("it does not begin with \"VOL\", as volumes do");
  if (magic[3] != 3) throw Error(fmt::format("version {} of the format is not known, only 3", int(magic[3])));
  file.read(numbers, sizeof numbers);
  file.read(box, sizeof box);
  const int encoding = numbers[0];
  if (encoding != 1 && encoding != 3)
    throw Error(fmt::format("its numbers are encoded as kind {}; known are 1, floats, and 3, bytes", encoding));
  VolumeGrid grid;
  grid.size = {numbers[1], numbers[2], numbers[3]};
  grid.channels = numbers[4];
  const std::string shape = fmt::format("{} x {} x {} cells of {} channels", numbers[1], numbers[2], numbers[3], numbers[4]);
  std::uint64_t count = 1;
  for (int i = 1; i < 5; ++i) {
    if (numbers[i] < 1 || std::uint64_t(numbers[i]) > most_cells / count) throw Error("of no size that makes sense: " + shape);
    count *= std::uint64_t(numbers[i]);
  }
  if (grid.channels != 1 && grid.channels != 3) throw Error("one channel or three are needed: " + shape);
  const std::uint64_t bytes = encoding == 1 ? 4 : 1, needed = header + count * bytes;
  if (file.size() != needed) throw Error(fmt::format("{} take {} bytes, but it is {} bytes long", shape, needed, file.size()));
  for (int k = 0; k < 3; ++k) {
    grid.low[k] = box[k];
    grid.high[k] = box[k + 3];
  }
  grid.values.resize(count);
  if (encoding == 1) {
    file.read(grid.values.data(), count * sizeof(float));
  } else {
    std::vector<std::uint8_t> raw(count);
    file.read(raw.data(), count);
    for (size_t i = 0; i < raw.size(); ++i) grid.values[i] = float(raw[i]) / 255;
  }
  return grid;
}

VolumeGrid read_npy(const std::string& path) {
  const FileContents contents(path);
  const NumpyArray array = parse_numpy_header(contents.text());
  const size_t dimensions = array.shape.size();
  if (!(dimensions == 3 || (dimensions == 4 && (array.shape[3] == 1 || array.shape[3] == 3))) || array.count() == 0)
    throw Error("an array of shape (nz, ny, nx) or (nz, ny, nx, 3) is needed");
  VolumeGrid grid;
  for (size_t k = 0; k < 3; ++k) {
    if (array.shape[2 - k] > most_cells) throw Error("its shape makes no sense");
    grid.size[k] = int(array.shape[2 - k]);
  }
  grid.channels = dimensions == 4 ? int(array.shape[3]) : 1;
  grid.values.resize(array.count());
  for (size_t i = 0; i < grid.values.size(); ++i) grid.values[i] = float(array[i]);
  return grid;
}

}  // namespace

float VolumeGrid::largest() const {
  float most = 0;
  for (const float v : values) most = std::max(most, std::abs(v));
  return most;
}

void VolumeGrid::look_up(const Point3& p, VoxelFilter filter, Beyond beyond, float* out) const {
  std::fill(out, out + channels, 0.0f);
  int first[3];
  float fraction[3];
  for (int k = 0; k < 3; ++k) {
    const float n = float(size[size_t(k)]);
    if ((beyond == Beyond::empty || beyond == Beyond::cut) && !(p[k] >= 0 && p[k] <= 1)) return;
    // Clamped to the range of an int; so far outside, floats do not resolve positions within a cell anyway.
    const float at = std::clamp(p[k] * n, -1e9f, 1e9f) - (filter == VoxelFilter::trilinear ? 0.5f : 0);
    if (!std::isfinite(at)) return;
    const float floor = std::floor(at);
    first[k] = int(floor);
    fraction[k] = filter == VoxelFilter::trilinear ? at - floor : 0;
    if (filter == VoxelFilter::nearest && p[k] == 1) first[k] = size[size_t(k)] - 1;
  }
  const int corners = filter == VoxelFilter::trilinear ? 8 : 1;
  for (int corner = 0; corner < corners; ++corner) {
    float weight = 1;
    size_t place = 0, stride = 1;
    bool there = true;
    for (int k = 0; k < 3; ++k) {
      const int step = (corner >> k) & 1, i = wrapped(first[k] + step, size[size_t(k)], beyond);
      weight *= step ? fraction[k] : 1 - fraction[k];
      there = there && i >= 0;
      if (!there) break;
      place += size_t(i) * stride;
      stride *= size_t(size[size_t(k)]);
    }
    if (!there || !(weight > 0)) continue;
    const float* value = &values[place * size_t(channels)];
    for (int c = 0; c < channels; ++c) out[c] += weight * value[c];
  }
}

VolumeGrid read_volume_grid(const std::string& path, const std::string& name) {
  if (path.ends_with(".vdb"))
    throw Error("files of OpenVDB are not read here, but those of NanoVDB are, which nanovdb_convert makes of them");
  VolumeGrid grid = named_nanovdb(path) ? read_nanovdb(path, name) : path.ends_with(".npy") ? read_npy(path) : read_vol(path);
  for (const float v : grid.values)
    if (!std::isfinite(v)) throw Error(fmt::format("it holds {}, which is no number", v));
  return grid;
}

VolumeGrid grid_of_file(const Component& of, const char* member, const FilePath& path, const std::string& name) {
  const std::string resolved = path.resolved();
  try {
    return read_volume_grid(resolved, name);
  } catch (const Error& error) {
    of.fail(member, "'" + resolved + "': " + error.what());
  } catch (const std::bad_alloc&) {
    of.fail(member, "'" + resolved + "': " + no_memory_to_read);
  }
}

VolumeGrid grid_of_list(const Component& of, const char* member, const std::vector<int>& resolution,
                        const std::vector<float>& values) {
  if (resolution.size() != 3) of.fail("resolution", "three numbers are needed: how many there are along x, y and z");
  VolumeGrid grid;
  std::uint64_t count = 1;
  for (size_t k = 0; k < 3; ++k) {
    if (resolution[k] < 1) of.fail("resolution", "at least 1 is needed along each axis");
    grid.size[k] = resolution[k];
    count *= std::uint64_t(resolution[k]);
    if (count > most_cells) of.fail("resolution", "too many cells");
  }
  if (values.size() != count && values.size() != 3 * count)
    of.fail(member, fmt::format("{} numbers for a grid of {}", values.size(), count));
  grid.channels = values.size() == count ? 1 : 3;
  for (const float v : values)
    if (!std::isfinite(v)) of.fail(member, fmt::format("{} is no number", v));
  grid.values = values;
  return grid;
}

void cut_negatives(const Component& of, const char* member, VolumeGrid& grid) {
  float least = 0, most = 0;
  for (const float v : grid.values) {
    least = std::min(least, v);
    most = std::max(most, v);
  }
  if (!(least < 0)) return;
  // Such values are left by filters that overshoot, and by programs that clamp at 0 in another precision.
  constexpr float rounding = 0.01f;
  if (least < -rounding * most) of.fail(member, fmt::format("it holds {}, and must not be negative", least));
  warn(fmt::format("{}.{}: numbers below 0, down to {}, are 0: they are less than {} of the largest", of.class_info().name,
                   member, least, rounding),
       of.location_of(member));
  for (float& v : grid.values) v = std::max(v, 0.0f);
}

void require_box(const Component& of, const char* member, const VolumeGrid& grid) {
  for (int k = 0; k < 3; ++k)
    if (!(grid.high[k] > grid.low[k] && std::isfinite(grid.high[k] - grid.low[k])))
      of.fail(member, "the box that the file names is empty or not finite");
}

}  // namespace etendue
