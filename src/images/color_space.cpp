#include <fmt/format.h>

#include "etendue/describe/color.h"
#include "etendue/film/image_tools.h"

namespace etendue {
namespace {

/// The indices of three channels; all -1 if one is missing.
std::array<std::ptrdiff_t, 3> find_channels(const Image& image, const char* a, const char* b, const char* c) {
  std::array<std::ptrdiff_t, 3> at{};
  const char* names[] = {a, b, c};
  for (size_t i = 0; i < 3; ++i) {
    const auto found = std::find(image.channels.begin(), image.channels.end(), names[i]);
    if (found == image.channels.end()) return {-1, -1, -1};
    at[i] = found - image.channels.begin();
  }
  return at;
}

std::string known(const Image& image, const char* key, const char* otherwise) {
  const auto found = image.metadata.find(key);
  return found == image.metadata.end() ? otherwise : found->second;
}

}  // namespace

Image convert_color_space(const Image& image, const std::string& color_space) {
  const RgbSpace& to = rgb_space(color_space);
  std::array<std::ptrdiff_t, 3> at = find_channels(image, "X", "Y", "Z");
  const bool was_xyz = at[0] >= 0;
  if (!was_xyz) at = find_channels(image, "R", "G", "B");
  if (at[0] < 0) throw Error("the picture has neither channels X Y Z nor R G B");
  // The channels' names take precedence over the file's metadata.
  const std::string from_name = was_xyz ? "xyz" : known(image, "color_space", "srgb");
  const std::string transfer = was_xyz ? "linear" : known(image, "transfer", "linear");
  const bool to_xyz = to.name == "xyz";

  Image out = image;
  out.metadata["color_space"] = to.name;
  out.metadata["transfer"] = "linear";
  if (to_xyz) out.metadata.erase("transfer");
  const char* names[2][3] = {{"R", "G", "B"}, {"X", "Y", "Z"}};
  for (size_t i = 0; i < 3; ++i) out.channels[size_t(at[i])] = names[to_xyz][i];

  const RgbSpace& from = rgb_space(from_name);
  const bool same = from.name == to.name;
  if (same && transfer == "linear") return out;
  std::array<double, 9> m{};
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) {
      if (same) {
        m[3 * i + j] = i == j;
        continue;
      }
      for (size_t k = 0; k < 3; ++k) {
        const double left = to_xyz ? double(i == k) : to.from_xyz[3 * i + k];
        const double right = was_xyz ? double(k == j) : from.to_xyz[3 * k + j];
        m[3 * i + j] += left * right;
      }
    }
  for (size_t p = 0; p < out.values.size(); p += out.channels.size()) {
    double v[3];
    for (size_t i = 0; i < 3; ++i) {
      const double x = out.values[p + size_t(at[i])];
      v[i] = transfer == "linear" ? x : decode_transfer(transfer, x);
    }
    for (size_t i = 0; i < 3; ++i) out.values[p + size_t(at[i])] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
  }
  return out;
}

}  // namespace etendue
