#pragma once
// JointScatter: base class of models that compute f and the pdf together, in local_value_and_pdf.

#include "etendue/scatter_model.h"

namespace etendue {

template <class Model>
class JointScatter : public ScatterModel<Model> {
 public:
  ScatterValue local_value_and_pdf(const Vector3& out, const Vector3& in, Lobes) const = delete;  // the model's is called
  Spectrum local_evaluate(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return this->model().local_value_and_pdf(out, in, lobes).value;
  }
  float local_pdf(const Vector3& out, const Vector3& in, Lobes lobes) const {
    return this->model().local_value_and_pdf(out, in, lobes).pdf;
  }

 protected:
  using ScatterModel<Model>::ScatterModel;
  /// Sets the value and the pdf of a sample in the direction s.in from those of all lobes together; returns whether the
  /// direction has a pdf.
  static bool complete(LocalSample& s, const ScatterValue& both) {
    s.value = both.value * std::abs(s.in.z);
    s.pdf = both.pdf;
    return s.pdf > 0;
  }
  ~JointScatter() = default;
};

}  // namespace etendue
