// The texture "imagemap".

#include <fmt/format.h>

#include <algorithm>

#include "etendue/film/image_tools.h"
#include "images/linear_image.h"
#include "reader.h"

namespace etendue::pbrt {

namespace {

/// Whether the image has an alpha channel that is not 1 everywhere.
bool transparent(Reader& reader, const FilePath& file) {
  try {
    const std::vector<std::string>& names = reader.importing.image_channels(file.resolved());
    for (const char* name : {"R", "G", "B", "A"})
      if (!std::ranges::count(names, name)) return false;
    const Image image = read_image(file.resolved());
    const size_t alpha = size_t(std::ranges::find(image.channels, "A") - image.channels.begin()), all = image.channels.size();
    if (alpha == all) return false;
    for (size_t i = alpha; i < image.values.size(); i += all)
      if (image.values[i] != 1) return true;
  } catch (const Error&) {  // reported by the map
  }
  return false;
}

void set_wrap(Reader& reader, Component& map, const Parameters& p) {
  const std::string wrap = p.text("wrap", "repeat");
  if (wrap == "black" || wrap == "clamp" || wrap == "repeat")
    set_member(map, "wrap", wrap, p.at);
  else
    reader.importing.inexact(fmt::format("wrap '{}' is not known: the image repeats", wrap), p.place("wrap"));
}

/// Whether v3 decodes the image's values from sRGB. Exporters for older versions wrote an exponent, which pbrt ignores.
bool decoded(Reader& reader, const Parameters& p) {
  const Parameter* gamma = p.find("gamma");
  if (!gamma || gamma->is("bool")) return p.boolean("gamma", true);
  reader.importing.inexact("a 'gamma' that is a number is not used, as in pbrt", gamma->at);
  return true;
}

void set_encoding(Reader& reader, Component& map, const Parameters& p) {
  const std::string encoding = p.text("encoding", "");
  if (encoding == "linear" || !decoded(reader, p))
    set_member(map, "transfer", "linear", p.at);
  else if (encoding == "gamma 2.2")
    set_member(map, "transfer", "gamma2.2", p.at);
  else if (!encoding.empty() && encoding != "sRGB")
    reader.importing.inexact(fmt::format("the encoding '{}' is taken for sRGB", encoding), p.place("encoding"));
}

/// A formula of the red, green and blue channels; the result is a grey value, for number and colour textures alike.
Ref<Component> of_channels(Reader& reader, const Component& map, const Parameters& p, const std::string& text, bool decoded) {
  std::vector<std::pair<std::string, Value>> parts;
  for (const auto& [name, channel] : {std::pair("r", "R"), std::pair("g", "G"), std::pair("b", "B")}) {
    const Ref<Component> part = copy(map);
    set_member(*part, "channel", channel, p.at);
    if (!decoded) set_member(*part, "transfer", "linear", p.at);
    parts.emplace_back(name, Value(part, p.at));
  }
  return formula(reader, p.at, text, parts);
}

/// v3 converts a colour to a number before decoding: the luminance y of the values stored in the file.
Ref<Component> luminance(Reader& reader, const Component& map, const Parameters& p, const std::string& path) {
  const std::string y = "(0.212671 * r + 0.71516 * g + 0.072169 * b)";
  if (!decoded(reader, p) || !(path.ends_with(".png") || path.ends_with(".tga"))) return of_channels(reader, map, p, y, false);
  return of_channels(reader, map, p, fmt::format("mix({0} / 12.92, pow(({0} + 0.055) / 1.055, 2.4), step(0.04045, {0}))", y),
                     false);
}

}  // namespace

bool colored(const FilePath& file) {
  try {
    const LinearImage image = read_linear_image(file.resolved(), automatic_transfer);
    for (size_t i = 0; i + 2 < image.rgb.size(); i += 3)
      if (image.rgb[i] != image.rgb[i + 1] || image.rgb[i] != image.rgb[i + 2]) return true;
  } catch (const Error&) {
  }
  return false;
}

// Read as a number, an image of v4 is its alpha if that is not 1 everywhere, else the mean of its colours; an image of v3 is
// its luminance.
Ref<Component> image_texture(Reader& reader, const Parameters& p, bool spectrum) {
  const Location at = p.at;
  const auto file = image_file(reader, p, "filename");
  if (!file) {
    reader.importing.inexact("grey, 0.5, stands for the image that is missing", p.place("filename"));
    const Ref<Component> grey = reader.make("ConstantMap", at);
    set_member(*grey, "value", 0.5, at);
    return grey;
  }
  const Ref<Component> map = reader.make("ImageMap", at);
  set_member(*map, "file", *file, p.place("filename"));
  const std::string filter = p.text("filter", reader.version == 4 ? "bilinear" : "trilinear");
  if (filter == "point") set_member(*map, "interpolation", "nearest", at);
  p.ignore({"maxanisotropy", "trilinear", "noiseaware"});  // filtering within a pixel
  set_wrap(reader, *map, p);
  set_encoding(reader, *map, p);
  const double scale = p.number("scale", 1);
  const bool inverted = p.boolean("invert", false);
  if (spectrum) {
    if (scale == 1 && !inverted) return map;
    // Applied to red, green and blue before they become a spectrum.
    const Ref<Component> product = reader.make("RgbProductMap", at);
    const double factor = inverted ? -scale : scale, offset = inverted ? 1 : 0;
    set_member(*product, "first", map, at);
    set_member(*product, "factor", Numbers{{factor, factor, factor}, 1, Dimension::none}, at);
    if (inverted) set_member(*product, "offset", Numbers{{offset, offset, offset}, 1, Dimension::none}, at);
    return product;
  }
  Ref<Component> result = map;
  // v4's filters that read single texels use the first channel.
  const bool texels = filter == "point" || filter == "ewa" || filter == "EWA";
  if (reader.version == 4 && !texels && transparent(reader, *file))
    set_member(*map, "channel", "A", at);
  else if (const bool several = colored(*file); several && reader.version == 3)
    result = luminance(reader, *map, p, file->resolved());
  else if (several && texels)
    set_member(*map, "channel", "R", at);
  else if (several)
    result = of_channels(reader, *map, p, "(r + g + b) / 3", true);
  if (scale != 1) result = formula(reader, at, fmt::format("{} * image", scale), {{"image", Value(result)}});
  if (inverted) result = formula(reader, at, "max(0, 1 - image)", {{"image", Value(result)}});
  return result;
}

}  // namespace etendue::pbrt
