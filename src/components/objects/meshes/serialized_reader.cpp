// Mitsuba's compressed meshes (.serialized), versions 3 and 4. Source: Jakob 2014, Mitsuba documentation, version 0.5,
// section 8.1.5.
//
// One file holds several meshes, each with its own header: uint16 0x041c, uint16 version, and then, compressed by zlib: uint32
// flags, in version 4 the mesh's name terminated by a zero byte, uint64 number of vertices, uint64 number of triangles, the
// lists of positions, normals, uvs, colours (depending on the flags, in floats or doubles) and the list of corners (uint32, or
// uint64 if the number of vertices exceeds uint32). At the file's end are the offsets of the meshes (uint64, in version 3
// uint32) and their number (uint32).

#include <zlib.h>

#include <charconv>
#include <cstring>

#include "etendue/core/error.h"
#include "files/regular_file.h"
#include "geometry/inner_origin.h"
#include "mesh_data.h"

namespace etendue {
namespace {

enum Flag : std::uint32_t {
  has_normals = 1,
  has_uvs = 2,
  has_colors = 8,
  own_normals = 16,
  in_floats = 0x1000,
  in_doubles = 0x2000
};

constexpr std::uint64_t most_elements = 0xffffffffu / 3;

template <class T>
T at(std::string_view file, size_t offset) {
  if (offset > file.size() || file.size() - offset < sizeof(T)) throw Error("the file ends too early");
  T value;
  std::memcpy(&value, file.data() + offset, sizeof(T));
  return value;
}

/// Decompresses bytes by zlib incrementally, so that a false size in the file allocates no memory.
class Inflated {
 public:
  explicit Inflated(std::string_view bytes) {
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream_.avail_in = uInt(std::min<size_t>(bytes.size(), std::numeric_limits<uInt>::max()));
    if (inflateInit(&stream_) != Z_OK) throw Error("zlib cannot start");
  }
  ~Inflated() { inflateEnd(&stream_); }
  Inflated(const Inflated&) = delete;
  Inflated& operator=(const Inflated&) = delete;

  void read(void* to, size_t bytes) {
    stream_.next_out = static_cast<Bytef*>(to);
    stream_.avail_out = uInt(bytes);
    while (stream_.avail_out > 0) {
      const int code = inflate(&stream_, Z_SYNC_FLUSH);
      if (stream_.avail_out == 0) return;
      if (code == Z_STREAM_END || (code == Z_BUF_ERROR && stream_.avail_in == 0))
        throw Error("the compressed part of the file ends too early");
      if (code != Z_OK) throw Error("the compressed part of the file is damaged");
    }
  }
  template <class T>
  T read() {
    T value;
    read(&value, sizeof(T));
    return value;
  }
  /// Reads a list in parts, so that a false count fails before it allocates memory.
  template <class T>
  std::vector<T> list(std::uint64_t count) {
    constexpr std::uint64_t part = 1 << 18;
    std::vector<T> values;
    while (values.size() < count) {
      const size_t from = values.size(), more = size_t(std::min<std::uint64_t>(count - from, part));
      values.resize(from + more);
      read(values.data() + from, more * sizeof(T));
    }
    return values;
  }
  std::vector<double> numbers(std::uint64_t count, bool doubles) {
    if (doubles) return list<double>(count);
    const std::vector<float> floats = list<float>(count);
    return {floats.begin(), floats.end()};
  }

