#include "baked_images.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "etendue/describe/registry.h"
#include "images/linear_image.h"
#include "members.h"

namespace etendue {
namespace {

/// Portable float map: "PF", the size, -1 for little-endian numbers, then rows from the lowest upwards.
std::string as_pfm(const LinearImage& image) {
  std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
  const size_t row = size_t(image.width) * 3 * sizeof(float), head = bytes.size();
  bytes.resize(head + row * size_t(image.height));
  for (size_t y = 0; y < size_t(image.height); ++y)
    std::memcpy(&bytes[head + row * (size_t(image.height) - 1 - y)], &image.rgb[y * size_t(image.width) * 3], row);
  return bytes;
}

/// The same part with another member.
Ref<Component> changed(const Component& part, std::string_view member, const Value& value) {
  Ref<Component> made = copy(part);
  set(*made, member, value);
  return made;
}

}  // namespace

Ref<Component> baked_product(Exporting& exporting, const Component& product) {
  const Ref<Component> first = part_of(product, "first"), second = part_of(product, "second");
  if (!first || !second || !constant_of(*second)) return nullptr;
  const bool moved = class_of(*first) == "UvTransformMap";
  const Ref<Component> image = moved ? part_of(*first, "map") : first;
  if (!image || class_of(*image) != "ImageMap" || !word_of(*image, "channel").empty() ||
      word_of(*image, "file").find("<UDIM>") != std::string::npos)
    return nullptr;
  LinearImage pixels = read_linear_image(word_of(*image, "file"), word_of(*image, "transfer"));
  const std::vector<double> factor = numbers_of(product, "factor"), offset = numbers_of(product, "offset");
  const std::array<double, 3> other = rgb_of(constant_of(*second), ColorUse::reflectance);
  for (size_t i = 0; i < pixels.rgb.size(); ++i)
    pixels.rgb[i] = std::max(0.0f, float(double(pixels.rgb[i]) * factor[i % 3] * other[i % 3] + offset[i % 3]));
  const std::string name = exporting.write_beside("product", "pfm", as_pfm(pixels));
  const FilePath file{(std::filesystem::path(exporting.folder()) / name).string(), {}};
  Ref<Component> made = changed(*image, "file", Value(file));
  set(*made, "transfer", Value(std::string("linear")));
  return moved ? changed(*first, "map", Value(made)) : made;
}

}  // namespace etendue
