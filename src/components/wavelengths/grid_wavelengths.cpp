#include <numeric>
#include <vector>

#include "etendue/wavelength_sampler.h"

namespace etendue {

/// The thesis's fixed grid: `count` cells of equal width over the range, whose centres are the only wavelengths; the
/// image's spectrum is the Riemann sum over them. Each path takes `spectrum_size` of them in rotation.
///
/// Sample s of a pixel has as hero the grid point p(s) = (offset + s * stride) mod count; the offset is a hash of the
/// pixel, the stride is coprime to count. Lane i takes the point floor(i * count / size) further on, mod count. So over
/// any `count` consecutive samples each lane takes every point exactly once (and when size divides count, over any
/// count/size consecutive samples each point is taken once by just one lane), and each lane alone is uniform on the grid:
/// probability 1/count for a cell of width (high - low)/count, which is the pdf 1/(high - low). This holds for every
/// count; with a count below spectrum_size some lanes of a path have the same wavelength, which is no error but a waste.
class GridWavelengths final : public WavelengthSampler {
  int count = 40;
  float low = wavelength_low;
  float high = wavelength_high;

 public:
  static void describe(Description<GridWavelengths>& d) {
    d.summary("A fixed grid of wavelengths of which each path takes its share in rotation.")
        .member<&GridWavelengths::count>("count", "1", "number of wavelengths; best a multiple of those a path carries",
                                         range(1, 4096), soft(4, 128), logarithmic)
        .member<&GridWavelengths::low>("low", "nm", "where the first cell begins; light below it is left out",
                                       range(double(wavelength_low), double(wavelength_high)))
        .member<&GridWavelengths::high>("high", "nm", "where the last cell ends; light above it is left out",
                                        range(double(wavelength_low), double(wavelength_high)));
  }

  void prepare() override {
    if (!(low < high)) fail("high", "must exceed low");
    pdf_ = 1 / (high - low);
    centres_.resize(size_t(count));
    for (int i = 0; i < count; ++i) centres_[size_t(i)] = float(double(low) + (i + 0.5) * (double(high) - double(low)) / count);
    for (int i = 0; i < spectrum_size; ++i) shift_[i] = std::uint32_t(i * count / spectrum_size);
    // Consecutive heroes should lie far apart within the count / size points between two lanes: the stride is near the golden
    // section of this distance.
    stride_ = std::max(1u, std::uint32_t(0.618 * count / spectrum_size + 0.5));
    while (std::gcd(stride_, std::uint32_t(count)) != 1) ++stride_;
  }

  Wavelengths sample(SampleKey key, float) const override {
    const std::uint32_t n = std::uint32_t(count);
    // Not the pixel's hash itself, which samplers use: the offset must not be correlated with their numbers.
    const std::uint64_t offset = mix_bits(key.walk ^ 0x6a09e667f3bcc908ull) >> 32;
    const std::uint32_t hero = std::uint32_t((offset + std::uint64_t(key.sample) * stride_) % n);
    Wavelengths result;
    for (int i = 0; i < spectrum_size; ++i) {
      const std::uint32_t point = hero + shift_[i];
      result.place(i, centres_[point < n ? point : point - n], pdf_);
    }
    return result;
  }

 private:
  std::vector<float> centres_;  // nm
  std::uint32_t shift_[spectrum_size] = {};
  std::uint32_t stride_ = 1;
  float pdf_ = 0;  // 1/nm
};

static const Register<GridWavelengths> registered;

}  // namespace etendue
