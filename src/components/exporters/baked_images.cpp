#include "baked_images.h"

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "etendue/describe/color.h"
#include "etendue/describe/registry.h"
#include "images/linear_image.h"
#include "images/listed_image.h"
#include "members.h"

namespace etendue {
namespace {

/// Portable float map: "PF", the size, -1 for little-endian numbers, then rows from the bottom upwards.
std::string as_pfm(const LinearImage& image) {
  std::string bytes = fmt::format("PF\n{} {}\n-1.0\n", image.width, image.height);
  const size_t row = size_t(image.width) * 3 * sizeof(float), head = bytes.size();
  bytes.resize(head + row * size_t(image.height));
  for (size_t y = 0; y < size_t(image.height); ++y)
    std::memcpy(&bytes[head + row * (size_t(image.height) - 1 - y)], &image.rgb[y * size_t(image.width) * 3], row);
  return bytes;
}

/// A copy of the component with one member changed.
Ref<Component> changed(const Component& part, std::string_view member, const Value& value) {
  Ref<Component> made = copy(part);
  set(*made, member, value);
  return made;
}

/// The ImageMap with other pixels, which are written to a file beside the exported one.
Ref<Component> with_pixels(Exporting& exporting, const Component& image, const char* what, const LinearImage& pixels) {
  const std::string name = exporting.write_beside(what, "pfm", as_pfm(pixels));
  const FilePath file{(std::filesystem::path(exporting.folder()) / name).string(), {}};
  Ref<Component> made = changed(image, "file", Value(file));
  set(*made, "values", Value(Value::List{}));
  set(*made, "resolution", Value(Numbers{{1, 1}, 1, Dimension::none}));
  set(*made, "number_type", Value(std::string("float")));
  set(*made, "transfer", Value(std::string("linear")));
  set(*made, "channel", Value(std::string()));
  return made;
}

bool one_file(const Component& image) { return word_of(image, "file").find("<UDIM>") == std::string::npos; }

std::array<double, 3> times(const std::array<double, 9>& m, const std::array<double, 3>& v) {
  return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[3] * v[0] + m[4] * v[1] + m[5] * v[2],
          m[6] * v[0] + m[7] * v[1] + m[8] * v[2]};
}

/// The texels of an ImageMap that is given by its numbers.
LinearImage listed_texels(const Component& image) {
  const std::vector<double> size = numbers_of(image, "resolution"), numbers = numbers_of(image, "values");
  const std::string type = word_of(image, "number_type");
  ListedImage listed = listed_image(image, {size.begin(), size.end()}, {numbers.begin(), numbers.end()},
                                    type == "uint8"    ? ListedNumbers::uint8
                                    : type == "uint16" ? ListedNumbers::uint16
                                                       : ListedNumbers::single,
                                    word_of(image, "transfer"), word_of(image, "channel"));
  LinearImage linear{listed.width, listed.height, std::move(listed.texels)};
  if (listed.channels == 1) {
    std::vector<float> rgb;
    rgb.reserve(3 * linear.rgb.size());
    for (const float grey : linear.rgb) rgb.insert(rgb.end(), 3, grey);
    linear.rgb = std::move(rgb);
  }
  return linear;
}

/// Applies `change` to an ImageMap's linear texels; the value of a single channel is repeated three times.
template <class Change>
LinearImage texels(const Component& image, Change change) {
  LinearImage pixels = image_texels(image);
  for (float* rgb = pixels.rgb.data(); rgb != pixels.rgb.data() + pixels.rgb.size(); rgb += 3)
    std::ranges::transform(change(std::array<double, 3>{double(rgb[0]), double(rgb[1]), double(rgb[2])}), rgb,
                           [](double value) { return float(value); });
  return pixels;
}

}  // namespace

bool is_listed(const Component& image) { return class_of(image) == "ImageMap" && word_of(image, "file").empty(); }

LinearImage image_texels(const Component& image) {
  if (is_listed(image)) return listed_texels(image);
  return read_linear_image(word_of(image, "file"), word_of(image, "transfer"), word_of(image, "channel"));
}

