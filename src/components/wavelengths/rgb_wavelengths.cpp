#include "etendue/describe/bands.h"
#include "etendue/wavelength_sampler.h"

namespace etendue {

/// No wavelengths but the three components of an RGB space (bands.h).
class RgbWavelengths final : public WavelengthSampler {
  std::string color_space = "srgb";

 public:
  static void describe(Description<RgbWavelengths>& d) {
    d.summary(
         "Red, green and blue in place of wavelengths, as in RGB renderers: colours given in RGB are taken as they are, and "
         "those "
         "of several surfaces multiply component by component. Measured spectra count by their colour. What needs wavelengths "
         "is "
         "an error: dispersion, thin films, gratings, spectral films.",
         "Borges 1991, Trichromatic approximation for computer graphics illumination models")
        .member<&RgbWavelengths::color_space>("color_space", "",
                                              "whose red, green and blue; colours of other spaces are converted, and what lies "
                                              "outside of this one is cut off",
                                              rgb_space_names());
  }

  void prepare() override { bands_ = bands_of(rgb_space(color_space)); }
  Wavelengths sample(SampleKey, float) const override { return bands_; }

 private:
  Wavelengths bands_;
};

static const Register<RgbWavelengths> registered;

}  // namespace etendue
