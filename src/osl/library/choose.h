#pragma once
// Templates that make rows of the table from functions of numbers.
//
// A formula is a struct with a static template `apply`, which works for float and for Dual<float>:
//
//   struct Sine { template <class N> static N apply(N x) { return sin(x); } };
//   {"TYPE sin(TYPE x)", by_component<Sine, 1>}

#include <utility>

#include "table.h"

namespace etendue::osl {

/// Component k of the i-th argument: a triple's, or the number itself of a float.
template <class N>
N component(const Call& c, int i, int k) {
  const float* p = static_cast<const float*>(c.arguments[i]);
  const int size = c.type(i).is_triple() ? 3 : 1;
  if (size == 3) p += k;
  if constexpr (is_dual<N>) {
    return c.derivatives(i) ? N(p[0], p[size], p[2 * size]) : N(p[0]);
  } else {
    return *p;
  }
}

namespace detail {

template <class N>
void set(float* to, int size, const N& v) {
  if constexpr (is_dual<N>) {
    to[0] = v.value, to[size] = v.dx, to[2 * size] = v.dy;
  } else {
    to[0] = v;
  }
}

template <class F, class N, int size, int... i>
void components(const Call& c, std::integer_sequence<int, i...>) {
  float* to = static_cast<float*>(c.result);
  for (int k = 0; k < size; ++k) set<N>(to + k, size, N(F::apply(component<N>(c, i, k)...)));
}

template <class F, int count, class N, int size>
void evaluate_components(const Call& c) {
  components<F, N, size>(c, std::make_integer_sequence<int, count>());
}

/// Sets the derivatives of the result to zero.
inline void no_derivatives(const Call& c) {
  if (!c.types.result.derivatives) return;
  const int size = c.types.result.type.floats() * c.types.result.type.elements();
  float* to = static_cast<float*>(c.result);
  for (int k = size; k < 3 * size; ++k) to[k] = 0;
}

template <class F, int count, int size>
void evaluate_constant_components(const Call& c) {
  components<F, float, size>(c, std::make_integer_sequence<int, count>());
  no_derivatives(c);
}

}  // namespace detail

/// F of `count` numbers, applied to each component. The result is a float or a triple; a float among triples counts for each
/// component.
template <class F, int count>
Evaluate by_component(const CallTypes& t) {
  const bool triple = t.result.type.is_triple();
  if (t.result.derivatives)
    return triple ? detail::evaluate_components<F, count, Dual<float>, 3>
                  : detail::evaluate_components<F, count, Dual<float>, 1>;
  return triple ? detail::evaluate_components<F, count, float, 3> : detail::evaluate_components<F, count, float, 1>;
}

/// The same for a function whose derivatives are zero: apply takes floats.
template <class F, int count>
Evaluate by_component_constant(const CallTypes& t) {
  return t.result.type.is_triple() ? detail::evaluate_constant_components<F, count, 3>
                                   : detail::evaluate_constant_components<F, count, 1>;
}

/// A function `F::evaluate<D>(const Call&)`: D is whether the result has derivatives.
template <class F>
Evaluate with_derivatives(const CallTypes& t) {
  return t.result.derivatives ? F::template evaluate<true> : F::template evaluate<false>;
}

/// One function for all types.
template <Evaluate function>
Evaluate always(const CallTypes&) {
  return function;
}

/// float or Dual<float>, Triple or Dual<Triple>.
template <class T, bool derivatives>
using Number = std::conditional_t<derivatives, Dual<T>, T>;

}  // namespace etendue::osl
