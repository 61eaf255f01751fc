#include "color_matrix.h"
#include "etendue/describe/color.h"
#include "etendue/exposed_tone_map.h"

namespace etendue {
namespace {

// The reference rendering of ACES 1.0 for a display of 48 cd/m^2 in a dim room, by S. Hill's fit (BakingLab, 2017): in
// ACEScg (AP1), with 4 % of the saturation taken away before the curve and 7 % after it (RRT_SAT_FACTOR = 0.96 and
// ODT_SAT_FACTOR = 0.93 of the Academy's transforms), each component goes through
//   (v (v + 0.0245786) - 0.000090537) / (v (0.983729 v + 0.4329510) + 0.238081).
// The white of the display's space is adapted to that of AP1 before, and back afterwards (Bradford's chromatic adaptation).
// Hill's matrices for sRGB are the products of these steps.
ColorMatrix with_saturation(const RgbSpace& space, double s) {
  ColorMatrix m;
  for (size_t i = 0; i < 3; ++i)
    for (size_t k = 0; k < 3; ++k) m[3 * i + k] = (1 - s) * space.to_xyz[3 + k] + (i == k ? s : 0);
  return m;
}

/// Chromatic adaptation: the matrix from X Y Z under one white to the X Y Z of the same appearance under another white. The
/// responses of the cones are scaled.
ColorMatrix bradford(const std::array<double, 2>& from, const std::array<double, 2>& to) {
  constexpr ColorMatrix cones = {0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296};
  constexpr ColorMatrix back = {0.9869929, -0.1470543, 0.1599627, 0.4323053, 0.5183603,
                                0.0492912, -0.0085287, 0.0400428, 0.9684867};
  const auto seen = [&](const std::array<double, 2>& w) {
    return cones * ColorTriple{w[0] / w[1], 1, (1 - w[0] - w[1]) / w[1]};
  };
  const ColorTriple a = seen(from), b = seen(to);
  return back * (ColorMatrix{b[0] / a[0], 0, 0, 0, b[1] / a[1], 0, 0, 0, b[2] / a[2]} * cones);
}

double curve(double v) {
  if (!(v > 0)) return 0;
  if (v > 1e9) return 1 / 0.983729;
  return std::max(0.0, (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

class AcesToneMap final : public ExposedToneMap {
 public:
  static void describe(Description<AcesToneMap>& d) {
    d.summary(
        "The look of the Academy's colour encoding, ACES 1.0: a filmic curve with much contrast, in which middle grey becomes "
        "a tenth of white. Saturated bright colours go towards white, reds towards orange; what is left outside the RGB "
        "space is clipped.",
        "S. Hill 2017, fit of the ACES RRT and ODT");
  }

 protected:
  void develop(Image& xyz) const override {
    const RgbSpace &space = rgb_space(color_space), &ap1 = rgb_space("acescg");
    const ColorMatrix in = with_saturation(ap1, 0.96) * (ap1.from_xyz * bradford(space.white, ap1.white));
    const ColorMatrix out = bradford(ap1.white, space.white) * (ap1.to_xyz * with_saturation(ap1, 0.93));
    for (size_t i = 0; i + 2 < xyz.values.size(); i += 3) {
      double* v = &xyz.values[i];
      ColorTriple c = in * ColorTriple{v[0], v[1], v[2]};
      for (double& x : c) x = curve(x);
      c = out * c;
      std::copy(c.begin(), c.end(), v);
    }
  }
};

static const Register<AcesToneMap> registered;

}  // namespace
}  // namespace etendue
