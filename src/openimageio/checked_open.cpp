#include "checked_open.h"

#include <fmt/format.h>

#include <cctype>
#include <string_view>

#include "etendue/core/error.h"
#include "exr_header.h"
#include "files/regular_file.h"
#include "refuse.h"

namespace etendue {
namespace {

using namespace std::string_view_literals;

/// The most numbers (channels of pixels) that a byte of a file can stand for. PNG: deflate makes 1032 bytes of one, each with
/// up to eight pixels. JPEG: six blocks of at least one bit each for 256 pixels of three channels, twice that to be safe. TGA:
/// a packet of five bytes for 128 pixels of four. TIFF, uncompressed: eight pixels of one bit. No other packs better than the
/// last.
double most_packed(const OIIO::ImageInput& input) {
  const std::string_view format = input.format_name();
  if (format == "png") return 8 * 1032;
  if (format == "jpeg") return 2048;
  if (format == "targa") return 128;
  if (format == "tiff" && input.spec().get_string_attribute("compression") == "none") return 8;
  return 65536;
}

void require_plausible(const OIIO::ImageInput& input, std::uint64_t file_size) {
  const OIIO::ImageSpec& spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) throw Error("it holds no pixels");
  if (spec.deep || spec.depth > 1) throw Error("it is a deep or volume image, which is not read");
  const double values = double(spec.width) * double(spec.height) * double(spec.nchannels);
  if (values > 1e5 && values > most_packed(input) * double(file_size))
    throw Error(fmt::format("it claims {} x {} pixels of {} channels, which its {} bytes cannot hold", spec.width, spec.height,
                            spec.nchannels, file_size));
  const double tile = double(spec.tile_width) * double(spec.tile_height) * double(spec.nchannels);
  if (tile > 0x1p26 && tile > 4 * values)
    throw Error(fmt::format("it claims tiles of {} x {} pixels for a picture of {} x {}", spec.tile_width, spec.tile_height,
                            spec.width, spec.height));
  require_memory(values * sizeof(float), "it");
}

/// Whether a file begins as one of the formats does that the library knows. It would try them all in turn, and some read a file
/// to its end before they give up. TGA begins with nothing of its own; its name must say it.
bool known_beginning(RegularFile& file, const std::string& path) {
  constexpr std::string_view beginnings[] = {"\x76\x2f\x31\x01"sv,
                                             "\x89PNG"sv,
                                             "#?"sv,
                                             "\xff\xd8\xff"sv,
                                             "II*\0"sv,
                                             "MM\0*"sv,
                                             "II+\0"sv,
                                             "MM\0+"sv,
                                             "BM"sv,
                                             "GIF8"sv,
                                             "P1"sv,
                                             "P2"sv,
                                             "P3"sv,
                                             "P4"sv,
                                             "P5"sv,
                                             "P6"sv,
                                             "PF"sv,
                                             "Pf"sv,
                                             "RIFF"sv,
                                             "SDPX"sv,
                                             "XPDS"sv,
                                             "8BPS"sv,
                                             "\x01\xda"sv,
                                             "DDS "sv,
                                             "SIMPLE"sv,
                                             "FOR4"sv,
                                             "Ptex"sv,
                                             "\0\0\1\0"sv,
                                             "\x80\x2a\x5f\xd7"sv,
                                             "\xd7\x5f\x2a\x80"sv,
                                             "\x53\x80\xf6\x34"sv,
                                             "\xff\x4f\xff\x51"sv,
                                             "\0\0\0\x0cjP"sv};
  char start[16];
  const std::string_view there(start, size_t(file.read_some(start, sizeof start)));
  for (const std::string_view beginning : beginnings)
    if (there.starts_with(beginning)) return true;
  if (there.size() > 8 && there.substr(4, 4) == "ftyp") return true;  // HEIF and AVIF
  std::string ending = path.substr(std::min(path.size(), path.find_last_of('.') + 1));
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == "tga" || ending == "tpic" || ending == "rla";
}

}  // namespace

std::unique_ptr<OIIO::ImageInput> open_checked(const std::string& path) {
  RegularFile file(path);
  if (!known_beginning(file, path)) throw Error("it does not begin as an image of any format that is read here");
  check_exr_header(path);
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
  if (!input) refuse(OIIO::geterror());
  require_plausible(*input, file.size());
  return input;
}

}  // namespace etendue
