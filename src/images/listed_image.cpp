#include "listed_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "etendue/describe/color.h"
#include "etendue/describe/component.h"
#include "linear_image.h"

namespace etendue {
namespace {

constexpr std::uint64_t most_pixels = std::uint64_t(1) << 32;

/// The places of the selected channels in a pixel, one or three.
std::vector<size_t> selected_channels(const Component& of, size_t count, const std::string& channel) {
  const std::string names = count == 1 ? "Y" : count == 2 ? "YA" : count == 3 ? "RGB" : "RGBA";
  if (channel.empty()) return count >= 3 ? std::vector<size_t>{0, 1, 2} : std::vector<size_t>{0};
  if (channel.size() == 1)
    if (const size_t place = names.find(char(std::toupper(static_cast<unsigned char>(channel[0])))); place != names.npos)
      return {place};
  std::string known;
  for (const char c : names) known += fmt::format("{}'{}'", known.empty() ? "" : ", ", c);
  of.fail("channel", fmt::format("the image has no channel '{}', but {}", channel, known));
}

/// Throws unless the number is one of its type.
void check_number(const Component& of, float value, size_t place, float largest) {
  if (!std::isfinite(value)) of.fail("values", fmt::format("the number at place {} is {}", place, value));
  if (largest > 0 && !(value >= 0 && value <= largest && value == std::floor(value)))
    of.fail("values", fmt::format("the number at place {} is {}: `number_type` says that they are integers from 0 to {}", place,
                                  value, largest));
}

}  // namespace

ListedImage listed_image(const Component& of, const std::vector<int>& resolution, const std::vector<float>& values,
                         ListedNumbers type, const std::string& transfer, const std::string& channel) {
  if (resolution.size() != 2 || resolution[0] < 1 || resolution[1] < 1)
    of.fail("resolution", "two numbers of at least 1 are needed: the width and the height");
  const std::uint64_t pixels = std::uint64_t(resolution[0]) * std::uint64_t(resolution[1]);
  if (pixels > most_pixels) of.fail("resolution", "too many pixels");
  const size_t count = values.size() / pixels;
  if (count < 1 || count > 4 || count * pixels != values.size())
    of.fail("values", fmt::format("{} numbers for an image of {} x {} pixels: 1 to 4 are needed for each", values.size(),
                                  resolution[0], resolution[1]));
  const std::vector<size_t> selected = selected_channels(of, count, channel);
  const float largest = type == ListedNumbers::single ? 0.0f : type == ListedNumbers::uint8 ? 255.0f : 65535.0f;
  for (size_t i = 0; i < values.size(); ++i) check_number(of, values[i], i, largest);

  const std::string encoding = transfer != automatic_transfer ? transfer : (type == ListedNumbers::single ? "linear" : "srgb");
  const auto decoded = [&](double value) {
    return encoding == "linear" ? float(value) : float(decode_transfer(encoding, value));
  };
  std::vector<float> table;  // of integers, whose powers are expensive
  if (largest > 0)
    for (int i = 0; i <= int(largest); ++i) table.push_back(decoded(double(i) / double(largest)));
  ListedImage image{resolution[0], resolution[1], int(selected.size()), {}};
  image.texels.reserve(pixels * selected.size());
  for (size_t pixel = 0; pixel < pixels; ++pixel)
    for (const size_t c : selected) {
      const float value = values[pixel * count + c];
      image.texels.push_back(largest > 0 ? table[size_t(value)] : decoded(double(value)));
    }
  return image;
}

}  // namespace etendue
