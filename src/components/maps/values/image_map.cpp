// ImageMap: an image on a surface, from a file or a list of numbers.

#include "components/maps/footprint.h"
#include "components/maps/image_texture.h"
#include "components/maps/rgb_source.h"
#include "etendue/describe/color.h"
#include "etendue/describe/read_ahead.h"
#include "etendue/object_map.h"
#include "images/linear_image.h"
#include "images/listed_image.h"
#include "images/udim_files.h"

namespace etendue {
namespace {

enum class Interpolation : std::uint8_t { nearest, bilinear };
enum class WrapV : std::uint8_t { same, repeat, mirror, clamp, black };  // the values of Wrap, after `same`
enum class AsNumber : std::uint8_t { mean, luminance };

// The image's numbers are decoded to linear ones before they are interpolated or averaged. With a footprint the result is the
// mean over the ellipse in which a pixel sees the surface. With `interpolation: nearest`, texels that are larger than the
// ellipse are returned unfiltered.
//
// The interpolated RGB is converted to a spectrum at each lookup. This differs from interpolating the texels' spectra, as the
// conversion is not linear, but it has the interpolated colour, which is what the image defines.
class ImageMap final : public ObjectMap, public RgbSource, public ReadsAhead {
 public:
  static void describe(Description<ImageMap>& d) {
    d.summary("An image over the surface coordinates: its lower left corner is at (0, 0), its upper right one at (1, 1).")
        .group("Image")
        .member<&ImageMap::file>("file", "",
                                 "the image: OpenEXR, HDR, PNG, JPEG, TIFF, PNM, PFM, WebP, BMP or TGA. With <UDIM> in its "
                                 "name: one image for each unit "
                                 "square of u and v, from files with 1001 + u + 10 v in that place; black where there is none. "
                                 "An OpenEXR file that says it is a cube of surroundings (envmap = cube) is laid in longitude "
                                 "and latitude, as Environment's u and v go. None: the numbers below")
        .member<&ImageMap::resolution>("resolution", "1", "width and height of the image [pixels]", unless("file"))
        .member<&ImageMap::values>("values", "1",
                                   "its values, from left to right in rows from the top: for each pixel grey; grey and alpha; "
                                   "red, green and blue; or these and alpha",
                                   unless("file"))
        .member<&ImageMap::number_type>("number_type", "",
                                        "of the values; float: they are used as they are; uint8 and uint16: integers, of which "
                                        "255 or 65535 stands for 1",
                                        choices("float", "uint8", "uint16"), unless("file"))
        .group("Placement")
        .member<&ImageMap::interpolation>(
            "interpolation", "",
            "what is between the middles of texels: nearest: texels as squares; bilinear: mixtures of four",
            choices("nearest", "bilinear"))
        .member<&ImageMap::wrap>("wrap", "", "what lies outside the unit square", choices("repeat", "mirror", "clamp", "black"))
        .member<&ImageMap::wrap_v>("wrap_v", "", "what lies above and below it; same: what `wrap` says for all sides",
                                   choices("same", "repeat", "mirror", "clamp", "black"))
        .member<&ImageMap::color_space>("color_space", "", "primaries and white of the image's RGB", rgb_space_names())
        .member<&ImageMap::transfer>("transfer", "", "how its numbers are encoded; auto: srgb for integers, linear for floats",
                                     image_transfer_names())
        .member<&ImageMap::channel>("channel", "",
                                    "which channels of the image: \"\" the first three or its only one, else the name of one "
                                    "(\"A\", \"depth.Z\") or of a layer (\"diffuse\" for diffuse.R, diffuse.G, diffuse.B)")
        .member<&ImageMap::as_number>("as_number", "",
                                      "what a colour is where a number is asked for, as a roughness or a height; mean: of its "
                                      "three values; luminance: their "
                                      "sum by the weights with which they are seen",
                                      choices("mean", "luminance"))
        .member<&ImageMap::repeat>("repeat", "1", "how many times the image is laid along u and along v");
  }

  void prepare() override {
    space_ = &rgb_space(color_space);
    for (size_t i = 0; i < 3; ++i) weights_[i] = as_number == AsNumber::mean ? 1.0f / 3 : float(space_->to_xyz[3 + i]);
    if (!(std::isfinite(repeat.x) && std::isfinite(repeat.y))) fail("repeat", "must be finite numbers");
    if (file.empty() && values.empty()) fail("file", "an image file is needed, or `resolution` and `values`");
    if (file.empty())
      use_values();
    else
      load(file.resolved());
    ahead_.clear();
  }

