#pragma once
// DenoisedOutput: an output that has a second picture beside it.

#include "etendue/denoiser.h"
#include "etendue/output.h"

namespace etendue {

/// As an Output it writes the picture as it is, by another output. Who finishes a render (render/denoising.h) writes the
/// denoised one beside it: only there is the scene known that guides are made of.
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

  /// The file of the denoised picture beside that of the picture: "box.denoised.png" beside "box.png".
  static std::string denoised_path(const std::string& path);
};

}  // namespace etendue
