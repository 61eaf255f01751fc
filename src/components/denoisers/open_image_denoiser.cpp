// Denoising by Open Image Denoise.
//
// The networks take unbounded (HDR) images, before any tone map. They were trained on RGB images without negative values, while
// colours of a spectral image may lie outside of the RGB space of any display. So images are passed in the space ACES 2065-1,
// in which every colour of light has components that are not negative.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "etendue/denoiser.h"
#include "etendue/describe/color.h"
#include "open_image_denoise.h"

namespace etendue {
namespace {

/// Three floats for each pixel.
using Pixels = std::vector<float>;
using Matrix = std::array<double, 9>;
constexpr Matrix as_it_is{1, 0, 0, 0, 1, 0, 0, 0, 1};

std::array<size_t, 3> places(const Image& image, const std::array<const char*, 3>& names) {
  std::array<size_t, 3> at{};
  for (size_t c = 0; c < 3; ++c) {
    const auto found = std::ranges::find(image.channels, names[c]);
    if (found == image.channels.end()) throw Error(fmt::format("a picture to be denoised has no channel {}", names[c]));
    at[c] = size_t(found - image.channels.begin());
  }
  return at;
}

/// Three channels of an image, multiplied by the matrix m and clamped; values that are not finite count as 0.
Pixels pixels_of(const Image& image, const std::array<size_t, 3>& at, const Matrix& m, float least, float most) {
  const size_t count = size_t(image.width) * size_t(image.height), stride = image.channels.size();
  Pixels pixels(3 * count);
  for (size_t i = 0; i < count; ++i) {
    double in[3];
    for (size_t c = 0; c < 3; ++c) {
      const double v = image.values[i * stride + at[c]];
      in[c] = std::isfinite(v) ? v : 0;
    }
    for (size_t c = 0; c < 3; ++c)
      pixels[3 * i + c] = std::clamp(float(m[3 * c] * in[0] + m[3 * c + 1] * in[1] + m[3 * c + 2] * in[2]), least, most);
  }
  return pixels;
}

/// A CPU device of Open Image Denoise, and its filters.
class Session {
 public:
  Session(const OpenImageDenoise& library, int quality, int threads, int width, int height)
      : library_(library),
        quality_(quality),
        width_(size_t(width)),
        height_(size_t(height)),
        device_(library.new_device(OpenImageDenoise::cpu_device)) {
    if (!device_) raise();
    // Otherwise the library would bind threads to cores, also those of this program.
    library_.set_device_switch(device_, "setAffinity", false);
    if (threads > 0) library_.set_device_number(device_, "numThreads", threads);
    library_.commit_device(device_);
    check();
  }
  ~Session() {
    if (device_) library_.release_device(device_);
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  struct Input {
    const char* name;
    Pixels* pixels;
  };
  /// The result of a filter of type "RT". `high_range`: the first input is unbounded (HDR). `clean`: the other inputs are free
  /// of noise.
  Pixels filtered(const std::vector<Input>& inputs, bool high_range, bool clean) {
    Pixels out(3 * width_ * height_);
    const OpenImageDenoise::Filter filter = library_.new_filter(device_, "RT");
    if (!filter) raise();
    const auto image = [&](const char* name, Pixels& pixels) {
      library_.set_image(filter, name, pixels.data(), OpenImageDenoise::three_floats, width_, height_, 0, 0, 0);
    };
    for (const Input& input : inputs) image(input.name, *input.pixels);
    image("output", out);
    library_.set_number(filter, "quality", quality_);
    if (high_range) library_.set_switch(filter, "hdr", true);
    if (clean) library_.set_switch(filter, "cleanAux", true);
    library_.commit_filter(filter);
    library_.execute(filter);
    library_.release_filter(filter);
    check();
    return out;
  }

 private:
  void check() const {
    const char* message = nullptr;
    if (library_.device_error(device_, &message) != OpenImageDenoise::no_error) raise(message);
  }
  [[noreturn]] void raise(const char* message = nullptr) const {
    if (!message) library_.device_error(device_, &message);
    throw Error(fmt::format("Open Image Denoise {}: {}", library_.version(), message ? message : "it gives no reason"));
  }

  const OpenImageDenoise& library_;
  const int quality_;
  const size_t width_, height_;
  const OpenImageDenoise::Device device_;
};

class OpenImageDenoiser final : public Denoiser {
  enum class Quality : std::uint8_t { fast, balanced, high };
  Quality quality = Quality::high;
  bool clean_guides = true;

 public:
  static void describe(Description<OpenImageDenoiser>& d) {
    d.summary(
         "Open Image Denoise, on the processor: a neural network that was trained on path traced pictures. The library, of "
         "version 2, is looked for when it is needed: where the environment variable ETENDUE_OIDN says, else where the system "
         "has libraries, else in PyPI's package pyoidn (pip install pyoidn). Noise of neighbouring pixels should be "
         "independent, which it is with BoxFilter {} alone: after a wider filter blotches stay.",
         "Áfra 2025, Open Image Denoise, www.openimagedenoise.org")
        .member<&OpenImageDenoiser::quality>("quality", "", "of the network: slower ones are better",
                                             choices("fast", "balanced", "high"), Effect::retone)
        .member<&OpenImageDenoiser::clean_guides>("clean_guides", "",
                                                  "whether noise is taken from the guides first, each by itself, so that "
                                                  "their edges can be trusted",
                                                  Effect::retone);
  }

  void require() const override { loaded(); }
  std::string worker() const override { return "Open Image Denoise " + loaded().version(); }

  Image denoised(const Image& picture, const Image& guides, int threads) const override {
    constexpr float most = std::numeric_limits<float>::max();
    const RgbSpace& space = rgb_space("aces2065-1");
    const std::array<size_t, 3> light = places(picture, {"X", "Y", "Z"});
    constexpr std::array quality_numbers{OpenImageDenoise::fast_quality, OpenImageDenoise::balanced_quality,
                                         OpenImageDenoise::high_quality};
    Session session(loaded(), quality_numbers.at(size_t(quality)), threads, picture.width, picture.height);

    Pixels color = pixels_of(picture, light, space.from_xyz, 0, most);
    std::vector<Session::Input> inputs{{"color", &color}};
    Pixels albedo, normal;
    if (!guides.channels.empty()) {
      if (guides.width != picture.width || guides.height != picture.height)
        throw Error("guides are not of the size of the picture to be denoised");
      albedo = pixels_of(guides, places(guides, {"albedo.R", "albedo.G", "albedo.B"}), as_it_is, 0, 1);
      normal = pixels_of(guides, places(guides, {"normal.X", "normal.Y", "normal.Z"}), as_it_is, -1, 1);
      if (clean_guides) {
        albedo = session.filtered({{"albedo", &albedo}}, false, false);
        normal = session.filtered({{"normal", &normal}}, false, false);
      }
      inputs.push_back({"albedo", &albedo});
      inputs.push_back({"normal", &normal});
    }
    const Pixels result = session.filtered(inputs, true, clean_guides && inputs.size() > 1);

    Image image = picture;
    const size_t stride = image.channels.size();
    for (size_t i = 0; 3 * i < result.size(); ++i)
      for (size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (size_t k = 0; k < 3; ++k) sum += space.to_xyz[3 * c + k] * double(result[3 * i + k]);
        image.values[i * stride + light[c]] = sum;
      }
    return image;
  }

 private:
  const OpenImageDenoise& loaded() const {
    try {
      return OpenImageDenoise::load();
    } catch (const Error& error) {
      fail("", error.what());
    }
  }
};

const Register<OpenImageDenoiser> registered;

}  // namespace
}  // namespace etendue
