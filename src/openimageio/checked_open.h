#pragma once

#include <OpenImageIO/imageio.h>

#include <memory>
#include <string>

namespace etendue {

/// Opens an image when it is a file and may hold what it claims; the library itself takes memory for whatever a header says.
/// Throws Error with the reason alone.
std::unique_ptr<OIIO::ImageInput> open_checked(const std::string& path);

}  // namespace etendue
