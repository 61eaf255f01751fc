// Translation of statements.

#include <fmt/format.h>

#include "coded_numbers.h"
#include "layer_builder.h"
#include "operations.h"
#include "references.h"
#include "shader_group.h"

namespace etendue::osl {
namespace {

class Block final : public Node {
 public:
  explicit Block(std::vector<const Node*> statements) : statements_(std::move(statements)) {}
  Flow run(RunState& run) const override {
    for (const Node* statement : statements_)
      if (const Flow flow = statement->run(run); flow != Flow::next) return flow;
    return Flow::next;
  }
  void emit(Code& code) const override {
    for (const Node* statement : statements_) statement->emit(code);
  }

 private:
  std::vector<const Node*> statements_;
};

class Branch final : public Node {
 public:
  Branch(const Value& condition, const Node* yes, const Node* no) : condition_(condition), yes_(yes), no_(no) {}
  Flow run(RunState& run) const override {
    condition_.evaluate(run);
    const Node* taken = load<int>(run, condition_.memory) ? yes_ : no_;
    return taken ? taken->run(run) : Flow::next;
  }
  void emit(Code& code) const override {
    condition_.emit(code);
    const Code::Label yes = code.label(), no = code.label(), end = code.label();
    code.branch((load_int(code, condition_.memory) != whole(code, 0)).word, yes, no);
    code.begin(yes);
    if (yes_) yes_->emit(code);
    code.jump(end);
    code.begin(no);
    if (no_) no_->emit(code);
    code.jump(end);
    code.begin(end);
  }

 private:
  Value condition_;
  const Node *yes_, *no_;
};

/// for, while, and do-while (`body_first`).
class Loop final : public Node {
 public:
  Loop(const Location& place, const Node* begin, bool has_condition, const Value& condition, const Node* step, const Node* body,
       bool body_first)
      : place_(place),
        begin_(begin),
        has_condition_(has_condition),
        condition_(condition),
        step_(step),
        body_(body),
        body_first_(body_first) {}
  Flow run(RunState& run) const override {
    if (begin_) begin_->run(run);
    for (bool first = body_first_;; first = false) {
      if ((++run.steps & 0xff) == 0) look_up(run);
      if (has_condition_ && !first) {
        condition_.evaluate(run);
        if (!load<int>(run, condition_.memory)) return Flow::next;
      }
      const Flow flow = body_ ? body_->run(run) : Flow::next;
      if (flow == Flow::break_loop) return Flow::next;
      if (flow == Flow::leave || flow == Flow::exit) return flow;
      if (step_) step_->run(run);
    }
  }
  void emit(Code& code) const override {
    if (begin_) begin_->emit(code);
    const Code::Label top = code.label(), body = code.label(), step = code.label(), end = code.label();
    const Code::Targets outer = code.targets;
    code.targets.break_loop = end;
    code.targets.continue_loop = step;
    code.jump(body_first_ ? body : top);
    code.begin(top);
    if (has_condition_) {
      condition_.emit(code);
      code.branch((load_int(code, condition_.memory) != whole(code, 0)).word, body, end);
    } else {
      code.jump(body);
    }
    code.begin(body);
    emit_look_up(code);
    if (body_) body_->emit(code);
    code.jump(step);
    code.begin(step);
    if (step_) step_->emit(code);
    code.jump(top);
    code.begin(end);
    code.targets = outer;
  }

 private:
  /// The code's own counter is of one layer, so that up to 255 steps of each are not counted.
  void emit_look_up(Code& code) const {
    const Code::Label now = code.label(), later = code.label();
    code.branch(code.tick(), now, later);
    code.begin(now);
    code.call(reinterpret_cast<const void*>(&look_up_from_code), WordKind::none, {code.run_state(), code.address(this)});
    code.jump(later);
    code.begin(later);
  }
  static void look_up_from_code(RunState* run, const Loop* loop) {
    run->steps += 256;
    loop->look_up(*run);
  }
  /// Now and then: a shader that never ends is stopped with its render, or as a fault.
  void look_up(RunState& run) const {
    if (run.abort && run.abort->load(std::memory_order_relaxed)) throw RunAborted();
    const auto now = std::chrono::steady_clock::now();
    if (run.steps == 0x100) run.looked_first = now;
    if (now - run.looked_first > RunState::most_time)
      throw Error(fmt::format("shader {}: this loop, or one around it, does not end: {} seconds at one point",
                              run.group->shader_name(run.layer)->text(), RunState::most_time.count()),
                  place_);
    if (run.steps < RunState::most_steps) return;
    throw Error(fmt::format("shader {}: this loop, or one around it, does not end: {} steps at one point",
                            run.group->shader_name(run.layer)->text(), RunState::most_steps),
                place_);
  }

