// ImageMap: an image file on a surface, filtered.

#include <OpenImageIO/imagecache.h>
#include <OpenImageIO/texture.h>

#include <mutex>

#include "etendue/color.h"
#include "etendue/object_map.h"
#include "etendue/scene_object.h"
#include "maps/linear_image.h"

namespace etendue {
namespace {

enum class Interpolation : std::uint8_t { nearest, bilinear, trilinear };
enum class Wrap : std::uint8_t { repeat, mirror, clamp, black };

/// One cache of image tiles for all maps, alive until the program ends.
OIIO::TextureSystem& textures() {
  static OIIO::TextureSystem* const system = [] {
    OIIO::TextureSystem* s = OIIO::TextureSystem::create(false);
    s->attribute("autotile", 64);
    s->attribute("automip", 1);
    s->attribute("accept_untiled", 1);
    s->attribute("accept_unmipped", 1);
    s->attribute("max_memory_MB", 2048.0f);
    return s;
  }();
  return *system;
}

/// OpenImageIO's own data of this thread, asked for once.
OIIO::TextureSystem::Perthread* thread_data() {
  thread_local OIIO::TextureSystem::Perthread* const data = textures().get_perthread_info();
  return data;
}

// The image's numbers are decoded to linear ones before they are filtered; mip levels are averages of linear texels too.
// A filtered RGB value becomes a spectrum at each lookup. That is not the filtered spectrum of the texels, as the fit is
// not linear, but it has the filtered colour, which is what an image says.
class ImageMap final : public ObjectMap {
 public:
  static void describe(Description<ImageMap>& d) {
    d.summary("An image file over the surface coordinates: its lower left corner is at (0, 0), its upper right one at (1, 1).")
        .member<&ImageMap::file>("file", "", "the image; any format OpenImageIO reads", required)
        .member<&ImageMap::interpolation>(
            "filter", "",
            "nearest: texels as squares; bilinear: between texels; trilinear: averaged over what a pixel sees as well",
            choices("nearest", "bilinear", "trilinear"))
        .member<&ImageMap::wrap>("wrap", "", "what lies outside the unit square", choices("repeat", "mirror", "clamp", "black"))
        .member<&ImageMap::color_space>("color_space", "", "primaries and white of the image's RGB")
        .member<&ImageMap::transfer>("transfer", "", "how its numbers are encoded; auto: srgb for integers, linear for floats")
        .member<&ImageMap::repeat>("repeat", "1", "how many times the image is laid along u and along v");
  }

  void prepare() override {
    try {
      space_ = &rgb_space(color_space);
    } catch (const Error& e) {
      fail("color_space", e.what());
    }
    try {
      check_transfer(transfer);
    } catch (const Error& e) {
      fail("transfer", e.what());
    }
    if (!(std::isfinite(repeat.x) && std::isfinite(repeat.y))) fail("repeat", "must be finite numbers");
    if (file.empty()) fail("file", "an image file is needed");
    load(file.resolved());
  }

  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    float rgb[3];
    look_up(p, rgb);
    return rgb_spectrum(*space_, rgb[0], rgb[1], rgb[2], use, w);
  }
  float scalar(const SurfacePoint& p) const override {
    float rgb[3];
    look_up(p, rgb);
    return channels_ == 1 ? rgb[0] : (rgb[0] + rgb[1] + rgb[2]) / 3;
  }

  FilePath file;
  Interpolation interpolation = Interpolation::trilinear;
  Wrap wrap = Wrap::repeat;
  std::string color_space = "srgb", transfer = automatic_transfer;
  Vector2 repeat{1, 1};

