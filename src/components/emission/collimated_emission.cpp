// CollimatedEmission: a beam of small divergence, like a laser's.

#include "axial_emission.h"

namespace etendue {
namespace {

// Profile f = 1 for h <= H, where H = 1 - cos(divergence), else 0 (AxialEmission); Omega = 2 pi H, and directions are sampled
// uniformly in the cone, with pdf 1 / Omega.
//
// Without divergence the directional distribution would be a delta function, and only paths that start at the beam could
// sample it. With a divergence all values are finite: at 0.1 degrees Omega = 9.6e-6 sr, so a beam of 1 W from 1 mm^2 has the
// radiance 1e11 W m^-2 sr^-1, and every algorithm can render it. Algorithms that sample the light from surface points hit the
// beam rarely, with large contributions; those that start at the light (light tracing, bidirectional path tracing) sample the
// illuminated surface with every path.
class CollimatedEmission final : public AxialEmission {
 public:
  CollimatedEmission() { about = About::normal; }

  static void describe(Description<CollimatedEmission>& d) {
    d.summary(
         "A beam like a laser's: the same radiance within a small cone about the surface's normal, or about an axis, and none "
         "beyond. Its divergence is not zero, so that its densities are finite and every renderer can deal with it; those that "
         "start at the light do so best.")
        .group("Light")
        .member<&CollimatedEmission::map>("radiance", "W m^-2 sr^-1 nm^-1",
                                          "radiance within the beam; only its shape counts when an amount is given",
                                          Meaning::radiance, soft(0.01, 1000), logarithmic);
    describe_amounts(d);
    d.group("Beam")
        .member<&CollimatedEmission::divergence>("divergence", "deg", "half of the cone's angle", range(1e-3, 10), logarithmic)
        .member<&CollimatedEmission::about>("about", "", "what the beam is about; a Point, which has no normal, takes the axis",
                                            choices("normal", "axis"))
        .member<&CollimatedEmission::axis>("axis", "1",
                                           "the way the beam travels, in the object's own coordinates; of any length");
  }

  void prepare() override {
    const double s = std::sin(double(divergence) * (3.14159265358979323846 / 360));
    height_ = float(2 * s * s);
    if (!(height_ > 0)) fail("divergence", "must be more than 0");
    solid_angle_ = 2 * pi * height_;
    prepare_axis();
    prepare_amounts("radiance");
  }

  float divergence = 0.1f;

 protected:
  // Directions have rounding errors of about 6e-8, which blur the cone's border: by 3e-5 of the beam's width at a divergence of
  // 0.1 degrees, by 4e-3 at 1e-3 degrees.
  float fall_off(float h) const override { return h <= height_ ? 1 : 0; }
  double solid_angle() const override { return double(solid_angle_); }
  double outer() const override { return double(height_); }
  float draw(float u, bool) const override { return height_ * u; }
  float drawn(float h, bool) const override { return h <= height_ ? 1 / solid_angle_ : 0; }

 private:
  float height_ = 0;       // H
  float solid_angle_ = 0;  // Omega [sr]
};

const Register<CollimatedEmission> registered;

}  // namespace
}  // namespace etendue
