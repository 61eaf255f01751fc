// Rows of the table: derivatives and what is made of them.

#include "choose.h"
#include "numbers.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

/// Dx and Dy: block `which` of the argument. Second derivatives are not known: those of the result are zero.
template <int which>
void derivative(const Call& c) {
  const int size = c.type(0).floats();
  const float* from = static_cast<const float*>(c.arguments[0]) + which * size;
  float* to = static_cast<float*>(c.result);
  for (int k = 0; k < size; ++k) to[k] = which && c.derivatives(0) ? from[k] : 0;
  detail::no_derivatives(c);
}

void filter_width(const Call& c) {
  const int size = c.type(0).floats();
  float* to = static_cast<float*>(c.result);
  for (int k = 0; k < size; ++k) {
    const Dual<float> x = component<Dual<float>>(c, 0, k);
    to[k] = std::sqrt(x.dx * x.dx + x.dy * x.dy);
  }
  detail::no_derivatives(c);
}

void area(const Call& c) {
  const auto p = c.get<Dual<Triple>>(0);
  c.give(length(cross(p.dx, p.dy)));
}

void calculate_normal(const Call& c) {
  const auto p = c.get<Dual<Triple>>(0);
  c.give(c.services.flipped_handedness() ? cross(p.dy, p.dx) : cross(p.dx, p.dy));
}

constexpr Derivatives taken = Derivatives::taken, none = Derivatives::none;

constexpr Row rows[] = {
    {"float Dx(float x)", always<derivative<1>>, taken},
    {"vector Dx(point x)", always<derivative<1>>, taken},
    {"vector Dx(vector x)", always<derivative<1>>, taken},
    {"vector Dx(normal x)", always<derivative<1>>, taken},
    {"color Dx(color x)", always<derivative<1>>, taken},
    {"float Dy(float x)", always<derivative<2>>, taken},
    {"vector Dy(point x)", always<derivative<2>>, taken},
    {"vector Dy(vector x)", always<derivative<2>>, taken},
    {"vector Dy(normal x)", always<derivative<2>>, taken},
    {"color Dy(color x)", always<derivative<2>>, taken},
    // There is no third direction at surfaces.
    {"float Dz(float x)", always<derivative<0>>, none},
    {"vector Dz(point x)", always<derivative<0>>, none},
    {"vector Dz(vector x)", always<derivative<0>>, none},
    {"vector Dz(normal x)", always<derivative<0>>, none},
    {"color Dz(color x)", always<derivative<0>>, none},
    {"float filterwidth(float x)", always<filter_width>, taken},
    {"vector filterwidth(point x)", always<filter_width>, taken},
    {"vector filterwidth(vector x)", always<filter_width>, taken},
    {"float area(point p)", always<area>, taken},
    {"vector calculatenormal(point p)", always<calculate_normal>, taken, 0, nullptr, false},
};

}  // namespace

std::span<const Row> derivative_rows() { return rows; }

}  // namespace etendue::osl
