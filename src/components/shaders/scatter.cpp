// Scatter's public calls for models that define the local functions only.

#include "etendue/scatter_answers.h"

namespace etendue {

using Answers = ScatterAnswers<Scatter>;

Spectrum Scatter::world_evaluate(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const {
  return Answers::evaluate(*this, out, in, transport, which);
}
float Scatter::world_pdf(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const {
  return Answers::pdf(*this, out, in, transport, which);
}
ScatterValue Scatter::world_value_and_pdf(const Vector3& out, const Vector3& in, Transport transport, Lobes which) const {
  return Answers::value_and_pdf(*this, out, in, transport, which);
}
std::optional<ScatterSample> Scatter::world_sample(const Vector3& out, float choice, Point2 u, Transport transport,
                                                   Lobes which) const {
  return Answers::sample(*this, out, choice, u, transport, which);
}
Spectrum Scatter::world_albedo(const Vector3& out, Lobes which) const { return Answers::albedo(*this, out, which); }

}  // namespace etendue
