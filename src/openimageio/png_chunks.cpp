// A PNG file (ISO/IEC 15948:2004, clause 5) consists of a signature of eight bytes and chunks: a big-endian length of four
// bytes, a name of four letters, so many bytes and a checksum of four; the chunk named IEND is the last.

#include "png_chunks.h"

#include <fmt/format.h>

#include <cstring>

#include "etendue/core/error.h"
#include "files/regular_file.h"

namespace etendue {

void check_png_chunks(const std::string& path) {
  RegularFile file(path);
  unsigned char bytes[8];
  if (file.read_some(bytes, 8) < 8 || std::memcmp(bytes, "\x89PNG\r\n\x1a\n", 8) != 0) return;
  std::uint64_t at = 8;
  // Encoders make chunks of 8 kB or more; a file with very many empty chunks would only waste time.
  for (int count = 0; at + 8 <= file.size(); ++count) {
    if (count == 1'000'000) throw Error("it has more than a million pieces");
    file.seek(at);
    file.read(bytes, 8);
    const std::uint64_t length =
        std::uint64_t(bytes[0]) << 24 | std::uint64_t(bytes[1]) << 16 | std::uint64_t(bytes[2]) << 8 | bytes[3];
    at += 8;
    if (length > file.size() - at)
      throw Error(fmt::format("it ends too early: a piece of it claims {} bytes, {} are left", length, file.size() - at));
    if (std::memcmp(bytes + 4, "IEND", 4) == 0) return;
    at += length + 4;
    // The library that reads the file would detect this too, but leak the memory of texts that it has begun to read.
    if (at > file.size()) throw Error("it ends too early: the sum of a piece is missing");
  }
}

}  // namespace etendue
