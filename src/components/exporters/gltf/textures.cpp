// Writes images as textures, and maps as the elements that glTF supports: a factor, a texture, vertex colours.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>

#include "components/exporters/baked_images.h"
#include "files/regular_file.h"
#include "images/image_library.h"
#include "images/linear_image.h"
#include "images/udim_files.h"
#include "writer.h"

namespace etendue::gltf_export {

/// The numbers of an ImageMap as a PNG file of 8 bits: in glTF, colours are encoded as sRGB and numbers are linear.
std::string Writer::as_png(const Component& image, bool colors) {
  const LinearImage texels = image_texels(image);
  std::vector<std::uint8_t> bytes;
  bool exact = true;
  for (const float value : texels.rgb) {
    const double encoded = 255 * (colors ? encode_transfer("srgb", double(value)) : double(value));
    bytes.push_back(std::uint8_t(std::clamp(std::round(encoded), 0.0, 255.0)));
    exact = exact && std::abs(encoded - double(bytes.back())) < 1e-3;
  }
  if (!exact) exporting.inexact("the numbers of an image are rounded to 8 bits, and cut to 0 and 1, in glTF", &image);
  const std::vector<unsigned char> png = image_library().encode(
      ".png", ImageHeader(texels.width, texels.height, 3, NumberType::uint8), std::span<const std::uint8_t>(bytes));
  return {png.begin(), png.end()};
}

Json Writer::image_entry(const Component& image, const std::string& ending, bool colors) {
  const std::string file = word_of(image, "file");
  if (!binary_)
    return {{"uri", as_uri(file.empty() ? exporting.write_beside("image", "png", as_png(image, colors))
                                        : exporting.copy_beside(file))}};
  std::string bytes;
  try {
    bytes = file.empty() ? as_png(image, colors) : read_regular_file(file);
  } catch (const Error& reason) {
    if (file.empty()) throw;
    throw Error(fmt::format("cannot read '{}': {}", file, reason.what()));
  }
  document_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}});
  buffer_ += bytes;
  buffer_.resize((buffer_.size() + 3) / 4 * 4);  // the following numbers stay aligned
  return {{"bufferView", document_["bufferViews"].size() - 1}, {"mimeType", ending == ".png" ? "image/png" : "image/jpeg"}};
}

