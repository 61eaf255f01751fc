#pragma once
// Selection among the material variants of a file (KHR_materials_variants).

#include "document.h"

namespace etendue::gltf {

/// The variant that `-D variant=` selects, by name or number. Nothing: the primitives' own materials, with a warning if the
/// file has variants.
std::optional<size_t> chosen_variant(Importing&, const Document&);

/// The material of a primitive in a variant.
std::optional<size_t> material_of(const Json& primitive, std::optional<size_t> variant);

}  // namespace etendue::gltf
