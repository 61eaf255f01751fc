// Rows of the table: step, linearstep, smoothstep, smooth_linearstep and aastep.

#include "choose.h"
#include "numbers.h"
#include "parts.h"

namespace etendue::osl {

namespace {

inline float quotient(float a, float b) { return safe_divide(a, b); }
inline Dual<float> quotient(const Dual<float>& a, const Dual<float>& b) { return a / b; }

struct Step {
  static float apply(float edge, float x) { return x < edge ? 0.0f : 1.0f; }
};

struct LinearStep {
  template <class N>
  static N apply(const N& low, const N& high, const N& x) {
    if (value_of(low) == value_of(high)) return N(Step::apply(value_of(low), value_of(x)));
    return clamped(N(quotient(x - low, high - low)), N(0), N(1));
  }
};

/// 3 t^2 - 2 t^3 between the edges.
struct SmoothStep {
  template <class N>
  static N apply(const N& low, const N& high, const N& x) {
    if (value_of(x) < value_of(low)) return N(0);
    if (value_of(x) >= value_of(high)) return N(1);
    const N t = quotient(x - low, high - low);
    return (N(3) - (t + t)) * (t * t);
  }
};

/// The linear step between low and high whose corners are rounded by parabolas of half width eps.
struct SmoothLinearStep {
  template <class N>
  static N apply(const N& low, const N& high, const N& x_, const N& eps_) {
    if (value_of(low) == value_of(high)) return N(Step::apply(value_of(low), value_of(x_)));
    const N inverse = quotient(N(1), high - low), eps = eps_ * inverse, x = (x_ - low) * inverse;
    const auto ramp = [&](const N& from) { return quotient(from * from, N(4) * eps); };
    const float at = value_of(x), radius = value_of(eps);
    if (at <= -radius) return N(0);
    if (at >= radius && at <= 1 - radius) return x;
    if (at >= 1 + radius) return N(1);
    if (at < radius) return ramp(x + eps);
    return N(1) - ramp(N(1) + eps - x);
  }
};

/// The length of the two derivatives: how much x changes between neighbouring samples.
float filter_width(const Dual<float>& x) { return std::sqrt(x.dx * x.dx + x.dy * x.dy); }

/// aastep(edge, s [, ds]), aastep(edge, s, dedge, ds): the mean of step over a box as wide as both change. The widths count as
/// constants in the derivatives.
struct SmoothedStep {
  template <bool D>
  static void evaluate(const Call& c) {
    using N = Number<float, D>;
    const N edge = c.get<N>(0), s = c.get<N>(1);
    const float edge_width = c.count() == 4 ? c.at<float>(2) : filter_width(c.get<Dual<float>>(0));
    const float s_width = c.count() > 2 ? c.at<float>(c.count() - 1) : filter_width(c.get<Dual<float>>(1));
    const float width = std::abs(edge_width) + std::abs(s_width), half = 0.5f * width;
    if (value_of(s) <= value_of(edge) - half) return c.give(N(0));
    if (value_of(s) >= value_of(edge) + half) return c.give(N(1));
    c.give(quotient(s - edge + N(half), N(width)));
  }
};

constexpr Derivatives taken = Derivatives::taken;

constexpr Row rows[] = {
    {"TYPE step(TYPE edge, TYPE x)", by_component_constant<Step, 2>, Derivatives::none},
    {"TYPE linearstep(TYPE low, TYPE high, TYPE x)", by_component<LinearStep, 3>},
    {"TYPE smoothstep(TYPE low, TYPE high, TYPE x)", by_component<SmoothStep, 3>},
    {"TYPE smooth_linearstep(TYPE low, TYPE high, TYPE x, TYPE eps)", by_component<SmoothLinearStep, 4>},
    {"float aastep(float edge, float s)", with_derivatives<SmoothedStep>, taken, 3},
    {"float aastep(float edge, float s, float ds)", with_derivatives<SmoothedStep>, taken, 1},
    {"float aastep(float edge, float s, float dedge, float ds)", with_derivatives<SmoothedStep>},
};

}  // namespace

std::span<const Row> step_rows() { return rows; }

}  // namespace etendue::osl
