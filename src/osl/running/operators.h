#pragma once
// The operators of the language, as functors for numbers with and without derivatives, and for numbers in code
// (coded_numbers.h).

#include <cstdint>

#include "coded_numbers.h"
#include "etendue/core/spectrum.h"

namespace etendue::osl::operators {

struct Add {
  template <class A, class B>
  auto operator()(const A& a, const B& b) const {
    return a + b;
  }
  int operator()(int a, int b) const { return int(unsigned(a) + unsigned(b)); }
};
struct Subtract {
  template <class A, class B>
  auto operator()(const A& a, const B& b) const {
    return a - b;
  }
  int operator()(int a, int b) const { return int(unsigned(a) - unsigned(b)); }
};
struct Multiply {
  template <class A, class B>
  auto operator()(const A& a, const B& b) const {
    return a * b;
  }
  int operator()(int a, int b) const { return int(unsigned(a) * unsigned(b)); }
  Matrix operator()(float a, const Matrix& b) const { return b * a; }
};
/// What is divided by zero is zero.
struct Divide {
  template <class A, class B>
  auto operator()(const A& a, const B& b) const {
    return a / b;
  }
  float operator()(float a, float b) const { return safe_divide(a, b); }
  int operator()(int a, int b) const { return b == 0 ? 0 : (b == -1 ? int(0u - unsigned(a)) : a / b); }
  Matrix operator()(float a, const Matrix& b) const { return Matrix::diagonal(a) / b; }
  Spectrum operator()(const Spectrum& a, const Spectrum& b) const {
    Spectrum r;
    for (int i = 0; i < spectrum_size; ++i) r.set(i, safe_divide(a[i], b[i]));
    return r;
  }
};
struct Modulus {
  Whole operator()(Whole a, Whole b) const { return a % b; }
  int operator()(int a, int b) const { return b == 0 || b == -1 ? 0 : a % b; }
};
struct ShiftLeft {
  Whole operator()(Whole a, Whole b) const { return shifted_left(a, b); }
  int operator()(int a, int b) const { return int(unsigned(a) << (b & 31)); }
};
struct ShiftRight {
  Whole operator()(Whole a, Whole b) const { return shifted_right(a, b); }
  int operator()(int a, int b) const { return a >> (b & 31); }
};
struct BitAnd {
  Whole operator()(Whole a, Whole b) const { return a & b; }
  int operator()(int a, int b) const { return a & b; }
};
struct BitOr {
  Whole operator()(Whole a, Whole b) const { return a | b; }
  int operator()(int a, int b) const { return a | b; }
};
struct BitXor {
  Whole operator()(Whole a, Whole b) const { return a ^ b; }
  int operator()(int a, int b) const { return a ^ b; }
};
struct Equal {
  template <class T>
  int operator()(const T& a, const T& b) const {
    return a == b;
  }
  int operator()(const Spectrum& a, const Spectrum& b) const {
    for (int i = 0; i < spectrum_size; ++i)
      if (a[i] != b[i]) return 0;
    return 1;
  }
};
struct Unequal {
  template <class T>
  int operator()(const T& a, const T& b) const {
    return !Equal()(a, b);
  }
};
struct Less {
  template <class T>
  auto operator()(const T& a, const T& b) const {
    return int_of(a < b);
  }
};
struct LessEqual {
  template <class T>
  auto operator()(const T& a, const T& b) const {
    return int_of(a <= b);
  }
};
struct Greater {
  template <class T>
  auto operator()(const T& a, const T& b) const {
    return int_of(a > b);
  }
};
struct GreaterEqual {
  template <class T>
  auto operator()(const T& a, const T& b) const {
    return int_of(a >= b);
  }
};
struct Negate {
  template <class T>
  auto operator()(const T& a) const {
    return -a;
  }
  int operator()(int a) const { return int(0u - unsigned(a)); }
  Matrix operator()(const Matrix& a) const { return a * -1.0f; }
};
struct Complement {
  Whole operator()(Whole a) const { return ~a; }
  int operator()(int a) const { return ~a; }
};

}  // namespace etendue::osl::operators
