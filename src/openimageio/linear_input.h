#pragma once
// Image files as linear values, for OpenImageIO's cache and for this program.

#include <OpenImageIO/imageio.h>

#include <string>

namespace etendue {

struct LinearImage;

/// The attribute of images that were resampled from a cube map.
inline constexpr const char* made_of_cube = "etendue:cube";

/// An image reader for OpenImageIO's cache that returns decoded values. Files are opened by a key that contains the path, the
/// transfer function, the channel and the time of the file's last change.
OIIO::ImageInput* make_linear_input();
std::string linear_image_key(const std::string& path, const std::string& transfer, const std::string& channel = {});

// See images/linear_image.h; read errors state the reason without the path.
void check_file_channel(const std::string& path, const std::string& channel);
LinearImage read_linear_file(const std::string& path, const std::string& transfer, const std::string& channel);

}  // namespace etendue
