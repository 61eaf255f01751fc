#pragma once
// Images that are written anew because another program has no words for what is done with them.

#include "etendue/exporter.h"

namespace etendue {

/// A product of an image and a colour (RgbProductMap) as an image of the products, written beside the exported file: an
/// ImageMap, or a UvTransformMap of one as in the product. Null: it is of something else.
Ref<Component> baked_product(Exporting&, const Component& product);

/// An ImageMap with its transfer function, channel and colour space undone: linear sRGB in a file of floats.
Ref<Component> baked_color(Exporting&, const Component& image);

/// An image of surroundings that says it is a cube (images/linear_image.h) in longitude and latitude, in a file of floats: its
/// name beside the exported file. Empty: it is none.
std::string baked_cube(Exporting&, const std::string& file, const std::string& transfer);
/// Whether an image says so.
bool says_it_is_a_cube(const std::string& file);

/// What another program makes of a colour where a number is asked for, as ImageMap's `as_number` names it.
enum class AsNumber : std::uint8_t { mean, luminance };

/// An ImageMap whose numbers the other program would take for others, as one of a grey image written beside the exported file:
/// where colours stand for numbers, a channel of the file is chosen, or the program does not decode it as is done here. Null:
/// it reads what is read here.
Ref<Component> baked_number(Exporting&, const Component& image, AsNumber there, bool decoded_there = true);

}  // namespace etendue
