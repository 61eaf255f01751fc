#include "operations.h"

#include "library_code.h"
#include "operators.h"

namespace etendue::osl {
namespace {

using namespace operators;

// ---- the same in code
// --------------------------------------------------------------------------------------------------------

/// How many floats a value consists of; 0: it is no number, or one for which the program's own functions are called.
template <class T>
inline constexpr int float_count = 0;
template <>
inline constexpr int float_count<float> = 1;
template <>
inline constexpr int float_count<Triple> = 3;
template <>
inline constexpr int float_count<Spectrum> = spectrum_size;

template <class Op>
inline constexpr bool is_equality = std::is_same_v<Op, Equal> || std::is_same_v<Op, Unequal>;

/// Whether all floats, or the one word, of two values are equal.
template <class T>
Truth emit_equal(Code& code, const Memory& a, const Memory& b) {
  if constexpr (std::is_same_v<T, int>) {
    return load_int(code, a) == load_int(code, b);
  } else if constexpr (std::is_pointer_v<T>) {
    return load_address(code, a) == load_address(code, b);
  } else {
    constexpr int count = sizeof(T) / sizeof(float);
    Truth all = load_number<Real>(code, a, 0) == load_number<Real>(code, b, 0);
    for (int k = 1; k < count; ++k) all = all && load_number<Real>(code, a, k) == load_number<Real>(code, b, k);
    return all;
  }
}

template <class N, class Op, int count>
void emit_floats(Code& code, const Memory& a, const Memory& b, const Memory& out) {
  std::array<decltype(Op()(std::declval<N>(), std::declval<N>())), count> results;
  for (int k = 0; k < count; ++k) results[k] = Op()(load_number<N>(code, a, k), load_number<N>(code, b, k));
  if constexpr (std::is_same_v<std::remove_cvref_t<decltype(results[0])>, Whole>)
    store(code, out, results[0]);
  else
    for (int k = 0; k < count; ++k) store_number(code, out, k, results[k]);
}

template <class A, class B, class Op>
void apply(const A* a, const B* b, std::invoke_result_t<Op, A, B>* out) {
  *out = Op()(*a, *b);
}

template <class A, class B, class Op, bool dual>
void emit_binary(Code& code, const Memory& a, const Memory& b, const Memory& out) {
  if constexpr (is_equality<Op>) {
    const Truth equal = emit_equal<A>(code, a, b);
    store(code, out, int_of(std::is_same_v<Op, Equal> ? equal : !equal));
  } else if constexpr (std::is_same_v<A, int> && std::is_same_v<B, int>) {
    store(code, out, Op()(load_int(code, a), load_int(code, b)));
  } else if constexpr (std::is_same_v<A, B> && float_count<A> > 0) {
    emit_floats<std::conditional_t<dual, Dual<Real>, Real>, Op, float_count<A>>(code, a, b, out);
  } else {
    Lent first(code, a), second(code, b), result(code, out);
    code.call(reinterpret_cast<const void*>(&apply<A, B, Op>), WordKind::none, {first.in(), second.in(), result.address()});
    result.out();
  }
}

// ---- nodes
// -------------------------------------------------------------------------------------------------------------------

/// Towards zero. Numbers beyond the range, and not-a-number, give the least int, as the processor's own instruction does.
int whole_number(float f) { return f > -2147483904.0f && f < 2147483648.0f ? int(f) : INT32_MIN; }

Real float_of(Whole a) { return coded<Real>(*a.code, a.code->float_of_int(a.word)); }

struct IntToFloat {
  float operator()(int a) const { return float(a); }
};
struct FloatToInt {
  int operator()(float a) const { return whole_number(a); }
};
struct IntToTriple {
  Triple operator()(int a) const { return Triple(float(a)); }
};
struct FloatToTriple {
  Triple operator()(float a) const { return Triple(a); }
  Dual<Triple> operator()(const Dual<float>& a) const { return {Triple(a.value), Triple(a.dx), Triple(a.dy)}; }
};
struct IntToMatrix {
  Matrix operator()(int a) const { return Matrix::diagonal(float(a)); }
};
struct FloatToMatrix {
  Matrix operator()(float a) const { return Matrix::diagonal(a); }
};
struct IntToSpectrum {
  Spectrum operator()(int a) const { return Spectrum(float(a)); }
};
struct FloatToSpectrum {
  Spectrum operator()(float a) const { return Spectrum(a); }
};

/// The same for one number or address, or a triple.
struct Same {
  template <class T>
  const T& operator()(const T& a) const {
    return a;
  }
};

struct IsTrue {
  int operator()(int a) const { return a != 0; }
  int operator()(float a) const { return a != 0; }
  int operator()(const Triple& a) const { return a.x != 0 || a.y != 0 || a.z != 0; }
  int operator()(const Matrix& a) const {
    for (const auto& row : a.m)
      for (const float x : row)
        if (x != 0) return 1;
    return 0;
  }
  int operator()(const Spectrum& a) const { return Unequal()(a, Spectrum()); }
  int operator()(const String* a) const { return !a->text().empty(); }
  int operator()(const ClosureNode* a) const { return a != nullptr; }
};
struct IsFalse {
  template <class T>
  int operator()(const T& a) const {
    return !IsTrue()(a);
  }
};

/// Operators of one operand. The ways of conversion differ in the numbers of words that they read and write.
template <class A, class Op>
struct Emit {
  static void unary(Code& code, const Memory& a, const Memory& out) {
    if constexpr (std::is_same_v<Op, IsTrue> || std::is_same_v<Op, IsFalse>) {
      const Truth yes = is_true(code, a);
      store(code, out, int_of(std::is_same_v<Op, IsTrue> ? yes : !yes));
    } else if constexpr (std::is_same_v<Op, FloatToInt>) {
      store(code, out, whole_number(load_number<Real>(code, a, 0)));
    } else if constexpr (std::is_same_v<Op, Same>) {
      emit_copy(code, a.type, {out.offset, {}}, 0, {a.offset, {}}, 0, sizeof(A));
      clear_derivatives(code, out);
    } else if constexpr (std::is_same_v<A, int> && std::is_same_v<std::invoke_result_t<Op, int>, int>) {
      store(code, out, Op()(load_int(code, a)));
    } else if constexpr (std::is_same_v<A, int>) {
      replicate(code, out, float_of(load_int(code, a)));
    } else if constexpr (std::is_same_v<Op, Negate>) {
      negate<Real>(code, a, out);
    } else {
      replicate(code, out, load_number<Real>(code, a, 0));
    }
  }
  static void dual_unary(Code& code, const Memory& a, const Memory& out) {
    if constexpr (std::is_same_v<Op, Same>)
      emit_copy(code, a.type, {out.offset, {}}, out.stride, {a.offset, {}}, a.stride, sizeof(A));
    else if constexpr (std::is_same_v<Op, Negate>)
      negate<Dual<Real>>(code, a, out);
    else
      replicate(code, out, load_number<Dual<Real>>(code, a, 0));
  }

