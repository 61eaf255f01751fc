#include "file_output.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <algorithm>

#include "refuse.h"

namespace etendue {
namespace {

OIIO::TypeDesc type_of(NumberType type) {
  switch (type) {
    case NumberType::uint8: return OIIO::TypeDesc::UINT8;
    case NumberType::uint16: return OIIO::TypeDesc::UINT16;
    case NumberType::half: return OIIO::TypeDesc::HALF;
    default: return OIIO::TypeDesc::FLOAT;
  }
}

void add_channels(OIIO::ImageSpec& spec, const std::vector<ImageHeader::Channel>& channels) {
  spec.channelnames.clear();
  bool equal = true;
  for (size_t i = 0; i < channels.size(); ++i) {
    spec.channelnames.push_back(channels[i].name);
    spec.channelformats.push_back(type_of(channels[i].type));
    equal = equal && channels[i].type == channels[0].type;
    if (channels[i].name == "A") spec.alpha_channel = int(i);
  }
  if (equal) spec.channelformats.clear();  // not all formats support types per channel
}

OIIO::ImageSpec spec_of(const std::string& extension, const ImageHeader& header) {
  // If types differ, this is only the type in which values are passed to the library.
  const NumberType widest = std::max_element(header.channels.begin(), header.channels.end(), [](const auto& a, const auto& b) {
                              return a.type < b.type;
                            })->type;
  OIIO::ImageSpec spec(header.width, header.height, int(header.channels.size()), type_of(widest));
  add_channels(spec, header.channels);
  spec.x = header.x;
  spec.y = header.y;
  if (header.whole.width() > 0 && header.whole.height() > 0) {
    spec.full_x = header.whole.x0;
    spec.full_y = header.whole.y0;
    spec.full_width = header.whole.width();
    spec.full_height = header.whole.height();
  } else {
    spec.full_x = header.x;
    spec.full_y = header.y;
  }
  if (header.tile_side > 0) spec.tile_width = spec.tile_height = header.tile_side;
  if (header.chromaticities)
    spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), header.chromaticities->data());
  if (extension == ".exr") {
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", "");  // otherwise the library writes the current time, and equal images differ
  }
  if (spec.alpha_channel >= 0 && extension != ".exr") spec.attribute("oiio:UnassociatedAlpha", 1);  // as when they are read
  for (const auto& [name, value] : header.texts) spec.attribute(name, value);
  if (header.transfer == "linear") spec.attribute("oiio:ColorSpace", "linear");
  if (header.transfer == "srgb") spec.attribute("oiio:ColorSpace", "sRGB");
  if (header.compression_level) spec.attribute("png:compressionLevel", *header.compression_level);
  return spec;
}

template <class T>
OIIO::TypeDesc type_of(std::span<const T>) {
  return OIIO::BaseTypeFromC<T>::value;
}

}  // namespace

std::vector<unsigned char> encode_file(const std::string& extension, const ImageHeader& header, const PixelValues& pixels) {
  const size_t wanted = size_t(header.width) * size_t(header.height) * header.channels.size();
  const auto [type, data, count] = std::visit(
      [](const auto& values) {
        return std::tuple<OIIO::TypeDesc, const void*, size_t>(type_of(values), values.data(), values.size());
      },
      pixels);
  if (header.channels.empty() || count != wanted) refuse("its numbers are not as many as its pixels have");
  const std::string name = "picture" + extension;  // never opened: the bytes stay in memory
  std::unique_ptr<OIIO::ImageOutput> encoder = OIIO::ImageOutput::create(name);
  if (!encoder) refuse(OIIO::geterror());
  if (!encoder->supports("ioproxy")) refuse(fmt::format("this image library cannot make {} files in memory", extension));
  OIIO::Filesystem::IOVecOutput memory;
  if (!encoder->set_ioproxy(&memory) || !encoder->open(name, spec_of(extension, header)) || !encoder->write_image(type, data) ||
      !encoder->close())
    refuse(encoder->geterror());
  encoder.reset();
  return memory.buffer();
}

}  // namespace etendue
