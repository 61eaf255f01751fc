// An emission out of tree: the disc of a star, which is darker towards its limb than in the middle.
#include "etendue/core/spectral_function.h"
#include "etendue/core/warp.h"
#include "etendue/describe/description.h"
#include "etendue/emission_shader.h"
#include "etendue/scene_object.h"

using namespace etendue;

// The linear law of limb darkening: with m = cos(theta) to the normal, the radiance is L f, f = 1 - a (1 - m); L is that of the
// middle of the disc, and a = 0.6 that of a grey atmosphere in Eddington's approximation (Milne 1921). On each side that emits,
//     K = integral of f m dw = 2 pi ((1 - a) / 2 + a / 3) = pi (1 - a / 3)  [sr],
// so that the power of an area A is K A L. Directions are sampled with the pdf f m / K [1/sr]. This is a mixture of m / pi,
// with the probability pi (1 - a) / K, and of 3 m^2 / (2 pi).
//
// A star seen as a point, or from infinity, has no disc: its radiance is the mean over the disc, L K / pi, in all directions.
class LimbDarkenedEmission final : public EmissionShader {
  Color radiance_ = flat_spectrum(1);
  float darkening = 0.6f;

 public:
  static void describe(Description<LimbDarkenedEmission>& d) {
    d.summary("The disc of a star: darker towards the limb.", "Milne 1921, Radiative equilibrium in the outer layers of a star")
        .member<&LimbDarkenedEmission::radiance_>("radiance", "W m^-2 sr^-1 nm^-1", "radiance in the middle of the disc",
                                                  Meaning::radiance, soft(0.01, 1000), logarithmic)
        .member<&LimbDarkenedEmission::darkening>("darkening", "1", "how much darker the limb is than the middle", range(0, 1));
  }
  void prepare() override {
    if (!radiance_) fail("radiance", "is none");
    if (radiance_->imaginary()) fail("radiance", "must be real; this is a complex index of refraction");
    const ValueRange values = range_of(*radiance_, ColorUse::radiance);
    if (!(values.least >= 0 && values.most < infinity)) fail("radiance", "must be neither negative nor infinite");
    share_ = pi * (1 - darkening / 3);
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    if (!emits(p, direction)) return {};
    return radiance_->evaluate(w, ColorUse::radiance) * (has_disc(p) ? profile(cosine(p, direction)) : share_ / pi);
  }
  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    if (p.normal == Normal3{}) return {warp::sphere(u), warp::sphere_pdf};
    float side = sides == Sides::back ? -1.0f : 1.0f;
    if (sides == Sides::both) side = choose(u.y, 0.5f) ? 1.0f : -1.0f;
    const bool first = choose(u.x, pi * (1 - darkening) / share_);
    const Vector3 local = warp::power_cosine({1 - u.x, u.y}, first ? 1.0f : 2.0f);
    const Vector3 direction = side * Frame(p.normal).to_world(local);
    return {direction, pdf(p, direction)};
  }
  float pdf(const SurfacePoint& p, const Vector3& direction) const override {
    if (p.normal == Normal3{}) return warp::sphere_pdf;
    if (!emits(p, direction)) return 0;
    const float m = cosine(p, direction);
    return (sides == Sides::both ? 0.5f : 1.0f) * profile(m) * m / share_;
  }
  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    if (object.infinite() && sides == Sides::back) return {};
    const float emitting_sides = sides == Sides::both && !object.infinite() && !object.delta() ? 2.0f : 1.0f;
    return radiance_->evaluate(w, ColorUse::radiance) * (emitting_sides * share_ * object.area());
  }

 private:
  static bool has_disc(const SurfacePoint& p) { return !(p.normal == Normal3{}) && !(p.object && p.object->infinite()); }
  static float cosine(const SurfacePoint& p, const Vector3& v) { return std::min(std::abs(dot(p.normal, v)), 1.0f); }
  float profile(float m) const { return 1 - darkening * (1 - m); }
  /// Whether u < probability; u becomes a uniform number again.
  static bool choose(float& u, float probability) {
    const bool chosen = u < probability;
    u = std::min(chosen ? u / probability : (u - probability) / (1 - probability), one_minus_epsilon);
    return chosen;
  }

  float share_ = pi;  // K [sr]
};

static const Register<LimbDarkenedEmission> registered;