 private:
  void load(const std::string& path) {
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    OIIO::TextureSystem& system = textures();
    OIIO::ImageCache& cache = *system.imagecache();
    const OIIO::ustring key(linear_image_key(path, transfer));
    const auto refuse = [&] {
      // OpenImageIO's message names our key; the path is what the user knows.
      std::string reason = system.geterror();
      if (reason.empty()) reason = cache.geterror();
      for (size_t at; (at = reason.find(key.string())) != std::string::npos;) reason.replace(at, key.string().size(), path);
      while (!reason.empty() && (reason.back() == '\n' || reason.back() == ' ')) reason.pop_back();
      cache.invalidate(key);
      fail("file", "cannot read '" + path + "': " + (reason.empty() ? "it is no image" : reason));
    };
    if (!cache.add_file(key, make_linear_input)) refuse();
    OIIO::ImageSpec spec;
    if (!cache.get_imagespec(key, spec)) refuse();
    channels_ = spec.nchannels;
    // Every pixel is read once now: a file that is damaged is found before rendering, not in the middle of it.
    constexpr int rows = 64;
    std::vector<float> strip(size_t(spec.width) * rows * size_t(channels_));
    for (int y = 0; y < spec.height; y += rows)
      if (!cache.get_pixels(key, 0, 0, spec.x, spec.x + spec.width, spec.y + y, spec.y + std::min(y + rows, spec.height), 0, 1,
                            OIIO::TypeDesc::FLOAT, strip.data()))
        refuse();
    handle_ = system.get_texture_handle(key);
    if (!handle_ || !system.good(handle_)) refuse();
  }

  void look_up(const SurfacePoint& p, float rgb[3]) const {
    OIIO::TextureOpt options;
    static constexpr OIIO::TextureOpt::Wrap wraps[] = {OIIO::TextureOpt::WrapPeriodic, OIIO::TextureOpt::WrapMirror,
                                                       OIIO::TextureOpt::WrapClamp, OIIO::TextureOpt::WrapBlack};
    options.swrap = options.twrap = wraps[int(wrap)];
    options.interpmode =
        interpolation == Interpolation::nearest ? OIIO::TextureOpt::InterpClosest : OIIO::TextureOpt::InterpBilinear;
    float dsdx = 0, dsdy = 0, dtdy = 0;
    if (interpolation == Interpolation::trilinear && p.footprint > 0) {
      options.mipmode = OIIO::TextureOpt::MipModeTrilinear;
      footprint(p, dsdx, dsdy, dtdy);
    } else {
      options.mipmode = OIIO::TextureOpt::MipModeNoMIP;
    }
    rgb[0] = rgb[1] = rgb[2] = 0;
    // Row 0 of the image is at v = 1. A failed lookup is black; prepare has read every pixel, so it can only be a file that
    // was removed since.
    textures().texture(handle_, thread_data(), options, p.uv.x * repeat.x, 1 - p.uv.y * repeat.y, dsdx, 0, dsdy, -dtdy,
                       channels_, rgb);
    if (channels_ == 1) rgb[1] = rgb[2] = rgb[0];
  }

  /// The change of texture coordinates over the ray's cone: along the unit vector of dpdu, and across it in the surface.
  /// With e1 = dpdu / |dpdu| and e2 orthogonal to it, a step w e1 changes u by w / |dpdu|; a step w e2 changes v by
  /// w / (dpdv . e2) and u by what takes back the part of dpdv along e1.
  void footprint(const SurfacePoint& p, float& dsdx, float& dsdy, float& dtdy) const {
    Vector3 dpdu = p.dpdu, dpdv = p.dpdv;
    if (dpdu == Vector3{} && dpdv == Vector3{} && p.object) {
      SurfacePoint copy = p;
      p.object->tangents(copy);
      dpdu = copy.dpdu;
      dpdv = copy.dpdv;
    }
    const float length_u = length(dpdu);
    if (!(length_u > 0)) return;
    const Vector3 e1 = dpdu / length_u;
    const float along = dot(dpdv, e1), across = length(dpdv - along * e1);
    if (!(across > 0)) return;
    const float du = p.footprint / length_u, dv = p.footprint / across;
    // Beyond the whole image everything is its mean.
    dsdx = std::min(du * std::abs(repeat.x), 1.0f);
    dtdy = std::min(dv * std::abs(repeat.y), 1.0f);
    dsdy = clamp(-dv * along / length_u * repeat.x, -1, 1);
  }

  const RgbSpace* space_ = nullptr;
  OIIO::TextureSystem::TextureHandle* handle_ = nullptr;
  int channels_ = 3;
};

const Register<ImageMap> registered;

}  // namespace
}  // namespace etendue
