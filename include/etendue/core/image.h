#pragma once
// Image: pixels with named channels. The result of Film::develop; tone maps, outputs and comparisons work on it.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace etendue {

/// Rows from top to bottom, channels interleaved: values[(y * width + x) * channels.size() + c].
struct Image {
  int width = 0, height = 0;
  std::vector<std::string> channels;  ///< "X" "Y" "Z", "R" "G" "B", or "layer.name" as in OpenEXR
  std::vector<double> values;
  /// Metadata: "color_space", "file_hash", "seed", "samples", "version", …
  std::map<std::string, std::string> metadata;

  Image() = default;
  Image(int width_, int height_, std::vector<std::string> names)
      : width(width_),
        height(height_),
        channels(std::move(names)),
        values(size_t(width_) * size_t(height_) * channels.size()) {}
  double& at(int x, int y, size_t c) { return values[(size_t(y) * size_t(width) + size_t(x)) * channels.size() + c]; }
  double at(int x, int y, size_t c) const { return values[(size_t(y) * size_t(width) + size_t(x)) * channels.size() + c]; }
};

}  // namespace etendue
