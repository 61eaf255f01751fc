// Writes maps as textures.

#include "components/exporters/asked_members.h"
#include "components/exporters/baked_images.h"
#include "writer.h"

namespace etendue::pbrt_export {

std::string Writer::value_or_texture(const char* name, const Ref<Component>& map, bool numbers, ColorUse use) {
  if (const Color c = constant_of(*map)) {
    if (!numbers) return spectrum(name, c, use);
    return fmt::format(" \"float {}\" {}", name, c->at(550, ColorUse::coefficient));
  }
  return fmt::format(" \"texture {}\" \"{}\"", name, texture(*map, numbers));
}

std::string Writer::color_map(const char* name, const Component& of, const char* member, ColorUse use) {
  const Ref<Component> map = part_of(of, member);
  return map ? value_or_texture(name, map, false, use) : std::string();
}

std::string Writer::number_map(const char* name, const Component& of, const char* member) {
  const Ref<Component> map = part_of(of, member);
  return map ? value_or_texture(name, map, true, ColorUse::coefficient) : std::string();
}

const Component& Writer::with_file(const Component& image, bool numbers) {
  if (!is_listed(image)) return image;
  Ref<Component>& made = listed_[{&image, numbers}];
  if (!made) made = numbers ? baked_number(exporting, image, AsNumber::mean) : baked_color(exporting, image);
  return *made;
}

std::string Writer::image(const Component& written, const std::string& more, bool numbers) {
  const Component& map = with_file(written, numbers);
  const std::string wrap = word_of(map, "wrap"), transfer = word_of(map, "transfer"),
                    file = exporting.copy_beside(word_of(map, "file"));
  std::string text = fmt::format(" \"imagemap\" \"string filename\" \"{}\"", file);
  if (wrap == "mirror")
    exporting.inexact("an image that is mirrored beyond its edges is repeated", &map);
  else
    text += fmt::format(" \"string wrap\" \"{}\"", wrap);
  if (const std::string above = word_of(map, "wrap_v"); above != "same" && above != wrap)
    exporting.inexact("an image is continued along v as it is along u", &map);
  if (word_of(map, "interpolation") == "nearest") text += " \"string filter\" \"point\"";
  if (transfer == "linear") text += " \"string encoding\" \"linear\"";
  if (transfer == "gamma2.2") text += " \"string encoding\" \"gamma 2.2\"";
  if (!word_of(map, "channel").empty()) exporting.inexact("the choice of an image's channels is left out", &map);
  if (word_of(map, "color_space") != "srgb") exporting.inexact("the colour space of an image is what its file says", &map);
  const std::vector<double> repeat = numbers_of(map, "repeat");
  if (more.empty() && repeat.size() == 2 && (repeat[0] != 1 || repeat[1] != 1))
    text += fmt::format(" \"float uscale\" {} \"float vscale\" {}", repeat[0], repeat[1]);
  if (!numbers) AskedMembers::note(map, "as_number");  // no colour depends on it
  return text + more;
}

std::string Writer::texture(const Component& map, bool numbers) {
  if (class_of(map) == "RgbProductMap") {
    Ref<Component>& made = baked_[&map];
    if (!made) made = baked_product(exporting, map);
    if (made) return texture(*made, numbers);
  }
  if (class_of(map) == "ImageMap" && numbers) {
    Ref<Component>& made = baked_[&map];
    if (!made) made = baked_number(exporting, map, AsNumber::mean);
    if (made) return texture(*made, true);
  }
  const std::string key = numbers ? "float" : "spectrum";
  // If a map is used both as numbers and as colours, two textures are written.
  std::string& known = textures_[&map];
  const std::string name = exporting.name_for(map) + (numbers ? "_number" : "");
  if (known.find("|" + name + "|") != known.npos) return name;
  known += "|" + name + "|";
  const std::string type = map.class_info().name;
  const auto inner = [&](const char* to, const char* member) {
    return numbers ? number_map(to, map, member) : color_map(to, map, member);
  };
  std::string text;
  if (type == "ImageMap") {
    text = image(map, "", numbers);
  } else if (type == "UvTransformMap" && number_of(map, "angle") == 0 && part_of(map, "map") &&
             (part_of(map, "map")->class_info().name == "ImageMap" || part_of(map, "map")->class_info().name == "CheckerMap")) {
    const Ref<Component> changed = part_of(map, "map");
    const bool is_image = changed->class_info().name == "ImageMap";
    const std::vector<double> repeat = numbers_of(*changed, "repeat"), scale = numbers_of(map, "scale"),
                              shift = numbers_of(map, "shift");
    const std::string where =
        fmt::format(" \"float uscale\" {} \"float vscale\" {} \"float udelta\" {} \"float vdelta\" {}", repeat[0] * scale[0],
                    repeat[1] * scale[1], repeat[0] * shift[0], repeat[1] * shift[1]);
    if (is_image) {
      text = image(*changed, where, numbers);
    } else {
      const auto of = [&](const char* to, const char* member) {
        return numbers ? number_map(to, *changed, member) : color_map(to, *changed, member);
      };
      text = " \"checkerboard\"" + of("tex1", "first") + of("tex2", "second") + where;
    }
  } else if (type == "CheckerMap" && word_of(map, "space") == "uv") {
    const std::vector<double> repeat = numbers_of(map, "repeat");
    text = " \"checkerboard\"" + inner("tex1", "first") + inner("tex2", "second") +
           fmt::format(" \"float uscale\" {} \"float vscale\" {}", repeat[0], repeat[1]);
  } else if (type == "MixMap") {
    text = " \"mix\"" + inner("tex1", "first") + inner("tex2", "second") + number_map("amount", map, "amount");
  } else if (type == "MultiplyMap" && !part_of(map, "third") && part_of(map, "second") &&
             constant_of(*part_of(map, "second")) && !constant_of(*part_of(map, "second"))->varies()) {
    text = " \"scale\"" + inner("tex", "first") + number_map("scale", map, "second");
  } else if (const Color c = constant_of(map)) {
    text = " \"constant\"" + (numbers ? fmt::format(" \"float value\" {}", c->at(550, ColorUse::coefficient))
                                      : spectrum("value", c, ColorUse::reflectance));
  } else {
    exporting.inexact(fmt::format("pbrt has no texture like {}: it is 0.5 everywhere", type), &map);
    text = numbers ? " \"constant\" \"float value\" 0.5" : " \"constant\" \"rgb value\" [ 0.5 0.5 0.5 ]";
  }
  out_ += fmt::format("Texture \"{}\" \"{}\"{}\n", name, key, text);
  return name;
}

}  // namespace etendue::pbrt_export
