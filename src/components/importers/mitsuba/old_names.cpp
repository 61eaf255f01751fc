// Names of Mitsuba 0.3 to 0.6 that changed later.

#include <cctype>
#include <utility>

#include "scene_reader.h"

namespace etendue::mitsuba {

std::string modern_name(const std::string& name) {
  std::string result;
  for (size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool after_small = i > 0 && (std::islower(static_cast<unsigned char>(name[i - 1])) != 0);
    if (std::isupper(c) && after_small) result += '_';
    result += char(std::tolower(c));
  }
  return result;
}

std::string modern_tag(const std::string& tag) {
  if (tag == "camera") return "sensor";
  if (tag == "luminaire") return "emitter";
  return tag;
}

std::string modern_type(const std::string& tag, const std::string& written) {
  std::string type = written;  // Mitsuba finds "Rectangle" too on file systems that ignore case
  for (char& c : type) c = char(std::tolower(static_cast<unsigned char>(c)));
  static constexpr std::pair<const char*, const char*> bsdfs[] = {
      {"lambertian", "diffuse"},        {"microfacet", "roughplastic"}, {"roughglass", "roughdielectric"},
      {"roughmetal", "roughconductor"}, {"composite", "mixturebsdf"},   {"bump", "bumpmap"},
      {"difftrans", "difftrans"},
  };
  static constexpr std::pair<const char*, const char*> textures[] = {{"ldrtexture", "bitmap"}, {"exrtexture", "bitmap"}};
  static constexpr std::pair<const char*, const char*> films[] = {{"exrfilm", "hdrfilm"}, {"pngfilm", "ldrfilm"}};
  const auto look_up = [&](const auto& table) {
    for (const auto& [old, modern] : table)
      if (type == old) return std::string(modern);
    return type;
  };
  if (tag == "bsdf") return look_up(bsdfs);
  if (tag == "texture") return look_up(textures);
  if (tag == "film") return look_up(films);
  return type;
}

}  // namespace etendue::mitsuba
