#include "folding.h"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "conversions.h"
#include "osl/library/services.h"

namespace etendue::osl {

namespace {

/// The world of functions that are computed without one: complaints are kept, so that the call is left to the run.
class NoWorld final : public Services {
 public:
  void warn(std::string_view, Location) override { complained = true; }
  void error(std::string_view, Location) override { complained = true; }
  void* allocate(std::size_t size, std::size_t) override {
    memory_.push_back(std::make_unique<std::max_align_t[]>(size / sizeof(std::max_align_t) + 1));
    return memory_.back().get();
  }
  bool complained = false;

 private:
  std::vector<std::unique_ptr<std::max_align_t[]>> memory_;
};

ExpressionPointer constant_of(Location at, Constant c) {
  auto e = std::make_unique<Expression>();
  e->kind = Expression::Kind::constant;
  e->place = at;
  e->type = c.type;
  e->constant = std::move(c);
  return e;
}

int wrap(std::int64_t v) { return int(std::uint32_t(std::uint64_t(v))); }

int on_ints(Operator o, int a, int b) {
  switch (o) {
    case Operator::add: return wrap(std::int64_t(a) + b);
    case Operator::subtract: return wrap(std::int64_t(a) - b);
    case Operator::multiply: return wrap(std::int64_t(a) * b);
    case Operator::divide: return b == 0 ? 0 : wrap(std::int64_t(a) / b);
    case Operator::modulus: return b == 0 ? 0 : wrap(std::int64_t(a) % b);
    case Operator::shift_left: return int(std::uint32_t(a) << (b & 31));
    case Operator::shift_right: return a >> (b & 31);
    case Operator::bit_and: return a & b;
    case Operator::bit_or: return a | b;
    case Operator::bit_xor: return a ^ b;
    case Operator::equal: return a == b;
    case Operator::unequal: return a != b;
    case Operator::less: return a < b;
    case Operator::less_equal: return a <= b;
    case Operator::greater: return a > b;
    case Operator::greater_equal: return a >= b;
    default: return 0;
  }
}

float on_floats(Operator o, float a, float b) {
  switch (o) {
    case Operator::add: return a + b;
    case Operator::subtract: return a - b;
    case Operator::multiply: return a * b;
    case Operator::divide: return safe_divide(a, b);
    default: return 0;
  }
}

int compare(Operator o, float a, float b) {
  switch (o) {
    case Operator::equal: return a == b;
    case Operator::unequal: return a != b;
    case Operator::less: return a < b;
    case Operator::less_equal: return a <= b;
    case Operator::greater: return a > b;
    default: return a >= b;
  }
}

bool is_comparison(Operator o) { return o >= Operator::equal && o <= Operator::greater_equal; }

/// False if this combination is left to the run.
bool fold_binary(const Expression& e, Constant& out) {
  const Constant &a = e.operands[0]->constant, &b = e.operands[1]->constant;
  const Type t = a.type;
  if (t.is_array() || t.is_closure() || b.type.is_closure()) return false;
  if (t.is_int() && b.type.is_int()) {
    const int v = on_ints(e.operation, a.at<int>(), b.at<int>());
    std::memcpy(out.bytes.data(), &v, sizeof v);
    return true;
  }
  if (t.is_string()) {
    const int v = (a.at<const String*>() == b.at<const String*>()) == (e.operation == Operator::equal);
    std::memcpy(out.bytes.data(), &v, sizeof v);
    return true;
  }
  if (!((t.is_float() && b.type.is_float()) || (t.is_triple() && b.type.is_triple()))) return false;
  const int floats = t.is_float() ? 1 : 3;
  if (is_comparison(e.operation)) {
    bool all = true;
    const Operator each = e.operation == Operator::unequal ? Operator::equal : e.operation;
    for (int i = 0; i < floats; ++i) all = all && compare(each, a.at<float>(std::size_t(i)), b.at<float>(std::size_t(i)));
    const int v = all != (e.operation == Operator::unequal);
    std::memcpy(out.bytes.data(), &v, sizeof v);
    return true;
  }
  for (int i = 0; i < floats; ++i) {
    const float v = on_floats(e.operation, a.at<float>(std::size_t(i)), b.at<float>(std::size_t(i)));
    std::memcpy(out.bytes.data() + std::size_t(i) * sizeof v, &v, sizeof v);
  }
  return true;
}

bool fold_unary(const Expression& e, Constant& out) {
  const Constant& a = e.operands[0]->constant;
  if (a.type.is_int()) {
    const int v = e.operation == Operator::negate ? wrap(-std::int64_t(a.at<int>())) : ~a.at<int>();
    std::memcpy(out.bytes.data(), &v, sizeof v);
    return true;
  }
  if (!a.type.float_based() || a.type.base == Base::spectrum || a.type.is_array()) return false;
  for (std::size_t i = 0; i < a.bytes.size() / sizeof(float); ++i) {
    const float v = -a.at<float>(i);
    std::memcpy(out.bytes.data() + i * sizeof v, &v, sizeof v);
  }
  return true;
}

bool fold_conversion(const Expression& e, Constant& out) {
  const Constant& a = e.operands[0]->constant;
  const Type &to = e.type, &from = a.type;
  if (equivalent(to, from)) {
    out.bytes = a.bytes;
    return true;
  }
  if (to.is_int() && from.is_float()) {
    const float f = a.at<float>();
    const int v = f >= 2147483648.0f ? 2147483647 : (f > -2147483648.0f ? int(f) : (f != f ? 0 : -2147483647 - 1));
    std::memcpy(out.bytes.data(), &v, sizeof v);
    return true;
  }
  if (!from.is_int() && !from.is_float()) return false;
  const float v = from.is_int() ? float(a.at<int>()) : a.at<float>();
  float* to_floats = reinterpret_cast<float*>(out.bytes.data());
  if (to.is_matrix()) {
    for (int i = 0; i < 4; ++i) to_floats[5 * i] = v;
  } else if (to.is_float() || to.is_triple()) {
    for (int i = 0; i < to.floats(); ++i) to_floats[i] = v;
  } else {
    return false;
  }
  return true;
}

bool truth_of(const Constant& c) {
  if (c.type.is_string()) return c.at<const String*>() != empty_string();
  if (c.type.is_closure()) return c.at<const void*>() != nullptr;
  if (c.type.is_int()) return c.at<int>() != 0;
  for (std::size_t i = 0; i < c.bytes.size() / sizeof(float); ++i)
    if (c.at<float>(i) != 0) return true;
  return false;
}

bool fold_aggregate(const Expression& e, Constant& out) {
  if (e.type.array == Type::unsized) return false;
  for (std::size_t i = 0; i < e.operands.size(); ++i) {
    if (!e.operands[i]) continue;
    const Constant& part = e.operands[i]->constant;
    const std::size_t offset = e.type.is_array() ? i * e.type.element_size() : e.type.structure->fields[i].offset;
    if (offset + part.bytes.size() > out.bytes.size()) return false;
    std::memcpy(out.bytes.data() + offset, part.bytes.data(), part.bytes.size());
  }
  return true;
}

bool fold_library(const Expression& e, Constant& out) {
  const Row& row = *e.row;
  if (!row.pure || !row.choose || row.refused || row.derivatives == Derivatives::taken) return false;
  if (std::strstr(row.signature, "output ")) return false;
  if (e.type.is_closure() || e.type.is_array() || e.type.is_structure() || e.type.base == Base::spectrum) return false;
  CallTypes types;
  types.result.type = e.type;
  types.place = e.place;
  std::vector<void*> arguments;
  for (const ExpressionPointer& o : e.operands) {
    types.arguments.push_back({o->type, false});
    arguments.push_back(const_cast<std::byte*>(o->constant.bytes.data()));
  }
  const Evaluate evaluate = row.choose(types);
  if (!evaluate) return false;
  NoWorld world;
  evaluate({arguments.data(), out.bytes.data(), types, world});
  return !world.complained;
}

bool fold_part(const Expression& e, Constant& out) {
  const Constant& whole = e.operands[0]->constant;
  std::size_t offset = 0;
  if (e.kind == Expression::Kind::field) {
    offset = whole.type.structure->fields[std::size_t(e.index)].offset;
  } else {
    const int i = e.operands[1]->constant.at<int>();
    const int count = e.kind == Expression::Kind::element ? whole.type.elements() : 3;
    if (i < 0 || i >= count) return false;  // an error of the run, with its place
    offset = std::size_t(i) * e.type.size();
  }
  if (offset + out.bytes.size() > whole.bytes.size()) return false;
  std::memcpy(out.bytes.data(), whole.bytes.data() + offset, out.bytes.size());
  return true;
}

bool fold_into(const Expression& e, Constant& out) {
  switch (e.kind) {
    case Expression::Kind::binary: return fold_binary(e, out);
    case Expression::Kind::unary: return fold_unary(e, out);
    case Expression::Kind::conversion: return fold_conversion(e, out);
    case Expression::Kind::aggregate: return fold_aggregate(e, out);
    case Expression::Kind::library: return fold_library(e, out);
    case Expression::Kind::element:
    case Expression::Kind::component:
    case Expression::Kind::field: return fold_part(e, out);
    case Expression::Kind::truth:
    case Expression::Kind::not_true: {
      const int v = truth_of(e.operands[0]->constant) == (e.kind == Expression::Kind::truth);
      std::memcpy(out.bytes.data(), &v, sizeof v);
      return true;
    }
    default: return false;
  }
}

}  // namespace

Constant zero_constant(const Type& t) {
  constexpr std::size_t most_bytes = std::size_t(1) << 28;
  Constant c;
  c.type = t;
  c.bytes.resize(std::min(t.size(), most_bytes));
  if (t.base == Base::string) {
    for (int i = 0; i < t.elements(); ++i) reinterpret_cast<const String**>(c.bytes.data())[i] = empty_string();
  } else if (t.is_structure()) {
    for (int i = 0; i < t.elements(); ++i)
      for (const Field& f : t.structure->fields) {
        const Constant part = zero_constant(f.type);
        std::memcpy(c.bytes.data() + std::size_t(i) * t.element_size() + f.offset, part.bytes.data(), part.bytes.size());
      }
  }
  return c;
}

ExpressionPointer make_constant(Location at, const Type& type, const void* bytes) {
  Constant c;
  c.type = type;
  c.bytes.resize(type.size());
  std::memcpy(c.bytes.data(), bytes, c.bytes.size());
  return constant_of(at, std::move(c));
}
ExpressionPointer make_constant(Location at, int v) { return make_constant(at, Base::int_, &v); }
ExpressionPointer make_constant(Location at, float v) { return make_constant(at, Base::float_, &v); }
ExpressionPointer make_constant(Location at, const String* v) { return make_constant(at, Base::string, &v); }

ExpressionPointer fold(ExpressionPointer e) {
  if (e->kind == Expression::Kind::constant || e->type.is_void() || e->type.is_closure()) return e;
  for (const ExpressionPointer& o : e->operands)
    if (o && o->kind != Expression::Kind::constant) return e;
  constexpr std::size_t most_bytes = 1 << 20;
  if (e->type.size() == 0 || e->type.size() > most_bytes) return e;
  Constant out = zero_constant(e->type);
  if (!fold_into(*e, out)) return e;
  return constant_of(e->place, std::move(out));
}

}  // namespace etendue::osl
