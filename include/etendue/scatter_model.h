#pragma once
// ScatterModel: the base of a Scatter whose local functions are called without virtual calls.

#include "etendue/scatter_answers.h"

namespace etendue {

/// The base of a model that is evaluated often (the curiously recurring template pattern): `class MyScatter final : public
/// ScatterModel<MyScatter>`, with public local functions. Each public function of Scatter is then a single virtual call. The
/// compiler inlines the local functions into it and omits the computation of arguments that the model does not use.
template <class Model>
class ScatterModel : public Scatter {
 protected:
  using Scatter::Scatter;
  ~ScatterModel() = default;

 private:
  using Answers = ScatterAnswers<Model>;
  const Model& model() const { return static_cast<const Model&>(*this); }

  Spectrum world_evaluate(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const final {
    return Answers::evaluate(model(), out, in, transport, which);
  }
  float world_pdf(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const final {
    return Answers::pdf(model(), out, in, transport, which);
  }
  ScatterValue world_value_and_pdf(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const final {
    return Answers::value_and_pdf(model(), out, in, transport, which);
  }
  std::optional<ScatterSample> world_sample(const Vector3& out, float choice, Point2 u, Transport transport,
                                            Lobes which) const final {
    return Answers::sample(model(), out, choice, u, transport, which);
  }
  Spectrum world_albedo(const Vector3& out, Lobes which) const final { return Answers::albedo(model(), out, which); }
};

}  // namespace etendue
