#pragma once
// DenoisedOutput: an output that also writes a denoised image, to a second file.

#include "etendue/denoiser.h"
#include "etendue/output.h"

namespace etendue {

/// As an Output it writes the image unchanged, by another output. The denoised image is written at the end of a render
/// (render/denoising.h), because the guides are rendered from the scene, which is available only there.
class DenoisedOutput final : public Output {
 public:
  static void describe(Description<DenoisedOutput>&);
  DenoisedOutput();

  Ref<Output> output;  ///< the format; its own `file` and `tone_map` are not used
  Ref<Denoiser> denoiser;

  void prepare() override;
  std::string extension() const override { return output ? output->extension() : ""; }
  bool for_display() const override { return output && output->for_display(); }
  void write_image(const Image& image, const std::string& path) const override { output->write_image(image, path); }

  /// The path of the denoised image for the path of an image: "box.denoised.png" for "box.png".
  static std::string denoised_path(const std::string& path);
};

}  // namespace etendue
