// DiffuseEmission: the same radiance in all directions.

#include "emission/per_object.h"
#include "etendue/emission_shader.h"
#include "etendue/object_map.h"
#include "etendue/scene_object.h"
#include "etendue/warp.h"

namespace etendue {
namespace {

// A surface of area A that emits radiance L in all directions of s sides sends out, at each wavelength, the power
// Phi = integral of L cos dw dA = pi s A mean(L)  [W/nm].
// When a total power P is asked for, L = k M with M what the map says, and P = integral of Phi over the wavelengths gives
// k = P / (pi s A integral of mean(M) dlambda).  A is the object's and, for a moving object, its area at that time, so a shader
// shared by several objects gives each of them the power P.
//
// mean(M) is exact for a map of one colour. For others it is the mean over points chosen by area on the object, found
// when an object is first met: at that time objects are prepared, as they are not yet when shaders are.
class DiffuseEmission final : public EmissionShader {
 public:
  static void describe(Description<DiffuseEmission>& d) {
    d.summary("Light that leaves with the same radiance in all directions.", "Lambert 1760, Photometria")
        .member<&DiffuseEmission::map>("radiance", "W m^-2 sr^-1 nm^-1",
                                       "radiance per wavelength; only its shape counts when a power is given")
        .member<&DiffuseEmission::watts>(
            "power", "W",
            "power of each object that has this emission, from its whole area, between 360 and 830 nm; 0: as the radiance says",
            at_least(0));
  }

  void prepare() override {
    if (!map) fail("radiance", "a map or a colour is needed");
    constant_ = map->constant();
    integral_ = 0;
    if (constant_) {
      // Values at 1 nm, by the trapezoid rule: tables are linear between those.
      double sum = 0;
      for (float lambda = wavelength_low; lambda <= wavelength_high; lambda += 1) {
        const double value = constant_->at(lambda, ColorUse::radiance);
        if (!(value >= 0 && std::isfinite(value)))
          fail("radiance", "must be neither negative nor infinite, and is " + std::to_string(value) + " at " +
                               std::to_string(int(lambda)) + " nm");
        sum += lambda == wavelength_low || lambda == wavelength_high ? value / 2 : value;
      }
      if (watts > 0 && !(sum > 0)) fail("radiance", "is black, so it cannot have the shape of the spectrum of a power");
      integral_ = sum;
    } else if (watts > 0) {
      measured_.reset();
    }
  }

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    if (!emits(p, direction)) return {};
    const Spectrum value = map->color(p, w, ColorUse::radiance);
    return watts > 0 && p.object ? value * scale(*p.object, p.time) : value;
  }

  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    if (p.normal == Normal3{}) return {warp::sphere(u), warp::sphere_density};
    float side = sides == Sides::back ? -1.0f : 1.0f, probability = 1;
    if (sides == Sides::both) {
      probability = 0.5f;
      side = u.x < 0.5f ? 1.0f : -1.0f;
      u.x = std::min(u.x < 0.5f ? 2 * u.x : 2 * u.x - 1, one_minus_epsilon);
    }
    const Vector3 local = warp::cosine_hemisphere(u);
    const Frame frame(p.normal);
    return {side * frame.to_world(local), probability * warp::cosine_hemisphere_density(local.z)};
  }
  float density(const SurfacePoint& p, const Vector3& direction) const override {
    if (p.normal == Normal3{}) return warp::sphere_density;
    if (!emits(p, direction)) return 0;
    return (sides == Sides::both ? 0.5f : 1.0f) * inverse_pi * std::abs(dot(p.normal, direction));
  }

  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    const float area = object.area();
    if (!(area > 0)) return {};
    const Spectrum mean = constant_ ? constant_->evaluate(w, ColorUse::radiance) : mean_radiance(object, w);
    return mean * (pi * side_count(object) * area * (watts > 0 ? scale(object, 0) : 1));
  }

  Ref<ObjectMap> map = constant(1.0f);
  double watts = 0;

 private:
  /// Of a point, which stands for a shrunk sphere, the inside does not count.
  float side_count(const SceneObject& object) const { return !object.delta() && sides == Sides::both ? 2.0f : 1.0f; }

  float scale(const SceneObject& object, float time) const {
    const double below =
        double(pi) * double(side_count(object)) * double(object.area(time)) * (constant_ ? integral_ : measure(object));
    return below > 0 ? float(watts / below) : 0;
  }

  /// mean(M) at some wavelengths, from 1024 points of the object.
  Spectrum mean_radiance(const SceneObject& object, const Wavelengths& w) const {
    constexpr int side = 32;
    Spectrum sum;
    float weights = 0;
    for (int i = 0; i < side; ++i)
      for (int k = 0; k < side; ++k) {
        const SurfaceSample s = object.sample_area({(float(i) + 0.5f) / side, (float(k) + 0.5f) / side}, 0);
        if (!(s.density > 0)) continue;
        sum += map->color(s.point, w, ColorUse::radiance) / s.density;
        weights += 1 / s.density;
      }
    return weights > 0 ? sum / weights : Spectrum();
  }

  double measure(const SceneObject& object) const {
    return measured_.get(object, [&] { return integrate(object); });
  }

  /// The integral of mean(M) over wavelengths, at the middle of 48 equal steps.
  double integrate(const SceneObject& object) const {
    constexpr int sets = 48 / spectrum_size;
    constexpr float step = (wavelength_high - wavelength_low) / (sets * spectrum_size);
    double sum = 0;
    for (int set = 0; set < sets; ++set) {
      Wavelengths w;
      for (int i = 0; i < spectrum_size; ++i)
        w.place(i, wavelength_low + (float(i * sets + set) + 0.5f) * step, 1 / (wavelength_high - wavelength_low));
      sum += double(mean_radiance(object, w).average()) * spectrum_size * double(step);
    }
    return sum;
  }

  Color constant_;
  double integral_ = 0;  // of the one colour over wavelengths
  PerObject measured_;
};

const Register<DiffuseEmission> registered;

}  // namespace
}  // namespace etendue
