#pragma once
// Images that are written anew because another program has no words for what is done with them.

#include "etendue/exporter.h"

namespace etendue {

/// A product of an image and a colour (RgbProductMap) as an image of the products, written beside the exported file: an
/// ImageMap, or a UvTransformMap of one as in the product. Null: it is of something else.
Ref<Component> baked_product(Exporting&, const Component& product);

}  // namespace etendue
