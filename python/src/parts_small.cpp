// Filters and phase functions that are written in Python.

#include "etendue/filter.h"
#include "etendue/phase_function.h"
#include "parts_points.h"

namespace etendue::python {

namespace {

const MethodName weight_name("weight"), radius_name("radius"), value_name("value"), sample_name("sample");

class PythonFilter final : public PartOf<Filter> {
 public:
  using PartOf::PartOf;
  float weight(float x, float y) const override {
    const PartCall call(*this, weight_name);
    return float(to_number(call(number(double(x)), number(double(y))), call.called));
  }
  float radius() const override { return number_of(*this, radius_name, 1); }
};

class PythonPhaseFunction final : public PartOf<PhaseFunction> {
 public:
  using PartOf::PartOf;
  float value(float h) const override {
    const PartCall call(*this, value_name);
    return float(to_number(call(number(double(h))), call.called));
  }
  float sample(float u) const override {
    const PartCall call(*this, sample_name);
    return float(to_number(call(number(double(u))), call.called));
  }
};

}  // namespace

PartInterface filter_interface() {
  return {"Filter",
          make_part<PythonFilter>,
          {{"weight", "self, x, y", "the weight of a sample at an offset from the pixel's centre [pixels]"},
           {"radius", "self", "half the width of the support [pixels]"},
           prepare_method},
          {{"weight"}, {"radius"}}};
}

PartInterface phase_function_interface() {
  return {"PhaseFunction",
          make_part<PythonPhaseFunction>,
          {{"value", "self, h", "the pdf of the direction [1/sr] at h = 1 - cos(scattering angle)"},
           {"sample", "self, u", "h for a uniform number, in proportion to `value`"},
           prepare_method},
          {{"value"}, {"sample"}}};
}

}  // namespace etendue::python
