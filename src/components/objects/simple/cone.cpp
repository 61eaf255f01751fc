// Cone: a cone or a truncated cone about the z axis.

#include "revolved_quadric.h"

namespace etendue {
namespace {

// With radii r0 at the base and r1 at the top the side is x^2 + y^2 = (r0 + k z)^2, k = (r1 - r0) / h, and the fraction of the
// area below a ring of radius r is (r^2 - r0^2) / (r1^2 - r0^2). Written with r + r0 instead of (r^2 - r0^2) / (r - r0), this
// has no cancellation, and a cone that is nearly a cylinder is no special case.
class Cone final : public RevolvedQuadric {
 public:
  static void describe(Description<Cone>& d) {
    d.summary(
         "A circular cone about the z axis with its base at z = 0, pointed or cut off at its height. On its side u goes around "
         "from +x towards +y, over the sweep, and v up; on its caps they are as on a Disc, u backwards on what faces down.",
         "intersection with quadrics: Hearn & Baker 2004")
        .group("Shape")
        .member<&Cone::radius>("radius", "m", "of its base", at_least(0), Effect::rebuild, soft(0, 100))
        .member<&Cone::top_radius>("top_radius", "m", "at its height; 0: a point", at_least(0), Effect::rebuild, soft(0, 100))
        .member<&Cone::height>("height", "m", "from base to top along z", more_than(0), Effect::rebuild, soft(0.01, 100),
                               logarithmic)
        .member<&Cone::caps>("caps", "", "whether discs close its ends", Effect::rebuild)
        .member<&Cone::sweep>("sweep", "deg", "how much of a turn there is, from x towards y; less than all of it is open",
                              Range{0, 360, true}, Effect::rebuild);
  }

  void prepare() override {
    if (!(radius >= 0 && radius < infinity)) fail("radius", "must not be negative, and finite");
    if (!(top_radius >= 0 && top_radius < infinity)) fail("top_radius", "must not be negative, and finite");
    if (!(height > 0 && height < infinity)) fail("height", "must be positive and finite");
    if (radius == 0 && top_radius == 0) fail("radius", "one of the two radii must be positive");
    r0_ = double(radius);
    r1_ = double(top_radius);
    const double h = double(height), k = (r1_ - r0_) / h;
    revolve({.square = k * k,
             .linear = 2 * r0_ * k,
             .constant = r0_ * r0_,
             .low = 0,
             .high = h,
             .low_radius = r0_,
             .high_radius = r1_,
             .low_cap = caps && r0_ > 0,
             .high_cap = caps && r1_ > 0,
             .side_area = M_PI * (r0_ + r1_) * std::hypot(h, r1_ - r0_)});
  }

  float radius = 1, top_radius = 0, height = 1;
  bool caps = true;

 protected:
  double height_at(double share) const override {
    const double r = std::sqrt(r0_ * r0_ + share * (r1_ * r1_ - r0_ * r0_));
    return r + r0_ > 0 ? profile().high * share * (r0_ + r1_) / (r + r0_) : 0;
  }

 private:
  double r0_ = 1, r1_ = 0;  // radii of base and top
};

const Register<Cone> registered;

}  // namespace
}  // namespace etendue
