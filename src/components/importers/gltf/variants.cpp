#include "variants.h"

#include <algorithm>

namespace etendue::gltf {
namespace {

constexpr const char* name_of_extension = "KHR_materials_variants";

}  // namespace

std::optional<size_t> chosen_variant(Importing& importing, const Document& document) {
  const Json& variants = list_in(extension(document.json(), name_of_extension), "variants");
  const auto said = importing.parameter("variant");
  if (variants.empty()) {
    if (said) throw Error("it has no variants of materials (KHR_materials_variants)", importing.at());
    return std::nullopt;
  }
  if (!said) {
    importing.inexact(fmt::format("none of its {} variants of materials is chosen; -D variant=NAME does", variants.size()),
                      importing.at());
    return std::nullopt;
  }
  std::vector<std::string> names;
  for (size_t i = 0; i < variants.size(); ++i) {
    names.push_back(text(variants[i], "name"));
    if (names.back() == *said || std::to_string(i) == *said) return i;
  }
  throw Error(fmt::format("there is no variant '{}'{}", *said, suggestion(*said, names)), importing.at());
}

std::optional<size_t> material_of(const Json& primitive, std::optional<size_t> variant) {
  if (variant)
    for (const Json& mapping : list_in(extension(primitive, name_of_extension), "mappings"))
      for (const Json& one : list_in(mapping, "variants"))
        if (one == Json(*variant)) return needed_whole(mapping, "material");
  return whole(primitive, "material");
}

}  // namespace etendue::gltf
