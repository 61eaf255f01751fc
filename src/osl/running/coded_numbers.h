#pragma once
// Numbers in code that is made: with them the formulas of Dual and of the operators read as they do for float and int, and make
// instructions instead of results.

#include <array>
#include <cmath>

#include "code.h"
#include "nodes.h"

namespace etendue::osl {

struct CodedNumber {
  Code* code = nullptr;
  Word word;
};

/// true or false
struct Truth : CodedNumber {};
/// An int.
struct Whole : CodedNumber {};
/// A float.
struct Real : CodedNumber {
  Real like(float f) const { return {{code, code->number(f)}}; }
};
/// The address of a string or a closure.
struct Address : CodedNumber {};

template <class T>
T coded(Code& code, Word word) {
  return T{{&code, word}};
}
inline Real real(Code& code, float f) { return coded<Real>(code, code.number(f)); }
inline Whole whole(Code& code, int i) { return coded<Whole>(code, code.integer(i)); }

// ---- truth ---------------------------------------------------------------------------------------------------------------

inline Truth operator&&(Truth a, Truth b) {
  return coded<Truth>(*a.code, a.code->arithmetic(Code::Arithmetic::bit_and, a.word, b.word));
}
inline Truth operator||(Truth a, Truth b) {
  return coded<Truth>(*a.code, a.code->arithmetic(Code::Arithmetic::bit_or, a.word, b.word));
}
template <class T>
T select(Truth condition, T yes, T no) {
  return coded<T>(*condition.code, condition.code->select(condition.word, yes.word, no.word));
}
inline Whole int_of(Truth t) { return coded<Whole>(*t.code, t.code->int_of_truth(t.word)); }
inline int int_of(bool b) { return b; }
inline Truth operator!(Truth a) {
  const Whole i = int_of(a);
  return coded<Truth>(*a.code, a.code->compare(Code::Comparison::equal, i.word, a.code->integer(0)));
}

template <class T>
concept Coded = std::is_same_v<T, Real> || std::is_same_v<T, Whole> || std::is_same_v<T, Address>;

template <Coded T>
Truth compared(Code::Comparison how, T a, T b) {
  return coded<Truth>(*a.code, a.code->compare(how, a.word, b.word));
}
template <Coded T>
Truth operator==(T a, T b) {
  return compared(Code::Comparison::equal, a, b);
}
template <Coded T>
Truth operator!=(T a, T b) {
  return compared(Code::Comparison::unequal, a, b);
}
template <Coded T>
Truth operator<(T a, T b) {
  return compared(Code::Comparison::less, a, b);
}
template <Coded T>
Truth operator<=(T a, T b) {
  return compared(Code::Comparison::less_equal, a, b);
}
template <Coded T>
Truth operator>(T a, T b) {
  return compared(Code::Comparison::greater, a, b);
}
template <Coded T>
Truth operator>=(T a, T b) {
  return compared(Code::Comparison::greater_equal, a, b);
}

// ---- floats --------------------------------------------------------------------------------------------------------------

inline Real computed(Code::Arithmetic how, Real a, Real b) {
  return coded<Real>(*a.code, a.code->arithmetic(how, a.word, b.word));
}
inline Real operator+(Real a, Real b) { return computed(Code::Arithmetic::add, a, b); }
inline Real operator-(Real a, Real b) { return computed(Code::Arithmetic::subtract, a, b); }
inline Real operator*(Real a, Real b) { return computed(Code::Arithmetic::multiply, a, b); }
/// Without the language's rule for zero.
inline Real divided(Real a, Real b) { return computed(Code::Arithmetic::divide, a, b); }
/// What is divided by zero is zero, as everywhere in the language.
inline Real operator/(Real a, Real b) { return select(b != b.like(0), divided(a, b), a.like(0)); }
inline Real function(Code::Function f, Real a) { return coded<Real>(*a.code, a.code->function(f, a.word)); }
inline Real operator-(Real a) { return function(Code::Function::negate, a); }

/// As operator/ of Dual<float>.
inline Dual<Real> operator/(const Dual<Real>& a, const Dual<Real>& b) {
  const Real zero = b.value.like(0);
  const Truth defined = !(b.value == zero);
  const Real inverse = divided(b.value.like(1), b.value), value = a.value * inverse;
  return {select(defined, divided(a.value, b.value), zero), select(defined, inverse * (a.dx - value * b.dx), zero),
          select(defined, inverse * (a.dy - value * b.dy), zero)};
}

inline Dual<Real> select(Truth condition, const Dual<Real>& yes, const Dual<Real>& no) {
  return {select(condition, yes.value, no.value), select(condition, yes.dx, no.dx), select(condition, yes.dy, no.dy)};
}

// ---- ints ----------------------------------------------------------------------------------------------------------------

inline Whole computed(Code::Arithmetic how, Whole a, Whole b) {
  return coded<Whole>(*a.code, a.code->arithmetic(how, a.word, b.word));
}
inline Whole operator+(Whole a, Whole b) { return computed(Code::Arithmetic::add, a, b); }
inline Whole operator-(Whole a, Whole b) { return computed(Code::Arithmetic::subtract, a, b); }
inline Whole operator*(Whole a, Whole b) { return computed(Code::Arithmetic::multiply, a, b); }
inline Whole operator-(Whole a) { return whole(*a.code, 0) - a; }
inline Whole operator~(Whole a) { return computed(Code::Arithmetic::bit_xor, a, whole(*a.code, -1)); }
inline Whole operator&(Whole a, Whole b) { return computed(Code::Arithmetic::bit_and, a, b); }
inline Whole operator|(Whole a, Whole b) { return computed(Code::Arithmetic::bit_or, a, b); }
inline Whole operator^(Whole a, Whole b) { return computed(Code::Arithmetic::bit_xor, a, b); }
inline Whole shifted_left(Whole a, Whole b) { return computed(Code::Arithmetic::shift_left, a, b & whole(*a.code, 31)); }
inline Whole shifted_right(Whole a, Whole b) { return computed(Code::Arithmetic::shift_right, a, b & whole(*a.code, 31)); }
/// A divisor with which the processor's division is defined: 1 instead of 0 and -1.
inline Whole harmless(Whole b) { return select(b == whole(*b.code, 0) || b == whole(*b.code, -1), whole(*b.code, 1), b); }
inline Whole operator/(Whole a, Whole b) {
  const Whole quotient = computed(Code::Arithmetic::divide, a, harmless(b));
  return select(b == whole(*b.code, 0), whole(*b.code, 0), select(b == whole(*b.code, -1), -a, quotient));
}
/// By 1 instead of 0 and -1 the remainder is 0, as it should be.
inline Whole operator%(Whole a, Whole b) { return computed(Code::Arithmetic::remainder, a, harmless(b)); }

// ---- values in memory ----------------------------------------------------------------------------------------------------

inline Real load_real(Code& code, const Spot& at) { return coded<Real>(code, code.load(WordKind::float_, at)); }
inline Whole load_int(Code& code, const Memory& m) { return coded<Whole>(code, code.load(WordKind::int_, {m.offset, {}})); }
inline Address load_address(Code& code, const Memory& m) {
  return coded<Address>(code, code.load(WordKind::address, {m.offset, {}}));
}
inline void store(Code& code, const Memory& m, const CodedNumber& v) { code.store({m.offset, {}}, v.word); }

/// Float `k` of a value, with or without its derivatives.
template <class N>
N load_number(Code& code, const Memory& m, int k) {
  const Spot at{m.offset + std::uint32_t(k) * 4, {}};
  if constexpr (is_dual<N>) {
    if (!m.stride) return N(load_real(code, at), real(code, 0), real(code, 0));
    return N(load_real(code, at), load_real(code, at + m.stride), load_real(code, at + 2 * std::size_t(m.stride)));
  } else {
    return load_real(code, at);
  }
}
inline void store_number(Code& code, const Memory& m, int k, const Dual<Real>& v) {
  const Spot at{m.offset + std::uint32_t(k) * 4, {}};
  code.store(at, v.value.word);
  if (!m.stride) return;
  code.store(at + m.stride, v.dx.word);
  code.store(at + 2 * std::size_t(m.stride), v.dy.word);
}
/// The derivatives are zero.
inline void store_number(Code& code, const Memory& m, int k, Real v) {
  store_number(code, m, k, Dual<Real>(v, real(code, 0), real(code, 0)));
}

/// Copies a value of a type, and its derivatives, as copy_value does.
void emit_copy(Code&, const Type&, const Spot& to, std::uint32_t to_stride, const Spot& from, std::uint32_t from_stride,
               std::size_t size);
/// Sets a value to zero, or its strings to "", as MemoryLayout::clear.
void emit_clear(Code&, const Type&, const Spot&);

}  // namespace etendue::osl
