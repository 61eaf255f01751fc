#pragma once
// NumPy arrays (.npy), as arrays and as images.

#include <cstdint>
#include <string_view>
#include <vector>

#include "etendue/core/image.h"

namespace etendue {

/// A view of an array in the bytes of a file; the last index varies fastest.
struct NumpyArray {
  std::vector<size_t> shape;
  std::string_view data;
  bool doubles = false;  ///< 8 bytes each; otherwise floats of 4 bytes

  size_t count() const { return data.size() / (doubles ? 8 : 4); }
  double operator[](size_t i) const;
  /// The most numbers of an array that is read.
  static constexpr size_t most_numbers = size_t(1) << 30;
};

/// Parses the header of an array and checks the amount of data; nothing is copied. Throws Error with the reason only.
NumpyArray parse_numpy_header(std::string_view bytes);

/// An image from the bytes of a file; channels X Y Z and "channel.3" … for three or more values per pixel, "Y" for one. Throws
/// Error with the reason only.
Image parse_numpy_array(std::string_view bytes);

}  // namespace etendue
