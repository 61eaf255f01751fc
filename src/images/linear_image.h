#pragma once
// Image files as linear values: transfer functions are decoded before any filtering.

#include <memory>
#include <string>
#include <vector>

namespace etendue {

/// The transfer function of a file when `transfer` is "auto": "srgb" for integers, "linear" for floats.
inline constexpr const char* automatic_transfer = "auto";
/// "auto" and the names of all transfer functions, as options of an image.
std::vector<std::string> image_transfer_names();

/// Throws Error, with the existing names, for a file without the channel. "": all channels; otherwise the name of a channel
/// ("A", "depth.Z") or of a layer ("diffuse" for diffuse.R, diffuse.G and diffuse.B). No error for a file that cannot be read
/// at all.
void check_channel(const std::string& path, const std::string& channel);

/// The names of a file's channels: R, G, B, A ... Only the header is read. Throws Error with the file's name and the reason.
std::vector<std::string> image_channels(const std::string& path);

/// Pixels from top to bottom, three channels interleaved; a grey image has three equal ones, and alpha is left out.
///
/// For all images and textures: an OpenEXR file whose attribute `envmap` says that it is a cube map is converted to longitude
/// and latitude, with the centre towards +z and the centre of its left half towards +x.
struct LinearImage {
  int width = 0, height = 0;
  std::vector<float> rgb;
  bool from_cube = false;
};
/// Reads the channel or layer of that name, see check_channel. Throws Error with the file's name and the reason.
LinearImage read_linear_image(const std::string& path, const std::string& transfer, const std::string& channel = {});

class ImageTexture;
struct ListedImage;
/// Implements ImageTexture::open, see there.
std::shared_ptr<const ImageTexture> read_texture(const std::string& path, const std::string& transfer,
                                                 const std::string& channel);
/// Implements ImageTexture::of, see there.
std::shared_ptr<const ImageTexture> texture_of(ListedImage);

}  // namespace etendue