  Location place_;
  const Node* begin_;
  bool has_condition_;
  Value condition_;
  const Node *step_, *body_;
  bool body_first_;
};

class Jump final : public Node {
 public:
  Jump(const Node* before, Flow flow) : before_(before), flow_(flow) {}
  Flow run(RunState& run) const override {
    if (before_) before_->run(run);
    return flow_;
  }
  void emit(Code& code) const override {
    if (before_) before_->emit(code);
    const Code::Targets& to = code.targets;
    code.jump(flow_ == Flow::break_loop      ? to.break_loop
              : flow_ == Flow::continue_loop ? to.continue_loop
              : flow_ == Flow::leave         ? to.leave
                                             : to.exit);
    code.begin(code.label());  // nothing reaches what follows in the same block
  }

 private:
  const Node* before_;
  Flow flow_;
};

}  // namespace

const Node* LayerBuilder::body() { return shader_.body ? statement(*shader_.body) : nullptr; }

const Node* LayerBuilder::default_value(const Symbol& parameter) {
  const std::size_t mark = layout_.mark();
  const Place to = variable(parameter);
  const Value from = value(*parameter.initial, to.memory.derivatives());
  const Node* node = copy_node(nodes_, from, to.memory);
  layout_.release(mark);
  return node;
}

const Node* LayerBuilder::sequence(const std::vector<StatementPointer>& statements) {
  std::vector<const Node*> nodes;
  for (const auto& s : statements)
    if (s)
      if (const Node* node = statement(*s)) nodes.push_back(node);
  if (nodes.empty()) return nullptr;
  return nodes.size() == 1 ? nodes[0] : nodes_.make<Block>(std::move(nodes));
}

const Node* LayerBuilder::declaration(const Statement& s) {
  const Place to = variable(*s.symbol);
  // A variable without an initial value begins as zero, so that no value of another point's run is seen.
  if (!s.symbol->initial) return clear_node(nodes_, to.memory);
  const Expression& initial = *s.symbol->initial;
  const Memory* into = initial.type.size() == to.memory.type.size() ? &to.memory : nullptr;
  const Value from = value(initial, to.memory.derivatives(), into);
  if (from.compute && from.memory.offset == to.memory.offset && from.memory.stride == to.memory.stride) return from.compute;
  const Node* copy = copy_node(nodes_, from, to.memory);
  return from.type().size() < to.memory.type.size() ? both(nodes_, clear_node(nodes_, to.memory), copy) : copy;
}

/// Null for a statement that does nothing.
const Node* LayerBuilder::statement(const Statement& s) {
  using Kind = Statement::Kind;
  const std::size_t mark = layout_.mark();
  const Node* result = nullptr;
  switch (s.kind) {
    case Kind::nothing: break;
    case Kind::expression: result = s.expression ? value(*s.expression, false).compute : nullptr; break;
    case Kind::declaration: result = declaration(s); break;
    case Kind::block: result = sequence(s.statements); break;
    case Kind::branch: {
      const Value condition = value(*s.expression, false);
      const Node* yes = s.body ? statement(*s.body) : nullptr;
      const Node* no = s.otherwise ? statement(*s.otherwise) : nullptr;
      result = nodes_.make<Branch>(condition, yes, no);
      break;
    }
    case Kind::loop:
    case Kind::do_loop: {
      const Node* begin = sequence(s.statements);
      const Value condition = s.expression ? value(*s.expression, false) : Value();
      const Node* step = s.step ? value(*s.step, false).compute : nullptr;
      const Node* body = s.body ? statement(*s.body) : nullptr;
      result = nodes_.make<Loop>(s.place, begin, s.expression != nullptr, condition, step, body, s.kind == Kind::do_loop);
      break;
    }
    case Kind::break_loop: result = nodes_.make<Jump>(nullptr, Flow::break_loop); break;
    case Kind::continue_loop: result = nodes_.make<Jump>(nullptr, Flow::continue_loop); break;
    case Kind::leave: {
      const Node* before = nullptr;
      if (s.expression) {
        const bool function = !calls_.empty() && !calls_.back().result.type.is_void();
        const Value v = value(*s.expression, function && calls_.back().result.derivatives());
        before = function ? copy_node(nodes_, v, calls_.back().result) : v.compute;
      }
      result = nodes_.make<Jump>(before, Flow::leave);
      break;
    }
    case Kind::exit: result = nodes_.make<Jump>(nullptr, Flow::exit); break;
  }
  layout_.release(mark);
  return result;
}

}  // namespace etendue::osl
