#include <tbb/parallel_for.h>

#include "reinhard.h"

namespace etendue {
namespace {

/// An image of one channel.
struct Plane {
  int width, height;
  std::vector<double> values;
};

/// Convolution with a Gaussian that is normalized over the part inside the image.
Plane blurred(const Plane& in, double sigma) {
  const int reach = int(std::ceil(3.5 * sigma));
  std::vector<double> weight;
  for (int i = 0; i <= reach; ++i) weight.push_back(std::exp(-0.5 * (i / sigma) * (i / sigma)));
  /// Along one axis: `count` lines of `length` values.
  const auto along = [&](const Plane& from, int length, int count, size_t step, size_t next_line) {
    Plane to{from.width, from.height, std::vector<double>(from.values.size())};
    tbb::parallel_for(0, count, [&](int line) {
      const double* a = &from.values[size_t(line) * next_line];
      double* b = &to.values[size_t(line) * next_line];
      for (int x = 0; x < length; ++x) {
        double sum = 0, all = 0;
        for (int k = std::max(0, x - reach); k <= std::min(length - 1, x + reach); ++k) {
          const double w = weight[size_t(std::abs(k - x))];
          sum += w * a[size_t(k) * step];
          all += w;
        }
        b[size_t(x) * step] = sum / all;
      }
    });
    return to;
  };
  return along(along(in, in.width, in.height, 1, size_t(in.width)), in.height, in.width, size_t(in.width), 1);
}

// Dodging and burning: A is the mean luminance V of the largest surrounding of a pixel that contains no strong contrast. V_s is
// the luminance convolved with the Gaussian exp(-r^2 / (alpha s)^2) / (pi (alpha s)^2), alpha = 1 / (2 sqrt 2), for the scales
// s = 1, 1.6, ..., 1.6^8 pixels; the surround of each scale is the centre of the next. The largest scale is taken up to which
//   |V_s - V_(1.6 s)| / (2^phi key / s^2 + V_s) < threshold    (equation 7).
// Between this scale and the next, V is interpolated to where the contrast would reach the threshold: otherwise neighbouring
// pixels that are almost equal could be shown differently.
class ReinhardLocalToneMap final : public ExposedToneMap {
  float white = 0;
  float sharpness = 8;
  float threshold = 0.05f;
  static constexpr int scales = 8;
  static constexpr double ratio = 1.6, key = 0.18;

 public:
  static void describe(Description<ReinhardLocalToneMap>& d) {
    d.summary(
         "Dodging and burning: as ReinhardToneMap, but what compresses a pixel is the mean luminance around it, as far as "
         "there "
         "is no strong contrast. Details stay in bright places; colours are kept as there.",
         "Reinhard, Stark, Shirley & Ferwerda 2002, Photographic tone reproduction for digital images, equation 9")
        .group("Curve")
        .member<&ReinhardLocalToneMap::white>("white", "1", reinhard_white_text, range(0, 1e9), Effect::retone, soft(0.5, 1000),
                                              logarithmic)
        .member<&ReinhardLocalToneMap::sharpness>("sharpness", "1", "how much edges are enhanced (phi of the paper)",
                                                  range(0, 20), Effect::retone)
        .member<&ReinhardLocalToneMap::threshold>("threshold", "1", "contrast that ends a pixel's surrounding", range(0.001, 1),
                                                  Effect::retone);
  }
  bool local() const override { return true; }

 protected:
  void develop(Image& xyz) const override {
    Plane luminance{xyz.width, xyz.height, std::vector<double>(xyz.values.size() / 3)};
    for (size_t i = 0; i < luminance.values.size(); ++i) luminance.values[i] = std::max(xyz.values[3 * i + 1], 0.0);
    // Of exp(-r^2 / (alpha s)^2) the standard deviation is alpha s / sqrt 2 = s / 4.
    double s = 1;
    Plane centre = blurred(luminance, s / 4);
    Plane around = centre;
    std::vector<bool> ended(luminance.values.size());
    std::vector<double> last(luminance.values.size());  // the contrast at the previous scale
    for (int scale = 0; scale < scales; ++scale, s *= ratio) {
      Plane surround = blurred(luminance, s * ratio / 4);
      const double least = std::exp2(double(sharpness)) * key / (s * s);
      for (size_t i = 0; i < ended.size(); ++i) {
        if (ended[i]) continue;
        const double v = centre.values[i];
        const double contrast = std::abs(v - surround.values[i]) / (least + v);
        ended[i] = !(contrast < double(threshold));
        const double reached = ended[i] ? (double(threshold) - last[i]) / (contrast - last[i]) : 1;
        around.values[i] += reached * (v - around.values[i]);
        last[i] = contrast;
      }
      centre = std::move(surround);
    }
    develop_reinhard(xyz, rgb_space(color_space), reinhard_white(xyz, white), [&](size_t i) { return around.values[i]; });
  }
};

static const Register<ReinhardLocalToneMap> registered;

}  // namespace
}  // namespace etendue
