// Paraboloid: a paraboloid of revolution, such as a parabolic mirror.

#include "revolved_quadric.h"

namespace etendue {
namespace {

// The side is x^2 + y^2 = c z with c = R^2 / h. Its area below z is 2 pi times the integral of sqrt(f + f'^2 / 4), that is
// pi c^2 / 6 ((1 + 4 z / c)^(3/2) - 1).
class Paraboloid final : public RevolvedQuadric {
 public:
  static void describe(Description<Paraboloid>& d) {
    d.summary(
         "A paraboloid of revolution with its vertex at the origin, open towards +z; its focus is at z = radius^2 / (4 "
         "height). "
         "u goes around from +x towards +y, over the sweep, and v with the distance from the axis, up to 1 at the rim; on the "
         "cap "
         "they are as on a Disc. The outside is in front.",
         "intersection with quadrics: Hearn & Baker 2004")
        .group("Shape")
        .member<&Paraboloid::radius>("radius", "m", "at its rim", more_than(0), Effect::rebuild, soft(0.01, 100), logarithmic)
        .member<&Paraboloid::height>("height", "m", "from vertex to rim along z", more_than(0), Effect::rebuild,
                                     soft(0.01, 100), logarithmic)
        .member<&Paraboloid::cap>("cap", "", "whether a disc closes it", Effect::rebuild)
        .member<&Paraboloid::sweep>("sweep", "deg",
                                    "how much of a turn there is, from x towards y; less than all of it is open",
                                    Range{0, 360, true}, Effect::rebuild);
  }

  void prepare() override {
    if (!(radius > 0 && radius < infinity)) fail("radius", "must be positive and finite");
    if (!(height > 0 && height < infinity)) fail("height", "must be positive and finite");
    const double r = double(radius), h = double(height);
    scale_ = r * r / h;
    // (1 + x)^(3/2) - 1, without cancellation for a flat bowl.
    whole_ = std::expm1(1.5 * std::log1p(4 * h / scale_));
    revolve({.square = 0,
             .linear = scale_,
             .constant = 0,
             .low = 0,
             .high = h,
             .low_radius = 0,
             .high_radius = r,
             .low_cap = false,
             .high_cap = cap,
             .side_area = M_PI / 6 * scale_ * scale_ * whole_});
  }

  float radius = 1, height = 1;
  bool cap = true;

 protected:
  double height_at(double share) const override { return scale_ / 4 * std::expm1(std::log1p(share * whole_) * (2.0 / 3)); }
  /// v is proportional to the radius: if it were proportional to the height, dpdv would be infinite at the vertex.
  Along along_profile(double, double r) const override {
    const double v = r / double(radius);
    return {v, 2 * double(height) * v, double(radius)};
  }

 private:
  double scale_ = 1, whole_ = 1;  // c above [m], and the area in units of pi c^2 / 6
};

const Register<Paraboloid> registered;

}  // namespace
}  // namespace etendue
