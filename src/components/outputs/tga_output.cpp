#include "encoded_image.h"
#include "etendue/output.h"

namespace etendue {
namespace {

class TgaOutput final : public Output {
  bool dither = false;

 public:
  static void describe(Description<TgaOutput>& d) {
    d.summary("Truevision TGA: R, G, B of 8 bits as the tone map made them. Holds no metadata.")
        .member<&TgaOutput::dither>("dither", "", "adds noise of half a step before rounding, against bands", Effect::retone);
  }
  void prepare() override { require_image_library(); }
  std::string extension() const override { return ".tga"; }
  bool for_display() const override { return true; }
  void write_image(const Image& image, const std::string& path) const override {
    write_display_image(image, path, extension(), 8, dither);
  }
};

static const Register<TgaOutput> registered;

}  // namespace
}  // namespace etendue