 private:
  z_stream stream_{};
};

/// The part of the file that contains the mesh with a given number.
std::string_view part_of(std::string_view file, std::uint32_t number) {
  const auto version = at<std::uint16_t>(file, 2);
  const size_t width = version == 3 ? 4 : 8;
  const auto count = at<std::uint32_t>(file, file.size() - std::min<size_t>(file.size(), 4));
  if (number >= count)
    throw Error("the file holds " + std::to_string(count) + " shapes, so there is none of the number " +
                std::to_string(number) + " (they count from 0)");
  if (count > (file.size() - 4) / width) throw Error("the list of shapes at the file's end is damaged");
  const size_t directory = file.size() - 4 - width * count;
  const auto offset_of = [&](size_t i) {
    return width == 4 ? at<std::uint32_t>(file, directory + 4 * i) : at<std::uint64_t>(file, directory + 8 * i);
  };
  const std::uint64_t begin = offset_of(number), end = number + 1 < count ? offset_of(number + 1) : directory;
  if (begin > end || end > directory) throw Error("the list of shapes at the file's end is damaged");
  return file.substr(size_t(begin), size_t(end - begin));
}

}  // namespace

MeshData read_serialized(std::string_view file, std::uint32_t number) {
  if (at<std::uint16_t>(file, 0) != 0x041c) throw Error("this is no file of serialized meshes: its first bytes are others");
  const std::string_view part = part_of(file, number);
  const auto version = at<std::uint16_t>(part, 2);
  if (at<std::uint16_t>(part, 0) != 0x041c || (version != 3 && version != 4))
    throw Error("serialized meshes of versions 3 and 4 are read, not of version " + std::to_string(version));
  Inflated in(part.substr(4));
  const auto flags = in.read<std::uint32_t>();
  if (version == 4)
    for (size_t length = 0; in.read<char>() != 0; ++length)
      if (length > 100000) throw Error("the mesh's name does not end");
  const auto vertices = in.read<std::uint64_t>(), triangles = in.read<std::uint64_t>();
  if (vertices > most_elements || triangles > most_elements)
    throw Error("it claims to have " + std::to_string(vertices) + " vertices and " + std::to_string(triangles) +
                " triangles, more than can be counted here");
  const bool doubles = flags & in_doubles;
  MeshData mesh;
  std::vector<DoublePoint3> positions;
  {
    const std::vector<double> p = in.numbers(3 * vertices, doubles);
    positions.reserve(vertices);
    for (size_t i = 0; i < p.size(); i += 3) positions.push_back({p[i], p[i + 1], p[i + 2]});
  }
  mesh.centre = inner_origin_for(positions);
  mesh.positions = relative_to(mesh.centre, positions);
  if (flags & has_normals) {
    const std::vector<double> n = in.numbers(3 * vertices, doubles);
    for (size_t i = 0; i < n.size(); i += 3) {
      const Vector3 v{float(n[i]), float(n[i + 1]), float(n[i + 2])};
      const float l = length(v);
      mesh.normals.push_back(l > 0 && l < infinity ? Normal3(v / l) : Normal3{});
    }
  }
  if (flags & has_uvs) {
    const std::vector<double> u = in.numbers(2 * vertices, doubles);
    for (size_t i = 0; i < u.size(); i += 2) mesh.uvs.push_back({float(u[i]), float(u[i + 1])});
  }
  if (flags & has_colors) {
    const std::vector<double> c = in.numbers(3 * vertices, doubles);
    mesh.attributes.push_back({"color", 3, {c.begin(), c.end()}});
  }
  const auto corners = in.list<std::uint32_t>(3 * triangles);
  mesh.triangles.reserve(triangles);
  for (size_t i = 0; i < corners.size(); i += 3) {
    for (size_t k = 0; k < 3; ++k)
      if (corners[i + k] >= vertices)
        throw Error("a triangle has the corner " + std::to_string(corners[i + k]) + ", but there are " +
                    std::to_string(vertices) + " vertices");
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }
  mesh.faceted = flags & own_normals;
  if (mesh.faceted) mesh.normals = {};
  return mesh;
}

namespace {

/// Reads the mesh whose number is given as `part`; the first one if `part` is empty.
MeshData read_numbered(const std::string& path, const std::string& part) {
  std::uint32_t number = 0;
  const char* const end = part.data() + part.size();
  if (!part.empty())
    if (const auto [stop, error] = std::from_chars(part.data(), end, number); error != std::errc() || stop != end)
      throw Error("its meshes have numbers from 0 on, not '" + part + "'");
  const FileContents file(path);
  if (file.text().empty()) throw Error("the file is empty");
  return read_serialized(file.text(), number);
}

const bool registered = register_mesh_format({"serialized"}, read_numbered);

}  // namespace
}  // namespace etendue
