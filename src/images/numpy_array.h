#pragma once
// NumPy arrays (.npy): as they are, and as pictures.

#include <cstdint>
#include <string_view>
#include <vector>

#include "etendue/core/image.h"

namespace etendue {

/// An array in the bytes of a file, the last index running fastest.
struct NumpyArray {
  std::vector<size_t> shape;
  std::string_view data;
  bool doubles = false;  ///< of 8 bytes each; else of 4

  size_t count() const { return data.size() / (doubles ? 8 : 4); }
  double operator[](size_t i) const;
  /// No array that is read has more numbers.
  static constexpr size_t most_numbers = size_t(1) << 30;
};

/// Reads what a file says of its array, and whether it holds as much; nothing is copied. Throws Error with the reason alone.
NumpyArray parse_numpy_header(std::string_view bytes);

/// From the bytes of a file; channels X Y Z and "channel.3" … for three values a pixel or more, "Y" for one. Throws Error
/// with the reason alone.
Image parse_numpy_array(std::string_view bytes);

}  // namespace etendue
