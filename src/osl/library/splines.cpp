// Rows of the table: spline and splineinverse.

#include <fmt/format.h>

#include "choose.h"
#include "numbers.h"
#include "parts.h"
#include "services.h"

namespace etendue::osl {

namespace {

/// A cubic basis: the weight of knot k of a segment at t in [0, 1] is the polynomial with coefficients rows[0][k] t^3 +
/// rows[1][k] t^2 + rows[2][k] t + rows[3][k]. Segments begin `step` knots apart.
struct Basis {
  const char* name;
  int step;
  float rows[4][4];
};

constexpr float sixth = 1.0f / 6;

constexpr Basis bases[] = {
    {"catmull-rom", 1, {{-0.5f, 1.5f, -1.5f, 0.5f}, {1, -2.5f, 2, -0.5f}, {-0.5f, 0, 0.5f, 0}, {0, 1, 0, 0}}},
    {"bezier", 3, {{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}},
    {"bspline", 1, {{-sixth, 0.5f, -0.5f, sixth}, {0.5f, -1, 0.5f, 0}, {-0.5f, 0, 0.5f, 0}, {sixth, 4 * sixth, sixth, 0}}},
    {"hermite", 2, {{2, 1, -2, 1}, {-3, -2, 3, -1}, {0, 1, 0, 0}, {1, 0, 0, 0}}},
    {"linear", 1, {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, -1, 1, 0}, {0, 1, 0, 0}}},
    {"constant", 1, {{0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 1, 0, 0}}},
};

const Basis& basis_named(const Call& c, const String* name) {
  for (const Basis& b : bases)
    if (name->view() == b.name) return b;
  c.services.error(fmt::format("Unknown spline basis \"{}\"", name->text()), c.types.place);
  return bases[4];
}

/// The knots of a call: an array, or separate arguments. (basis, x, y[]), (basis, x, n, y[]), (basis, x, y0, y1, y2, y3, ...)
struct Knots {
  const Call& call;
  int first = 2, count = 0;
  bool array = false;

  explicit Knots(const Call& c) : call(c) {
    if (c.type(2).is_int() && c.count() > 3 && c.type(3).is_array()) first = 3;
    array = c.type(first).is_array();
    count = array ? c.type(first).elements() : c.count() - first;
    if (array && first == 3) count = std::min(c.at<int>(2), count);
  }

  /// Component k of the i-th.
  template <class N>
  N get(int i, int k) const {
    if (!array) return call.type(first + i).is_int() ? N(float(call.at<int>(first + i))) : component<N>(call, first + i, k);
    const Type& type = call.type(first);
    const int size = type.floats(), block = size * type.elements();
    const float* p = static_cast<const float*>(call.arguments[first]) + i * size + (size == 3 ? k : 0);
    if constexpr (is_dual<N>)
      return call.derivatives(first) ? N(p[0], p[block], p[2 * block]) : N(p[0]);
    else
      return *p;
  }

  bool enough(int needed = 4) const {
    if (count >= needed) return true;
    call.services.error(fmt::format("A spline needs at least {} knots, not {}", needed, count), call.types.place);
    return false;
  }
};

int segments_of(const Basis& basis, int knots) { return (knots - 4) / basis.step + 1; }

/// Where on which segment x in [0, 1] is.
template <class N>
struct Located {
  int first = 0;  ///< knot of the segment
  N t;

