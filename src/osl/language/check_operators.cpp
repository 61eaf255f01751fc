// Operators: the types of their operands and results, and functions that stand for them (`__operator__add__`).

#include <fmt/format.h>

#include "checker.h"
#include "conversions.h"
#include "folding.h"
#include "parser.h"

namespace etendue::osl {

namespace {

struct OperatorName {
  Operator operation;
  const char* sign;
  const char* function;
};
constexpr OperatorName operator_names[] = {
    {Operator::add, "+", "__operator__add__"},          {Operator::subtract, "-", "__operator__sub__"},
    {Operator::multiply, "*", "__operator__mul__"},     {Operator::divide, "/", "__operator__div__"},
    {Operator::modulus, "%", "__operator__mod__"},      {Operator::shift_left, "<<", "__operator__shl__"},
    {Operator::shift_right, ">>", "__operator__shr__"}, {Operator::bit_and, "&", "__operator__bitand__"},
    {Operator::bit_or, "|", "__operator__bitor__"},     {Operator::bit_xor, "^", "__operator__xor__"},
    {Operator::equal, "==", "__operator__eq__"},        {Operator::unequal, "!=", "__operator__neq__"},
    {Operator::less, "<", "__operator__lt__"},          {Operator::less_equal, "<=", "__operator__le__"},
    {Operator::greater, ">", "__operator__gt__"},       {Operator::greater_equal, ">=", "__operator__ge__"},
    {Operator::negate, "-", "__operator__neg__"},       {Operator::complement, "~", "__operator__compl__"},
};

const OperatorName& names_of(Operator o) {
  for (const OperatorName& n : operator_names)
    if (n.operation == o) return n;
  return operator_names[0];
}

bool is_comparison(Operator o) { return o >= Operator::equal && o <= Operator::greater_equal; }
bool is_bitwise(Operator o) { return o >= Operator::shift_left && o <= Operator::bit_xor; }
bool is_number(const Type& t) { return t.is_int() || t.is_float(); }

/// The kind of the triple that an operation of two triples gives: the difference of two points is a vector, a point moved by a
/// vector a point; else the kind of the first.
Base triple_of(Operator o, Base a, Base b) {
  if (a == b) return o == Operator::subtract && a == Base::point ? Base::vector : a;
  if (a == Base::color || b == Base::color) return Base::color;
  if (a == Base::point || b == Base::point) return Base::point;
  return a;
}

}  // namespace

/// The call of a function that the text declares for an operator and these operands; null if there is none.
ExpressionPointer Checker::overloaded(const char* name, std::vector<ExpressionPointer>& operands, Location at) {
  if (scope_->functions(name).empty()) return nullptr;
  std::vector<Argument> arguments;
  for (ExpressionPointer& o : operands) arguments.push_back({std::move(o), nullptr, at});
  if (candidates(name, arguments).empty()) {
    for (std::size_t i = 0; i < operands.size(); ++i) operands[i] = std::move(arguments[i].value);
    return nullptr;
  }
  return call(name, std::move(arguments), {}, at);
}

ExpressionPointer Checker::closure_operation(Operator o, ExpressionPointer a, ExpressionPointer b, Location at) {
  const Type ta = a->type, tb = b->type;
  const auto weight = [](const Type& t) {
    return is_number(t) || (t.is_triple() && t.base == Base::color) || t == Type(Base::spectrum);
  };
  if (o == Operator::add && ta.is_closure() && tb.is_closure() && !ta.is_array() && !tb.is_array())
    return make(Expression::Kind::binary, ta, at, std::move(a), std::move(b));
  if (o == Operator::add) {  // closure + 0
    if (ta.is_closure() && !ta.is_array()) b = converted(std::move(b), ta, "the sum");
    if (tb.is_closure() && !tb.is_array()) a = converted(std::move(a), tb, "the sum");
    if (a->type.is_closure() && b->type.is_closure())
      return make(Expression::Kind::binary, a->type, at, std::move(a), std::move(b));
  }
  if (o == Operator::multiply && !ta.is_array() && !tb.is_array()) {
    if (ta.is_closure() && weight(tb)) {
      if (tb.is_int()) b = convert(std::move(b), Base::float_);
      return make(Expression::Kind::binary, ta, at, std::move(a), std::move(b));
    }
    if (tb.is_closure() && weight(ta)) {
      if (ta.is_int()) a = convert(std::move(a), Base::float_);
      return make(Expression::Kind::binary, tb, at, std::move(a), std::move(b));
    }
  }
  refuse(at, fmt::format("there is no '{}' of '{}' and '{}'", names_of(o).sign, ta.name(), tb.name()));
}

ExpressionPointer Checker::operation(Operator o, ExpressionPointer a, ExpressionPointer b, Location at) {
  {
    std::vector<ExpressionPointer> operands;
    operands.push_back(std::move(a)), operands.push_back(std::move(b));
    if (ExpressionPointer called = overloaded(names_of(o).function, operands, at)) return called;
    a = std::move(operands[0]), b = std::move(operands[1]);
  }
  const Type ta = a->type, tb = b->type;
  const auto none = [&]() {
    refuse(at, fmt::format("there is no '{}' of '{}' and '{}'", names_of(o).sign, ta.name(), tb.name()));
  };
  if (ta.is_array() || tb.is_array() || ta.is_structure() || tb.is_structure() || ta.is_void() || tb.is_void()) none();
  const auto binary = [&](const Type& result, const Type& operands) {
    a = convert(std::move(a), operands), b = convert(std::move(b), operands);
    ExpressionPointer e = make(Expression::Kind::binary, result, at, std::move(a), std::move(b));
    e->operation = o;
    return fold(std::move(e));
  };
  const auto mixed = [&](const Type& result) {
    ExpressionPointer e = make(Expression::Kind::binary, result, at, std::move(a), std::move(b));
    e->operation = o;
    return e;
  };
  if (ta.is_closure() || tb.is_closure()) {
    ExpressionPointer e = closure_operation(o, std::move(a), std::move(b), at);
    e->operation = o;
    return e;
  }
  const Type result_of_comparison = Base::int_;
  if (ta.is_string() || tb.is_string()) {
    if (!ta.is_string() || !tb.is_string() || (o != Operator::equal && o != Operator::unequal)) none();
    return binary(result_of_comparison, Base::string);
  }
  if (is_bitwise(o)) {
    if (!ta.is_int() || !tb.is_int()) none();
    return binary(Base::int_, Base::int_);
  }
  const bool numbers = is_number(ta) && is_number(tb);
  const Type number = ta.is_int() && tb.is_int() ? Base::int_ : Base::float_;
  if (is_comparison(o)) {
    if (numbers) return binary(result_of_comparison, number);
    if (o != Operator::equal && o != Operator::unequal) none();
    const Type larger = is_number(ta) ? tb : ta;
    if (!(equivalent(ta, tb) || is_number(ta) || is_number(tb)) || larger == Type(Base::spectrum)) none();
    return binary(result_of_comparison, larger);
  }
  if (o == Operator::modulus) {
    if (ta.is_int() && tb.is_int()) return binary(Base::int_, Base::int_);
    if (ta == Type(Base::spectrum) || tb == Type(Base::spectrum) || ta.is_matrix() || tb.is_matrix()) none();
    std::vector<Argument> arguments;
    if (ta.is_int()) a = convert(std::move(a), Base::float_);
    arguments.push_back({std::move(a), nullptr, at}), arguments.push_back({std::move(b), nullptr, at});
    return call("fmod", std::move(arguments), {}, at);
  }
  if (numbers) return binary(number, number);
  if (ta == Type(Base::spectrum) || tb == Type(Base::spectrum)) {
    if (!((ta == tb) || is_number(ta) || is_number(tb))) none();
    return binary(Base::spectrum, Base::spectrum);
  }
  if (ta.is_matrix() || tb.is_matrix()) {
    if (o != Operator::multiply && o != Operator::divide) none();
    if (ta.is_int()) a = convert(std::move(a), Base::float_);
    if (tb.is_int()) b = convert(std::move(b), Base::float_);
    if (!(ta.is_matrix() || is_number(ta)) || !(tb.is_matrix() || is_number(tb))) none();
    return mixed(Base::matrix);
  }
  if (ta.is_triple() && tb.is_triple()) {
    const Type result = triple_of(o, ta.base, tb.base);
    ExpressionPointer e = make(Expression::Kind::binary, result, at, std::move(a), std::move(b));
    e->operation = o;
    return fold(std::move(e));
  }
  const Type triple = ta.is_triple() ? ta : tb;
  return binary(triple, triple);
}

ExpressionPointer Checker::binary(const syntax::Expression& e, Type expected) {
  if (!e.name.empty()) {  // && and ||
    ExpressionPointer a = condition(*e.operands[0]), b = condition(*e.operands[1]);
    const bool both = e.name == "&&";
    if (a->kind == Expression::Kind::constant) {
      // Short circuit: what is not evaluated may be dropped.
      if ((a->constant.at<int>() != 0) == both) return b;
      dropped_.push_back(std::move(b));
      return a;
    }
    return make(both ? Expression::Kind::logical_and : Expression::Kind::logical_or, Base::int_, e.place, std::move(a),
                std::move(b));
  }
  if (is_comparison(e.operation)) expected = {};
  ExpressionPointer a = value(*e.operands[0], expected);
  return operation(e.operation, std::move(a), value(*e.operands[1], expected), e.place);
}

ExpressionPointer Checker::unary(const syntax::Expression& e, Type expected) {
  if (e.name == "!") {
    ExpressionPointer v = value(*e.operands[0]);
    std::vector<ExpressionPointer> operands;
    operands.push_back(std::move(v));
    if (ExpressionPointer called = overloaded("__operator__not__", operands, e.place)) return called;
    return truth(std::move(operands[0]), true);
  }
  ExpressionPointer v = value(*e.operands[0], expected);
  if (e.name.empty()) {
    std::vector<ExpressionPointer> operands;
    operands.push_back(std::move(v));
    if (ExpressionPointer called = overloaded(names_of(e.operation).function, operands, e.place)) return called;
    v = std::move(operands[0]);
  }
  const Type t = v->type;
  const bool allowed =
      e.operation == Operator::complement ? t.is_int() : !t.is_array() && !t.is_string() && !t.is_structure() && !t.is_void();
  if (!allowed)
    refuse(e.place, fmt::format("there is no '{}' of '{}'", e.name == "+" ? "+" : names_of(e.operation).sign, t.name()));
  if (e.name == "+") return v;
  ExpressionPointer out = make(Expression::Kind::unary, t, e.place, std::move(v));
  out->operation = e.operation;
  return fold(std::move(out));
}

ExpressionPointer Checker::truth(ExpressionPointer v, bool negated) {
  const Type t = v->type;
  if (t.is_array() || t.is_structure() || t.is_void() || t.base == Base::spectrum)
    refuse(v->place, fmt::format("'{}' is neither true nor false", t.name()));
  const Location at = v->place;
  return fold(make(negated ? Expression::Kind::not_true : Expression::Kind::truth, Base::int_, at, std::move(v)));
}

ExpressionPointer Checker::condition(const syntax::Expression& e) { return truth(value(e)); }

ExpressionPointer Checker::conditional(const syntax::Expression& e, Type expected) {
  ExpressionPointer which = condition(*e.operands[0]);
  const bool list_first = e.operands[1]->kind == syntax::Expression::Kind::list;
  const bool list_second = e.operands[2]->kind == syntax::Expression::Kind::list;
  if ((list_first || list_second) && expected.is_void()) refuse(e.place, "the type of a list is not known here");
  ExpressionPointer a = value(*e.operands[1], expected), b = value(*e.operands[2], expected);
  Type t = a->type;
  if (!(a->type == b->type)) {
    if (a->type.is_void() || b->type.is_void()) refuse(e.place, "one of the two values has no type");
    if (a->type.is_closure() && !b->type.is_closure()) {
      b = converted(std::move(b), a->type, "the second value");
    } else if (b->type.is_closure() && !a->type.is_closure()) {
      a = converted(std::move(a), b->type, "the first value");
    } else if (equivalent(a->type, b->type) || assignable(a->type, b->type)) {
      b = convert(std::move(b), a->type);
    } else if (assignable(b->type, a->type)) {
      a = convert(std::move(a), b->type);
    } else {
      refuse(e.place, fmt::format("the two values have the types '{}' and '{}'", a->type.name(), b->type.name()));
    }
    t = a->type;
  }
  return make(Expression::Kind::conditional, t, e.place, std::move(which), std::move(a), std::move(b));
}

}  // namespace etendue::osl
