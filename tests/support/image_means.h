#pragma once
// Means of images.

#include <map>
#include <string>

#include "etendue/core/image.h"

namespace etendue::test {

/// Means over the pixels of each channel, by its name.
inline std::map<std::string, double> means(const Image& image) {
  std::map<std::string, double> means;
  for (size_t c = 0; c < image.channels.size(); ++c) {
    double& sum = means[image.channels[c]];
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) sum += image.at(x, y, c) / (double(image.width) * image.height);
  }
  return means;
}

}  // namespace etendue::test
