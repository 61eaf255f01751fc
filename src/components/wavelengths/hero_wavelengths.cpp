#include <array>
#include <cmath>
#include <cstring>

#include "etendue/wavelength_sampler.h"

namespace etendue {

/// A hero wavelength is sampled for each path; the others are at equal distances from it in the CDF, so that each
/// wavelength alone has the distribution's pdf (Wilkie et al. 2014, section 3).
class HeroWavelengths final : public WavelengthSampler {
  enum class Distribution { visible, uniform };

  float low = wavelength_low;
  float high = wavelength_high;
  Distribution distribution = Distribution::visible;

 public:
  static void describe(Description<HeroWavelengths>& d) {
    d.summary("A random hero wavelength per path and others at equal distances from it.",
              "Wilkie et al. 2014, Hero Wavelength Spectral Sampling; Radziszewski et al. 2009, An Improved Technique for Full "
              "Spectral Rendering")
        .member<&HeroWavelengths::low>("low", "nm", "shortest wavelength; light below it is left out",
                                       range(double(wavelength_low), double(wavelength_high)))
        .member<&HeroWavelengths::high>("high", "nm", "longest wavelength; light above it is left out",
                                        range(double(wavelength_low), double(wavelength_high)))
        .member<&HeroWavelengths::distribution>(
            "distribution", "", "visible: more where the eye is sensitive; uniform: all alike", choices("visible", "uniform"));
  }

  void prepare() override {
    if (!(low < high)) fail("high", "must exceed low");
    // visible: p(lambda) ~ 1 / cosh^2(a (lambda - b)), a = 0.0072 / nm, b = 538 nm (Radziszewski et al.), cut to the
    // range. Its integral is tanh(a (lambda - b)) / a, so lambda(u) = b + atanh(t0 + u (t1 - t0)) / a with t = tanh at
    // the ends. lambda(u) is interpolated linearly between `cells` + 1 values, and the pdf is that of the interpolated
    // distribution: within a cell it is exactly 1 / (cells * width of the cell).
    constexpr double a = 0.0072, b = 538;
    const double t0 = std::tanh(a * (double(low) - b)), t1 = std::tanh(a * (double(high) - b));
    const auto inverse = [&](double u) {
      if (u <= 0) return double(low);
      if (u >= 1) return double(high);
      return distribution == Distribution::uniform ? double(low) + u * (double(high) - double(low))
                                                   : b + std::atanh(t0 + u * (t1 - t0)) / a;
    };
    for (int i = 0; i < cells; ++i) {
      const double begin = inverse(double(i) / cells), end = inverse(double(i + 1) / cells);
      Column& column = columns_[size_t(i % distance)];
      for (const int k : {i / distance, i / distance + spectrum_size}) {
        column.low[k] = float(begin);
        column.width[k] = float(end - begin);
        column.pdf[k] = float(1 / (cells * (end - begin)));
      }
    }
  }

  Wavelengths sample(SampleKey, float u) const override {
    // A distance of 1/size in u is a whole number of cells, so all wavelengths are at the same fraction of their cells.
    static_assert(cells % spectrum_size == 0);
    const float position = clamp(u, 0, one_minus_epsilon) * float(cells);
    const int cell = int(position);
    const float fraction = position - float(cell);
    const Column& column = columns_[size_t(cell % distance)];
    const int first = cell / distance;
    const detail::Lanes lambda = from(column.low, first) + fraction * from(column.width, first);
    const detail::Lanes longest = high - detail::Lanes{};
    return {lambda < longest ? lambda : longest, from(column.pdf, first)};
  }

 private:
  static constexpr int cells = 1024, distance = cells / spectrum_size;
  /// The cells of wavelengths that are sampled together, in order and repeated once, so that the cells that follow any of them
  /// cyclically are contiguous.
  struct Column {
    float low[2 * spectrum_size], width[2 * spectrum_size];  // nm
    float pdf[2 * spectrum_size];                            // 1/nm
  };
  static detail::Lanes from(const float* values, int first) {
    detail::Lanes lanes;
    std::memcpy(&lanes, values + first, sizeof lanes);
    return lanes;
  }
  std::array<Column, size_t(distance)> columns_{};
};

static const Register<HeroWavelengths> registered;

}  // namespace etendue
