// Checks whether an OpenEXR file can hold the pixels that its header claims.
//
// The layout (Kainz, Bogart & Hess 2004, "The OpenEXR image file format"; openexr.com, "OpenEXR File Layout"): four bytes of
// magic number, a 32-bit version with flags, a header for each part, and for each part a table with the 64-bit offset of every
// chunk (some rows of pixels, or a tile). A header is a list of attributes: name and type, each terminated by a zero, a 32-bit
// size and that many bytes; a zero ends the list. All numbers are little endian.

#include "exr_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

constexpr std::uint32_t magic_number = 20000630;
enum Flags : std::uint32_t { tiled = 0x200, deep = 0x800, multipart = 0x1000 };
enum Compression : std::uint8_t { none, rle, zips, zip, piz, pxr24, b44, b44a, dwaa, dwab };

static_assert(std::endian::native == std::endian::little, "numbers are taken from the file as they are");

/// Reads the bytes of the headers in order.
class Cursor {
 public:
  explicit Cursor(std::string_view bytes) : rest_(bytes) {}

  template <class T>
  T number() {
    T value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string_view bytes(size_t count) {
    if (count > rest_.size()) throw Error("its header is damaged: it ends too early");
    const std::string_view taken = rest_.substr(0, count);
    rest_.remove_prefix(count);
    return taken;
  }
  /// A zero-terminated text; the zero is consumed too.
  std::string_view text() {
    const size_t end = rest_.find('\0');
    if (end == std::string_view::npos) throw Error("its header is damaged: it ends too early");
    const std::string_view taken = rest_.substr(0, end);
    rest_.remove_prefix(end + 1);
    return taken;
  }
  size_t left() const { return rest_.size(); }

 private:
  std::string_view rest_;
};

/// Corners of a window of pixels, both inclusive.
struct Window {
  std::int32_t x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  std::int64_t width() const { return std::int64_t(x1) - x0 + 1; }
  std::int64_t height() const { return std::int64_t(y1) - y0 + 1; }
};

struct Tiles {
  std::uint32_t width = 0, height = 0;
};

/// The properties of one part of a file that are checked.
struct Part {
  std::optional<Window> data;
  std::optional<Tiles> tiles;
  std::optional<std::uint32_t> chunks;
  std::uint8_t compression = none;
  std::uint64_t pixel_bytes = 0;  ///< size of a pixel with all channels
  std::uint64_t channels = 0;
  bool cube = false;  ///< an environment map on the faces of a cube
};

Window window_of(Cursor& value) {
  Window w;
  for (std::int32_t* corner : {&w.x0, &w.y0, &w.x1, &w.y1}) *corner = value.number<std::int32_t>();
  constexpr std::int32_t most = 1 << 30;  // differences and sums do not overflow
  for (const std::int32_t corner : {w.x0, w.y0, w.x1, w.y1})
    if (corner < -most || corner > most)
      throw Error("its header is damaged: a window reaches to pixel " + std::to_string(corner));
  if (w.width() < 1 || w.height() < 1) throw Error("it holds no pixels");
  return w;
}

/// A channel: name, type (0 and 2: four bytes, 1: two), linear, three reserved bytes, sampling along x and y; a zero ends the
/// list.
void read_channels(Cursor& value, Part& part) {
  part.channels = part.pixel_bytes = 0;
  while (!value.text().empty()) {
    const auto type = value.number<std::int32_t>();
    value.bytes(4);
    const auto x = value.number<std::int32_t>(), y = value.number<std::int32_t>();
    if (type < 0 || type > 2 || x < 1 || y < 1)
      throw Error("its header is damaged: a channel has a type or sampling that none has");
    part.pixel_bytes += type == 1 ? 2 : 4;
    ++part.channels;
  }
}

/// False: an empty header, which ends the list of parts.
bool read_part(Cursor& cursor, Part& part) {
  bool any = false;
  for (std::string_view name = cursor.text(); !name.empty(); name = cursor.text()) {
    any = true;
    const std::string_view type = cursor.text();
    const auto size = cursor.number<std::uint32_t>();
    if (size > cursor.left())
      throw Error(fmt::format("its header is damaged: an attribute claims {} bytes, {} are left", size, cursor.left()));
    Cursor value(cursor.bytes(size));
    if (name == "channels" && type == "chlist") read_channels(value, part);
    if (name == "dataWindow" && type == "box2i") part.data = window_of(value);
    if (name == "displayWindow" && type == "box2i") window_of(value);
    if (name == "compression" && type == "compression") part.compression = value.number<std::uint8_t>();
    if (name == "chunkCount" && type == "int") part.chunks = value.number<std::uint32_t>();
    constexpr std::uint8_t envmap_cube = 1;
    if (name == "envmap" && type == "envmap") part.cube = value.number<std::uint8_t>() == envmap_cube;
    if (name == "tiles" && type == "tiledesc") {
      part.tiles = Tiles{};
      part.tiles->width = value.number<std::uint32_t>();
      part.tiles->height = value.number<std::uint32_t>();
      value.number<std::uint8_t>();
    }
  }
  return any;
}

/// Rows of pixels that are compressed as one chunk.
std::int64_t rows_per_chunk(std::uint8_t compression) {
  switch (compression) {
    case zip:
    case pxr24: return 16;
    case piz:
    case b44:
    case b44a:
    case dwaa: return 32;
    case dwab: return 256;
    default: return 1;
  }
}

/// The largest number of pixel bytes that a byte of the file can encode. Run-length coding: runs of up to 128 bytes take two.
/// Deflate encodes 258 bytes by two bits, and PXR24 drops a quarter before. The Huffman codes of PIZ encode runs of up to 255
/// numbers of two bytes; B44A packs 32 bytes into three. DWA deflates one number of two bytes for a block of 64.
double most_packed(std::uint8_t compression) {
  constexpr double deflate = 1032;
  switch (compression) {
    case none: return 1;
    case rle: return 64;
    case zips:
    case zip: return deflate;
    case pxr24: return deflate * 4 / 3;
    case piz: return 2048;
    case b44:
    case b44a: return 11;
    default: return 64 * deflate;
  }
}

void check_part(const Part& part, std::uint64_t file_size) {
  if (!part.data || part.pixel_bytes == 0) return;  // the library reports what is missing
  const std::int64_t width = part.data->width(), height = part.data->height();
  const auto claims = [&](const std::string& what) {
    return Error(fmt::format("it claims {} x {} pixels of {} channels{}, which its {} bytes cannot hold", width, height,
                             part.channels, what, file_size));
  };
  const double pixel_bytes = double(width) * double(height) * double(part.pixel_bytes);
  if (pixel_bytes > 1e5 && pixel_bytes > most_packed(part.compression) * double(file_size)) throw claims("");
  double chunks = double((height + rows_per_chunk(part.compression) - 1) / rows_per_chunk(part.compression));
  if (part.tiles) {
    const std::int64_t w = part.tiles->width, h = part.tiles->height;
    if (w < 1 || h < 1 || w > INT32_MAX || h > INT32_MAX)
      throw Error("its header is damaged: its tiles have no size that makes sense");
    // Memory is allocated for whole tiles; a small image may well be smaller than one tile.
    constexpr double usual = 4096.0 * 4096;
    if (double(w) * double(h) > usual && (w > width || h > height))
      throw Error(fmt::format("it claims tiles of {} x {} pixels for a picture of {} x {}", w, h, width, height));
    chunks = double((width + w - 1) / w) * double((height + h - 1) / h);
  }
  if (part.chunks) chunks = std::max(chunks, double(*part.chunks));
  if (8 * chunks > double(file_size)) throw claims(fmt::format(" in {} pieces", chunks));
}

}  // namespace

bool check_exr_header(const std::string& path) {
  RegularFile file(path);
  std::uint32_t start[2] = {0, 0};
  if (file.read_some(start, sizeof start) < sizeof start || start[0] != magic_number) return false;
  if (start[1] & deep) throw Error("it is a deep image, which is not read");
  // Headers contain texts and small previews; the limit keeps this fast for large files.
  constexpr std::uint64_t most = 16u << 20;
  std::string bytes(size_t(std::min(file.size() - sizeof start, most)), '\0');
  bytes.resize(size_t(file.read_some(bytes.data(), bytes.size())));
  Cursor cursor(bytes);
  bool first = true, cube = false;
  for (Part part; read_part(cursor, part); part = {}) {
    if (part.tiles && !(start[1] & (tiled | multipart))) part.tiles.reset();
    check_part(part, file.size());
    if (first) cube = part.cube;
    first = false;
    if (!(start[1] & multipart)) break;
  }
  return cube;
}

}  // namespace etendue