 private:
  static constexpr int words = int(sizeof(A) / sizeof(float));

  static void clear_derivatives(Code& code, const Memory& out) {
    if (!out.stride) return;
    for (std::size_t i = 1; i < 3; ++i) code.clear({out.offset + std::uint32_t(i) * out.stride, {}}, sizeof(A));
  }
  /// -x, of a matrix x * -1, which is the same but for not-a-number's sign.
  template <class N>
  static void negate(Code& code, const Memory& a, const Memory& out) {
    std::array<N, words> results;
    for (int k = 0; k < words; ++k) {
      if constexpr (std::is_same_v<A, Matrix>)
        results[k] = load_number<N>(code, a, k) * real(code, -1);
      else
        results[k] = -load_number<N>(code, a, k);
    }
    for (int k = 0; k < words; ++k) store_number(code, out, k, results[k]);
  }
  /// One number as all components, or in the diagonal of a matrix.
  template <class N>
  static void replicate(Code& code, const Memory& out, const N& x) {
    if (out.type.is_matrix()) {
      if constexpr (std::is_same_v<N, Real>)
        for (int k = 0; k < 16; ++k) store_number(code, out, k, k % 5 == 0 ? x : x.like(0));
      return;
    }
    for (int k = 0; k < out.type.floats(); ++k) store_number(code, out, k, x);
  }
  static Truth is_true(Code& code, const Memory& a) {
    if constexpr (std::is_same_v<A, int>) {
      return load_int(code, a) != whole(code, 0);
    } else if constexpr (std::is_same_v<A, const String*>) {
      return load_address(code, a) != coded<Address>(code, code.address(empty_string()));
    } else if constexpr (std::is_pointer_v<A>) {
      return load_address(code, a) != coded<Address>(code, code.address(nullptr));
    } else {
      Truth any = load_number<Real>(code, a, 0) != real(code, 0);
      for (int k = 1; k < words; ++k) any = any || load_number<Real>(code, a, k) != real(code, 0);
      return any;
    }
  }
  static Whole whole_number(Real f) {
    const Truth in_range = f > f.like(-2147483904.0f) && f < f.like(2147483648.0f);
    const Real safe = select(in_range, f, f.like(0));
    return select(in_range, coded<Whole>(*f.code, f.code->int_of_float(safe.word)), whole(*f.code, INT32_MIN));
  }
};

template <class A, class B, class Op>
class Binary final : public Node {
 public:
  Binary(const Value& a, const Value& b, const Memory& out) : a_(a), b_(b), out_(out) {}
  Flow run(RunState& run) const override {
    a_.evaluate(run);
    b_.evaluate(run);
    store(run, out_, Op()(load<A>(run, a_.memory), load<B>(run, b_.memory)));
    return Flow::next;
  }
  void emit(Code& code) const override {
    a_.emit(code);
    b_.emit(code);
    emit_binary<A, B, Op, false>(code, a_.memory, b_.memory, out_);
  }