// Here the lookup coordinates are shift + R(angle) (scale * uv); glTF uses the same formula with v downwards, where a rotation
// has the opposite sense; the difference of the two shifts follows from that.
std::optional<Json> Writer::texture(const Placed& placed, bool colors) {
  const Component& image = *placed.image;
  const std::string file = word_of(image, "file");
  const bool listed = is_listed(image);
  std::string ending = listed ? ".png" : std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (ending != ".png" && ending != ".jpg" && ending != ".jpeg") {
    exporting.inexact("images are PNG or JPEG files in glTF: another becomes a grey of 0.5", &image);
    return std::nullopt;
  }
  if (file.find(udim_mark) != std::string::npos) {
    exporting.inexact("an image in several files is a grey of 0.5", &image);
    return std::nullopt;
  }
  const bool map = class_of(image) == "ImageMap";  // the image of a NormalMapShader has no wrap and interpolation modes
  const std::string transfer = listed ? "auto" : word_of(image, "transfer");  // as_png decodes, and selects the channel
  if (map && !listed && colors && !word_of(image, "channel").empty())
    exporting.inexact("the choice of an image's channels is left out", &image);
  if (colors && transfer == "linear") exporting.inexact("the colours of an image are encoded as sRGB in glTF", &image);
  if (!colors && !listed && transfer != "linear")
    exporting.inexact("numbers of an image, such as normals, are linear in glTF", &image);
  const std::string wrap = map ? word_of(image, "wrap") : "repeat", above = map ? word_of(image, "wrap_v") : "same";
  const std::string wrap_v = above == "same" ? wrap : above;
  if (wrap == "black" || wrap_v == "black") exporting.inexact("an image that is black outside is clamped in glTF", &image);
  const bool nearest = map && word_of(image, "interpolation") == "nearest";
  const std::string source = listed ? exporting.name_for(image) + (colors ? " colors" : " numbers") : file;
  size_t& known = textures_[{source, wrap + " " + wrap_v + (nearest ? " nearest" : "")}];
  if (known == 0) {
    constexpr int clamp = 33071, mirror = 33648, repeated = 10497, filter_nearest = 9728, filter_linear = 9729;
    const auto code = [](const std::string& w) {
      return w == "mirror" ? mirror : (w == "clamp" || w == "black" ? clamp : repeated);
    };
    document_["images"].push_back(image_entry(image, ending, colors));
    document_["samplers"].push_back(
        {{"wrapS", code(wrap)}, {"wrapT", code(wrap_v)}, {"magFilter", nearest ? filter_nearest : filter_linear}});
    document_["textures"].push_back(
        {{"source", document_["images"].size() - 1}, {"sampler", document_["samplers"].size() - 1}});
    known = document_["textures"].size();
  }
  Json used{{"index", known - 1}};
  const std::vector<double> repeat = numbers_of(image, "repeat");
  // The image's own repeat factors apply after the rotation; equal ones, or none, commute with it.
  if (placed.angle != 0 && repeat[0] != repeat[1])
    exporting.inexact("an image that is turned is laid along u and v equally often", &image);
  const double angle = placed.angle, c = std::cos(angle), s = std::sin(angle);
  const double u = placed.scale[0] * repeat[0], v = placed.scale[1] * repeat[1];
  const double shift_u = placed.shift[0] * repeat[0], shift_v = placed.shift[1] * repeat[1];
  if (u != 1 || v != 1 || angle != 0 || shift_u != 0 || shift_v != 0) {
    Json t{{"scale", {u, v}}, {"offset", {shift_u - s * v, 1 - c * v - shift_v}}};
    if (angle != 0) t["rotation"] = angle;
    extend(used, "KHR_texture_transform", std::move(t));
  }
  return used;
}

std::optional<Writer::Placed> Writer::placed_of(const Component& map) {
  if (class_of(map) == "ImageMap") return Placed{&map};
  if (class_of(map) != "UvTransformMap") return std::nullopt;
  const Ref<Component> inner = part_of(map, "map");
  if (!inner || class_of(*inner) != "ImageMap") return std::nullopt;
  const std::vector<double> scale = numbers_of(map, "scale"), shift = numbers_of(map, "shift");
  return Placed{inner.get(), {scale[0], scale[1]}, {shift[0], shift[1]}, number_of(map, "angle") * std::numbers::pi / 180};
}

std::optional<Writer::Amount> Writer::amount_of(const Component& map) {
  if (const Color c = constant_of(map)) return Amount{double(c->at(at_d_line, ColorUse::coefficient))};
  if (const auto placed = placed_of(map)) {
    Amount made{1, placed, word_of(*placed->image, "channel")};
    if (is_listed(*placed->image)) {  // as_png writes the selected channel alone
      const std::vector<double> size = numbers_of(*placed->image, "resolution");
      made.grey = !made.channel.empty() || double(numbers_of(*placed->image, "values").size()) < 3 * size[0] * size[1];
      made.channel.clear();
    } else
      try {
        made.grey = image_channels(word_of(*placed->image, "file")).size() < 3;
      } catch (const Error&) {  // reported when the image is opened
      }
    return made;
  }
  if (class_of(map) == "AttributeMap") {
    Amount made;
    made.of_vertices = word_of(map, "name");
    return made;
  }
  if (class_of(map) != "MultiplyMap" || part_of(map, "third")) return std::nullopt;
  const Ref<Component> first = part_of(map, "first"), second = part_of(map, "second");
  if (!first || !second) return std::nullopt;
  auto a = amount_of(*first), b = amount_of(*second);
  if (!a || !b || (a->image && b->image) || (!a->of_vertices.empty() && !b->of_vertices.empty())) return std::nullopt;
  if (b->image) a->image = b->image, a->channel = b->channel, a->grey = b->grey;
  if (!b->of_vertices.empty()) a->of_vertices = b->of_vertices;
  a->factor *= b->factor;
  return a;
}

