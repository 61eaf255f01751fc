// Hyperboloid: a hyperboloid of one sheet, the shape of a cooling tower.

#include "revolved_quadric.h"

namespace etendue {
namespace {

// The side is x^2 + y^2 = w^2 + s z^2 with s = (R^2 - w^2) / (h/2)^2. With p = sqrt(s (1 + s)) / w its area between the waist
// and z is 2 pi times the integral of sqrt(f + f'^2 / 4) = w sqrt(1 + p^2 z^2),
//   pi w (z sqrt(1 + p^2 z^2) + asinh(p z) / p).
class Hyperboloid final : public RevolvedQuadric {
 public:
  static void describe(Description<Hyperboloid>& d) {
    d.summary(
         "A hyperboloid of revolution of one sheet about the z axis, from -height/2 to height/2 with its waist at z = 0: what "
         "a "
         "straight line sweeps that turns around an axis it does not meet. On its side u goes around from +x towards +y, over "
         "the sweep, and v up; on its caps they are as on a Disc, u backwards on what faces down.",
         "intersection with quadrics: Hearn & Baker 2004")
        .group("Shape")
        .member<&Hyperboloid::waist_radius>("waist_radius", "m", "in the middle, where it is narrowest", more_than(0),
                                            Effect::rebuild, soft(0.01, 100), logarithmic)
        .member<&Hyperboloid::radius>("radius", "m", "at its ends; at least that of the waist", more_than(0), Effect::rebuild,
                                      soft(0.01, 100), logarithmic)
        .member<&Hyperboloid::height>("height", "m", "its length along z", more_than(0), Effect::rebuild, soft(0.01, 100),
                                      logarithmic)
        .member<&Hyperboloid::caps>("caps", "", "whether discs close its ends", Effect::rebuild)
        .member<&Hyperboloid::sweep>("sweep", "deg",
                                     "how much of a turn there is, from x towards y; less than all of it is open",
                                     Range{0, 360, true}, Effect::rebuild);
  }

  void prepare() override {
    if (!(waist_radius > 0 && waist_radius < infinity)) fail("waist_radius", "must be positive and finite");
    if (!(radius < infinity)) fail("radius", "must be finite");
    if (!(radius >= waist_radius)) fail("radius", "must not be smaller than waist_radius");
    if (!(height > 0 && height < infinity)) fail("height", "must be positive and finite");
    const double w = double(waist_radius), r = double(radius), half = 0.5 * double(height);
    const double square = (r - w) * (r + w) / (half * half);
    steepness_ = std::sqrt(square * (1 + square)) / w;
    half_integral_ = integral(half);
    revolve({.square = square,
             .linear = 0,
             .constant = w * w,
             .low = -half,
             .high = half,
             .low_radius = r,
             .high_radius = r,
             .low_cap = caps,
             .high_cap = caps,
             .side_area = 2 * M_PI * w * half_integral_,
             .convex = false});
  }

  float waist_radius = 0.5f, radius = 1, height = 2;
  bool caps = true;

 protected:
  double height_at(double share) const override {
    const double wanted = std::abs(2 * share - 1) * half_integral_, half = profile().high;
    // The integral is convex, so Newton's method started to the right of the root converges monotonically.
    double z = half;
    for (int i = 0; i < 60; ++i) {
      const double step = (integral(z) - wanted) / (2 * std::hypot(1, steepness_ * z));
      z -= step;
      if (!(step > 1e-13 * half)) break;
    }
    return std::copysign(std::clamp(z, 0.0, half), share - 0.5);
  }

 private:
  /// z sqrt(1 + p^2 z^2) + asinh(p z) / p, for z >= 0.
  double integral(double z) const {
    const double x = steepness_ * z;
    return z * (std::hypot(1, x) + (x > 1e-8 ? std::asinh(x) / x : 1));
  }

  double steepness_ = 1;      // p above [1/m]
  double half_integral_ = 1;  // from the waist to an end [m]
};

const Register<Hyperboloid> registered;

}  // namespace
}  // namespace etendue
