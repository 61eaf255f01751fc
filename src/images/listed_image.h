#pragma once
// Images that a component gives by its numbers instead of a file.

#include <cstdint>
#include <string>
#include <vector>

namespace etendue {

class Component;

/// The type of the numbers: floats as they are, or integers that stand for fractions of the largest integer.
enum class ListedNumbers : std::uint8_t { single, uint8, uint16 };

/// Linear values in rows from the top, one or three channels interleaved.
struct ListedImage {
  int width = 0, height = 0, channels = 1;
  std::vector<float> texels;
};

/// Decodes the values of an image, 1 to 4 for each pixel: grey, grey and alpha, RGB, RGB and alpha. `transfer` and `channel`
/// are as those of image files (linear_image.h); the channels' names are Y, A and R, G, B, A. Fails by the component's members
/// `resolution` (width and height), `values`, `number_type` and `channel`.
ListedImage listed_image(const Component& of, const std::vector<int>& resolution, const std::vector<float>& values,
                         ListedNumbers, const std::string& transfer, const std::string& channel);

}  // namespace etendue
