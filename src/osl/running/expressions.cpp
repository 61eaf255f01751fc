// Translation of expressions without calls. See nodes.h for the order of evaluation.

#include <fmt/format.h>

#include <algorithm>

#include "coded_numbers.h"
#include "layer_builder.h"
#include "operations.h"
#include "references.h"

namespace etendue::osl {
namespace {

class Sequence final : public Node {
 public:
  explicit Sequence(std::vector<const Node*> nodes) : nodes_(std::move(nodes)) {}
  Flow run(RunState& run) const override {
    for (const Node* node : nodes_) node->run(run);
    return Flow::next;
  }
  void emit(Code& code) const override {
    for (const Node* node : nodes_) node->emit(code);
  }

 private:
  std::vector<const Node*> nodes_;
};

class Conditional final : public Node {
 public:
  Conditional(const Value& condition, const Node* yes, const Node* no) : condition_(condition), yes_(yes), no_(no) {}
  Flow run(RunState& run) const override {
    condition_.evaluate(run);
    return (load<int>(run, condition_.memory) ? yes_ : no_)->run(run);
  }
  void emit(Code& code) const override {
    condition_.emit(code);
    const Code::Label yes = code.label(), no = code.label(), end = code.label();
    code.branch((load_int(code, condition_.memory) != whole(code, 0)).word, yes, no);
    code.begin(yes);
    yes_->emit(code);
    code.jump(end);
    code.begin(no);
    no_->emit(code);
    code.jump(end);
    code.begin(end);
  }

 private:
  Value condition_;
  const Node *yes_, *no_;
};

class ShortCircuit final : public Node {
 public:
  ShortCircuit(const Value& a, const Value& b, bool both, const Memory& out) : a_(a), b_(b), both_(both), out_(out) {}
  Flow run(RunState& run) const override {
    a_.evaluate(run);
    int result = load<int>(run, a_.memory);
    if ((result != 0) == both_) {
      b_.evaluate(run);
      result = load<int>(run, b_.memory);
    }
    value_at<int>(run, out_.offset) = result != 0;
    return Flow::next;
  }
  void emit(Code& code) const override {
    const Code::Label more = code.label(), end = code.label();
    a_.emit(code);
    const Truth first = load_int(code, a_.memory) != whole(code, 0);
    store(code, out_, int_of(first));
    code.branch(first.word, both_ ? more : end, both_ ? end : more);
    code.begin(more);
    b_.emit(code);
    store(code, out_, int_of(load_int(code, b_.memory) != whole(code, 0)));
    code.jump(end);
    code.begin(end);
  }

