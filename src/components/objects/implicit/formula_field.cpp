// Evaluation of formulas as fields. Each function is implemented for a number type T, double or Interval, and for dual numbers
// over T.

#include "formula_field.h"

namespace etendue {
namespace {

// ---- doubles: a result that is not finite becomes 0, as in maps
// -----------------------------------------------------------------------

double settled(double x) { return std::isfinite(x) ? x : 0; }
Interval settled(const Interval& x) { return x; }

double smaller(double a, double b) { return std::min(a, b); }
double larger(double a, double b) { return std::max(a, b); }
double absolute(double a) { return std::abs(a); }
double square_root(double a) { return std::sqrt(std::max(a, 0.0)); }
double exponential(double a) { return settled(std::exp(a)); }
double logarithm(double a) { return a > 0 ? std::log(a) : 0; }
double sine(double a) { return std::sin(a); }
double cosine(double a) { return std::cos(a); }
double arc_tangent_2(double y, double x) { return std::atan2(y, x); }
double round_down(double a) { return std::floor(a); }
Interval round_down(const Interval& a) { return {std::floor(a.low), std::floor(a.high)}; }
double whole_power(double x, int n) { return settled(std::pow(x, n)); }

double power(double a, double b) { return a >= 0 ? settled(std::pow(a, b)) : 0; }
/// a^b for a >= 0 is monotonic in each argument, so the extremes are at the corners; for a < 0 it is 0.
Interval power(const Interval& a, const Interval& b) {
  if (a.high < 0) return {0, 0};
  const double low = std::max(a.low, 0.0);
  const double p = std::pow(low, b.low), q = std::pow(low, b.high), r = std::pow(a.high, b.low), s = std::pow(a.high, b.high);
  const Interval all = Interval::around(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
  return a.low <= 0 ? hull(all, 0) : all;
}

/// t^2 (3 - 2 t), monotonic in [0, 1].
double eased(double t) { return t * t * (3 - 2 * t); }
Interval eased(const Interval& t) { return Interval::around(eased(t.low), eased(t.high)); }

// Helpers of piecewise functions: which branch is certain, where a function is discontinuous, and the hull of both branches.
bool surely_less(double a, double b) { return a < b; }
bool surely_less(const Interval& a, const Interval& b) { return a.high < b.low; }
bool jumps(double, double) { return false; }
bool jumps(const Interval& x, const Interval& whole) { return whole.low != whole.high || x.low == whole.low; }
bool around_cut(double, double) { return false; }
bool around_cut(const Interval& y, const Interval& x) { return x.low <= 0 && y.contains(0); }

double either(bool first, double a, double b) { return first ? a : b; }
Interval either(bool, const Interval& a, const Interval& b) { return hull(a, b); }
double undefined(double) { return 0; }
Interval undefined(const Interval&) { return Interval::whole(); }

// ---- dual numbers -------------------------------------------------------------------------------------------

template <class T, int N>
struct Dual {
  T value;
  std::array<T, N> slopes{};

  Dual() = default;
  Dual(double x) : value(x) {}                                      // NOLINT: a constant
  Dual(const T& x, const T& slope, const Dual& inner) : value(x) {  // the chain rule
    for (size_t i = 0; i < N; ++i) slopes[i] = slope * inner.slopes[i];
  }
  /// f(a, b) with partial derivatives.
  Dual(const T& x, const T& by_a, const Dual& a, const T& by_b, const Dual& b) : value(x) {
    for (size_t i = 0; i < N; ++i) slopes[i] = by_a * a.slopes[i] + by_b * b.slopes[i];
  }
};

#define DUAL                \
  template <class T, int N> \
  Dual<T, N>
#define D const Dual<T, N>&
DUAL operator+(D a, D b) { return {a.value + b.value, 1, a, 1, b}; }
DUAL operator-(D a, D b) { return {a.value - b.value, 1, a, -1, b}; }
DUAL operator-(D a) { return {-a.value, -1, a}; }
DUAL operator*(D a, D b) { return {a.value * b.value, b.value, a, a.value, b}; }
DUAL operator/(D a, D b) {
  const T quotient = a.value / b.value, inverse = T(1) / b.value;
  return {quotient, inverse, a, -(quotient * inverse), b};
}
DUAL settled(D a) { return a; }
DUAL choose(bool a_surely, bool b_surely, bool first, const T& value, D a, D b) {
  Dual<T, N> d = a_surely ? a : b;
  if (!a_surely && !b_surely)
    for (size_t i = 0; i < N; ++i) d.slopes[i] = either(first, a.slopes[i], b.slopes[i]);
  d.value = value;
  return d;
}
DUAL smaller(D a, D b) {
  const bool less = surely_less(a.value, b.value);
  return choose(less, surely_less(b.value, a.value), true, smaller(a.value, b.value), a, b);
}
DUAL larger(D a, D b) {
  const bool less = surely_less(a.value, b.value);
  return choose(surely_less(b.value, a.value), less, true, larger(a.value, b.value), a, b);
}
DUAL absolute(D a) {
  const Dual<T, N> opposite = -a, zero(0);
  return choose(surely_less(T(0), a.value), surely_less(a.value, T(0)), true, absolute(a.value), a, opposite);
}
DUAL square_root(D a) {
  const T root = square_root(a.value);
  return {root, surely_less(a.value, T(0)) ? T(0) : T(0.5) / root, a};
}
DUAL exponential(D a) {
  const T e = exponential(a.value);
  return {e, e, a};
}
DUAL logarithm(D a) { return {logarithm(a.value), surely_less(a.value, T(0)) ? T(0) : T(1) / a.value, a}; }
DUAL sine(D a) { return {sine(a.value), cosine(a.value), a}; }
DUAL cosine(D a) { return {cosine(a.value), -sine(a.value), a}; }
DUAL arc_tangent_2(D y, D x) {
  if (around_cut(y.value, x.value)) return {arc_tangent_2(y.value, x.value), undefined(x.value), y, undefined(x.value), x};
  const T square = whole_power(x.value, 2) + whole_power(y.value, 2);
  return {arc_tangent_2(y.value, x.value), x.value / square, y, -(y.value / square), x};
}
DUAL round_down(D a) {
  const T whole = round_down(a.value);
  return {whole, jumps(a.value, whole) ? undefined(whole) : T(0), a};
}
DUAL whole_power(D a, int n) {
  if (n == 0) return 1;
  return {whole_power(a.value, n), T(n) * whole_power(a.value, n - 1), a};
}
DUAL power(D a, D b) {
  if (surely_less(a.value, T(0))) return 0;
  const T p = power(a.value, b.value);
  return {p, b.value * (p / a.value), a, p * logarithm(a.value), b};
}
DUAL eased(D t) { return {eased(t.value), T(6) * t.value * (T(1) - t.value), t}; }
#undef DUAL
#undef D

/// 0 where x < edge, else 1.
double stepped(double edge, double x) { return x < edge ? 0 : 1; }
Interval stepped(const Interval& edge, const Interval& x) {
  return surely_less(x, edge) ? Interval(0) : (edge.high <= x.low ? Interval(1) : Interval(0, 1));
}
template <class T, int N>
Dual<T, N> stepped(const Dual<T, N>& edge, const Dual<T, N>& x) {
  const T s = stepped(edge.value, x.value);
  const T slope = surely_less(x.value, edge.value) || surely_less(edge.value, x.value) ? T(0) : undefined(s);
  return {s, slope, x, slope, edge};
}

}  // namespace

FormulaField::FormulaField(const Formula& formula) {
  for (const Formula::Step& step : formula.steps()) {
    const size_t n = steps_.size();
    const auto pushes = [&](size_t i, std::uint8_t what) { return n >= i && steps_[n - i].operation == what; };
    if (step.operation == Formula::multiply && pushes(1, Formula::push_value) && pushes(2, Formula::push_value) &&
        steps_[n - 1].place == steps_[n - 2].place) {
      steps_[n - 1] = {raise, 2, 0};  // x * x: x^2 has tighter interval bounds than a product of independent factors
      continue;
    }
    if (step.operation == Formula::power && pushes(1, Formula::push_number) && std::abs(steps_[n - 1].number) <= 64 &&
        steps_[n - 1].number == std::floor(steps_[n - 1].number)) {
      steps_[n - 1] = {raise, int(steps_[n - 1].number), 0};
      continue;
    }
    steps_.push_back({step.operation, step.place, double(step.number)});
  }
}

template <class T>
T FormulaField::run(const std::array<T, 3>& x) const {
  std::array<T, Formula::deepest + 1> stack;
  T* top = stack.data();  // one past the last value
  for (const Step& step : steps_) {
    if (step.operation == Formula::push_number) {
      *top++ = T(step.number);
      continue;
    }
    if (step.operation == Formula::push_value) {
      *top++ = x[size_t(step.place)];
      continue;
    }
    top -= step.operation == raise ? 1 : Formula::arguments(step.operation);
    T& a = top[0];
    const T &b = top[1], &c = top[2];
    switch (step.operation) {
      case Formula::add: a = a + b; break;
      case Formula::subtract: a = a - b; break;
      case Formula::multiply: a = a * b; break;
      case Formula::divide: a = a / b; break;
      case Formula::negate: a = -a; break;
      case Formula::absolute: a = absolute(a); break;
      case Formula::square_root: a = square_root(a); break;
      case Formula::exponential: a = exponential(a); break;
      case Formula::logarithm: a = logarithm(a); break;
      case Formula::sine: a = sine(a); break;
      case Formula::cosine: a = cosine(a); break;
      case Formula::tangent: a = sine(a) / cosine(a); break;
      case Formula::arc_tangent_2: a = arc_tangent_2(a, b); break;
      case Formula::round_down: a = round_down(a); break;
      case Formula::fraction: a = a - round_down(a); break;
      case Formula::remainder: a = a - b * round_down(a / b); break;
      case Formula::power: a = power(a, b); break;
      case Formula::minimum: a = smaller(a, b); break;
      case Formula::maximum: a = larger(a, b); break;
      case Formula::threshold: a = stepped(a, b); break;
      case Formula::clamp: a = smaller(larger(a, b), c); break;
      case Formula::mix: a = a + c * (b - a); break;
      case Formula::smooth_step: a = eased(smaller(larger((c - a) / (b - a), T(0.0)), T(1.0))); break;
      case raise: a = whole_power(a, step.place); break;
      default: break;  // the mean over wavelengths, which of a single number is that number
    }
    a = settled(a);
    ++top;
  }
  return stack[0];
}

double FormulaField::value(const Place& x) const { return run<double>({x[0], x[1], x[2]}); }

Place FormulaField::gradient(const Place& x) const {
  std::array<Dual<double, 3>, 3> at{x[0], x[1], x[2]};
  for (size_t k = 0; k < 3; ++k) at[k].slopes[k] = 1;
  return run(at).slopes;
}

Interval FormulaField::range(const std::array<Interval, 3>& box) const { return run(box); }

Interval FormulaField::range(const std::array<Interval, 3>& box, const double (&direction)[3], Interval& slope) const {
  std::array<Dual<Interval, 1>, 3> at;
  for (size_t k = 0; k < 3; ++k) {
    at[k].value = box[k];
    at[k].slopes[0] = direction[k];
  }
  const Dual<Interval, 1> f = run(at);
  slope = f.slopes[0];
  return f.value;
}

}  // namespace etendue