 private:
  Value a_, b_;
  Memory out_;
};

template <class A, class B, class Op>
class DualBinary final : public Node {
 public:
  DualBinary(const Value& a, const Value& b, const Memory& out) : a_(a), b_(b), out_(out) {}
  Flow run(RunState& run) const override {
    a_.evaluate(run);
    b_.evaluate(run);
    store(run, out_, Op()(load_dual<A>(run, a_.memory), load_dual<B>(run, b_.memory)));
    return Flow::next;
  }
  void emit(Code& code) const override {
    a_.emit(code);
    b_.emit(code);
    emit_binary<A, B, Op, true>(code, a_.memory, b_.memory, out_);
  }

 private:
  Value a_, b_;
  Memory out_;
};

template <class A, class Op>
class Unary final : public Node {
 public:
  Unary(const Value& a, const Memory& out) : a_(a), out_(out) {}
  Flow run(RunState& run) const override {
    a_.evaluate(run);
    store(run, out_, Op()(load<A>(run, a_.memory)));
    return Flow::next;
  }
  void emit(Code& code) const override {
    a_.emit(code);
    Emit<A, Op>::unary(code, a_.memory, out_);
  }

 private:
  Value a_;
  Memory out_;
};

template <class A, class Op>
class DualUnary final : public Node {
 public:
  DualUnary(const Value& a, const Memory& out) : a_(a), out_(out) {}
  Flow run(RunState& run) const override {
    a_.evaluate(run);
    store(run, out_, Op()(load_dual<A>(run, a_.memory)));
    return Flow::next;
  }
  void emit(Code& code) const override {
    a_.emit(code);
    Emit<A, Op>::dual_unary(code, a_.memory, out_);
  }

