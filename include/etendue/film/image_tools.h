#pragma once
// Reading, writing, describing and comparing pictures.

#include <string>
#include <vector>

#include "etendue/core/image.h"
#include "etendue/film/image_buffer.h"

namespace etendue {

/// Reads any format the image library knows, and NumPy arrays of floats or doubles of shape (height, width[, channels]).
/// Values come back linear: whole-number formats that say nothing else are decoded from sRGB. "color_space" is what the
/// file says, else "xyz" for arrays and "srgb". Throws Error naming the file and the reason.
Image read_image(const std::string& path);

/// Writes with the Output of the path's ending, as it is by default. Pictures for display are encoded as sRGB first when
/// they are not yet encoded. Throws Error, for an unknown ending naming the known ones.
void write_any(const Image&, const std::string& path);

/// Size, metadata and the range of each channel of a picture in a file, in lines of text.
std::string describe_image(const std::string& path);
/// The same of a picture in memory.
std::string describe_image(const Image&);

/// A picture in linear values of an RGB space, or X Y Z for "xyz", whatever it was in: by its metadata "color_space" and
/// "transfer" (without the latter it is linear), and without them by its channels' names. Further channels are kept.
/// Colours are not adapted from one white to another.
Image convert_color_space(const Image&, const std::string& color_space);

/// How a channel of one picture differs from that of another.
struct ChannelComparison {
  std::string name;
  double mean_a = 0, mean_b = 0;
  double ratio = 1;  ///< of the means, a over b; 1 when both are zero
  double root_mean_square_error = 0, maximum_difference = 0;
};

/// How a picture differs from a reference b, over the n values of all pixels and colour channels that are finite in both.
struct Comparison {
  double root_mean_square_error = 0;  ///< sqrt(sum (a - b)^2 / n)
  /// sum((a - b)^2 / (b^2 + e)) / n with e = 1e-2 mean(b)^2, which keeps black places from deciding alone
  double relative_mean_square_error = 0;
  /// Symmetric mean absolute percentage error as a fraction: sum(2 |a - b| / (|a| + |b|)) / n, from 0 to 2
  double symmetric_error = 0;
  double maximum_difference = 0;     ///< largest |a - b|
  int maximum_x = 0, maximum_y = 0;  ///< where
  std::string maximum_channel;
  size_t not_finite = 0;  ///< values left out; the errors are not numbers when nothing was left
  std::vector<ChannelComparison> channels;
};

/// Compares the colours of two pictures after converting both to a space. Throws Error when their sizes differ.
Comparison compare(const Image& a, const Image& b, const std::string& color_space = "xyz");

/// Mean luminances of the same tile in two pictures.
struct TileRatio {
  PixelArea area;
  double mean_a = 0, mean_b = 0;
  double ratio = 1;  ///< a over b; 1 when both are zero
};

/// For tiles of size x size pixels (smaller at the right and lower edge), row by row. Throws Error when sizes differ.
std::vector<TileRatio> tile_ratios(const Image& a, const Image& b, int size);

}  // namespace etendue
