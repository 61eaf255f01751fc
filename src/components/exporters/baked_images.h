#pragma once
// Images that are written anew because another program cannot express an operation on them.

#include "etendue/exporter.h"

namespace etendue {

struct LinearImage;

/// Whether an image is an ImageMap that is given by its numbers, which other programs do not have: it has to be written to a
/// file.
bool is_listed(const Component& image);
/// The linear texels of an ImageMap of one file, or of its numbers; a single channel is repeated three times. Throws Error.
LinearImage image_texels(const Component& image);

/// A product of an image and a colour (RgbProductMap) as an image of the products, written beside the exported file: an
/// ImageMap, or a UvTransformMap of one as in the product. Null: the product has other factors.
Ref<Component> baked_product(Exporting&, const Component& product);

/// An ImageMap converted to linear sRGB in a file of floats, with transfer function, channel and colour space applied.
Ref<Component> baked_color(Exporting&, const Component& image);

/// If an environment image is a cube map (images/linear_image.h), writes it in longitude and latitude to a file of floats and
/// returns its name beside the exported file. Empty: the image is no cube map.
std::string baked_cube(Exporting&, const std::string& file, const std::string& transfer);
/// Whether an image is a cube map by its own attribute.
bool says_it_is_a_cube(const std::string& file);

/// How another program converts a colour to a number, named as in ImageMap's `as_number`.
enum class AsNumber : std::uint8_t { mean, luminance };

/// An ImageMap that the other program would read as other numbers (because it converts colours to numbers in another way, a
/// channel is selected, or it does not decode the file as this program does) is written as a grey image beside the exported
/// file. Null: the other program reads the same numbers.
Ref<Component> baked_number(Exporting&, const Component& image, AsNumber there, bool decoded_there = true);

}  // namespace etendue