Ref<Component> baked_product(Exporting& exporting, const Component& product) {
  const Ref<Component> first = part_of(product, "first"), second = part_of(product, "second");
  if (!first || !second || !constant_of(*second)) return nullptr;
  const bool moved = class_of(*first) == "UvTransformMap";
  const Ref<Component> image = moved ? part_of(*first, "map") : first;
  if (!image || class_of(*image) != "ImageMap" || !word_of(*image, "channel").empty() || !one_file(*image)) return nullptr;
  LinearImage pixels = image_texels(*image);
  const std::vector<double> factor = numbers_of(product, "factor"), offset = numbers_of(product, "offset");
  const std::array<double, 3> other = rgb_of(constant_of(*second), ColorUse::reflectance);
  for (size_t i = 0; i < pixels.rgb.size(); ++i)
    pixels.rgb[i] = std::max(0.0f, float(double(pixels.rgb[i]) * factor[i % 3] * other[i % 3] + offset[i % 3]));
  const Ref<Component> made = with_pixels(exporting, *image, "product", pixels);
  return moved ? changed(*first, "map", Value(made)) : made;
}

Ref<Component> baked_color(Exporting& exporting, const Component& image) {
  if (!one_file(image)) return nullptr;
  const std::array<double, 9>&to_xyz = rgb_space(word_of(image, "color_space")).to_xyz, &from_xyz = rgb_space("srgb").from_xyz;
  bool beyond = false;
  const bool converted = word_of(image, "color_space") != "srgb";
  const LinearImage pixels = texels(image, [&](std::array<double, 3> rgb) {
    if (!converted) return rgb;
    rgb = times(from_xyz, times(to_xyz, rgb));
    for (double& value : rgb) {
      beyond = beyond || value < -1e-4;
      value = std::max(value, 0.0);
    }
    return rgb;
  });
  if (beyond) exporting.inexact("colours of an image that sRGB does not have are clipped", &image);
  Ref<Component> made = with_pixels(exporting, image, "colors", pixels);
  set(*made, "color_space", Value(std::string("srgb")));
  return made;
}

std::string baked_cube(Exporting& exporting, const std::string& file, const std::string& transfer) {
  if (!says_it_is_a_cube(file)) return {};
  return exporting.write_beside("surroundings", "pfm", as_pfm(read_linear_image(file, transfer)));
}

bool says_it_is_a_cube(const std::string& file) {
  return file.ends_with(".exr") && read_linear_image(file, "linear").from_cube;
}

// Mean and luminance of three equal values are that value.
Ref<Component> baked_number(Exporting& exporting, const Component& image, AsNumber there, bool decoded_there) {
  const std::string file = word_of(image, "file"), channel = word_of(image, "channel"), space = word_of(image, "color_space");
  if (!one_file(image)) return nullptr;
  const bool mean = word_of(image, "as_number") == "mean",
             same = mean == (there == AsNumber::mean) && (mean || space == "srgb");
  const bool listed = is_listed(image);
  if (!listed && channel.empty() && decoded_there && (same || image_channels(file).size() < 3)) return nullptr;
  bool grey = !listed && channel.empty() && decoded_there;
  const std::array<double, 9>& to_xyz = rgb_space(space).to_xyz;
  const LinearImage pixels = texels(image, [&](const std::array<double, 3>& rgb) {
    grey = grey && rgb[0] == rgb[1] && rgb[0] == rgb[2];
    const double number = mean ? (rgb[0] + rgb[1] + rgb[2]) / 3 : times(to_xyz, rgb)[1];
    return std::array<double, 3>{number, number, number};
  });
  if (grey) return nullptr;
  Ref<Component> made = with_pixels(exporting, image, "numbers", pixels);
  set(*made, "color_space", Value(std::string("srgb")));
  set(*made, "as_number", Value(std::string(there == AsNumber::mean ? "mean" : "luminance")));
  return made;
}

}  // namespace etendue
