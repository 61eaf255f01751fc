#pragma once
// Image files as linear numbers, for OpenImageIO's cache and for us.

#include <OpenImageIO/imageio.h>

#include <string>

namespace etendue {

struct LinearImage;

/// The attribute of what is made of a cube of surroundings.
inline constexpr const char* made_of_cube = "etendue:cube";

/// An image reader for OpenImageIO's caches, which gives a file's numbers decoded. It opens files by a key that tells the
/// path, the transfer function, the channel and when the file was last changed.
OIIO::ImageInput* make_linear_input();
std::string linear_image_key(const std::string& path, const std::string& transfer, const std::string& channel = {});

// See images/linear_image.h; errors in reading tell the reason alone.
void check_file_channel(const std::string& path, const std::string& channel);
LinearImage read_linear_file(const std::string& path, const std::string& transfer, const std::string& channel);

}  // namespace etendue
