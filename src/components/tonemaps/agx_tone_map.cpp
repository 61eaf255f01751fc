#include "color_matrix.h"
#include "core/over_range.h"
#include "etendue/describe/color.h"
#include "etendue/exposed_tone_map.h"
#include "tabulated.h"

namespace etendue {
namespace {

// AgX, after T. Sobotka (github.com/sobotka/AgX-S2O3): three steps, with a curve that is applied to each component of a colour.
//  1. The colour is expressed in a space whose primaries lie 1 / (1 - 0.2) times as far from white as the display's. So colours
//     that the display can show have no component that is zero, and most other colours none that is negative. For sRGB the
//     matrix from one space to the other is the published "inset" (0.8424, 0.0784, 0.0792; ...).
//  2. The logarithm to base 2 over middle grey, from -10 to 6.5 stops, becomes x in [0, 1]; a sigmoid of it is the code value
//     y of a display whose light is y^2.2. It goes from 0 to 1, through 1/2 with the slope a at middle grey, x_0 = 10 / 16.5:
//       y = 1/2 + s t / (1 + |t|^p)^(1/p),   t = a (x - x_0) / s,
//     p = 3 below and 3.25 above middle grey. With d the distance of an end from x_0, the second term is 1/2 at this end if
//       s = a d ((2 a d)^p - 1)^(-1/p).
//     Sobotka has a = 2. With a = 16.5 ln 2 / (2 * 2.2) = 2.6 the light of the display changes near middle grey by the same
//     factor as that of the scene (d ln y^2.2 = 2.2 a / (16.5 y) d log2 L), as it does without tone mapping.
//  3. The code values are converted from the wide space back to the display's (B. Wrensch, "Minimal AgX implementation", 2023,
//     whose polynomial is a fit to the sigmoid with a = 2). Without this "outset" middle tones are paler than in the scene.
// Because the curve is applied to each component, saturated colours approach white as they get brighter, as on film, instead of
// remaining at the most saturated colour of the space.
constexpr double middle_grey = 0.18, lowest_stops = -10, highest_stops = 6.5, widening = 1 / (1 - 0.2), display_power = 2.2;

class Sigmoid {
 public:
  explicit Sigmoid(double slope) : slope_(slope), below_(scale(pivot, toe)), above_(scale(1 - pivot, shoulder)) {}

  /// Code value in [0, 1] of a component of light.
  double operator()(double light) const {
    if (!(light > 0)) return 0;
    const double stops = std::clamp(std::log2(light / middle_grey), lowest_stops, highest_stops);
    const double d = (stops - lowest_stops) / (highest_stops - lowest_stops) - pivot;
    return std::clamp(0.5 + (d < 0 ? -half(-d, below_, toe) : half(d, above_, shoulder)), 0.0, 1.0);
  }

  static constexpr double pivot = -lowest_stops / (highest_stops - lowest_stops), toe = 3, shoulder = 3.25;

 private:
  double half(double d, double s, double power) const {
    const double t = slope_ * d / s;
    return s * t / std::pow(1 + std::pow(t, power), 1 / power);
  }
  double scale(double d, double power) const { return slope_ * d * std::pow(std::pow(2 * slope_ * d, power) - 1, -1 / power); }

  double slope_, below_, above_;
};

class AgXToneMap final : public ExposedToneMap {
  float contrast = 2.6f;

 public:
  static void describe(Description<AgXToneMap>& d) {
    d.summary(
         "A filmic curve over 16.5 stops: middle grey stays, shadows and lights are compressed, and bright saturated colours "
         "go to white instead of being clipped. Most colours beyond the RGB space are drawn in; hues stay near what they are.",
         "T. Sobotka, AgX; B. Wrensch 2023, Minimal AgX implementation")
        // The slope of a straight line from middle grey to white is 1 / (2 * 6.5 / 16.5) = 1.27; an S is steeper.
        .group("Curve")
        .member<&AgXToneMap::contrast>("contrast", "1",
                                       "slope of the curve at middle grey: 2 is the original's, which is soft; 2.6 keeps "
                                       "contrasts there as they are in the scene",
                                       range(1.3, 10), Effect::retone, soft(1.3, 5));
  }

 protected:
  void develop(Image& xyz) const override {
    const RgbSpace& space = rgb_space(color_space);
    auto primaries = space.primaries;
    for (auto& p : primaries)
      for (size_t i = 0; i < 2; ++i) p[i] = space.white[i] + widening * (p[i] - space.white[i]);
    const RgbSpace wide = make_rgb_space("the wide one of AgX", primaries, space.white);
    const ColorMatrix outset = space.from_xyz * wide.to_xyz;
    const Sigmoid sigmoid{double(contrast)};
    const Tabulated code(int(lowest_stops), 7, [&](double x) { return sigmoid(x * middle_grey); });
    const Tabulated light(-12, 0, [](double y) { return std::pow(y, display_power); });
    over_range(xyz.values.size() / 3, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) {
        double* v = &xyz.values[3 * i];
        ColorTriple c = wide.from_xyz * ColorTriple{v[0], v[1], v[2]};
        for (double& x : c) x = code(x / middle_grey);
        c = outset * c;
        for (double& x : c) x = light(std::min(x, 1.0));
        c = space.to_xyz * c;
        std::copy(c.begin(), c.end(), v);
      }
    });
  }
};

static const Register<AgXToneMap> registered;

}  // namespace
}  // namespace etendue
