// Images of models: unreadable images are left out with a warning, since a model without an image is better than none.

#include <algorithm>

#include "images/linear_image.h"
#include "images/udim_files.h"
#include "surface.h"

namespace etendue {
namespace {

/// The mean colour of about ten thousand pixels.
std::optional<std::array<double, 3>> mean_of(const std::string& file, const std::string& transfer) {
  LinearImage image;
  try {
    image = read_linear_image(file, transfer);
  } catch (const Error&) {
    return std::nullopt;  // damage behind the header is reported when the map opens the file
  }
  std::array<double, 3> sum{};
  const size_t pixels = image.rgb.size() / 3, step = std::max<size_t>(pixels / 10000, 1);
  size_t count = 0;
  for (size_t i = 0; i < pixels; i += step, ++count)
    for (size_t c = 0; c < 3; ++c) sum[c] += double(image.rgb[3 * i + c]);
  for (double& x : sum) x /= double(std::max<size_t>(count, 1));
  return sum;
}

}  // namespace

std::optional<std::string> optional_image(Importing& importing, const std::string& named, Location at,
                                          const std::string& beside) {
  const std::string_view mark = udim_mark;
  const size_t place = named.rfind(mark), slash = named.find_last_of("/\\");
  if (place == std::string::npos || (slash != std::string::npos && slash > place))
    return importing.optional_file(named, at, beside);
  for (int number = 1001; number <= 1100; ++number) try {
      std::string tile = named;
      tile.replace(place, mark.size(), std::to_string(number));
      std::string found = importing.file(tile, at, beside);
      const size_t there = found.rfind(std::to_string(number));
      return there == std::string::npos ? found : found.replace(there, 4, mark);
    } catch (const Error&) {  // some UDIM tiles may be missing
    }
  return importing.optional_file(named, at, beside);
}

const std::vector<std::string>& channels_of_image(Importing& importing, const std::string& file) {
  const std::vector<UdimFile> tiles = udim_files(file);
  return importing.image_channels(tiles.empty() ? file : tiles[0].path);
}

std::optional<SurfaceTexture> readable_texture(Importing& importing, const std::string& file, Location at, bool* has_alpha) {
  try {
    const std::vector<std::string>& channels = channels_of_image(importing, file);
    for (const UdimFile& tile : udim_files(file)) (void)importing.file(tile.path, at);  // each must be allowed
    if (has_alpha) *has_alpha = std::ranges::count(channels, "A") > 0;
    SurfaceTexture texture;
    texture.file = file;
    return texture;
  } catch (const Error& error) {
    importing.inexact(std::string("the image is left out: ") + error.what(), at);
    return std::nullopt;
  }
}

std::optional<std::array<double, 3>> mean_of_image(const std::string& file) { return mean_of(file, automatic_transfer); }

bool looks_like_normals(const std::string& file) {
  const auto mean = mean_of(file, "linear");
  return mean && std::abs((*mean)[0] - 0.5) < 0.1 && std::abs((*mean)[1] - 0.5) < 0.1 && (*mean)[2] > 0.7;
}

}  // namespace etendue
