// Emissions that are written in Python.

#include "etendue/core/warp.h"
#include "etendue/emission_shader.h"
#include "etendue/numbers.h"
#include "etendue/scene_object.h"
#include "parts_points.h"

namespace etendue::python {

namespace {

const MethodName radiance_name("radiance"), sample_name("sample"), pdf_name("pdf"), power_name("power"),
    only_at_infinity_name("only_at_infinity");

/// Without `sample` and `pdf` directions are sampled in proportion to the cosine with the normal, on the sides that emit.
/// Without `power` it is the mean of radiance |cos| area / pdf over points and directions of a regular pattern.
class PythonEmission final : public PartOf<EmissionShader> {
 public:
  using PartOf::PartOf;

  Spectrum radiance(const SurfacePoint& p, const Vector3& direction, const Wavelengths& w) const override {
    if (!emits(p, direction)) return {};
    std::array<float, spectrum_size> lambda;
    for (int i = 0; i < spectrum_size; ++i) lambda[size_t(i)] = w[i];
    const PartCall call(*this, radiance_name);
    return to_spectrum(call(PointArgument(p), tuple_of(direction), tuple_of_numbers(lambda)), call.called);
  }

  DirectionSample sample(const SurfacePoint& p, Point2 u) const override {
    if (!defines(sample_name)) return cosine_sample(p, u);
    const PartCall call(*this, sample_name);
    const nb::object returned = call(PointArgument(p), tuple_of(u));
    static const std::string wanted = "a direction and its pdf [1/sr]: ((x, y, z), pdf)";
    if (!PyTuple_Check(returned.ptr()) || PyTuple_Size(returned.ptr()) != 2) call.called.refuse(returned, wanted);
    DirectionSample s;
    s.direction = to_vector(PyTuple_GetItem(returned.ptr(), 0), call.called, "a direction of three finite numbers");
    s.pdf = float(to_number(PyTuple_GetItem(returned.ptr(), 1), call.called));
    if (s.pdf < 0) call.called.refuse(returned, "a pdf that is not negative");
    return s;
  }

  float pdf(const SurfacePoint& p, const Vector3& direction) const override {
    if (!defines(sample_name)) return cosine_pdf(p, direction);
    if (!emits(p, direction)) return 0;
    const PartCall call(*this, pdf_name);
    return float(to_number(call(PointArgument(p), tuple_of(direction)), call.called));
  }

  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    if (!defines(power_name)) return object.infinite() ? power_from_infinity(object, w) : power_of_points(object, w);
    std::array<float, spectrum_size> lambda;
    for (int i = 0; i < spectrum_size; ++i) lambda[size_t(i)] = w[i];
    const PartCall call(*this, power_name);
    return to_spectrum(call(number(double(object.area())), tuple_of_numbers(lambda)), call.called);
  }

  bool only_at_infinity() const override { return truth_of(*this, only_at_infinity_name, false); }

 private:
  DirectionSample cosine_sample(const SurfacePoint& p, Point2 u) const {
    if (p.normal == Normal3{}) return {warp::sphere(u), warp::sphere_pdf};
    float side = sides == Sides::back ? -1.0f : 1.0f;
    if (sides == Sides::both) {
      side = u.x < 0.5f ? 1.0f : -1.0f;
      u.x = std::min(u.x < 0.5f ? 2 * u.x : 2 * u.x - 1, one_minus_epsilon);
    }
    const Vector3 direction = side * Frame(p.normal).to_world(warp::cosine_hemisphere(u));
    return {direction, cosine_pdf(p, direction)};
  }
  float cosine_pdf(const SurfacePoint& p, const Vector3& direction) const {
    if (p.normal == Normal3{}) return warp::sphere_pdf;
    if (!emits(p, direction)) return 0;
    return (sides == Sides::both ? 0.5f : 1.0f) * inverse_pi * std::abs(dot(p.normal, direction));
  }

  static constexpr int pattern_size = 2048;
  /// Four numbers of the R sequence (Roberts 2018): i times powers of the inverse of the root of x^5 = x + 1, modulo 1.
  static std::array<float, 4> pattern(int i) {
    constexpr double root = 1.1673039782614187;
    std::array<float, 4> u{};
    double step = 1;
    for (float& x : u) {
      step /= root;
      x = std::min(float(std::fmod(0.5 + step * (i + 1), 1.0)), one_minus_epsilon);
    }
    return u;
  }

  Spectrum power_of_points(const SceneObject& object, const Wavelengths& w) const {
    Spectrum sum;
    for (int i = 0; i < pattern_size; ++i) {
      const std::array<float, 4> u = pattern(i);
      const SurfaceSample at = object.sample_area({u[0], u[1]}, 0);
      const DirectionSample s = sample(at.point, {u[2], u[3]});
      if (!(at.pdf > 0) || !(s.pdf > 0)) continue;
      const float cosine = object.delta() ? 1 : std::abs(dot(at.point.normal, s.direction));
      sum += radiance(at.point, s.direction, w) * (cosine / (at.pdf * s.pdf));
    }
    return sum / float(pattern_size);
  }

  /// Of parallel light from each direction: radiance times the projected area of the scene's bounding sphere, a quarter of its
  /// surface area.
  Spectrum power_from_infinity(const SceneObject& object, const Wavelengths& w) const {
    Spectrum sum;
    for (int i = 0; i < pattern_size; ++i) {
      const std::array<float, 4> u = pattern(i);
      Ray ray;
      ray.direction = warp::sphere({u[0], u[1]});
      SurfacePoint p;
      object.surface_point(ray, {}, p);
      sum += radiance(p, -ray.direction, w);
    }
    return sum * (object.area() * pi / float(pattern_size));
  }
};

}  // namespace

PartInterface emission_interface() {
  return {
      "EmissionShader",
      make_part<PythonEmission>,
      {{"radiance", "self, point, direction, wavelengths",
        "emitted radiance [W m^-2 sr^-1 nm^-1] in a unit direction away from the surface; from infinity, against the direction "
        "that light comes from. Asked on the sides that emit only"},
       {"sample", "self, point, u", "a direction of emission and its pdf [1/sr]; by default in proportion to the cosine"},
       {"pdf", "self, point, direction", "the pdf [1/sr] of `sample`"},
       {"power", "self, area, wavelengths",
        "the power [W/nm] of an object of an area [m^2]; by default integrated numerically"},
       {"only_at_infinity", "self", "whether only objects at infinity may have it; False by default"},
       prepare_method},
      {{"radiance"}},
      {"sample", "pdf"}};
}

}  // namespace etendue::python
