#include "encoded_image.h"
#include "etendue/film/image_tools.h"
#include "etendue/output.h"

namespace etendue {
namespace {

class HdrOutput final : public Output {
 public:
  static void describe(Description<HdrOutput>& d) {
    d.summary(
        "Radiance HDR: linear sRGB with a shared exponent, about 1 % exact. Colours outside the space are moved to its "
        "edge; holds neither layers nor metadata.",
        "Ward 1991, Real pixels");
  }
  void prepare() override { require_image_library(); }
  std::string extension() const override { return ".hdr"; }
  bool for_display() const override { return false; }

  void write_image(const Image& given, const std::string& path) const override {
    const Image image = convert_color_space(given, "srgb");
    const size_t red = size_t(std::find(image.channels.begin(), image.channels.end(), "R") - image.channels.begin());
    const size_t pixels = size_t(image.width) * size_t(image.height), stride = image.channels.size();
    std::vector<float> values(3 * pixels);
    // The largest number whose exponent fits in the format's eight bits.
    constexpr double limit = 0x1.fep126;
    for (size_t i = 0; i < values.size(); ++i) {
      const double v = image.values[i / 3 * stride + red + i % 3];
      values[i] = v > 0 ? float(std::min(v, limit)) : 0;  // NaN becomes 0
    }
    write_encoded(path, extension(), ImageHeader(image.width, image.height, 3, NumberType::single), values);
  }
};

static const Register<HdrOutput> registered;

}  // namespace
}  // namespace etendue
