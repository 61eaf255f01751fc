#pragma once
// Which materials a mesh has, of those that a file gives it to choose from (KHR_materials_variants).

#include "document.h"

namespace etendue::gltf {

/// What `-D variant=` chooses, by name or number; none: the materials of the primitives themselves, with a note that there are
/// others.
std::optional<size_t> chosen_variant(Importing&, const Document&);

/// The material of a primitive in a variant.
std::optional<size_t> material_of(const Json& primitive, std::optional<size_t> variant);

}  // namespace etendue::gltf
