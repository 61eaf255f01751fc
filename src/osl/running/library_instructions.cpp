// Short functions of the library as instructions. Each formula is that of the library (mathematics.cpp, geometry.cpp,
// steps.cpp, numbers.h), with its branches as selections: the numbers are the same to the bit, which tests check.

#include <limits>
#include <string_view>
#include <unordered_map>

#include "coded_numbers.h"
#include "library_code.h"

namespace etendue::osl {
namespace {

// ---- numbers -------------------------------------------------------------------------------------------------------------

/// A constant like x, with zero derivatives.
Real constant(Real x, float f) { return x.like(f); }
Dual<Real> constant(const Dual<Real>& x, float f) { return {x.value.like(f), x.value.like(0), x.value.like(0)}; }
/// A value of the same kind as `like`, with zero derivatives.
Real without_derivatives(Real, Real x) { return x; }
Dual<Real> without_derivatives(const Dual<Real>&, Real x) { return {x, x.like(0), x.like(0)}; }

Dual<Real> chain(Real value, Real slope, const Dual<Real>& u) { return {value, slope * u.dx, slope * u.dy}; }
Dual<Real> chain(Real value, Real by_u, const Dual<Real>& u, Real by_v, const Dual<Real>& v) {
  return {value, by_u * u.dx + by_v * v.dx, by_u * u.dy + by_v * v.dy};
}

using Unary = float (*)(float);
using Binary = float (*)(float, float);
Real called(Unary f, Real x) {
  return coded<Real>(*x.code, x.code->call_pure(reinterpret_cast<const void*>(f), WordKind::float_, std::span(&x.word, 1)));
}
Real called(Binary f, Real x, Real y) {
  const Word words[] = {x.word, y.word};
  return coded<Real>(*x.code, x.code->call_pure(reinterpret_cast<const void*>(f), WordKind::float_, words));
}

Real sqrt(Real x) { return function(Code::Function::square_root, x); }
Real floor(Real x) { return function(Code::Function::floor, x); }
Real sqrt_or_zero(Real x) { return select(x > x.like(0), sqrt(x), x.like(0)); }
Real inversesqrt_or_zero(Real x) { return select(x > x.like(0), divided(x.like(1), sqrt(x)), x.like(0)); }
Dual<Real> sqrt_or_zero(const Dual<Real>& x) {
  const Real root = sqrt_or_zero(x.value), zero = root.like(0);
  return chain(root, select(root > zero, divided(root.like(0.5f), root), zero), x);
}
/// As std::clamp.
Real between(Real x, float low, float high) {
  return select(x < x.like(low), x.like(low), select(x.like(high) < x, x.like(high), x));
}
Real at_least_smallest(Real x) {
  const Real least = x.like(std::numeric_limits<float>::min());
  return select(x < least, least, x);
}

template <class N>
N minimum(const N& a, const N& b) {
  return select(value_of(a) <= value_of(b), a, b);
}
template <class N>
N maximum(const N& a, const N& b) {
  return select(value_of(a) > value_of(b), a, b);
}
template <class N>
N clamped(const N& x, const N& low, const N& high) {
  return maximum(minimum(x, high), low);
}

// ---- smooth functions of one number: value(x), and slope(x, value) -------------------------------------------------------

constexpr float pi = 3.14159265358979323846f;

#define ETENDUE_OSL_CODED(NAME, VALUE, SLOPE)                                             \
  struct NAME {                                                                           \
    static Real value(Real x) { return VALUE; }                                           \
    static Real slope([[maybe_unused]] Real x, [[maybe_unused]] Real y) { return SLOPE; } \
    static Real apply(Real x) { return value(x); }                                        \
    static Dual<Real> apply(const Dual<Real>& x) {                                        \
      const Real y = value(x.value);                                                      \
      return chain(y, slope(x.value, y), x);                                              \
    }                                                                                     \
  };

ETENDUE_OSL_CODED(Radians, x* x.like(pi / 180), x.like(pi / 180))
ETENDUE_OSL_CODED(Degrees, x* x.like(180 / pi), x.like(180 / pi))
ETENDUE_OSL_CODED(Cosine, called(&std::cos, x), -called(&std::sin, x))
ETENDUE_OSL_CODED(Sine, called(&std::sin, x), called(&std::cos, x))
ETENDUE_OSL_CODED(Tangent, called(&std::tan, x), x.like(1) + y * y)
ETENDUE_OSL_CODED(ArcCosine, called(&std::acos, between(x, -1, 1)), -inversesqrt_or_zero(x.like(1) - x * x))
ETENDUE_OSL_CODED(ArcSine, called(&std::asin, between(x, -1, 1)), inversesqrt_or_zero(x.like(1) - x * x))
ETENDUE_OSL_CODED(ArcTangent, called(&std::atan, x), divided(x.like(1), x.like(1) + x * x))
ETENDUE_OSL_CODED(Exponential, called(&std::exp, x), y)
ETENDUE_OSL_CODED(Exponential2, called(&std::exp2, x), y* x.like(0.69314718056f))
ETENDUE_OSL_CODED(Logarithm, called(&std::log, at_least_smallest(x)), select(x > x.like(0), divided(x.like(1), x), x.like(0)))
ETENDUE_OSL_CODED(SquareRoot, sqrt_or_zero(x), select(y > y.like(0), divided(y.like(0.5f), y), y.like(0)))
ETENDUE_OSL_CODED(InverseSquareRoot, inversesqrt_or_zero(x), x.like(-0.5f) * y * y * y)
ETENDUE_OSL_CODED(Absolute, function(Code::Function::absolute, x), select(x < x.like(0), x.like(-1), x.like(1)))

#undef ETENDUE_OSL_CODED

// ---- functions whose derivatives are zero --------------------------------------------------------------------------------

template <Code::Function f>
struct Rounded {
  static Real apply(Real x) { return function(f, x); }
};
struct Sign {
  static Real apply(Real x) {
    const Real zero = x.like(0);
    return select(x > zero, x.like(1), select(x < zero, x.like(-1), zero));
  }
};
struct Step {
  static Real apply(Real edge, Real x) { return select(x < edge, x.like(0), x.like(1)); }
};

// ---- functions of several numbers ----------------------------------------------------------------------------------------

struct Power {
  static Real value(Real x, Real y) {
    constexpr float largest = std::numeric_limits<float>::max();
    const Real zero = x.like(0), usual = between(called(&std::pow, x, y), -largest, largest);
    return select(y == zero, x.like(1), select(x == zero, zero, select(x < zero && y != floor(y), zero, usual)));
  }
  static Real apply(Real x, Real y) { return value(x, y); }
  static Dual<Real> apply(const Dual<Real>& x, const Dual<Real>& y) {
    const Real v = value(x.value, y.value), zero = v.like(0);
    return chain(v, y.value * value(x.value, y.value - v.like(1)), x,
                 select(x.value > zero, v * called(&std::log, x.value), zero), y);
  }
};
struct FlooredRemainder {
  static Real apply(Real a, Real b) { return select(b == b.like(0), a, a - b * floor(divided(a, b))); }
  static Dual<Real> apply(const Dual<Real>& a, const Dual<Real>& b) {
    const Real zero = b.value.like(0), n = select(b.value == zero, zero, floor(divided(a.value, b.value)));
    return {a.value - b.value * n, a.dx - b.dx * n, a.dy - b.dy * n};
  }
};
struct TruncatedRemainder {
  static Real apply(Real a, Real b) { return select(b == b.like(0), b.like(0), called(&std::fmod, a, b)); }
  static Dual<Real> apply(const Dual<Real>& a, const Dual<Real>& b) {
    const Real zero = b.value.like(0);
    const Real n = select(b.value == zero, zero, function(Code::Function::truncate, divided(a.value, b.value)));
    return {apply(a.value, b.value), a.dx - b.dx * n, a.dy - b.dy * n};
  }
};
struct Minimum {
  template <class N>
  static N apply(const N& a, const N& b) {
    return minimum(a, b);
  }
};
struct Maximum {
  template <class N>
  static N apply(const N& a, const N& b) {
    return maximum(a, b);
  }
};
struct Clamp {
  template <class N>
  static N apply(const N& x, const N& low, const N& high) {
    return clamped(x, low, high);
  }
};
struct Mix {
  template <class N>
  static N apply(const N& x, const N& y, const N& a) {
    return x * (constant(a, 1) - a) + y * a;
  }
};
struct Select {
  template <class N>
  static N apply(const N& x, const N& y, const N& condition) {
    return select(value_of(condition) != value_of(condition).like(0), y, x);
  }
};
struct LinearStep {
  template <class N>
  static N apply(const N& low, const N& high, const N& x) {
    const N hard = without_derivatives(x, Step::apply(value_of(low), value_of(x)));
    return select(value_of(low) == value_of(high), hard, clamped(N((x - low) / (high - low)), constant(x, 0), constant(x, 1)));
  }
};
struct SmoothStep {
  template <class N>
  static N apply(const N& low, const N& high, const N& x) {
    const N t = (x - low) / (high - low);
    const N between = (constant(x, 3) - (t + t)) * (t * t);
    return select(value_of(x) < value_of(low), constant(x, 0), select(value_of(x) >= value_of(high), constant(x, 1), between));
  }
};
struct Hypotenuse {
  template <class N, class... M>
  static N apply(const N& a, const M&... others) {
    return sqrt_or_zero(((a * a) + ... + (others * others)));
  }
};

// ---- triples -------------------------------------------------------------------------------------------------------------

struct Three {
  Real x, y, z;
  Real operator[](int i) const { return i == 0 ? x : (i == 1 ? y : z); }
};
Three operator+(const Three& a, const Three& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Three operator-(const Three& a, const Three& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Three operator-(const Three& a) { return {-a.x, -a.y, -a.z}; }
Three operator*(Real s, const Three& a) { return {a.x * s, a.y * s, a.z * s}; }
Real dot(const Three& a, const Three& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Three cross(const Three& a, const Three& b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
Dual<Real> dot(const Dual<Three>& a, const Dual<Three>& b) {
  return {dot(a.value, b.value), dot(a.dx, b.value) + dot(a.value, b.dx), dot(a.dy, b.value) + dot(a.value, b.dy)};
}
Dual<Three> cross(const Dual<Three>& a, const Dual<Three>& b) {
  return {cross(a.value, b.value), cross(a.dx, b.value) + cross(a.value, b.dx), cross(a.dy, b.value) + cross(a.value, b.dy)};
}
Dual<Three> operator*(const Dual<Real>& s, const Dual<Three>& a) {
  return {s.value * a.value, s.dx * a.value + s.value * a.dx, s.dy * a.value + s.value * a.dy};
}
Three select(Truth t, const Three& a, const Three& b) {
  return {select(t, a.x, b.x), select(t, a.y, b.y), select(t, a.z, b.z)};
}
Dual<Three> select(Truth t, const Dual<Three>& a, const Dual<Three>& b) {
  return {select(t, a.value, b.value), select(t, a.dx, b.dx), select(t, a.dy, b.dy)};
}
Real length(const Three& v) { return sqrt(dot(v, v)); }
Dual<Real> length(const Dual<Three>& v) { return sqrt_or_zero(dot(v, v)); }
Three normalized(const Three& v) {
  const Real size = length(v);
  return {v.x / size, v.y / size, v.z / size};
}
Dual<Three> normalized(const Dual<Three>& v) {
  const Dual<Real> size = length(v);
  const auto part = [&](int i) { return Dual<Real>(v.value[i], v.dx[i], v.dy[i]) / size; };
  const Dual<Real> x = part(0), y = part(1), z = part(2);
  return {{x.value, y.value, z.value}, {x.dx, y.dx, z.dx}, {x.dy, y.dy, z.dy}};
}

// ---- rows ----------------------------------------------------------------------------------------------------------------

/// Component k of argument i; the number itself of a float.
template <class N>
N component(const CodedCall& c, std::size_t i, int k) {
  const Memory& m = c.arguments[i].memory;
  return load_number<N>(c.code, m, m.type.is_triple() ? k : 0);
}

template <class F, class N, std::size_t... i>
void components(const CodedCall& c, std::index_sequence<i...>) {
  std::array<N, 3> results;
  const int count = c.result.type.is_triple() ? 3 : 1;
  for (int k = 0; k < count; ++k) results[std::size_t(k)] = F::apply(component<N>(c, i, k)...);
  for (int k = 0; k < count; ++k) store_number(c.code, c.result, k, results[std::size_t(k)]);
}

template <class F, int count>
void by_component(const CodedCall& c) {
  if (c.result.stride)
    components<F, Dual<Real>>(c, std::make_index_sequence<count>());
  else
    components<F, Real>(c, std::make_index_sequence<count>());
}
template <class F, int count>
void by_component_constant(const CodedCall& c) {
  components<F, Real>(c, std::make_index_sequence<count>());
}

template <class V>
V triple(const CodedCall& c, std::size_t i) {
  if constexpr (is_dual<V>) {
    const auto x = component<Dual<Real>>(c, i, 0), y = component<Dual<Real>>(c, i, 1), z = component<Dual<Real>>(c, i, 2);
    return {{x.value, y.value, z.value}, {x.dx, y.dx, z.dx}, {x.dy, y.dy, z.dy}};
  } else {
    return {component<Real>(c, i, 0), component<Real>(c, i, 1), component<Real>(c, i, 2)};
  }
}
void give(const CodedCall& c, Real r) { store_number(c.code, c.result, 0, r); }
void give(const CodedCall& c, const Dual<Real>& r) { store_number(c.code, c.result, 0, r); }
void give(const CodedCall& c, Whole r) { store(c.code, c.result, r); }
void give(const CodedCall& c, const Three& r) {
  for (int k = 0; k < 3; ++k) store_number(c.code, c.result, k, r[k]);
}
void give(const CodedCall& c, const Dual<Three>& r) {
  for (int k = 0; k < 3; ++k) store_number(c.code, c.result, k, Dual<Real>(r.value[k], r.dx[k], r.dy[k]));
}

template <class V>
struct Geometry {
  static void emit_dot(const CodedCall& c) { give(c, dot(triple<V>(c, 0), triple<V>(c, 1))); }
  static void emit_cross(const CodedCall& c) { give(c, cross(triple<V>(c, 0), triple<V>(c, 1))); }
  static void emit_length(const CodedCall& c) { give(c, length(triple<V>(c, 0))); }
  static void emit_distance(const CodedCall& c) { give(c, length(triple<V>(c, 0) - triple<V>(c, 1))); }
  static void emit_normalize(const CodedCall& c) { give(c, normalized(triple<V>(c, 0))); }
  static void emit_reflect(const CodedCall& c) {
    const V i = triple<V>(c, 0), n = triple<V>(c, 1);
    const auto once = dot(n, i);
    give(c, i - (once + once) * n);
  }
  static void emit_faceforward(const CodedCall& c) {
    const V n = triple<V>(c, 0);
    const Real facing = dot(triple<Three>(c, 1), triple<Three>(c, 2));
    give(c, select(facing > facing.like(0), -n, n));
  }
};
template <void (*plain)(const CodedCall&), void (*dual)(const CodedCall&)>
void either(const CodedCall& c) {
  (c.result.stride ? dual : plain)(c);
}
#define ETENDUE_OSL_GEOMETRY(NAME) either<Geometry<Three>::emit_##NAME, Geometry<Dual<Three>>::emit_##NAME>

/// Dx (1) and Dy (2).
template <int which>
void derivative(const CodedCall& c) {
  std::array<Real, 3> results;
  const int count = c.result.type.is_triple() ? 3 : 1;
  for (int k = 0; k < count; ++k) {
    const auto x = component<Dual<Real>>(c, 0, k);
    results[std::size_t(k)] = which == 1 ? x.dx : x.dy;
  }
  for (int k = 0; k < count; ++k) store_number(c.code, c.result, k, results[std::size_t(k)]);
}
void filter_width(const CodedCall& c) {
  std::array<Real, 3> results;
  const int count = c.result.type.is_triple() ? 3 : 1;
  for (int k = 0; k < count; ++k) {
    const auto x = component<Dual<Real>>(c, 0, k);
    results[std::size_t(k)] = sqrt(x.dx * x.dx + x.dy * x.dy);
  }
  for (int k = 0; k < count; ++k) store_number(c.code, c.result, k, results[std::size_t(k)]);
}

/// select with an int condition.
template <class N>
void select_parts(const CodedCall& c) {
  const Truth second = load_int(c.code, c.arguments[2].memory) != whole(c.code, 0);
  std::array<N, 3> results;
  const int count = c.result.type.is_triple() ? 3 : 1;
  for (int k = 0; k < count; ++k) results[std::size_t(k)] = select(second, component<N>(c, 1, k), component<N>(c, 0, k));
  for (int k = 0; k < count; ++k) store_number(c.code, c.result, k, results[std::size_t(k)]);
}

Whole int_at(const CodedCall& c, std::size_t i) { return load_int(c.code, c.arguments[i].memory); }
void absolute_int(const CodedCall& c) {
  const Whole x = int_at(c, 0);
  give(c, select(x < whole(c.code, 0), -x, x));
}
Whole smaller(Whole a, Whole b) { return select(b < a, b, a); }
Whole larger(Whole a, Whole b) { return select(a < b, b, a); }
void minimum_int(const CodedCall& c) { give(c, smaller(int_at(c, 0), int_at(c, 1))); }
void maximum_int(const CodedCall& c) { give(c, larger(int_at(c, 0), int_at(c, 1))); }
void clamp_int(const CodedCall& c) { give(c, larger(smaller(int_at(c, 0), int_at(c, 2)), int_at(c, 1))); }

template <class N>
void one_number(const CodedCall& c) {
  const N x = component<N>(c, 0, 0);
  for (int k = 0; k < 3; ++k) store_number(c.code, c.result, k, x);
}

struct Instructions {
  const char* signature;
  void (*emit)(const CodedCall&);
};

constexpr Instructions table[] = {
    {"TYPE radians(TYPE x)", by_component<Radians, 1>},
    {"TYPE degrees(TYPE x)", by_component<Degrees, 1>},
    {"TYPE cos(TYPE x)", by_component<Cosine, 1>},
    {"TYPE sin(TYPE x)", by_component<Sine, 1>},
    {"TYPE tan(TYPE x)", by_component<Tangent, 1>},
    {"TYPE acos(TYPE x)", by_component<ArcCosine, 1>},
    {"TYPE asin(TYPE x)", by_component<ArcSine, 1>},
    {"TYPE atan(TYPE x)", by_component<ArcTangent, 1>},
    {"TYPE pow(TYPE x, TYPE y)", by_component<Power, 2>},
    {"TRIPLE pow(TRIPLE x, float y)", by_component<Power, 2>},
    {"TYPE exp(TYPE x)", by_component<Exponential, 1>},
    {"TYPE exp2(TYPE x)", by_component<Exponential2, 1>},
    {"TYPE log(TYPE x)", by_component<Logarithm, 1>},
    {"TYPE sqrt(TYPE x)", by_component<SquareRoot, 1>},
    {"TYPE inversesqrt(TYPE x)", by_component<InverseSquareRoot, 1>},
    {"float hypot(float x, float y)", by_component<Hypotenuse, 2>},
    {"float hypot(float x, float y, float z)", by_component<Hypotenuse, 3>},
    {"int abs(int x)", absolute_int},
    {"int fabs(int x)", absolute_int},
    {"TYPE abs(TYPE x)", by_component<Absolute, 1>},
    {"TYPE fabs(TYPE x)", by_component<Absolute, 1>},
    {"TYPE sign(TYPE x)", by_component_constant<Sign, 1>},
    {"TYPE floor(TYPE x)", by_component_constant<Rounded<Code::Function::floor>, 1>},
    {"TYPE ceil(TYPE x)", by_component_constant<Rounded<Code::Function::ceiling>, 1>},
    {"TYPE round(TYPE x)", by_component_constant<Rounded<Code::Function::round>, 1>},
    {"TYPE trunc(TYPE x)", by_component_constant<Rounded<Code::Function::truncate>, 1>},
    {"TYPE fmod(TYPE a, TYPE b)", by_component<TruncatedRemainder, 2>},
    {"TRIPLE fmod(TRIPLE a, float b)", by_component<TruncatedRemainder, 2>},
    {"TYPE mod(TYPE a, TYPE b)", by_component<FlooredRemainder, 2>},
    {"TRIPLE mod(TRIPLE a, float b)", by_component<FlooredRemainder, 2>},
    {"int min(int a, int b)", minimum_int},
    {"TYPE min(TYPE a, TYPE b)", by_component<Minimum, 2>},
    {"int max(int a, int b)", maximum_int},
    {"TYPE max(TYPE a, TYPE b)", by_component<Maximum, 2>},
    {"int clamp(int x, int low, int high)", clamp_int},
    {"TYPE clamp(TYPE x, TYPE low, TYPE high)", by_component<Clamp, 3>},
    {"TYPE mix(TYPE x, TYPE y, TYPE a)", by_component<Mix, 3>},
    {"TRIPLE mix(TRIPLE x, TRIPLE y, float a)", by_component<Mix, 3>},
    {"TYPE select(TYPE x, TYPE y, int condition)", either<select_parts<Real>, select_parts<Dual<Real>>>},
    {"TYPE select(TYPE x, TYPE y, TYPE condition)", by_component<Select, 3>},
    {"TRIPLE select(TRIPLE x, TRIPLE y, float condition)", by_component<Select, 3>},
    {"TYPE step(TYPE edge, TYPE x)", by_component_constant<Step, 2>},
    {"TYPE linearstep(TYPE low, TYPE high, TYPE x)", by_component<LinearStep, 3>},
    {"TYPE smoothstep(TYPE low, TYPE high, TYPE x)", by_component<SmoothStep, 3>},
    {"float dot(vector a, vector b)", ETENDUE_OSL_GEOMETRY(dot)},
    {"vector cross(vector a, vector b)", ETENDUE_OSL_GEOMETRY(cross)},
    {"float length(vector v)", ETENDUE_OSL_GEOMETRY(length)},
    {"float distance(point a, point b)", ETENDUE_OSL_GEOMETRY(distance)},
    {"normal normalize(normal v)", ETENDUE_OSL_GEOMETRY(normalize)},
    {"vector normalize(vector v)", ETENDUE_OSL_GEOMETRY(normalize)},
    {"vector reflect(vector i, vector n)", ETENDUE_OSL_GEOMETRY(reflect)},
    {"vector faceforward(vector n, vector i, vector reference)", ETENDUE_OSL_GEOMETRY(faceforward)},
    {"float Dx(float x)", derivative<1>},
    {"vector Dx(point x)", derivative<1>},
    {"vector Dx(vector x)", derivative<1>},
    {"vector Dx(normal x)", derivative<1>},
    {"color Dx(color x)", derivative<1>},
    {"float Dy(float x)", derivative<2>},
    {"vector Dy(point x)", derivative<2>},
    {"vector Dy(vector x)", derivative<2>},
    {"vector Dy(normal x)", derivative<2>},
    {"color Dy(color x)", derivative<2>},
    {"float filterwidth(float x)", filter_width},
    {"vector filterwidth(point x)", filter_width},
    {"vector filterwidth(vector x)", filter_width},
    {"color color(float f)", either<one_number<Real>, one_number<Dual<Real>>>},
    {"point point(float f)", either<one_number<Real>, one_number<Dual<Real>>>},
    {"vector vector(float f)", either<one_number<Real>, one_number<Dual<Real>>>},
    {"normal normal(float f)", either<one_number<Real>, one_number<Dual<Real>>>},
};

#undef ETENDUE_OSL_GEOMETRY

}  // namespace

bool emit_instructions(const Row& row, const CodedCall& call) {
  static const auto by_signature = [] {
    std::unordered_map<std::string_view, void (*)(const CodedCall&)> map;
    for (const Instructions& entry : table) map.emplace(entry.signature, entry.emit);
    return map;
  }();
  const auto found = by_signature.find(row.signature);
  if (found == by_signature.end()) return false;
  found->second(call);
  return true;
}

}  // namespace etendue::osl