 private:
  Value a_;
  Memory out_;
};

template <class T, class Op>
const Node* numeric(NodeStore& nodes, const Value& a, const Value& b, const Memory& out) {
  if (out.stride) return nodes.make<DualBinary<T, T, Op>>(a, b, out);
  return nodes.make<Binary<T, T, Op>>(a, b, out);
}

/// + - * / of the types that have them all.
template <class Op>
const Node* arithmetic(NodeStore& nodes, const Value& a, const Value& b, const Memory& out) {
  const Type &ta = a.type(), &tb = b.type();
  if (ta.is_int() && tb.is_int()) return nodes.make<Binary<int, int, Op>>(a, b, out);
  if (ta.is_float() && tb.is_float()) return numeric<float, Op>(nodes, a, b, out);
  if (ta.is_triple() && tb.is_triple()) return numeric<Triple, Op>(nodes, a, b, out);
  if (ta.base == Base::spectrum && tb.base == Base::spectrum) return nodes.make<Binary<Spectrum, Spectrum, Op>>(a, b, out);
  return nullptr;
}

template <class Op>
const Node* matrix_arithmetic(NodeStore& nodes, const Value& a, const Value& b, const Memory& out) {
  const Type &ta = a.type(), &tb = b.type();
  if (ta.is_matrix() && tb.is_matrix()) return nodes.make<Binary<Matrix, Matrix, Op>>(a, b, out);
  if (ta.is_matrix() && tb.is_float()) return nodes.make<Binary<Matrix, float, Op>>(a, b, out);
  if (ta.is_float() && tb.is_matrix()) return nodes.make<Binary<float, Matrix, Op>>(a, b, out);
  return arithmetic<Op>(nodes, a, b, out);
}

template <class Op>
const Node* equality(NodeStore& nodes, const Value& a, const Value& b, const Memory& out) {
  const Type& t = a.type();
  if (t.is_int()) return nodes.make<Binary<int, int, Op>>(a, b, out);
  if (t.is_float()) return nodes.make<Binary<float, float, Op>>(a, b, out);
  if (t.is_triple()) return nodes.make<Binary<Triple, Triple, Op>>(a, b, out);
  if (t.is_matrix()) return nodes.make<Binary<Matrix, Matrix, Op>>(a, b, out);
  if (t.is_string()) return nodes.make<Binary<const String*, const String*, Op>>(a, b, out);
  if (t.base == Base::spectrum) return nodes.make<Binary<Spectrum, Spectrum, Op>>(a, b, out);
  return nullptr;
}

template <class Op>
const Node* order(NodeStore& nodes, const Value& a, const Value& b, const Memory& out) {
  if (a.type().is_int()) return nodes.make<Binary<int, int, Op>>(a, b, out);
  if (a.type().is_float()) return nodes.make<Binary<float, float, Op>>(a, b, out);
  return nullptr;
}

template <class Op>
const Node* whole(NodeStore& nodes, const Value& a, const Value& b, const Memory& out) {
  return nodes.make<Binary<int, int, Op>>(a, b, out);
}

// ---- conversions
// ---------------------------------------------------------------------------------------------------------------

/// The closure that does nothing, of a null.
class NoClosure final : public Node {
 public:
  NoClosure(const Value& from, const Memory& out) : from_(from), out_(out) {}
  Flow run(RunState& run) const override {
    from_.evaluate(run);
    value_at<const ClosureNode*>(run, out_.offset) = nullptr;
    return Flow::next;
  }
  void emit(Code& code) const override {
    from_.emit(code);
    code.store({out_.offset, {}}, code.address(nullptr));
  }

 private:
  Value from_;
  Memory out_;
};

class Copy final : public Node {
 public:
  Copy(const Value& from, const Memory& to) : from_(from), to_(to), size_(std::min(from.type().size(), to.type.size())) {}
  Flow run(RunState& run) const override {
    from_.evaluate(run);
    copy_value(run.memory + to_.offset, to_.stride, run.memory + from_.memory.offset, from_.memory.stride, size_);
    return Flow::next;
  }
  void emit(Code& code) const override {
    from_.emit(code);
    emit_copy(code, to_.type, {to_.offset, {}}, to_.stride, {from_.memory.offset, {}}, from_.memory.stride, size_);
  }

