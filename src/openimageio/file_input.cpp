#include "openimageio/file_input.h"

#include <OpenImageIO/imageio.h>
#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "openimageio/refuse.h"

namespace etendue {
namespace {

/// Texts of the file, without what only tells how it is packed.
std::map<std::string, std::string> texts(const OIIO::ImageSpec& spec) {
  std::map<std::string, std::string> found;
  for (const OIIO::ParamValue& p : spec.extra_attribs) {
    const std::string name = p.name().string();
    if (p.type() == OIIO::TypeString && name.find(':') == std::string::npos && name != "compression" &&
        name != "ResolutionUnit")
      found[name] = p.get_string();
  }
  return found;
}

/// What the file says, else sRGB for whole numbers and linear for the others.
std::string transfer(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (space == "linear" || space == "Linear" || space == "scene_linear") return "linear";
  return spec.format.is_floating_point() ? "linear" : "srgb";
}

std::string read_bytes(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) refuse(std::generic_category().message(errno));
  std::ostringstream bytes;
  bytes << in.rdbuf();
  if (!in || in.bad()) refuse(std::generic_category().message(errno));
  return std::move(bytes).str();
}

/// Whether a TGA file holds all its pixels, which the image library does not notice: after a header of 18 bytes (their
/// meaning: Truevision TGA File Format Specification 2.0), a text and a palette come the pixels, plain or in packets of
/// 1 to 128, of which those with the top bit set hold one pixel to be repeated.
bool complete_targa(const std::string& file) {
  const auto byte = [&](size_t i) { return size_t(static_cast<unsigned char>(file[i])); };
  const auto word = [&](size_t i) { return byte(i) | byte(i + 1) << 8; };
  if (file.size() < 18) return false;
  const size_t pixels = word(12) * word(14), size = (byte(16) + 7) / 8;
  size_t at = 18 + byte(0) + (byte(1) == 1 ? word(5) * ((byte(7) + 7) / 8) : 0);
  if ((byte(2) & 8) == 0) return at + pixels * size <= file.size();
  for (size_t done = 0; done < pixels;) {
    if (at >= file.size()) return false;
    const size_t packet = byte(at), count = (packet & 127) + 1;
    at += 1 + (packet & 128 ? 1 : count) * size;
    done += count;
  }
  return at <= file.size();
}

}  // namespace

StoredImage read_file(const std::string& path) {
  std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path);
  if (!input) refuse(OIIO::geterror());
  const OIIO::ImageSpec spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) refuse("it holds no pixels");
  // No format packs better than this; a damaged header must not make us ask for all the memory there is.
  const double values = double(spec.width) * double(spec.height) * double(spec.nchannels);
  std::error_code code;
  const auto file_size = std::filesystem::file_size(path, code);
  if (!code && values > 1e6 && values / 65536 > double(file_size))
    refuse(fmt::format("it claims {} x {} pixels, which its {} bytes cannot hold", spec.width, spec.height, file_size));

  if (std::string_view(input->format_name()) == "targa" && !complete_targa(read_bytes(path))) refuse("it ends too early");

  Image image(spec.width, spec.height, spec.channelnames);
  image.channels.resize(size_t(spec.nchannels));
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::DOUBLE, image.values.data())) refuse(input->geterror());
  image.metadata = texts(spec);
  if (spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width || spec.height != spec.full_height) {
    image.metadata["crop_x"] = std::to_string(spec.x - spec.full_x);
    image.metadata["crop_y"] = std::to_string(spec.y - spec.full_y);
    image.metadata["full_width"] = std::to_string(spec.full_width);
    image.metadata["full_height"] = std::to_string(spec.full_height);
  }
  return {std::move(image), transfer(spec)};
}

}  // namespace etendue
