// A BMP file has a header of 14 bytes ("BM", the file's size, four unused bytes, the offset of the pixels) and one that
// describes the image, which begins with its own length: 12 bytes in OS/2's version, where pixels are never compressed, or 40
// and more (Microsoft, "Bitmap Header Types"; BITMAPINFOHEADER). All numbers are little endian.

#include "bmp_header.h"

#include <fmt/format.h>

#include <cstring>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {
namespace {

std::uint32_t number(const unsigned char* bytes, int count) {
  std::uint32_t n = 0;
  for (int i = count; i-- > 0;) n = n << 8 | bytes[i];
  return n;
}

/// Whether pixels of so many bits can have this compression: 0 none, 1 and 2 run lengths, 3 with a bit mask for each colour.
bool goes_with(std::uint32_t packing, std::uint32_t bits) {
  switch (packing) {
    case 0: return bits == 1 || bits == 2 || bits == 4 || bits == 8 || bits == 16 || bits == 24 || bits == 32;
    case 1: return bits == 8;
    case 2: return bits == 4;
    case 3: return bits == 16 || bits == 32;
    default: return false;
  }
}

}  // namespace

void check_bmp_header(const std::string& path) {
  RegularFile file(path);
  unsigned char bytes[34];
  const auto size = file.read_some(bytes, sizeof bytes);
  if (size < 2 || std::memcmp(bytes, "BM", 2) != 0) return;
  const bool short_header = size >= 26 && number(bytes + 14, 4) == 12;
  if (size < (short_header ? 26 : 34)) throw Error("it ends within its header");
  const std::uint32_t bits = number(bytes + (short_header ? 24 : 28), 2);
  const std::uint32_t packing = short_header ? 0 : number(bytes + 30, 4);
  if (!goes_with(packing, bits))
    throw Error(fmt::format("its pixels of {} bits cannot be packed in the way {}", bits, packing));
  const std::uint32_t begin = number(bytes + 10, 4);
  if (begin >= file.size()) throw Error(fmt::format("its pixels begin at byte {} of {}", begin, file.size()));
}

}  // namespace etendue
