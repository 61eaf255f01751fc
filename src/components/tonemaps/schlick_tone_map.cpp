#include "etendue/tone_map.h"
#include "luminance.h"

namespace etendue {
namespace {

// Schlick 1994 maps x = L / L_white in [0, 1] by
//   F(x) = p x / ((p - 1) x + 1),   p >= 1,
// which takes 0 to 0 and 1 to 1 and has slope p at black. He chooses p so that the darkest luminance L_dark of the
// picture becomes the darkest grey M that can be told from black among the N levels of the display:
//   F(L_dark / L_white) = M / N   =>   p = M (L_white - L_dark) / (L_dark (N - M)),   about M L_white / (N L_dark).
class SchlickToneMap final : public ToneMap {
  float p = 0;
  float darkest_grey = 1;
  float levels = 256;
  float dark_percentile = 5;
  float percentile = 100;

 public:
  static void describe(Description<SchlickToneMap>& d) {
    d.summary(
         "A rational curve of the luminance relative to white that lifts dark places and keeps black, white and "
         "chromaticities.",
         "Schlick 1994, Quantization techniques for visualization of high dynamic range pictures")
        .group("Curve")
        .member<&SchlickToneMap::p>("p", "1", "slope of the curve at black, at least 1; 0: found from the members below",
                                    range(0, 1e9), Effect::retone, soft(1, 1000), logarithmic)
        .member<&SchlickToneMap::darkest_grey>("darkest_grey", "1", "the darkest level that can be told from black (M)",
                                               Range{0, 65535, true}, Effect::retone, soft(0.1, 100), logarithmic, unless("p"))
        .member<&SchlickToneMap::levels>("levels", "1", "number of levels of the display (N)", range(2, 65536), Effect::retone,
                                         soft(2, 65536), logarithmic, unless("p"))
        .member<&SchlickToneMap::dark_percentile>(
            "dark_percentile", "1", "percentage of the pixels with light darker than what becomes the darkest grey",
            range(0, 100), Effect::retone, unless("p"))
        .member<&SchlickToneMap::percentile>("percentile", "1", "percentage of the pixels with light that stay below white",
                                             Range{0, 100, true}, Effect::retone, soft(50, 100));
  }

  void prepare() override {
    if (p != 0 && p < 1) fail("p", "must be at least 1, or 0 to find it");
    if (darkest_grey >= levels) fail("darkest_grey", "must be less than the number of levels");
  }

 protected:
  void map(Image& xyz) const override {
    std::vector<double> luminances = positive_luminances(xyz);
    const double white = percentile_of(luminances, double(percentile));
    double slope = double(p);
    if (slope == 0 && white > 0) {
      const double dark = percentile_of(luminances, double(dark_percentile));
      const double m = double(darkest_grey), n = double(levels);
      slope = std::max(1.0, m * (white - dark) / (dark * (n - m)));
    }
    map_luminance(xyz, white, [slope](double x) { return slope * x / ((slope - 1) * x + 1); });
  }
};

static const Register<SchlickToneMap> registered;

}  // namespace
}  // namespace etendue
