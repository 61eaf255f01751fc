#pragma once
// Image files as linear numbers: what encodes them is undone before anything filters them.

#include <memory>
#include <string>
#include <vector>

namespace etendue {

/// The transfer function a file's numbers are in, when `transfer` is "auto": "srgb" for integers, "linear" for floats.
inline constexpr const char* automatic_transfer = "auto";
/// "auto" and all transfer functions there are: what may be said of an image.
std::vector<std::string> image_transfer_names();

/// Throws Error for a file that has no such channel, saying which it has. "": all; else the name of a channel ("A", "depth.Z")
/// or of a layer ("diffuse" for diffuse.R, diffuse.G and diffuse.B). A file that cannot be read at all passes.
void check_channel(const std::string& path, const std::string& channel);

/// The names of a file's channels: R, G, B, A ... Throws Error naming the file and the reason, as far as its head tells.
std::vector<std::string> image_channels(const std::string& path);

/// Pixels from top to bottom, three channels interleaved; a grey image has three equal ones, and alpha is left out.
///
/// All that is read here, and textures too: an OpenEXR file that says it is one of surroundings on the faces of a cube (its
/// attribute `envmap`) is given in longitude and latitude, with the middle towards +z and the middle of its left half towards
/// +x.
struct LinearImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
  bool from_cube = false;
};
/// Of the channel or layer of that name, see check_channel. Throws Error naming the file and the reason.
LinearImage read_linear_image(const std::string& path, const std::string& transfer, const std::string& channel = {});

class ImageTexture;
/// For ImageTexture::open, which says what it does.
std::shared_ptr<const ImageTexture> read_texture(const std::string& path, const std::string& transfer,
                                                 const std::string& channel);

}  // namespace etendue
