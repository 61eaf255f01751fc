// DiffuseEmission: the same radiance in all directions.

#include "any_radiance.h"
#include "shaped_emission.h"

namespace etendue {
namespace {

constexpr double pi_exactly = 3.14159265358979323846;

// The profile is f = 1 (ShapedEmission). A surface that emits from s sides has K = s * integral of cos dw = s pi.
class DiffuseEmission final : public ShapedEmission {
 public:
  static void describe(Description<DiffuseEmission>& d) {
    d.summary("Light that leaves with the same radiance in all directions.", "Lambert 1760, Photometria")
        .group("Light")
        .member<&DiffuseEmission::map>("radiance", "W m^-2 sr^-1 nm^-1",
                                       "radiance per wavelength; only its shape counts when an amount is given",
                                       Meaning::radiance, soft(0.01, 1000), logarithmic);
    describe_amounts(d);
  }

  void prepare() override { prepare_amounts("radiance"); }

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    return emits(p, direction) ? scaled(p, w, 1) : Spectrum();
  }

  DirectionSample sample(const SurfacePoint& p, Point2 u) const override { return any_radiance::sample(*this, p, u); }
  float pdf(const SurfacePoint& p, const Vector3& direction) const override { return any_radiance::pdf(*this, p, direction); }

 protected:
  float profile(const SurfacePoint&, const Vector3&) const override { return 1; }
  double solid_angle() const override { return 4 * pi_exactly; }
  double surface_share(const SurfacePoint&) const override { return (sides == Sides::both ? 2 : 1) * pi_exactly; }
  bool same_on_surfaces() const override { return true; }
};

const Register<DiffuseEmission> registered;

}  // namespace
}  // namespace etendue
