#include "relight.h"

#include <fmt/format.h>

#include <vector>

#include "etendue/core/error.h"
#include "etendue/describe/color.h"
#include "film/image_bands.h"

namespace etendue {

namespace {

struct Group {
  size_t first;  // channel, X
  std::array<double, 3> factors;
};

/// The light groups of a picture with their factors; all names in `factors` must be groups.
std::vector<Group> groups_of(const Image& picture, const std::map<std::string, std::array<double, 3>>& factors) {
  constexpr std::string_view prefix = "light.", suffix = ".X";
  std::vector<Group> groups;
  size_t named = 0;
  for (size_t c = 3; c + 2 < picture.channels.size(); ++c) {
    const std::string& channel = picture.channels[c];
    if (!channel.starts_with(prefix) || !channel.ends_with(suffix)) continue;
    const auto found = factors.find(channel.substr(prefix.size(), channel.size() - prefix.size() - suffix.size()));
    named += found != factors.end();
    groups.push_back({c, found == factors.end() ? std::array<double, 3>{1, 1, 1} : found->second});
  }
  if (groups.empty()) throw Error("this picture has no light groups: the image's layers name none");
  if (named < factors.size()) throw Error("this picture has other light groups");
  return groups;
}

bool of_another_picture(const std::string& channel) {
  return channel.starts_with("variance.") || channel.starts_with("length_") || channel.starts_with("path.") ||
         measures_spectrum(channel);
}

using Matrix = std::array<double, 9>;
std::array<double, 3> times(const Matrix& m, const std::array<double, 3>& v) {
  std::array<double, 3> result{};
  for (size_t i = 0; i < 3; ++i) result[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
  return result;
}

}  // namespace

Image relit(const Image& picture, const std::map<std::string, std::array<double, 3>>& factors) {
  const std::vector<Group> groups = groups_of(picture, factors);
  const RgbSpace& srgb = rgb_space("srgb");
  std::vector<size_t> kept;
  std::vector<std::string> names;
  for (size_t c = 0; c < picture.channels.size(); ++c)
    if (!of_another_picture(picture.channels[c])) {
      kept.push_back(c);
      names.push_back(picture.channels[c]);
    }
  Image result(picture.width, picture.height, std::move(names));
  result.metadata = picture.metadata;
  const size_t stride = picture.channels.size();
  std::vector<double> pixel(stride);
  for (size_t p = 0; p < size_t(picture.width) * size_t(picture.height); ++p) {
    pixel.assign(picture.values.begin() + std::ptrdiff_t(p * stride),
                 picture.values.begin() + std::ptrdiff_t((p + 1) * stride));
    pixel[0] = pixel[1] = pixel[2] = 0;
    for (const Group& group : groups) {
      std::array<double, 3> rgb = times(srgb.from_xyz, {pixel[group.first], pixel[group.first + 1], pixel[group.first + 2]});
      for (size_t i = 0; i < 3; ++i) rgb[i] *= group.factors[i];
      const std::array<double, 3> xyz = times(srgb.to_xyz, rgb);
      for (size_t i = 0; i < 3; ++i) {
        pixel[group.first + i] = xyz[i];
        pixel[i] += xyz[i];
      }
    }
    for (size_t k = 0; k < kept.size(); ++k) result.values[p * kept.size() + k] = pixel[kept[k]];
  }
  return result;
}

}  // namespace etendue
