#include "file_input.h"

#include <OpenImageIO/imageio.h>

#include <string_view>

#include "checked_open.h"
#include "files/regular_file.h"
#include "refuse.h"

namespace etendue {
namespace {

/// Text attributes of the file, except those about its encoding.
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

/// The transfer function that the file states, else sRGB for integers and linear for floats.
std::string transfer(const OIIO::ImageSpec& spec) {
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  if (space == "linear" || space == "Linear" || space == "scene_linear") return "linear";
  return spec.format.is_floating_point() ? "linear" : "srgb";
}

/// Whether a TGA file contains all its pixels, which OpenImageIO does not check: a header of 18 bytes (fields: Truevision TGA
/// File Format Specification 2.0), a text and a palette precede the pixels, which are plain or in packets of 1 to 128, where a
/// packet with the top bit set holds one pixel to be repeated.
bool complete_targa(std::string_view file) {
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
  const CheckedInput input = open_checked(path);
  const OIIO::ImageSpec spec = input->spec();
  require_memory(double(spec.width) * double(spec.height) * double(spec.nchannels) * sizeof(double), "it");
  if (std::string_view(input->format_name()) == "targa" && !complete_targa(FileContents(path).text()))
    refuse("it ends too early");

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