  void read_ahead() override {
    if (!file.empty())
      for (const UdimFile& f : files_of(file.resolved())) ahead_.push_back(ImageTexture::open(f.path, transfer, channel));
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    float rgb[3];
    look_up(p, rgb);
    return rgb_spectrum(*space_, rgb[0], rgb[1], rgb[2], use, w);
  }
  float scalar(const SurfacePoint& p) const override {
    float rgb[3];
    const int channels = look_up(p, rgb);
    return channels == 1 ? rgb[0] : weights_[0] * rgb[0] + weights_[1] * rgb[1] + weights_[2] * rgb[2];
  }

  std::string rgb_space_name() const override { return color_space; }
  void rgb(const SurfacePoint& p, float out[3]) const override { look_up(p, out); }

  float largest() const override {
    float most = 0;
    for (const auto& tile : tiles_)
      if (tile) most = std::max(most, tile->largest());
    return most;
  }

  FilePath file;
  std::vector<int> resolution{1, 1};
  std::vector<float> values;
  ListedNumbers number_type = ListedNumbers::single;
  Interpolation interpolation = Interpolation::bilinear;
  Wrap wrap = Wrap::repeat;
  WrapV wrap_v = WrapV::same;
  std::string color_space = "srgb", transfer = automatic_transfer, channel;
  AsNumber as_number = AsNumber::mean;
  Vector2 repeat{1, 1};

 private:
  static std::vector<UdimFile> files_of(const std::string& path) {
    return path.find(udim_mark) != std::string::npos ? udim_files(path) : std::vector<UdimFile>{{0, 0, path}};
  }
  void use_values() {
    tiles_ = {ImageTexture::of(listed_image(*this, resolution, values, number_type, transfer, channel))};
    tiled_ = cube_ = false;
  }
  void load(const std::string& path) {
    tiles_.clear();
    tiled_ = path.find(udim_mark) != std::string::npos;
    const std::vector<UdimFile> files = files_of(path);
    if (files.empty()) fail("file", "there is no file '" + path + "' with a number from 1001 to 9999 for " + udim_mark);
    for (const UdimFile& f : files) {
      try {
        check_channel(f.path, channel);
      } catch (const Error& e) {
        fail("channel", e.what());
      }
      try {
        const size_t place = size_t(f.v * 10 + f.u);
        if (place >= tiles_.size()) tiles_.resize(place + 1);
        tiles_[place] = ImageTexture::open(f.path, transfer, channel);
      } catch (const Error& e) {
        fail("file", e.what());
      }
    }
    cube_ = !tiled_ && tiles_.front()->from_cube();
  }

  /// Writes the RGB at a point, and returns how many channels the image has.
  int look_up(const SurfacePoint& p, float rgb[3]) const {
    rgb[0] = rgb[1] = rgb[2] = 0;
    float u = p.uv.x * repeat.x, v = p.uv.y * repeat.y;
    const ImageTexture* texture = tiles_.front().get();
    Wraps outside(wrap, wrap_v != WrapV::same ? Wrap(int(wrap_v) - 1) : (cube_ ? Wrap::clamp : wrap));
    if (tiled_) {
      float column = std::floor(u), row = std::floor(v);
      // The right and upper border of a tile belongs to this tile if no other tile is adjacent there.
      if (!tile(column, row)) {
        const bool left = u == column, low = v == row;
        if (left && tile(column - 1, row))
          --column;
        else if (low && tile(column, row - 1))
          --row;
        else if (left && low && tile(column - 1, row - 1))
          --column, --row;
      }
      texture = tile(column, row);
      if (!texture) return 1;
      u -= column;
      v -= row;
      outside = Wrap::clamp;
    }
    UvFootprint f;
    if (p.footprint > 0) {
      f = uv_footprint(p);
      for (Vector2* axis : {&f.longer, &f.shorter}) *axis = {axis->x * repeat.x, axis->y * repeat.y};
    }
    if (p.footprint > 0 && (interpolation == Interpolation::bilinear || texture->texels_along(f) > 1))
      texture->mean({u, v}, f, outside, rgb);
    else if (interpolation == Interpolation::nearest)
      texture->nearest({u, v}, outside, rgb);
    else
      texture->bilinear({u, v}, outside, rgb);
    if (texture->channels() == 1) rgb[1] = rgb[2] = rgb[0];
    return texture->channels();
  }

  /// The image of a unit square; null: there is none.
  const ImageTexture* tile(float u, float v) const {
    if (!(u >= 0 && u < 10 && v >= 0 && v * 10 + u < float(tiles_.size()))) return nullptr;
    return tiles_[size_t(v) * 10 + size_t(u)].get();
  }

  const RgbSpace* space_ = nullptr;
  float weights_[3] = {};  // of red, green and blue in scalar()
  bool tiled_ = false, cube_ = false;
  std::vector<std::shared_ptr<const ImageTexture>> ahead_;
  std::vector<std::shared_ptr<const ImageTexture>> tiles_;  // the only one, or that of square (u, v) at 10 v + u
};

const Register<ImageMap> registered;

}  // namespace
}  // namespace etendue
