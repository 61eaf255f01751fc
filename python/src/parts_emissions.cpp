// Emissions that are written in Python.

#include "components/emission/any_radiance.h"
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
    if (!defines(sample_name)) return any_radiance::sample(*this, p, u);
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
    if (!defines(sample_name)) return any_radiance::pdf(*this, p, direction);
    if (!emits(p, direction)) return 0;
    const PartCall call(*this, pdf_name);
    return float(to_number(call(PointArgument(p), tuple_of(direction)), call.called));
  }

  Spectrum power(const SceneObject& object, const Wavelengths& w) const override {
    constexpr int calls = 2048;
    if (!defines(power_name)) return any_radiance::power(*this, object, w, calls);
    std::array<float, spectrum_size> lambda;
    for (int i = 0; i < spectrum_size; ++i) lambda[size_t(i)] = w[i];
    const PartCall call(*this, power_name);
    return to_spectrum(call(number(double(object.area())), tuple_of_numbers(lambda)), call.called);
  }

  bool only_at_infinity() const override { return truth_of(*this, only_at_infinity_name, false); }
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