 private:
  Value from_;
  Memory to_;
  std::size_t size_;
};

template <class T>
const Node* copy_of(NodeStore& nodes, const Value& from, const Memory& to) {
  if (to.stride) return nodes.make<DualUnary<T, Same>>(from, to);
  return nodes.make<Unary<T, Same>>(from, to);
}

// ---- truth
// -------------------------------------------------------------------------------------------------------------------

template <class Op>
const Node* truth_of(NodeStore& nodes, const Value& a, const Memory& out) {
  const Type& t = a.type();
  if (t.is_closure()) return nodes.make<Unary<const ClosureNode*, Op>>(a, out);
  if (t.is_int()) return nodes.make<Unary<int, Op>>(a, out);
  if (t.is_float()) return nodes.make<Unary<float, Op>>(a, out);
  if (t.is_triple()) return nodes.make<Unary<Triple, Op>>(a, out);
  if (t.is_matrix()) return nodes.make<Unary<Matrix, Op>>(a, out);
  if (t.is_string()) return nodes.make<Unary<const String*, Op>>(a, out);
  if (t.base == Base::spectrum) return nodes.make<Unary<Spectrum, Op>>(a, out);
  return nullptr;
}

class MakeTriple final : public Node {
 public:
  MakeTriple(const Value& x, const Value& y, const Value& z, const Memory& out) : x_(x), y_(y), z_(z), out_(out) {}
  Flow run(RunState& run) const override {
    x_.evaluate(run);
    y_.evaluate(run);
    z_.evaluate(run);
    if (out_.stride)
      store(run, out_,
            make_triple(load_dual<float>(run, x_.memory), load_dual<float>(run, y_.memory), load_dual<float>(run, z_.memory)));
    else
      store(run, out_, Triple(load<float>(run, x_.memory), load<float>(run, y_.memory), load<float>(run, z_.memory)));
    return Flow::next;
  }
  void emit(Code& code) const override {
    x_.emit(code);
    y_.emit(code);
    z_.emit(code);
    if (out_.stride)
      emit_parts<Dual<Real>>(code);
    else
      emit_parts<Real>(code);
  }

 private:
  template <class N>
  void emit_parts(Code& code) const {
    const N x = load_number<N>(code, x_.memory, 0), y = load_number<N>(code, y_.memory, 0),
            z = load_number<N>(code, z_.memory, 0);
    store_number(code, out_, 0, x);
    store_number(code, out_, 1, y);
    store_number(code, out_, 2, z);
  }

