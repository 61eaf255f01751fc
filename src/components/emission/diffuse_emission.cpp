// DiffuseEmission: the same radiance in all directions.

#include "etendue/core/warp.h"
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

  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    if (p.normal == Normal3{}) return {warp::sphere(u), warp::sphere_pdf};
    float side = sides == Sides::back ? -1.0f : 1.0f, probability = 1;
    if (sides == Sides::both) {
      probability = 0.5f;
      side = u.x < 0.5f ? 1.0f : -1.0f;
      u.x = std::min(u.x < 0.5f ? 2 * u.x : 2 * u.x - 1, one_minus_epsilon);
    }
    const Vector3 local = warp::cosine_hemisphere(u);
    const Frame frame(p.normal);
    return {side * frame.to_world(local), probability * warp::cosine_hemisphere_pdf(local.z)};
  }
  float pdf(const SurfacePoint& p, const Vector3& direction) const override {
    if (p.normal == Normal3{}) return warp::sphere_pdf;
    if (!emits(p, direction)) return 0;
    return (sides == Sides::both ? 0.5f : 1.0f) * inverse_pi * std::abs(dot(p.normal, direction));
  }

 protected:
  float profile(const SurfacePoint&, const Vector3&) const override { return 1; }
  double solid_angle() const override { return 4 * pi_exactly; }
  double surface_share(const SurfacePoint&) const override { return (sides == Sides::both ? 2 : 1) * pi_exactly; }
  bool same_on_surfaces() const override { return true; }
};

const Register<DiffuseEmission> registered;

}  // namespace
}  // namespace etendue