std::optional<Writer::Amount> Writer::textured_amount(const Component& of, const char* member, const char* channel) {
  const Ref<Component> map = part_of(of, member);
  auto amount = map ? amount_of(*map) : std::nullopt;
  if (!amount || !amount->image || !amount->of_vertices.empty()) return std::nullopt;
  const bool fits = amount->channel == channel || (amount->channel.empty() && amount->grey && *channel != 'A');
  return fits ? amount : std::nullopt;
}

double Writer::number(const Component& of, const char* member, double otherwise, const char* channel, Json& to,
                      const char* key) {
  if (const auto amount = textured_amount(of, member, channel))
    if (auto made = texture(*amount->image, false)) {
      to[key] = std::move(*made);
      return amount->factor;
    }
  return scalar(of, member, otherwise);
}

double Writer::scalar(const Component& of, const char* member, double otherwise) {
  const Value value = value_of(of, member);
  if (const Number* n = value.as<Number>()) return n->value;
  const Ref<Component> map = part_of(of, member);
  const Color c = map ? constant_of(*map) : color_of(of, member);
  if (c) return double(c->at(at_d_line, ColorUse::coefficient));
  if (map) exporting.inexact(fmt::format("'{}' differs from place to place: it is {}", member, otherwise), &of);
  return otherwise;
}

Writer::Look Writer::look(const Component& of, const char* member, ColorUse use, bool base) {
  if (const Ref<Component> map = part_of(of, member)) {
    Look made = look_of(*map, use);
    if (made.by_vertex && !base) exporting.inexact("colours of vertices are those of the base alone in glTF", &of, member);
    return made;
  }
  const Color c = color_of(of, member);
  return {c ? rgb_of(c, use) : std::array<double, 3>{1, 1, 1}};
}

Writer::Look Writer::look_of(const Component& map, ColorUse use) {
  const std::string& type = class_of(map);
  if (const Color c = constant_of(map)) return {rgb_of(c, use)};
  if (const auto placed = placed_of(map)) {
    Look made{{1, 1, 1}, texture(*placed, true)};
    if (!made.texture) made.factor = {0.5, 0.5, 0.5};
    return made;
  }
  if (type == "AttributeMap" && word_of(map, "name") == "color") {
    Look made;
    const Ref<Component> otherwise = part_of(map, "otherwise");
    made.by_vertex = otherwise ? look_of(*otherwise, use).factor : made.factor;
    return made;
  }
  if (type == "UvTransformMap") {
    const Ref<Component> inner = part_of(map, "map");
    if (inner && constant_of(*inner)) return look_of(*inner, use);
  }
  const bool rgb = type == "RgbProductMap" && numbers_of(map, "offset") == std::vector<double>{0, 0, 0};
  if (rgb || (type == "MultiplyMap" && !part_of(map, "third"))) {
    const Ref<Component> first = part_of(map, "first"), second = part_of(map, "second");
    if (first && second) {
      Look a = look_of(*first, use);
      const Look b = look_of(*second, use);
      const std::vector<double> more = rgb ? numbers_of(map, "factor") : std::vector<double>{1, 1, 1};
      if (!(a.texture && b.texture) && !(a.by_vertex && b.by_vertex)) {
        for (size_t i = 0; i < 3; ++i) a.factor[i] *= b.factor[i] * more[i];
        if (b.texture) a.texture = b.texture;
        if (b.by_vertex) a.by_vertex = b.by_vertex;
        return a;
      }
    }
  }
  exporting.inexact(fmt::format("a map like {} is a grey of 0.5", type), &map);
  return {{0.5, 0.5, 0.5}};
}

}  // namespace etendue::gltf_export
