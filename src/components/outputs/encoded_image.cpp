#include "encoded_image.h"

#include <fmt/format.h>

#include <vector>

#include "etendue/core/error.h"
#include "etendue/core/math.h"
#include "files/whole_file.h"

namespace etendue {
namespace {

std::array<size_t, 3> rgb_channels(const Image& image, const std::string& path) {
  std::array<size_t, 3> at{};
  const char* names[] = {"R", "G", "B"};
  for (size_t c = 0; c < 3; ++c) {
    const auto found = std::find(image.channels.begin(), image.channels.end(), names[c]);
    if (found == image.channels.end())
      throw Error(fmt::format("cannot write '{}': the format takes R G B and the picture has no {}; it was not tone mapped",
                              path, names[c]));
    at[c] = size_t(found - image.channels.begin());
  }
  return at;
}

template <class T>
std::vector<T> quantized(const Image& image, const std::array<size_t, 3>& channels, bool dither) {
  constexpr double maximum = double(std::numeric_limits<T>::max());
  const size_t count = size_t(image.width) * size_t(image.height), stride = image.channels.size();
  std::vector<T> out(3 * count);
  for (size_t i = 0; i < out.size(); ++i) {
    const double value = image.values[i / 3 * stride + channels[i % 3]];
    double v = maximum * (value > 0 ? std::min(value, 1.0) : 0);  // NaN becomes 0
    // Black and white are not dithered.
    if (dither && v > 0 && v < maximum) v += double(to_unit_float(std::uint32_t(mix_bits(i + 1) >> 32))) - 0.5;
    out[i] = T(std::clamp(v + 0.5, 0.0, maximum));
  }
  return out;
}

}  // namespace

void write_encoded(const std::string& path, const std::string& extension, const ImageHeader& header,
                   const PixelValues& pixels) {
  std::vector<unsigned char> bytes;
  try {
    bytes = image_library().encode(extension, header, pixels);
  } catch (const Error& e) {
    throw Error(fmt::format("cannot write '{}': {}", path, e.what()));
  }
  write_whole_file(path, bytes.data(), bytes.size());
}

void write_display_image(const Image& image, const std::string& path, const std::string& extension, int bits, bool dither) {
  const std::array<size_t, 3> channels = rgb_channels(image, path);
  ImageHeader header(image.width, image.height, 3, bits > 8 ? NumberType::uint16 : NumberType::uint8);
  header.texts = image.metadata;
  const auto known = [&](const char* key) {
    const auto found = image.metadata.find(key);
    return found == image.metadata.end() ? std::string() : found->second;
  };
  if (known("transfer") == "linear" || (known("transfer") == "srgb" && known("color_space") == "srgb"))
    header.transfer = known("transfer");
  if (bits > 8)
    write_encoded(path, extension, header, quantized<std::uint16_t>(image, channels, dither));
  else
    write_encoded(path, extension, header, quantized<std::uint8_t>(image, channels, dither));
}

}  // namespace etendue
