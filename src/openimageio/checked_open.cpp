#include "checked_open.h"

#include <fmt/format.h>

#include <cctype>
#include <string_view>

#include "bmp_header.h"
#include "etendue/core/error.h"
#include "exr_header.h"
#include "files/regular_file.h"
#include "png_chunks.h"
#include "refuse.h"

namespace etendue {
namespace {

using namespace std::string_view_literals;

/// The largest number of values (channels of pixels) that a byte of a file can encode. PNG: deflate expands one byte to 1032,
/// each with up to eight pixels. JPEG: six blocks of at least one bit each for 256 pixels of three channels, twice that to be
/// safe. TGA: a packet of five bytes for 128 pixels of four channels. BMP: two bytes for 255 pixels of four channels. TIFF,
/// uncompressed: eight pixels of one bit. No other format exceeds the last value.
double most_packed(const OIIO::ImageInput& input) {
  const std::string_view format = input.format_name();
  if (format == "png") return 8 * 1032;
  if (format == "jpeg") return 2048;
  if (format == "targa") return 128;
  if (format == "bmp") return 512;
  if (format == "tiff" && input.spec().get_string_attribute("compression") == "none") return 8;
  return 65536;
}

void require_plausible(const OIIO::ImageInput& input, std::uint64_t file_size) {
  const OIIO::ImageSpec& spec = input.spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) throw Error("it holds no pixels");
  if (spec.deep || spec.depth > 1) throw Error("it is a deep or volume image, which is not read");
  constexpr int most = 1 << 29;  // sums, differences and doubled coordinates do not overflow
  for (const int number :
       {spec.x, spec.y, spec.width, spec.height, spec.full_x, spec.full_y, spec.full_width, spec.full_height})
    if (number < -most || number > most) throw Error(fmt::format("its windows reach to pixel {}", number));
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

/// The first bytes of a format's files, and OpenImageIO's name of its reader.
struct Beginning {
  std::string_view bytes;
  const char* reader;
};

/// The supported formats, each with its own reader only. OpenImageIO has 28 readers and would try all of them in turn; some
/// read a file to its end before they give up, and those of rare formats crash or hang on damaged files (IFF and DDS did for
/// one of a hundred). These are the formats that tests/hostile attacks.
constexpr Beginning beginnings[] = {
    {"\x76\x2f\x31\x01"sv, "openexr"},
    {"\x89PNG"sv, "png"},
    {"#?"sv, "hdr"},
    {"\xff\xd8\xff"sv, "jpeg"},
    {"II*\0"sv, "tiff"},
    {"MM\0*"sv, "tiff"},
    {"II+\0"sv, "tiff"},
    {"MM\0+"sv, "tiff"},
    {"P1"sv, "pnm"},
    {"P2"sv, "pnm"},
    {"P3"sv, "pnm"},
    {"P4"sv, "pnm"},
    {"P5"sv, "pnm"},
    {"P6"sv, "pnm"},
    {"PF"sv, "pnm"},
    {"Pf"sv, "pnm"},
    {"RIFF"sv, "webp"},
    {"BM"sv, "bmp"},
};

/// The reader for a file. TGA has no signature; it is recognized by the file's name.
const char* reader_for(RegularFile& file, const std::string& path) {
  char start[16];
  const std::string_view there(start, size_t(file.read_some(start, sizeof start)));
  for (const Beginning& beginning : beginnings)
    if (there.starts_with(beginning.bytes)) return beginning.reader;
  std::string ending = path.substr(std::min(path.size(), path.find_last_of('.') + 1));
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (ending == "tga" || ending == "tpic") return "targa";
  throw Error(
      "it does not begin as an image of a format that is read here: OpenEXR, HDR, PNG, JPEG, TIFF, PNM, PFM, WebP, BMP, TGA");
}

}  // namespace

CheckedInput open_checked(const std::string& path) {
  auto file = std::make_shared<RegularFile>(path);
  const char* const reader = reader_for(*file, path);
  const bool cube = check_exr_header(path);
  check_png_chunks(path);
  check_bmp_header(path);
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::create(reader);
  if (!input) refuse(OIIO::geterror());
  // Colours are not premultiplied by alpha if the file stores them unassociated (PNG, TGA, WebP, most TIFFs): callers multiply
  // decoded values if they need to.
  OIIO::ImageSpec ignored, wanted;
  wanted.attribute("oiio:UnassociatedAlpha", 1);
  if (!input->open(file->path_to_open(), ignored, wanted)) refuse(input->geterror());
  require_plausible(*input, file->size());
  const bool unpacked = file->path_to_open() != path;
  return {unpacked ? file : nullptr, std::move(input), cube};
}

}  // namespace etendue
