#pragma once
// NumPy arrays (.npy) as pictures.

#include <string>
#include <string_view>

#include "etendue/image.h"

namespace etendue {

/// From the bytes of a file; channels X Y Z and "channel.3" … for three values a pixel or more, "Y" for one. Throws Error
/// with the reason alone.
Image parse_numpy_array(std::string_view bytes);

}  // namespace etendue
