// Colours written as RGB or XYZ.

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>

#include "etendue/core/error.h"
#include "etendue/describe/bands.h"
#include "etendue/describe/component.h"
#include "named.h"
#include "sigmoid_fit.h"

namespace etendue {

namespace {

constexpr int fine_step = 1;  // nm

/// A colour whose sigmoids are fitted individually with the 1 nm sum: exact where a reflectance of the colour exists, without a
/// table.
class RgbColor final : public SpectralFunction {
 public:
  RgbColor(const RgbSpace& space, const std::array<double, 3>& rgb, std::string expression)
      : space_(&space), illuminant_(space.illuminant), expression_(std::move(expression)) {
    const SigmoidFit& fit = fit_of(space);
    std::array<double, 3> positive, reflectance, half;
    for (size_t i = 0; i < 3; ++i) {
      positive[i] = std::max(rgb[i], 0.0);
      reflectance[i] = std::min(positive[i], 1.0);
      rgb_[i] = float(positive[i]);
    }
    const double largest = std::max({positive[0], positive[1], positive[2]});
    for (size_t i = 0; i < 3; ++i) half[i] = largest > 0 ? positive[i] / (2 * largest) : 0;
    reflectance_ = fit.solve(reflectance);
    half_ = fit.solve(half);
    scale_ = float(2 * largest);
  }

  Spectrum evaluate(const Wavelengths& wavelengths, ColorUse use) const override {
    if (in_bands(wavelengths)) [[unlikely]]
      return &space_of_bands(wavelengths) == space_ ? rgb_in_bands(*space_, rgb_[0], rgb_[1], rgb_[2], use, wavelengths)
                                                    : in_bands_.of(*this, use, wavelengths);
    const Coefficients& c = use == ColorUse::reflectance ? reflectance_ : half_;
    const Spectrum s = evaluate_sigmoid(float(c[0]), float(c[1]), float(c[2]), wavelengths);
    if (use == ColorUse::reflectance) return s;
    return use == ColorUse::radiance ? scale_ * s * illuminant_->evaluate(wavelengths, use) : scale_ * s;
  }
  float at(float wavelength, ColorUse use) const override {
    if (use == ColorUse::reflectance) return float(evaluate_sigmoid(reflectance_, double(wavelength)));
    const double s = double(scale_) * evaluate_sigmoid(half_, double(wavelength));
    return float(use == ColorUse::radiance ? s * double(illuminant_->at(wavelength, use)) : s);
  }
  std::string expression() const override { return expression_; }
  std::vector<float> corners() const override { return illuminant_->corners(); }
  float largest_component() const override { return scale_ / 2; }

 private:
  static const SigmoidFit& fit_of(const RgbSpace& space) {
    static std::mutex mutex;
    static std::map<std::string, std::unique_ptr<SigmoidFit>> fits;
    const std::lock_guard lock(mutex);
    auto& fit = fits[space.name];
    if (!fit) fit = std::make_unique<SigmoidFit>(space, fine_step);
    return *fit;
  }

  Coefficients reflectance_, half_;  // of the colour, and of the colour scaled so that its largest component is 1/2
  float scale_;                      // twice the largest component
  float rgb_[3];                     // without negative components
  const RgbSpace* space_;            // lives as long as the program
  BandValues in_bands_;              // of other spaces
  Color illuminant_;
  std::string expression_;
};

Color make_color(const RgbSpace& space, const std::array<double, 3>& rgb, std::string expression) {
  for (const double x : rgb) {
    if (!std::isfinite(x) || !std::isfinite(float(x))) throw Error(expression + ": components must be finite numbers");
    if (x < 0) warn(expression + ": negative components count as 0");
  }
  return Color(new RgbColor(space, rgb, std::move(expression)));
}

std::string components_text(double a, double b, double c) {
  return number_text(a) + ", " + number_text(b) + ", " + number_text(c) + ")";
}

}  // namespace

Color rgb_color(const std::string& space, double r, double g, double b) {
  const RgbSpace& s = rgb_space(space);
  return make_color(s, {r, g, b}, (s.name == "srgb" ? "rgb(" : "rgb(" + quoted(s.name) + ", ") + components_text(r, g, b));
}

Color srgb_color(double r, double g, double b) {
  const std::string text = "srgb(" + components_text(r, g, b);
  for (const double x : {r, g, b})
    if (!(x >= 0 && x <= 1)) throw Error(text + ": components must lie in [0, 1]");
  return make_color(rgb_space("srgb"), {decode_transfer("srgb", r), decode_transfer("srgb", g), decode_transfer("srgb", b)},
                    text);
}

Color xyz_color(double x, double y, double z) {
  return make_color(rgb_space("xyz"), {x, y, z}, "xyz(" + components_text(x, y, z));
}

}  // namespace etendue