  Located(const Basis& basis, int knots, const N& x) {
    const int segments = segments_of(basis, knots);
    const N along = clamped(x, N(0), N(1)) * N(float(segments));
    const int segment = std::clamp(int(value_of(along)), 0, segments - 1);
    t = along - N(float(segment));
    first = segment * basis.step;
  }
};

template <class N>
N at(const Basis& basis, const Knots& knots, const Located<N>& where, int k) {
  const N t = where.t;
  N sum(0);
  for (int i = 0; i < 4; ++i) {
    const auto row = [&](int r) { return N(basis.rows[r][i]); };
    sum = sum + (((row(0) * t + row(1)) * t + row(2)) * t + row(3)) * knots.get<N>(where.first + i, k);
  }
  return sum;
}

/// A number that is not one counts as 0, so that no knot outside is read.
template <class N>
N number_or_zero(const N& x) {
  return value_of(x) == value_of(x) ? x : N(0);
}

struct Spline {
  template <bool D>
  static void evaluate(const Call& c) {
    using N = Number<float, D>;
    const Basis& basis = basis_named(c, c.string(0));
    const Knots knots(c);
    const int size = c.types.result.type.is_triple() ? 3 : 1;
    const bool enough = knots.enough();
    for (int k = 0; k < size; ++k) {
      N value(0);
      if (enough) value = at(basis, knots, Located<N>(basis, knots.count, number_or_zero(c.get<N>(1))), k);
      detail::set<N>(static_cast<float*>(c.result) + k, size, value);
    }
  }
};

/// The x in [low, high], a segment's range, where the spline has value v, by bisection; false if there is none.
bool solve(const Basis& basis, const Knots& knots, float v, float low, float high, float& x) {
  const auto value = [&](float at_x) { return at(basis, knots, Located<float>(basis, knots.count, at_x), 0); };
  const float a = value(low), b = value(high);
  if (!(std::min(a, b) <= v && v <= std::max(a, b))) return false;
  const bool rising = a < b;
  for (int i = 0; i < 40 && high - low > 1e-7f * std::max(high, 1e-3f); ++i) {
    const float middle = 0.5f * (low + high);
    ((value(middle) < v) == rising ? low : high) = middle;
  }
  x = 0.5f * (low + high);
  return true;
}

float inverse(const Basis& basis, const Knots& knots, float v) {
  const bool inner = basis.step == 1;  // the first and last knot are not interpolated
  const float first = knots.get<float>(inner ? 1 : 0, 0), last = knots.get<float>(knots.count - (inner ? 2 : 1), 0);
  const bool rising = knots.get<float>(1, 0) < knots.get<float>(knots.count - 2, 0);
  if (rising ? v <= first : v >= first) return 0;
  if (rising ? v >= last : v <= last) return 1;
  // Monotonic knots can have a curve that is not: each segment is searched by itself.
  const int segments = segments_of(basis, knots.count);
  float x = 0;
  for (int s = 0; s < segments; ++s)
    if (solve(basis, knots, v, float(s) / float(segments), float(s + 1) / float(segments), x)) break;
  return x;
}

/// dx/dv = 1 / spline'(x).
struct SplineInverse {
  template <bool D>
  static void evaluate(const Call& c) {
    using N = Number<float, D>;
    const Basis& basis = basis_named(c, c.string(0));
    const Knots knots(c);
    if (!knots.enough()) return c.give(N(0));
    const N v = number_or_zero(c.get<N>(1));
    const float x = inverse(basis, knots, value_of(v));
    if constexpr (D) {
      const Dual<float> along(x, 1, 0);
      const float slope = at(basis, knots, Located<Dual<float>>(basis, knots.count, along), 0).dx;
      c.give(chain(x, x > 0 && x < 1 ? safe_divide(1, slope) : 0, v));
    } else {
      c.give(x);
    }
  }
};

constexpr Row rows[] = {
    {"TYPE spline(string basis, float x, TYPE y[])", with_derivatives<Spline>, Derivatives::passed, 0, nullptr, false},
    {"TYPE spline(string basis, float x, int knots, TYPE y[])", with_derivatives<Spline>, Derivatives::passed, 0, nullptr,
     false},
    {"TYPE spline(string basis, float x, TYPE y0, TYPE y1, TYPE y2, TYPE y3, ...)", with_derivatives<Spline>,
     Derivatives::passed, 0, nullptr, false},
    {"float splineinverse(string basis, float v, float y[])", with_derivatives<SplineInverse>, Derivatives::passed, 0, nullptr,
     false},
    {"float splineinverse(string basis, float v, int knots, float y[])", with_derivatives<SplineInverse>, Derivatives::passed,
     0, nullptr, false},
    {"float splineinverse(string basis, float v, float y0, float y1, float y2, float y3, ...)", with_derivatives<SplineInverse>,
     Derivatives::passed, 0, nullptr, false},
};

}  // namespace

std::span<const Row> spline_rows() { return rows; }

}  // namespace etendue::osl
