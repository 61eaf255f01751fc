// Surroundings: the medium around all other objects.

#include <fmt/format.h>

#include "etendue/infinite_object.h"

namespace etendue {
namespace {

// Its inside is all of space. Paths begin in it and never cross its surface, since it has none: MediumStack keeps it below all
// objects that paths enter. An unbounded medium blocks all light from infinity. A bounded one lets light through; it fills only
// a sphere around the scene, wherever a ray begins (transport/medium_interval.h).
class Surroundings final : public SurroundingObject {
 public:
  static void describe(Description<Surroundings>& d) {
    d.summary(
         "What all other objects stand in, such as fog or the sea: it has no surface, and its inside is all of space that no "
         "other object fills, whatever their priorities. Its interior is the medium there, and of its shader the index of "
         "refraction counts alone.")
        .group("Shape")
        .member<&Surroundings::relative_reach>(
            "reach", "1",
            "how far from the scene's centre it goes, in radii of the sphere around all objects that have an end; 0: it has no "
            "end, and light from infinity does not get through what it is filled with",
            at_least(0), soft(0, 100));
  }

  void prepare() override {
    if (!(relative_reach >= 0 && relative_reach < infinity)) fail("reach", "must be finite and not negative");
    if (relative_reach > 0 && relative_reach < 1) fail("reach", "below 1 the medium would end before the scene does");
    if (emission) fail("emission", "surroundings have no surface that could emit; their medium may");
    if (!interior || relative_reach > 0) return;
    if (!interior->homogeneous())
      fail("interior", "a medium that differs from place to place needs an end: give a reach, or let a Box be filled with it");
    if (interior->emits()) refuse_endless_light();
  }

  /// Stores the radius of the sphere that the medium fills.
  void enclose(const Point3& centre, float radius) override { InfiniteObject::enclose(centre, relative_reach * radius); }

  float reach(const Ray& ray) const override {
    if (relative_reach == 0) return infinity;
    // The ray's exit from the sphere, computed in double as in Sphere; 0 for a ray that misses the sphere.
    double a = 0, b = 0, c = -double(radius_) * double(radius_);
    for (int k = 0; k < 3; ++k) {
      const double d = double(ray.direction[k]), o = double(ray.origin[k]) - double(centre_[k]);
      a += d * d;
      b += d * o;
      c += o * o;
    }
    const double squared = b * b - a * c;
    if (!(squared >= 0)) return 0;
    const double root = std::sqrt(squared);
    return float(std::max(0.0, b > 0 ? -c / (b + root) : (root - b) / a));
  }

  float relative_reach = 0;

 private:
  /// Throws Error if the medium emits at a wavelength at which its extinction is zero: an unbounded medium would have infinite
  /// radiance.
  void refuse_endless_light() const {
    for (int first = 360; first <= 830; first += spectrum_size) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i) w.place(i, float(std::min(first + i, 830)), 1);
      const VolumeCoefficients c = interior->coefficients({}, 0, w);
      const Spectrum extinction = c.extinction();
      for (int i = 0; i < spectrum_size; ++i)
        if (c.emission[i] > 0 && !(extinction[i] > 0))
          fail("interior",
               fmt::format("its medium shines at {} nm and absorbs nothing there: without end it would be endlessly bright; "
                           "give a reach",
                           std::min(first + i, 830)));
    }
  }
};

const Register<Surroundings> registered;

}  // namespace
}  // namespace etendue
