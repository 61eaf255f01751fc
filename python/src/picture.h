#pragma once
// Picture: an Image that Python's arrays view. It does not change.

#include <memory>

#include "binding.h"
#include "etendue/core/image.h"

namespace etendue::python {

struct Picture {
  explicit Picture(Image made) : image(std::make_shared<const Image>(std::move(made))) {}
  std::shared_ptr<const Image> image;
};

/// The pixels, shape (height, width, channels): a read-only array of the picture's own memory.
nb::object pixels_of(const Picture&);

}  // namespace etendue::python
