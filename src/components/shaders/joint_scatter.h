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
  ~JointScatter() = default;
};

}  // namespace etendue
