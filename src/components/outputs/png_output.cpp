#include "encoded_image.h"
#include "etendue/output.h"

namespace etendue {
namespace {

class PngOutput final : public Output {
  int bits = 8;
  bool dither = false;

 public:
  static void describe(Description<PngOutput>& d) {
    d.summary("PNG: R, G, B as the tone map made them, and what is known of the picture as texts.")
        .member<&PngOutput::bits>("bits", "1", "of each value: 8 or 16", range(8, 16), Effect::retone)
        .member<&PngOutput::dither>("dither", "", "adds noise of half a step before rounding, against bands", Effect::retone);
  }
  void prepare() override {
    if (bits != 8 && bits != 16) fail("bits", "must be 8 or 16");
    require_image_library();
  }
  std::string extension() const override { return ".png"; }
  bool for_display() const override { return true; }
  void write_image(const Image& image, const std::string& path) const override {
    write_display_image(image, path, extension(), bits, dither);
  }
};

static const Register<PngOutput> registered;

}  // namespace
}  // namespace etendue
