// BlackbodyMap: the radiance of a black body at a temperature given by a map.

#include "color/planck.h"
#include "etendue/describe/bands.h"
#include "etendue/object_map.h"

namespace etendue {
namespace {

class BlackbodyMap final : public ObjectMap {
 public:
  static void describe(Description<BlackbodyMap>& d) {
    d.summary("The radiance of a black body whose temperature is a map: glowing metal, and the `glow` of a flame (MapVolume).",
              "Planck 1901, On the law of distribution of energy in the normal spectrum")
        .member<&BlackbodyMap::temperature>("temperature", "K", "the temperature; at 0 and below it is dark", Meaning::number)
        .member<&BlackbodyMap::factor>("factor", "1", "what the radiance is multiplied by", at_least(0), soft(0, 10))
        .member<&BlackbodyMap::normalized>("normalized", "",
                                           "whether the radiance is divided by its highest value over all wavelengths: the "
                                           "temperature then says no more than the colour, and `factor` how bright it is");
  }

  void prepare() override {
    if (!temperature) fail("temperature", "a map or a number is needed");
    if (!std::isfinite(factor)) fail("factor", "must be finite");
  }
  Spectrum color(const SurfacePoint& p, const Wavelengths& w, ColorUse use) const override {
    const double t = double(temperature->scalar(p));
    if (!(t > 0)) return {};
    const double scale = scale_at(t);
    if (in_bands(w)) return projected([&](float lambda) { return std::min(scale * planck(double(lambda), t), most); }, use, w);
    Spectrum s;
    for (int i = 0; i < spectrum_size; ++i) {
      const auto x = float(std::min(scale * planck(double(w[i]), t), most));
      s.set(i, use == ColorUse::reflectance ? std::min(x, 1.0f) : x);
    }
    return s;
  }
  float scalar(const SurfacePoint& p) const override {
    const double t = double(temperature->scalar(p));
    if (!(t > 0)) return 0;
    // The mean over the visible range, by the midpoint rule with steps of 47 nm.
    constexpr int steps = 10;
    constexpr double width = double(wavelength_high - wavelength_low) / steps;
    double sum = 0;
    for (int i = 0; i < steps; ++i) sum += planck(double(wavelength_low) + width * (i + 0.5), t);
    return float(std::min(scale_at(t) * sum / steps, most));
  }

  Ref<ObjectMap> temperature = etendue::constant(1500);
  float factor = 1;
  bool normalized = false;

 private:
  /// Upper limit of the result, so that it is finite at any temperature.
  static constexpr double most = 1e30;
  double scale_at(double t) const { return normalized ? double(factor) / highest_planck(t) : double(factor); }
};

const Register<BlackbodyMap> registered;

}  // namespace
}  // namespace etendue