  Value x_, y_, z_;
  Memory out_;
};

}  // namespace

// ---- which node
// --------------------------------------------------------------------------------------------------------------

const Node* binary_node(NodeStore& nodes, Operator operation, const Value& a, const Value& b, const Memory& out) {
  if (a.type().is_closure() && b.type().is_closure()) return closure_sum_node(nodes, a, b, out);
  if (a.type().is_closure()) return closure_product_node(nodes, a, b, false, out);
  if (b.type().is_closure()) return closure_product_node(nodes, b, a, true, out);
  switch (operation) {
    case Operator::add: return arithmetic<Add>(nodes, a, b, out);
    case Operator::subtract: return arithmetic<Subtract>(nodes, a, b, out);
    case Operator::multiply: return matrix_arithmetic<Multiply>(nodes, a, b, out);
    case Operator::divide: return matrix_arithmetic<Divide>(nodes, a, b, out);
    case Operator::modulus: return whole<Modulus>(nodes, a, b, out);
    case Operator::shift_left: return whole<ShiftLeft>(nodes, a, b, out);
    case Operator::shift_right: return whole<ShiftRight>(nodes, a, b, out);
    case Operator::bit_and: return whole<BitAnd>(nodes, a, b, out);
    case Operator::bit_or: return whole<BitOr>(nodes, a, b, out);
    case Operator::bit_xor: return whole<BitXor>(nodes, a, b, out);
    case Operator::equal: return equality<Equal>(nodes, a, b, out);
    case Operator::unequal: return equality<Unequal>(nodes, a, b, out);
    case Operator::less: return order<Less>(nodes, a, b, out);
    case Operator::less_equal: return order<LessEqual>(nodes, a, b, out);
    case Operator::greater: return order<Greater>(nodes, a, b, out);
    case Operator::greater_equal: return order<GreaterEqual>(nodes, a, b, out);
    case Operator::none:
    case Operator::negate:
    case Operator::complement: break;
  }
  return nullptr;
}

const Node* unary_node(NodeStore& nodes, Operator operation, const Value& a, const Memory& out) {
  const Type& t = a.type();
  if (operation == Operator::complement) return nodes.make<Unary<int, Complement>>(a, out);
  if (t.is_closure()) return nullptr;
  if (t.is_int()) return nodes.make<Unary<int, Negate>>(a, out);
  if (t.is_float() && out.stride) return nodes.make<DualUnary<float, Negate>>(a, out);
  if (t.is_float()) return nodes.make<Unary<float, Negate>>(a, out);
  if (t.is_triple() && out.stride) return nodes.make<DualUnary<Triple, Negate>>(a, out);
  if (t.is_triple()) return nodes.make<Unary<Triple, Negate>>(a, out);
  if (t.is_matrix()) return nodes.make<Unary<Matrix, Negate>>(a, out);
  if (t.base == Base::spectrum) return nodes.make<Unary<Spectrum, Negate>>(a, out);
  return nullptr;
}

const Node* conversion_node(NodeStore& nodes, const Value& a, const Memory& out) {
  const Type &from = a.type(), &to = out.type;
  if (to.is_closure()) return from.is_closure() ? copy_node(nodes, a, out) : nodes.make<NoClosure>(a, out);
  if (from.is_int() && to.is_float()) return nodes.make<Unary<int, IntToFloat>>(a, out);
  if (from.is_float() && to.is_int()) return nodes.make<Unary<float, FloatToInt>>(a, out);
  if (from.is_int() && to.is_triple()) return nodes.make<Unary<int, IntToTriple>>(a, out);
  if (from.is_float() && to.is_triple() && out.stride) return nodes.make<DualUnary<float, FloatToTriple>>(a, out);
  if (from.is_float() && to.is_triple()) return nodes.make<Unary<float, FloatToTriple>>(a, out);
  if (from.is_int() && to.is_matrix()) return nodes.make<Unary<int, IntToMatrix>>(a, out);
  if (from.is_float() && to.is_matrix()) return nodes.make<Unary<float, FloatToMatrix>>(a, out);
  if (from.is_int() && to.base == Base::spectrum) return nodes.make<Unary<int, IntToSpectrum>>(a, out);
  if (from.is_float() && to.base == Base::spectrum) return nodes.make<Unary<float, FloatToSpectrum>>(a, out);
  return copy_node(nodes, a, out);
}

const Node* truth_node(NodeStore& nodes, const Value& a, bool expected, const Memory& out) {
  return expected ? truth_of<IsTrue>(nodes, a, out) : truth_of<IsFalse>(nodes, a, out);
}

const Node* copy_node(NodeStore& nodes, const Value& from, const Memory& to) {
  const Type& t = to.type;
  if (!t.is_array() && !from.type().is_array()) {
    if (t.is_closure()) return copy_of<const ClosureNode*>(nodes, from, to);
    if (t.is_int()) return copy_of<int>(nodes, from, to);
    if (t.is_float()) return copy_of<float>(nodes, from, to);
    if (t.is_triple()) return copy_of<Triple>(nodes, from, to);
    if (t.is_string()) return copy_of<const String*>(nodes, from, to);
  }
  return nodes.make<Copy>(from, to);
}

const Node* triple_node(NodeStore& nodes, const Value& x, const Value& y, const Value& z, const Memory& out) {
  return nodes.make<MakeTriple>(x, y, z, out);
}

}  // namespace etendue::osl
