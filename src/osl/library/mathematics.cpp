// Rows of the table: mathematical functions of numbers, component by component.

#include "choose.h"
#include "numbers.h"
#include "parts.h"

namespace etendue::osl {

namespace {

constexpr float pi = 3.14159265358979323846f;

// A smooth function f with its slope f'(x); `y` is f(x).
#define ETENDUE_OSL_SMOOTH(NAME, VALUE, SLOPE)                                               \
  struct NAME {                                                                              \
    static float value(float x) { return VALUE; }                                            \
    static float slope([[maybe_unused]] float x, [[maybe_unused]] float y) { return SLOPE; } \
    template <class N>                                                                       \
    static N apply(N x) {                                                                    \
      return smooth<NAME>(x);                                                                \
    }                                                                                        \
  };

ETENDUE_OSL_SMOOTH(Radians, x*(pi / 180), pi / 180)
ETENDUE_OSL_SMOOTH(Degrees, x * (180 / pi), 180 / pi)
ETENDUE_OSL_SMOOTH(Cosine, std::cos(x), -std::sin(x))
ETENDUE_OSL_SMOOTH(Sine, std::sin(x), std::cos(x))
ETENDUE_OSL_SMOOTH(Tangent, std::tan(x), 1 + y * y)
ETENDUE_OSL_SMOOTH(ArcCosine, std::acos(std::clamp(x, -1.0f, 1.0f)), -inversesqrt_or_zero(1 - x * x))
ETENDUE_OSL_SMOOTH(ArcSine, std::asin(std::clamp(x, -1.0f, 1.0f)), inversesqrt_or_zero(1 - x * x))
ETENDUE_OSL_SMOOTH(ArcTangent, std::atan(x), 1 / (1 + x * x))
ETENDUE_OSL_SMOOTH(HyperbolicCosine, std::cosh(x), std::sinh(x))
ETENDUE_OSL_SMOOTH(HyperbolicSine, std::sinh(x), std::cosh(x))
ETENDUE_OSL_SMOOTH(HyperbolicTangent, std::tanh(x), 1 - y * y)
ETENDUE_OSL_SMOOTH(Exponential, std::exp(x), y)
ETENDUE_OSL_SMOOTH(Exponential2, std::exp2(x), y * 0.69314718056f)
ETENDUE_OSL_SMOOTH(ExponentialMinus1, std::expm1(x), std::exp(x))
ETENDUE_OSL_SMOOTH(Logarithm, safe_log(x), x > 0 ? 1 / x : 0)
ETENDUE_OSL_SMOOTH(Logarithm2, std::log2(std::max(x, std::numeric_limits<float>::min())), x > 0 ? 1.44269504089f / x : 0)
ETENDUE_OSL_SMOOTH(Logarithm10, std::log10(std::max(x, std::numeric_limits<float>::min())), x > 0 ? 0.4342944819f / x : 0)
ETENDUE_OSL_SMOOTH(SquareRoot, sqrt_or_zero(x), y > 0 ? 0.5f / y : 0)
ETENDUE_OSL_SMOOTH(InverseSquareRoot, inversesqrt_or_zero(x), -0.5f * y * y * y)
ETENDUE_OSL_SMOOTH(CubeRoot, std::cbrt(x), y != 0 ? 1 / (3 * y * y) : 0)
ETENDUE_OSL_SMOOTH(Absolute, std::abs(x), x < 0 ? -1 : 1)
ETENDUE_OSL_SMOOTH(ErrorFunction, std::erf(x), 1.12837916710f * std::exp(-x * x))
ETENDUE_OSL_SMOOTH(ComplementaryErrorFunction, std::erfc(x), -1.12837916710f * std::exp(-x * x))

// A function that is constant in pieces.
#define ETENDUE_OSL_STEPS(NAME, VALUE)            \
  struct NAME {                                   \
    static float apply(float x) { return VALUE; } \
  };

ETENDUE_OSL_STEPS(Exponent, x != 0 ? std::logb(x) : std::logb(std::numeric_limits<float>::min()))
ETENDUE_OSL_STEPS(Sign, x > 0 ? 1.0f : (x < 0 ? -1.0f : 0.0f))
ETENDUE_OSL_STEPS(Floor, std::floor(x))
ETENDUE_OSL_STEPS(Ceiling, std::ceil(x))
ETENDUE_OSL_STEPS(Round, std::round(x))
ETENDUE_OSL_STEPS(Truncate, std::trunc(x))

#undef ETENDUE_OSL_SMOOTH
#undef ETENDUE_OSL_STEPS

struct ArcTangent2 {
  static float apply(float y, float x) { return std::atan2(y, x); }
  static Dual<float> apply(const Dual<float>& y, const Dual<float>& x) {
    const float square = x.value * x.value + y.value * y.value, inverse = safe_divide(1, square);
    return chain(std::atan2(y.value, x.value), x.value * inverse, y, -y.value * inverse, x);
  }
};

struct Power {
  template <class N>
  static N apply(const N& x, const N& y) {
    return safe_pow(x, y);
  }
};

struct LogarithmOfBase {
  template <class N>
  static N apply(const N& x, const N& b) {
    const N above = Logarithm::apply(x), below = Logarithm::apply(b);
    if constexpr (is_dual<N>)
      return above / below;
    else
      return safe_divide(above, below);
  }
};

struct Hypotenuse {
  template <class N, class... M>
  static N apply(const N& a, const M&... others) {
    return sqrt_or_zero(((a * a) + ... + (others * others)));
  }
};

struct TruncatedRemainder {
  template <class N>
  static N apply(const N& a, const N& b) {
    return safe_fmod(a, b);
  }
};

struct FlooredRemainder {
  template <class N>
  static N apply(const N& a, const N& b) {
    return floor_mod(a, b);
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
    return x * (N(1) - a) + y * a;
  }
};

struct Select {
  template <class N>
  static N apply(const N& x, const N& y, const N& condition) {
    return value_of(condition) != 0 ? y : x;
  }
};

/// select with an int condition.
struct SelectByInt {
  template <class N, int size>
  static void evaluate(const Call& c) {
    const int from = c.at<int>(2) ? 1 : 0;
    float* to = static_cast<float*>(c.result);
    for (int k = 0; k < size; ++k) detail::set<N>(to + k, size, component<N>(c, from, k));
  }
  static Evaluate choose(const CallTypes& t) {
    const bool triple = t.result.type.is_triple();
    if (t.result.derivatives) return triple ? evaluate<Dual<float>, 3> : evaluate<Dual<float>, 1>;
    return triple ? evaluate<float, 3> : evaluate<float, 1>;
  }
};

/// void sincos(x, output sine, output cosine)
void sine_and_cosine(const Call& c) {
  const int size = c.type(0).is_triple() ? 3 : 1;
  for (int k = 0; k < size; ++k) {
    const Dual<float> x = component<Dual<float>>(c, 0, k);
    const float sine = std::sin(x.value), cosine = std::cos(x.value);
    float* to_sine = static_cast<float*>(c.arguments[1]) + k;
    float* to_cosine = static_cast<float*>(c.arguments[2]) + k;
    to_sine[0] = sine, to_cosine[0] = cosine;
    if (c.derivatives(1)) to_sine[size] = cosine * x.dx, to_sine[2 * size] = cosine * x.dy;
    if (c.derivatives(2)) to_cosine[size] = -sine * x.dx, to_cosine[2 * size] = -sine * x.dy;
  }
}

// Functions of ints. The sums and negations wrap around.
void absolute_int(const Call& c) {
  const int x = c.at<int>(0);
  c.give(x < 0 ? int(-unsigned(x)) : x);
}
void minimum_int(const Call& c) { c.give(std::min(c.at<int>(0), c.at<int>(1))); }
void maximum_int(const Call& c) { c.give(std::max(c.at<int>(0), c.at<int>(1))); }
void clamp_int(const Call& c) { c.give(std::max(std::min(c.at<int>(0), c.at<int>(2)), c.at<int>(1))); }
// stdosl.h divides ints by the truncating division before it takes the floor: the remainder has the sign of a.
void remainder_int(const Call& c) {
  const long long a = c.at<int>(0), b = c.at<int>(1);
  c.give(int(b == 0 ? a : a % b));
}

void is_nan(const Call& c) { c.give(int(std::isnan(c.at<float>(0)))); }
void is_infinite(const Call& c) { c.give(int(std::isinf(c.at<float>(0)))); }
void is_finite(const Call& c) { c.give(int(std::isfinite(c.at<float>(0)))); }

constexpr Derivatives none = Derivatives::none;

constexpr Row rows[] = {
    {"TYPE radians(TYPE x)", by_component<Radians, 1>},
    {"TYPE degrees(TYPE x)", by_component<Degrees, 1>},
    {"TYPE cos(TYPE x)", by_component<Cosine, 1>},
    {"TYPE sin(TYPE x)", by_component<Sine, 1>},
    {"TYPE tan(TYPE x)", by_component<Tangent, 1>},
    {"void sincos(TYPE x, output TYPE sine, output TYPE cosine)", always<sine_and_cosine>},
    {"TYPE acos(TYPE x)", by_component<ArcCosine, 1>},
    {"TYPE asin(TYPE x)", by_component<ArcSine, 1>},
    {"TYPE atan(TYPE x)", by_component<ArcTangent, 1>},
    {"TYPE atan2(TYPE y, TYPE x)", by_component<ArcTangent2, 2>},
    {"TYPE cosh(TYPE x)", by_component<HyperbolicCosine, 1>},
    {"TYPE sinh(TYPE x)", by_component<HyperbolicSine, 1>},
    {"TYPE tanh(TYPE x)", by_component<HyperbolicTangent, 1>},
    {"TYPE pow(TYPE x, TYPE y)", by_component<Power, 2>},
    {"TRIPLE pow(TRIPLE x, float y)", by_component<Power, 2>},
    {"TYPE exp(TYPE x)", by_component<Exponential, 1>},
    {"TYPE exp2(TYPE x)", by_component<Exponential2, 1>},
    {"TYPE expm1(TYPE x)", by_component<ExponentialMinus1, 1>},
    {"TYPE log(TYPE x)", by_component<Logarithm, 1>},
    {"TYPE log(TYPE x, float base)", by_component<LogarithmOfBase, 2>},
    {"TYPE log2(TYPE x)", by_component<Logarithm2, 1>},
    {"TYPE log10(TYPE x)", by_component<Logarithm10, 1>},
    {"TYPE logb(TYPE x)", by_component_constant<Exponent, 1>, none},
    {"TYPE sqrt(TYPE x)", by_component<SquareRoot, 1>},
    {"TYPE inversesqrt(TYPE x)", by_component<InverseSquareRoot, 1>},
    {"TYPE cbrt(TYPE x)", by_component<CubeRoot, 1>},
    {"float hypot(float x, float y)", by_component<Hypotenuse, 2>},
    {"float hypot(float x, float y, float z)", by_component<Hypotenuse, 3>},
    {"int abs(int x)", always<absolute_int>, none},
    {"int fabs(int x)", always<absolute_int>, none},
    {"TYPE abs(TYPE x)", by_component<Absolute, 1>},
    {"TYPE fabs(TYPE x)", by_component<Absolute, 1>},
    {"TYPE sign(TYPE x)", by_component_constant<Sign, 1>, none},
    {"TYPE floor(TYPE x)", by_component_constant<Floor, 1>, none},
    {"TYPE ceil(TYPE x)", by_component_constant<Ceiling, 1>, none},
    {"TYPE round(TYPE x)", by_component_constant<Round, 1>, none},
    {"TYPE trunc(TYPE x)", by_component_constant<Truncate, 1>, none},
    {"TYPE fmod(TYPE a, TYPE b)", by_component<TruncatedRemainder, 2>},
    {"TRIPLE fmod(TRIPLE a, float b)", by_component<TruncatedRemainder, 2>},
    {"int mod(int a, int b)", always<remainder_int>, none},
    {"TYPE mod(TYPE a, TYPE b)", by_component<FlooredRemainder, 2>},
    {"TRIPLE mod(TRIPLE a, float b)", by_component<FlooredRemainder, 2>},
    {"int min(int a, int b)", always<minimum_int>, none},
    {"TYPE min(TYPE a, TYPE b)", by_component<Minimum, 2>},
    {"int max(int a, int b)", always<maximum_int>, none},
    {"TYPE max(TYPE a, TYPE b)", by_component<Maximum, 2>},
    {"int clamp(int x, int low, int high)", always<clamp_int>, none},
    {"TYPE clamp(TYPE x, TYPE low, TYPE high)", by_component<Clamp, 3>},
    {"TYPE mix(TYPE x, TYPE y, TYPE a)", by_component<Mix, 3>},
    {"TRIPLE mix(TRIPLE x, TRIPLE y, float a)", by_component<Mix, 3>},
    {"TYPE select(TYPE x, TYPE y, int condition)", SelectByInt::choose},
    {"TYPE select(TYPE x, TYPE y, TYPE condition)", by_component<Select, 3>},
    {"TRIPLE select(TRIPLE x, TRIPLE y, float condition)", by_component<Select, 3>},
    {"int isnan(float x)", always<is_nan>, none},
    {"int isinf(float x)", always<is_infinite>, none},
    {"int isfinite(float x)", always<is_finite>, none},
    {"float erf(float x)", by_component<ErrorFunction, 1>},
    {"float erfc(float x)", by_component<ComplementaryErrorFunction, 1>},
};

}  // namespace

std::span<const Row> mathematics_rows() { return rows; }

}  // namespace etendue::osl
