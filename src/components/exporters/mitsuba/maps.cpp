// Writes colours and textures.

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "components/exporters/asked_members.h"
#include "components/exporters/baked_images.h"
#include "images/linear_image.h"
#include "writer.h"

namespace etendue::mitsuba_export {

namespace {

const Transform turn_over(Transform::DoubleMatrix{1, 0, 0, 0, 0, -1, 0, 1, 0, 0, 1, 0});

std::string ending_of(const std::string& file) {
  std::string ending = std::filesystem::path(file).extension().string();
  std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return ending;
}

/// Whether Mitsuba decodes an ImageMap's file as this program does: it decodes integers from sRGB, and treats floats and `raw`
/// as linear.
bool decoded_alike(const Component& image, Texels texels) {
  const std::string transfer = word_of(image, "transfer"), ending = ending_of(word_of(image, "file"));
  const bool floats = ending == ".exr" || ending == ".hdr" || ending == ".pfm",
             integers = ending == ".png" || ending == ".jpg" || ending == ".jpeg" || ending == ".bmp" || ending == ".tga";
  // Its spectral variants accept only raw images of colours for numbers, and no raw images for colours.
  if (texels == Texels::normals || (texels == Texels::numbers && image_channels(word_of(image, "file")).size() >= 3))
    return transfer == "linear" || (transfer == "auto" && floats);
  return transfer == "auto" || (transfer == "linear" && (floats || texels == Texels::numbers)) ||
         (transfer == "srgb" && integers);
}

}  // namespace

void Writer::map(Node parent, const char* name, const Component& of, const char* member, ColorUse use, Uv uv) {
  const Ref<Component> m = part_of(of, member);
  if (!m) return;
  if (class_of(*m) == "ConstantMap")
    spectrum(parent, name, color_of(*m, "value"), use);
  else
    texture(parent, name, *m, use, {}, uv);
}

void Writer::texture(Node parent, const char* name, const Component& m, ColorUse use, const Transform& coordinates, Uv uv) {
  const std::string& type = class_of(m);
  const Transform own = uv == Uv::from_top ? coordinates * turn_over : coordinates;
  const auto node = [&](const char* plugin) {
    Node n = parent.append_child("texture");
    n.append_attribute("name") = name;
    n.append_attribute("type") = plugin;
    return n;
  };
  if (type == "RgbProductMap") {
    Ref<Component>& made = baked_[{&m, Texels::colors}];
    if (!made) made = baked_product(exporting, m);
    if (made) {
      const Ref<Component> image = class_of(*made) == "ImageMap" ? made : part_of(*made, "map");
      readable_.insert(image.get());
      if (read_as_ == Texels::numbers)
        exporting.inexact("of a product of colours that stands for a number Mitsuba takes the luminance, not the mean", &m);
      return texture(parent, name, *made, use, coordinates, uv);
    }
  }
  if (type == "ImageMap")
    if (const Ref<Component> made = readable(m)) return texture(parent, name, *made, use, coordinates, uv);
  if (type == "UvTransformMap") {
    const std::vector<double> scale = numbers_of(m, "scale"), shift = numbers_of(m, "shift");
    const Transform step = Transform::translate({shift[0], shift[1], 0}) *
                           Transform::rotate(number_of(m, "angle") * std::numbers::pi / 180, {0, 0, 1}) *
                           Transform::scale({scale[0], scale[1], 1});
    const Ref<Component> inner = part_of(m, "map");
    if (class_of(*inner) == "ConstantMap")
      spectrum(parent, name, color_of(*inner, "value"), use);
    else
      texture(parent, name, *inner, use, step * coordinates, uv);
  } else if (type == "ReadAsMap" && use == ColorUse::radiance && word_of(m, "as") == "coefficient") {
    texture(parent, name, *part_of(m, "map"), ColorUse::coefficient, coordinates, uv);
  } else if (type == "ImageMap") {
    if (use == ColorUse::radiance) exporting.inexact("a picture as light has no white D65 in Mitsuba", &m);
    Node n = node("bitmap");
    text(n, "filename", exporting.copy_beside(word_of(m, "file")));
    if (word_of(m, "interpolation") == "nearest") text(n, "filter_type", "nearest");
    const std::string wrap = word_of(m, "wrap");
    if (wrap == "black") exporting.inexact("a picture that is black outside is repeated in Mitsuba", &m);
    if (wrap == "mirror" || wrap == "clamp") text(n, "wrap_mode", wrap);
    if (const std::string above = word_of(m, "wrap_v"); above != "same" && above != wrap)
      exporting.inexact("a picture is continued along v as it is along u in Mitsuba", &m);
    if (read_as_ != Texels::colors && decoded_alike(m, Texels::normals)) truth(n, "raw", true);
    if (read_as_ != Texels::numbers) AskedMembers::note(m, "as_number");  // nothing else depends on it
    const std::vector<double> repeat = numbers_of(m, "repeat");
    transform(n, "to_uv", turn_over * Transform::scale({repeat[0], repeat[1], 1}) * own);
  } else if (type == "CheckerMap" && word_of(m, "space") == "uv") {
    const bool exchanged = read_as_ == Texels::numbers;
    Node n = node("checkerboard");  // Mitsuba exchanges the two values of a checkerboard of numbers
    map(n, exchanged ? "color1" : "color0", m, "first", use, uv);
    map(n, exchanged ? "color0" : "color1", m, "second", use, uv);
    const std::vector<double> repeat = numbers_of(m, "repeat");
    transform(n, "to_uv", Transform::scale({repeat[0] / 2, repeat[1] / 2, 1}) * own);
  } else if (type == "AttributeMap") {
    Node n = node("mesh_attribute");
    const std::string attribute = word_of(m, "name");
    text(n, "name", attribute.starts_with("face_") ? attribute : "vertex_" + attribute);
  } else {
    exporting.inexact(fmt::format("Mitsuba has no texture like {}: 0.5 stands for it", type), &m);
    value(parent, "spectrum", name, "0.5");
  }
}

double Writer::scalar(const Component& of, const char* member) {
  const Ref<Component> m = part_of(of, member);
  if (!m) return number_of(of, member);
  if (class_of(*m) == "ConstantMap") return double(color_of(*m, "value")->at(550, ColorUse::coefficient));
  exporting.inexact(fmt::format("'{}' of {} is one number in Mitsuba: 0.5 stands for the map", member, class_of(of)), &of);
  return 0.5;
}

void Writer::scalar_map(Node parent, const char* name, const Component& of, const char* member, Uv uv) {
  const Ref<Component> m = part_of(of, member);
  if (m && class_of(*m) != "ConstantMap") {
    read_as_ = Texels::numbers;
    texture(parent, name, *m, ColorUse::reflectance, {}, uv);
    read_as_ = Texels::colors;
  } else {
    number(parent, name, scalar(of, member));
  }
}

void Writer::normals(Node parent, const char* name, const Component& image, Uv uv) {
  read_as_ = Texels::normals;
  texture(parent, name, image, ColorUse::coefficient, {}, uv);
  read_as_ = Texels::colors;
}

Ref<Component> Writer::readable(const Component& image) {
  if (readable_.contains(&image) || word_of(image, "file").find("<UDIM>") != std::string::npos) return nullptr;
  Ref<Component>& made = baked_[{&image, read_as_}];
  if (made) return made;
  const bool listed = is_listed(image), decoded = !listed && decoded_alike(image, read_as_);
  const bool kept = read_as_ == Texels::normals || word_of(image, "color_space") == "srgb";
  if (read_as_ == Texels::numbers)
    made = baked_number(exporting, image, AsNumber::luminance, decoded);
  else if (listed || !decoded || !kept || !word_of(image, "channel").empty() || says_it_is_a_cube(word_of(image, "file")))
    made = baked_color(exporting, image);
  if (made) readable_.insert(made.get());
  return made;
}

}  // namespace etendue::mitsuba_export
