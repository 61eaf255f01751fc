#include "nanovdb_file.h"

#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "etendue/core/error.h"
#include "files/regular_file.h"
#include "nanovdb_tree.h"

// A file is a row of segments (Museth 2021, "NanoVDB: A GPU-friendly and portable VDB data structure for real-time rendering
// and simulation"; version 32 of the format, as in OpenVDB 9 to 12). All numbers are little endian.
//     header of a segment, 16 bytes:   "NanoVDB0" or "NanoVDB2"; version (uint32: 11 bits major, 11 minor, 10 patch); number of
//                                      grids (uint16); compression (uint16: 0 none, 1 zip, 2 blosc)
//     for each grid, 176 bytes:        size of the grid (uint64), its size in the file (uint64), ...; at 136 the length of its
//                                      name (uint32) with the 0 at its end; after these 176 bytes the name
//     the grids' bytes, one after another; with zip, the number of compressed bytes (uint64) and the compressed bytes.

namespace etendue {
namespace {

struct Entry {
  std::string name;
  std::uint64_t bytes = 0, bytes_in_file = 0, offset = 0;
  int codec = 0;
};

template <class T>
T number_at(const unsigned char* bytes, size_t offset) {
  T v;
  std::memcpy(&v, bytes + offset, sizeof v);
  return v;
}

/// Reads the entries of all grids of the file.
std::vector<Entry> list_grids(RegularFile& file) {
  constexpr size_t header_size = 16, entry_size = 176, longest_name = 4096;
  std::vector<Entry> all;
  std::uint64_t offset = 0;
  while (offset < file.size()) {
    unsigned char header[header_size];
    file.seek(offset);
    file.read(header, header_size);
    if (std::memcmp(header, "NanoVDB0", 8) != 0 && std::memcmp(header, "NanoVDB2", 8) != 0)
      throw Error("it begins neither with \"NanoVDB0\" nor with \"NanoVDB2\", as its kind does");
    if (const unsigned major = number_at<std::uint32_t>(header, 8) >> 21; major != 32)
      throw Error(fmt::format("version {} of the format is not known, only 32: convert it again by nanovdb_convert", major));
    const size_t first = all.size(), count = number_at<std::uint16_t>(header, 12);
    offset += header_size;
    for (size_t i = 0; i < count; ++i) {
      unsigned char bytes[entry_size];
      file.read(bytes, entry_size);
      Entry entry;
      const auto length = number_at<std::uint32_t>(bytes, 136);
      if (length > longest_name) throw Error("the name of a grid is too long");
      entry.name.resize(length);
      file.read(entry.name.data(), length);
      entry.name.resize(std::strlen(entry.name.c_str()));
      entry.bytes = number_at<std::uint64_t>(bytes, 0);
      entry.bytes_in_file = number_at<std::uint64_t>(bytes, 8);
      entry.codec = number_at<std::uint16_t>(header, 14);
      all.push_back(entry);
      offset += entry_size + length;
    }
    for (size_t i = first; i < all.size(); ++i) {
      all[i].offset = offset;
      if (offset > file.size() || all[i].bytes_in_file > file.size() - offset) throw Error("it ends within its grids");
      offset += all[i].bytes_in_file;
    }
  }
  if (all.empty()) throw Error("it holds no grid");
  return all;
}

Entry find_grid(RegularFile& file, const std::string& name) {
  const std::vector<Entry> all = list_grids(file);
  std::string known;
  for (const Entry& entry : all) {
    if (name.empty() || name == entry.name) return entry;
    known += (known.empty() ? "" : ", ") + entry.name;
  }
  throw Error(fmt::format("it holds no grid '{}', only: {}", name, known));
}

std::vector<unsigned char> bytes_of(RegularFile& file, const Entry& entry) {
  file.seek(entry.offset);
  if (entry.codec == 0) {
    if (entry.bytes != entry.bytes_in_file) throw Error("it says two lengths of what is not compressed");
    require_memory(double(entry.bytes), "its grid");
    std::vector<unsigned char> bytes(entry.bytes);
    file.read(bytes.data(), entry.bytes);
    return bytes;
  }
  if (entry.codec == 2)
    throw Error("it is compressed by blosc, which is not read here: nanovdb_convert --zip makes one that is");
  if (entry.codec != 1) throw Error(fmt::format("it is compressed in a way that is not known ({})", entry.codec));
  std::uint64_t size = 0;
  file.read(&size, sizeof size);
  // Deflate's compression ratio is at most 1032.
  if (size > entry.bytes_in_file || entry.bytes / 1033 > size) throw Error("what is compressed in it has no possible length");
  require_memory(double(entry.bytes) + double(size), "its grid");
  std::vector<unsigned char> packed(size), bytes(entry.bytes);
  file.read(packed.data(), size);
  uLongf unpacked = entry.bytes;
  if (uncompress(bytes.data(), &unpacked, packed.data(), size) != Z_OK || unpacked != entry.bytes)
    throw Error("what is compressed in it is damaged");
  return bytes;
}

}  // namespace

bool named_nanovdb(const std::string& path) { return path.ends_with(".nvdb"); }

std::vector<std::string> nanovdb_grids(const std::string& path) {
  RegularFile file(path);
  std::vector<std::string> names;
  for (const Entry& entry : list_grids(file)) names.push_back(entry.name);
  return names;
}

VolumeGrid read_nanovdb(const std::string& path, const std::string& name) {
  RegularFile file(path);
  const Entry entry = find_grid(file, name);
  return dense_grid(bytes_of(file, entry));
}

}  // namespace etendue
