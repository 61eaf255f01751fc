#pragma once
// Functions that read, write, describe and compare images.

#include <string>
#include <vector>

#include "etendue/core/image.h"
#include "etendue/film/image_buffer.h"

namespace etendue {

/// Reads any format of the image library, and NumPy arrays of floats or doubles of shape (height, width[, channels]). The
/// values are linear: integer formats without a stated encoding are decoded from sRGB. The metadata "color_space" is that of
/// the file, else "xyz" for arrays and "srgb" for other files. Throws Error with the file and the reason.
Image read_image(const std::string& path);

/// Writes with the Output for the path's extension, with default members. For display formats the image is encoded as sRGB
/// first if it is not encoded yet. Throws Error; for an unknown extension with a list of the known ones.
void write_any(const Image&, const std::string& path);

/// Size, metadata and the range of each channel of an image file, in lines of text.
std::string describe_image(const std::string& path);
/// The same for an image in memory.
std::string describe_image(const Image&);

/// Converts an image to linear values of an RGB space, or to X Y Z for "xyz". The source space is given by the metadata
/// "color_space" and "transfer" (without "transfer" it is linear), or without these by the channels' names. Further channels
/// are kept. There is no chromatic adaptation between different whites.
Image convert_color_space(const Image&, const std::string& color_space);

/// The difference of a channel between two images.
struct ChannelComparison {
  std::string name;
  double mean_a = 0, mean_b = 0;
  double ratio = 1;  ///< of the means, a over b; 1 when both are zero
  double root_mean_square_error = 0, maximum_difference = 0;
};

/// The difference of an image a from a reference b, over the n values of all pixels and colour channels that are finite in
/// both.
struct Comparison {
  double root_mean_square_error = 0;  ///< sqrt(sum (a - b)^2 / n)
  /// sum((a - b)^2 / (b^2 + e)) / n with e = 1e-2 mean(b)^2, so that dark pixels do not dominate
  double relative_mean_square_error = 0;
  /// Symmetric mean absolute percentage error as a fraction: sum(2 |a - b| / (|a| + |b|)) / n, from 0 to 2
  double symmetric_error = 0;
  double maximum_difference = 0;     ///< largest |a - b|
  int maximum_x = 0, maximum_y = 0;  ///< pixel of the largest difference
  std::string maximum_channel;
  size_t not_finite = 0;  ///< number of omitted values; the errors are NaN if no values remain
  std::vector<ChannelComparison> channels;
};

/// Compares the colours of two images after converting both to a colour space. Throws Error if their sizes differ.
Comparison compare(const Image& a, const Image& b, const std::string& color_space = "xyz");

/// Mean luminances of the same tile in two images.
struct TileRatio {
  PixelArea area;
  double mean_a = 0, mean_b = 0;
  double ratio = 1;  ///< a over b; 1 when both are zero
};

/// The ratios of all tiles of size x size pixels (smaller at the right and lower edge), row by row. Throws Error if the images'
/// sizes differ.
std::vector<TileRatio> tile_ratios(const Image& a, const Image& b, int size);

}  // namespace etendue
