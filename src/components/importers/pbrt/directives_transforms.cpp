// Transforms, named coordinate systems, and the two times of motion.

#include <cmath>

#include "directives.h"

namespace etendue::pbrt {

void Directives::apply(const Transform& t) {
  for (size_t i = 0; i < 2; ++i)
    if (r.state.active & (1u << i)) r.state.ctm[i] = r.state.ctm[i] * t;
}

void Directives::put(const std::array<Transform, 2>& to) {
  for (size_t i = 0; i < 2; ++i)
    if (r.state.active & (1u << i)) r.state.ctm[i] = to[i];
}

Transform Directives::matrix() {
  const auto m = numbers<16>();
  // Column-major. The last row should be (0, 0, 0, 1); it does not affect directions, and so not the lights at infinity.
  if (std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) > 1e-9 * std::abs(m[15]) || m[15] == 0)
    r.importing.inexact("the last row of a matrix, which makes a perspective, is left out: for directions nothing is changed",
                        at_);
  const double w = m[15] == 0 ? 1 : m[15];
  Transform::DoubleMatrix rows{m[0], m[4], m[8], m[12], m[1], m[5], m[9], m[13], m[2], m[6], m[10], m[14]};
  for (double& x : rows) x /= w;
  return Transform(rows);
}

void Directives::identity() { put({}); }

void Directives::translate() {
  const auto n = numbers<3>();
  apply(Transform::translate({n[0], n[1], n[2]}));
}

void Directives::scale() {
  const auto n = numbers<3>();
  apply(Transform::scale({n[0], n[1], n[2]}));
}

void Directives::rotate() {
  const auto n = numbers<4>();
  if (n[1] == 0 && n[2] == 0 && n[3] == 0) throw Error("an axis of rotation cannot be zero", at_);
  apply(Transform::rotate(n[0] * 3.14159265358979323846 / 180, {n[1], n[2], n[3]}));
}

void Directives::look_at() {
  const auto n = numbers<9>();
  const DoubleVector3 way{n[3] - n[0], n[4] - n[1], n[5] - n[2]}, up{n[6], n[7], n[8]}, side = cross(up, way);
  const auto length = [](const DoubleVector3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); };
  if (!(length(side) > 1e-12 * length(up) * length(way)))
    throw Error("LookAt needs two different points and an up direction that is not along the view", at_);
  // The same matrix as in this program, although pbrt's +x points to the right in the image and ours to the left.
  apply(Transform::look_at({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, up).inverse());
}

void Directives::transform() {
  const Transform t = matrix();
  put({t, t});
}

void Directives::concat_transform() { apply(matrix()); }

void Directives::coordinate_system() { named_systems_[text()] = r.state.ctm; }

void Directives::coordinate_system_transform() {
  const std::string name = text();
  const auto found = named_systems_.find(name);
  if (found != named_systems_.end())
    put(found->second);
  else
    r.importing.inexact(fmt::format("there is no coordinate system '{}': the transform stays what it is, as in pbrt", name),
                        at_);
}

void Directives::transform_times() {
  need_options();
  const auto n = numbers<2>();
  r.times = n;
}

void Directives::active_transform() {
  const Token t = lexer().next();
  const std::string_view which = t.text;
  if (which == "StartTime")
    r.state.active = 1;
  else if (which == "EndTime")
    r.state.active = 2;
  else if (which == "All")
    r.state.active = 3;
  else
    throw Error("ActiveTransform is of StartTime, EndTime or All", t.end() ? at_ : lexer().place(t));
}

}  // namespace etendue::pbrt
