// Cylinder: a circular cylinder about the z axis.

#include "revolved_quadric.h"

namespace etendue {
namespace {

class Cylinder final : public RevolvedQuadric {
 public:
  static void describe(Description<Cylinder>& d) {
    d.summary(
         "A circular cylinder about the z axis, from -height/2 to height/2. On its side u goes around from +x towards +y, over "
         "the sweep, and v up; on its caps they are as on a Disc, u backwards on what faces down.",
         "intersection with quadrics: Hearn & Baker 2004")
        .group("Shape")
        .member<&Cylinder::radius>("radius", "m", "its radius", more_than(0), Effect::rebuild, soft(0.01, 100), logarithmic)
        .member<&Cylinder::height>("height", "m", "its length along z", more_than(0), Effect::rebuild, soft(0.01, 100),
                                   logarithmic)
        .member<&Cylinder::caps>("caps", "", "whether discs close its ends", Effect::rebuild)
        .member<&Cylinder::sweep>("sweep", "deg", "how much of a turn there is, from x towards y; less than all of it is open",
                                  Range{0, 360, true}, Effect::rebuild);
  }

  void prepare() override {
    if (!(radius > 0 && radius < infinity)) fail("radius", "must be positive and finite");
    if (!(height > 0 && height < infinity)) fail("height", "must be positive and finite");
    const double r = double(radius), half = 0.5 * double(height);
    revolve({.square = 0,
             .linear = 0,
             .constant = r * r,
             .low = -half,
             .high = half,
             .low_radius = r,
             .high_radius = r,
             .low_cap = caps,
             .high_cap = caps,
             .side_area = 4 * M_PI * r * half,
             .tube = true});
  }

  float radius = 1, height = 1;
  bool caps = true;

 protected:
  double height_at(double share) const override { return profile().low + share * (profile().high - profile().low); }
};

const Register<Cylinder> registered;

}  // namespace
}  // namespace etendue