 private:
  Value a_, b_;
  bool both_;
  Memory out_;
};

/// The part of a value that lies `offset` bytes behind its beginning.
Memory part(const Memory& whole, std::size_t offset, const Type& type) {
  return {type, whole.offset + std::uint32_t(offset), whole.stride};
}

}  // namespace

LayerBuilder::LayerBuilder(const Shader& shader, std::vector<SymbolPlan> plans, MemoryLayout& layout, NodeStore& nodes)
    : shader_(shader), plans_(std::move(plans)), layout_(layout), nodes_(nodes) {
  bindings_.resize(plans_.size());
}

Memory LayerBuilder::result_memory(const Type& type, bool derivatives, const Memory* into) {
  return into ? *into : layout_.temporary(type, derivatives);
}

Value LayerBuilder::constant(const Constant& c) { return {layout_.constant(c.type, c.bytes), nullptr}; }

Value LayerBuilder::constant_int(int i) {
  return {layout_.constant(Type(Base::int_), std::as_bytes(std::span(&i, 1))), nullptr};
}

/// `derivatives`: they will be read; a value that has none still stands for zero derivatives. With `into`, operators leave
/// their result there; the caller has to copy any value that lies elsewhere.
Value LayerBuilder::value(const Expression& e, bool derivatives, const Memory* into) {
  using Kind = Expression::Kind;
  derivatives = derivatives && carries_derivatives(e.type);
  const auto operand = [&](std::size_t i) -> const Expression& { return *e.operands[i]; };
  switch (e.kind) {
    case Kind::constant: return constant(e.constant);
    case Kind::variable:
    case Kind::element:
    case Kind::component:
    case Kind::matrix_component:
    case Kind::field: return read(place(e), derivatives);
    case Kind::conversion: {
      const Value from = value(operand(0), derivatives);
      const Type& type = from.type();
      // The same numbers under another type need no copy.
      if ((type.is_triple() && e.type.is_triple()) || (type == e.type && !e.type.is_closure()))
        return {{e.type, from.memory.offset, from.memory.stride}, from.compute};
      Type to = e.type;
      if (to.array == Type::unsized) to.array = type.array;
      const Memory out = result_memory(to, derivatives && from.memory.derivatives(), into);
      return {out, conversion_node(nodes_, from, out)};
    }
    case Kind::truth:
    case Kind::not_true: {
      const Value from = value(operand(0), false);
      const Memory out = result_memory(Type(Base::int_), false, into);
      return {out, truth_node(nodes_, from, e.kind == Kind::truth, out)};
    }
    case Kind::unary: {
      const Value from = value(operand(0), derivatives);
      const Memory out = result_memory(e.type, derivatives && from.memory.derivatives(), into);
      if (from.type().is_closure()) {  // -c is -1 * c
        const float minus = -1;
        const Value weight{layout_.constant(Type(Base::float_), std::as_bytes(std::span(&minus, 1))), nullptr};
        return {out, binary_node(nodes_, Operator::multiply, weight, from, out)};
      }
      return {out, unary_node(nodes_, e.operation, from, out)};
    }
    case Kind::binary: return binary(e, derivatives, into);
    case Kind::logical_and:
    case Kind::logical_or: return short_circuit(e);
    case Kind::conditional: return conditional(e, derivatives);
    case Kind::comma: {
      std::vector<const Node*> before;
      for (std::size_t i = 0; i + 1 < e.operands.size(); ++i)
        if (const Node* node = value(operand(i), false).compute) before.push_back(node);
      Value last = value(operand(e.operands.size() - 1), derivatives);
      if (last.compute) before.push_back(last.compute);
      last.compute = nodes_.make<Sequence>(std::move(before));
      return last;
    }
    case Kind::assignment: return assignment(e, derivatives);
    case Kind::increment: return increment(e);
    case Kind::call: return call(e, derivatives);
    case Kind::library: return library_call(e, derivatives, into);
    case Kind::closure: return closure(e);
    case Kind::aggregate: return aggregate(e, derivatives);
    case Kind::array_length: return constant_int(place(operand(0)).memory.type.array);
    case Kind::is_connected: return constant_int(connection_of(operand(0)));
    case Kind::is_constant: return constant_int(is_constant(operand(0)));
  }
  throw Error("an expression of unknown kind", e.place);
}

Value LayerBuilder::binary(const Expression& e, bool derivatives, const Memory* into) {
  const Value a = value(*e.operands[0], derivatives), b = value(*e.operands[1], derivatives);
  const Memory out = result_memory(e.type, derivatives && (a.memory.derivatives() || b.memory.derivatives()), into);
  const Node* node = binary_node(nodes_, e.operation, a, b, out);
  if (!node) throw Error(fmt::format("no such operation for {} and {}", a.type().name(), b.type().name()), e.place);
  return {out, node};
}

Value LayerBuilder::short_circuit(const Expression& e) {
  const Value a = value(*e.operands[0], false), b = value(*e.operands[1], false);
  const Memory out = layout_.temporary(Type(Base::int_), false);
  return {out, nodes_.make<ShortCircuit>(a, b, e.kind == Expression::Kind::logical_and, out)};
}

Value LayerBuilder::conditional(const Expression& e, bool derivatives) {
  const Value condition = value(*e.operands[0], false);
  const Value yes = value(*e.operands[1], derivatives), no = value(*e.operands[2], derivatives);
  const Memory out = layout_.temporary(yes.type(), derivatives && (yes.memory.derivatives() || no.memory.derivatives()));
  return {out, nodes_.make<Conditional>(condition, copy_node(nodes_, yes, out), copy_node(nodes_, no, out))};
}

Value LayerBuilder::aggregate(const Expression& e, bool derivatives) {
  Type type = e.type;
  if (type.array == Type::unsized) type.array = int(e.operands.size());
  const Memory out = layout_.temporary(type, derivatives);
  std::vector<const Node*> parts;
  const auto count = std::size_t(type.is_array() ? type.array : int(type.structure->fields.size()));
  bool complete = e.operands.size() >= count;
  for (const auto& operand : e.operands) complete = complete && operand;
  if (!complete) parts.push_back(clear_node(nodes_, out));
  for (std::size_t i = 0; i < std::min(count, e.operands.size()); ++i) {
    if (!e.operands[i]) continue;
    const Memory to = type.is_array() ? part(out, i * type.element_size(), type.element())
                                      : part(out, type.structure->fields[i].offset, type.structure->fields[i].type);
    parts.push_back(copy_node(nodes_, value(*e.operands[i], derivatives), to));
  }
  return {out, nodes_.make<Sequence>(std::move(parts))};
}

// ---- references
// ----------------------------------------------------------------------------------------------------------------

Place LayerBuilder::variable(const Symbol& symbol) {
  const auto i = std::size_t(symbol.index);
  Binding& binding = bindings_[i];
  if (binding.bound) return binding.place;
  const SymbolPlan& plan = plans_[i];
  binding.bound = true;
  binding.place.memory =
      plan.placed ? plan.memory
                  : layout_.allocate(plan.type, plan.derivatives && carries_derivatives(plan.type), MemoryLayout::Use::own);
  binding.place.fetch = plan.fetch;
  return binding.place;
}

Place LayerBuilder::element(const Expression& e, int operand, const Place& base, int count, const Type& of,
                            std::uint32_t step) {
  const Expression& index = *e.operands[std::size_t(operand)];
  Place result = base;
  result.memory.type = of;
  if (index.kind == Expression::Kind::constant && !base.locator) {
    const int i = index.constant.at<int>();
    if (i >= 0 && i < count) {
      result.memory.offset += std::uint32_t(i) * step;
      return result;
    }
  }
  const Symbol* root = e.root();
  result.locator = element_locator(nodes_, base, value(index, false), count, step, root ? root->name : "", e.place);
  result.fetch = nullptr;
  return result;
}

Place LayerBuilder::place(const Expression& e) {
  using Kind = Expression::Kind;
  switch (e.kind) {
    case Kind::variable: return variable(*e.symbol);
    case Kind::element: {
      const Place base = place(*e.operands[0]);
      const Type type = base.memory.type;
      return element(e, 1, base, type.elements(), type.element(), std::uint32_t(type.element_size()));
    }
    case Kind::component: return element(e, 1, place(*e.operands[0]), 3, Type(Base::float_), sizeof(float));
    case Kind::matrix_component: {
      Place row = place(*e.operands[0]);
      row.memory.stride = 0;
      row = element(e, 1, row, 4, Type(Base::matrix), 4 * sizeof(float));
      return element(e, 2, row, 4, Type(Base::float_), sizeof(float));
    }
    case Kind::field: {
      Place base = place(*e.operands[0]);
      const Field& field = base.memory.type.structure->fields[std::size_t(e.index)];
      Place result = base;
      result.memory.type = field.type;
      if (!carries_derivatives(field.type)) result.memory.stride = 0;
      if (base.locator) {
        result.locator = offset_locator(nodes_, base, std::uint32_t(field.offset));
        result.fetch = nullptr;
      } else {
        result.memory.offset += std::uint32_t(field.offset);
      }
      return result;
    }
    default: {  // a value that is no variable: `normalize(v)[0]`
      const Value v = value(e, true);
      return {v.memory, nullptr, v.compute};
    }
  }
}

Value LayerBuilder::read(const Place& from, bool derivatives) {
  Memory memory = from.memory;
  if (!derivatives) memory.stride = 0;
  if (!from.locator) return {memory, from.fetch};
  const Memory out = layout_.temporary(memory.type, memory.derivatives());
  return {out, read_node(nodes_, from, out)};
}

// ---- assignments
// ---------------------------------------------------------------------------------------------------------------

Value LayerBuilder::assignment(const Expression& e, bool derivatives) {
  const Place to = place(*e.operands[0]);
  if (e.operation != Operator::none) return compound_assignment(e, to, derivatives);
  const bool wanted = to.memory.derivatives();
  if (to.locator) {
    const Value from = value(*e.operands[1], wanted);
    const Memory result = layout_.temporary(to.memory.type, derivatives && wanted);
    return {result, write_node(nodes_, to, from, &result)};
  }
  const bool same_size = e.operands[1]->type.size() == to.memory.type.size();
  const Value from = value(*e.operands[1], wanted, same_size ? &to.memory : nullptr);
  const bool there = from.compute && from.memory.offset == to.memory.offset && from.memory.stride == to.memory.stride;
  const Node* node = there ? from.compute : copy_node(nodes_, from, to.memory);
  Memory result = to.memory;
  if (!derivatives) result.stride = 0;
  return {result, node};
}

Value LayerBuilder::compound_assignment(const Expression& e, const Place& to, bool derivatives) {
  const bool wanted = to.memory.derivatives();
  const Value by = value(*e.operands[1], wanted);
  Memory old = to.memory;
  if (!to.locator) {
    const Node* node = binary_node(nodes_, e.operation, {old, to.fetch}, by, to.memory);
    if (!node) throw Error(fmt::format("no such operation for {} and {}", old.type.name(), by.type().name()), e.place);
    if (!derivatives) old.stride = 0;
    return {old, node};
  }
  old = layout_.temporary(to.memory.type, wanted);
  const Memory result = layout_.temporary(to.memory.type, wanted);
  const Node* operation = binary_node(nodes_, e.operation, {old, nullptr}, {by.memory, nullptr}, result);
  if (!operation) throw Error(fmt::format("no such operation for {} and {}", old.type.name(), by.type().name()), e.place);
  return {result, update_node(nodes_, to, by, old, operation, result)};
}

Value LayerBuilder::increment(const Expression& e) {
  const Place at = place(*e.operands[0]);
  const Memory result = layout_.temporary(at.memory.type, at.memory.derivatives());
  return {result, increment_node(nodes_, at, e.index, e.postfix, result)};
}

// ---- what the group knows
// --------------------------------------------------------------------------------------------------------

bool LayerBuilder::is_constant(const Expression& e) {
  if (e.kind == Expression::Kind::constant) return true;
  if (e.kind == Expression::Kind::library && !(e.row && e.row->pure)) return false;
  if (e.kind == Expression::Kind::variable) {
    const Binding& binding = bindings_[std::size_t(e.symbol->index)];
    const SymbolPlan& plan = plans_[std::size_t(e.symbol->index)];
    return plan.constant && !binding.place.fetch;
  }
  switch (e.kind) {
    case Expression::Kind::assignment:
    case Expression::Kind::increment:
    case Expression::Kind::call:
    case Expression::Kind::closure: return false;
    default: break;
  }
  return std::all_of(e.operands.begin(), e.operands.end(),
                     [&](const auto& operand) { return !operand || is_constant(*operand); });
}

int LayerBuilder::connection_of(const Expression& e) {
  const Symbol* root = e.root();
  if (!root) return 0;
  // A function's argument stands for the caller's variable, which has the same place.
  const Place at = place(e);
  for (const SymbolPlan& plan : plans_) {
    if (!plan.placed || at.locator || at.memory.offset < plan.memory.offset ||
        at.memory.offset >= plan.memory.offset + std::max<std::size_t>(plan.type.size(), 1))
      continue;
    for (const auto& [offset, value] : plan.connected_parts)
      if (plan.memory.offset + offset == at.memory.offset) return value;
    return plan.connected;
  }
  return 0;
}

}  // namespace etendue::osl
