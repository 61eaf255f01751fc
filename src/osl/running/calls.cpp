// Translation of calls: of the shader's functions, of the library, of closures' constructors and of constructors of values.

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <string_view>

#include "coded_numbers.h"
#include "layer_builder.h"
#include "library_code.h"
#include "operations.h"
#include "osl/library/closures.h"
#include "references.h"

namespace etendue::osl {
namespace {

/// A call of a function of the shader. Its body is translated anew for each call, with the caller's places in place of its
/// parameters.
class FunctionCall final : public Node {
 public:
  FunctionCall(std::vector<const Node*> before, const Node* body, std::vector<const Node*> after)
      : before_(std::move(before)), body_(body), after_(std::move(after)) {}
  Flow run(RunState& run) const override {
    for (const Node* node : before_) node->run(run);
    if (body_ && body_->run(run) == Flow::exit) throw ExitLayer();
    for (const Node* node : after_) node->run(run);
    return Flow::next;
  }
  void emit(Code& code) const override {
    for (const Node* node : before_) node->emit(code);
    if (body_) {
      const Code::Label end = code.label();
      const Code::Label outer = std::exchange(code.targets.leave, end);
      body_->emit(code);
      code.jump(end);
      code.begin(end);
      code.targets.leave = outer;
    }
    for (const Node* node : after_) node->emit(code);
  }

 private:
  std::vector<const Node*> before_;
  const Node* body_;
  std::vector<const Node*> after_;
};

/// Notes where an output argument with computed indices is; copies the value that is there; and the new value back to it.
class ReferenceIn final : public Node {
 public:
  ReferenceIn(const Place& from, const Memory& copy, std::uint32_t pointer) : from_(from), copy_(copy), pointer_(pointer) {}
  Flow run(RunState& run) const override {
    if (from_.fetch) from_.fetch->run(run);
    std::byte* at = from_.find(run);
    value_at<std::byte*>(run, pointer_) = at;
    copy_value(run.memory + copy_.offset, copy_.stride, at, from_.memory.stride, copy_.type.size());
    return Flow::next;
  }
  void emit(Code& code) const override {
    if (from_.fetch) from_.fetch->emit(code);
    const Word at = code.address_of(from_.emit(code));
    code.store({pointer_, {}}, at);
    emit_copy(code, copy_.type, {copy_.offset, {}}, copy_.stride, {0, at}, from_.memory.stride, copy_.type.size());
  }

 private:
  Place from_;
  Memory copy_;
  std::uint32_t pointer_;
};
class ReferenceOut final : public Node {
 public:
  ReferenceOut(const Memory& copy, std::uint32_t pointer, std::uint32_t stride)
      : copy_(copy), pointer_(pointer), stride_(stride) {}
  Flow run(RunState& run) const override {
    copy_value(value_at<std::byte*>(run, pointer_), stride_, run.memory + copy_.offset, copy_.stride, copy_.type.size());
    return Flow::next;
  }
  void emit(Code& code) const override {
    const Word to = code.load(WordKind::address, {pointer_, {}});
    emit_copy(code, copy_.type, {0, to}, stride_, {copy_.offset, {}}, copy_.stride, copy_.type.size());
  }

 private:
  Memory copy_;
  std::uint32_t pointer_, stride_;
};

/// The addresses of arguments, without an allocation for the usual numbers of them.
class WithAddresses {
 public:
  WithAddresses(RunState& run, const std::vector<Value>& arguments) {
    void** to = few_;
    if (arguments.size() > few) {
      many_.resize(arguments.size());
      to = many_.data();
    }
    for (const Value& argument : arguments) *to++ = run.memory + argument.memory.offset;
  }
  void* const* get() const { return many_.empty() ? few_ : many_.data(); }

 private:
  static constexpr std::size_t few = 20;
  void* few_[few];
  std::vector<void*> many_;
};

class LibraryCall final : public Node {
 public:
  LibraryCall(const Row& row, std::unique_ptr<const CallTypes> types, Evaluate evaluate, std::vector<Value> arguments,
              std::vector<bool> outputs, const Memory& result, bool speaks_itself, std::vector<const Node*> after)
      : row_(row),
        types_(std::move(types)),
        evaluate_(evaluate),
        arguments_(std::move(arguments)),
        outputs_(std::move(outputs)),
        result_(result),
        speaks_itself_(speaks_itself),
        after_(std::move(after)) {}

  Flow run(RunState& run) const override {
    for (const Value& argument : arguments_) argument.evaluate(run);
    const WithAddresses addresses(run, arguments_);
    run.speaks_itself = speaks_itself_;
    evaluate_(Call{addresses.get(), run.memory + result_.offset, *types_, run.services});
    run.speaks_itself = false;
    for (const Node* node : after_) node->run(run);
    return Flow::next;
  }
  void emit(Code& code) const override {
    for (const Value& argument : arguments_) argument.emit(code);
    const CodedCall call{code, *types_, arguments_, outputs_, result_};
    if (!emit_instructions(row_, call) && !emit_noise(row_, call)) {
      LentArguments lent(call);
      if (speaks_itself_)
        code.call(reinterpret_cast<const void*>(&speak), WordKind::none, {code.run_state(), code.address(this), lent.call()});
      else
        code.call(reinterpret_cast<const void*>(evaluate_), WordKind::none, {lent.call()});
      lent.end();
    }
    for (const Node* node : after_) node->emit(code);
  }

 private:
  static void speak(RunState* run, const LibraryCall* self, const Call* call) {
    run->speaks_itself = true;
    self->evaluate_(*call);
    run->speaks_itself = false;
  }

  const Row& row_;
  std::unique_ptr<const CallTypes> types_;
  Evaluate evaluate_;
  std::vector<Value> arguments_;
  std::vector<bool> outputs_;
  Memory result_;
  bool speaks_itself_;
  std::vector<const Node*> after_;
};

class MakeClosure final : public Node {
 public:
  MakeClosure(const ClosureShape* shape, std::unique_ptr<const CallTypes> types, std::vector<Value> arguments,
              const Memory& out)
      : shape_(shape), types_(std::move(types)), arguments_(std::move(arguments)), out_(out) {}
  Flow run(RunState& run) const override {
    for (const Value& argument : arguments_) argument.evaluate(run);
    const WithAddresses addresses(run, arguments_);
    const Call call{addresses.get(), nullptr, *types_, run.services};
    value_at<const ClosureNode*>(run, out_.offset) = make_component(call, *shape_);
    return Flow::next;
  }
  void emit(Code& code) const override {
    for (const Value& argument : arguments_) argument.emit(code);
    const std::vector<bool> outputs(arguments_.size());
    const Memory no_result;
    const CodedCall call{code, *types_, arguments_, outputs, no_result};
    LentArguments lent(call);
    const Word made =
        code.call(reinterpret_cast<const void*>(&make_component), WordKind::address, {lent.call(), code.address(shape_)});
    lent.end();
    code.store({out_.offset, {}}, made);
  }

 private:
  const ClosureShape* shape_;
  std::unique_ptr<const CallTypes> types_;
  std::vector<Value> arguments_;
  Memory out_;
};

/// Whether the row's i-th parameter is written. Behind the last one, that of "..." counts.
bool is_output(const Row& row, std::size_t i) {
  std::string_view text = row.signature;
  text.remove_prefix(text.find('(') + 1);
  for (; i > 0; --i) {
    const std::size_t comma = text.find(',');
    if (comma == std::string_view::npos) break;
    text.remove_prefix(comma + 1);
  }
  text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
  return text.starts_with("output ") && (i == 0 || text.find("...") != std::string_view::npos);
}

/// How this call treats derivatives. The noises that are chosen by name take them only if the name is "gabor", or unknown.
Derivatives treatment(const Row& row, const Expression& e) {
  const std::string_view signature = row.signature;
  if (row.derivatives != Derivatives::taken || signature.find("noise(string name") == std::string_view::npos)
    return row.derivatives;
  const Expression& name = *e.operands[0];
  if (name.kind != Expression::Kind::constant || name.constant.at<const String*>()->view() == "gabor") return row.derivatives;
  return Derivatives::passed;
}

/// Whether the row makes a triple of three numbers.
bool makes_triple(const Row& row) {
  const std::string_view text = row.signature;
  for (const std::string_view type : {"color", "point", "vector", "normal"})
    if (text.starts_with(type))
      return text.substr(type.size() + 1).starts_with(std::string(type) + "(float ") &&
             std::count(text.begin(), text.end(), ',') == 2;
  return false;
}

bool takes_derivatives(const Row& row, Derivatives how, std::size_t i) {
  return how == Derivatives::taken && (row.taken == 0 || (i < 32 && (row.taken >> i & 1)));
}

}  // namespace

// ---- functions of the shader
// ---------------------------------------------------------------------------------------------------

Value LayerBuilder::call(const Expression& e, bool derivatives) {
  const Function& function = *e.function;
  std::vector<const Node*> before, after;
  std::vector<std::pair<std::size_t, Binding>> saved;
  std::vector<Place> places;
  for (std::size_t i = 0; i < function.parameters.size(); ++i) {
    const Symbol& parameter = *function.parameters[i];
    const Expression& operand = *e.operands[i];
    const bool output = parameter.role == Symbol::Role::output_argument;
    Place at;
    if (operand.is_reference()) at = place(operand);
    if (operand.is_reference() && !at.locator) {
      // A parameter that is fetched when it is read stays so in the function.
      if (at.fetch && operand.kind != Expression::Kind::variable) before.push_back(std::exchange(at.fetch, nullptr));
    } else if (output) {
      const Memory copy = layout_.temporary(at.memory.type, at.memory.derivatives());
      const std::uint32_t pointer = layout_.temporary(Type(Base::string), false).offset;  // the size of an address
      before.push_back(nodes_.make<ReferenceIn>(at, copy, pointer));
      after.push_back(nodes_.make<ReferenceOut>(copy, pointer, at.memory.stride));
      at = {copy, nullptr, nullptr};
    } else {
      const Value v = operand.is_reference() ? read(at, wants(parameter)) : value(operand, wants(parameter));
      if (v.compute) before.push_back(v.compute);
      at = {v.memory, nullptr, nullptr};
    }
    if (at.memory.type.is_triple()) at.memory.type.base = parameter.type.base;
    places.push_back(at);
  }
  // Bound only now: an argument may itself call the function.
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto index = std::size_t(function.parameters[i]->index);
    saved.emplace_back(index, bindings_[index]);
    bindings_[index] = {places[i], true};
  }
  Frame frame;
  if (!function.result.is_void()) frame.result = layout_.temporary(function.result, derivatives);
  calls_.push_back(frame);
  const Node* body = function.body ? statement(*function.body) : nullptr;
  calls_.pop_back();
  for (const auto& [index, binding] : saved) bindings_[index] = binding;
  // A function that ends without `return` gives zero, not what an earlier call left.
  const bool returns = function.body && function.body->kind == Statement::Kind::block && !function.body->statements.empty() &&
                       function.body->statements.back() && function.body->statements.back()->kind == Statement::Kind::leave;
  if (!function.result.is_void() && !returns) before.push_back(clear_node(nodes_, frame.result));
  return {frame.result, nodes_.make<FunctionCall>(std::move(before), body, std::move(after))};
}

// ---- the library
// -----------------------------------------------------------------------------------------------------------------

Value LayerBuilder::contiguous(const Value& v) {
  if (v.memory.contiguous()) return v;
  const Memory copy = layout_.temporary(v.type(), true);
  return {copy, copy_node(nodes_, v, copy)};
}

Value LayerBuilder::library_call(const Expression& e, bool derivatives, const Memory* into) {
  const Row& row = *e.row;
  if (makes_triple(row)) return triple(e, derivatives, into);
  const Derivatives how = treatment(row, e);
  if (row.refused) throw Error(row.refused, e.place);
  auto types = std::make_unique<CallTypes>();
  types->place = e.place;
  std::vector<Value> arguments;
  std::vector<const Node*> after;
  std::vector<bool> outputs;
  bool writes_derivatives = derivatives;
  for (std::size_t i = 0; i < e.operands.size(); ++i) {
    outputs.push_back(is_output(row, i));
    if (outputs[i]) writes_derivatives = writes_derivatives || place(*e.operands[i]).memory.derivatives();
  }
  bool any = false;  // whether an input has derivatives
  for (std::size_t i = 0; i < e.operands.size(); ++i) {
    const Expression& operand = *e.operands[i];
    Value argument;
    if (outputs[i]) {
      const Place at = place(operand);
      if (!at.locator && at.memory.contiguous()) {
        argument = {at.memory, at.fetch};
      } else {
        const Memory copy = layout_.temporary(at.memory.type, at.memory.derivatives());
        const std::uint32_t pointer = layout_.temporary(Type(Base::string), false).offset;
        argument = {copy, nodes_.make<ReferenceIn>(at, copy, pointer)};
        after.push_back(nodes_.make<ReferenceOut>(copy, pointer, at.memory.stride));
      }
    } else {
      const bool wanted = takes_derivatives(row, how, i) || (how != Derivatives::none && writes_derivatives);
      argument = contiguous(value(operand, wanted));
      if (!wanted) argument.memory.stride = 0;
      any = any || argument.memory.derivatives();
    }
    types->arguments.push_back({argument.type(), argument.memory.derivatives()});
    arguments.push_back(argument);
  }
  const bool has = derivatives && (how == Derivatives::taken || (how == Derivatives::passed && any));
  Memory result;
  if (!e.type.is_void()) result = layout_.temporary(e.type, has);
  types->result = {e.type, has};
  const Evaluate evaluate = row.choose ? row.choose(*types) : nullptr;
  if (!evaluate) throw Error(fmt::format("'{}' cannot be called with these types", row.signature), e.place);
  const std::string_view signature = row.signature;
  const bool speaks_itself = signature.starts_with("void error(") || signature.starts_with("void warning(");
  return {result, nodes_.make<LibraryCall>(row, std::move(types), evaluate, std::move(arguments), std::move(outputs), result,
                                           speaks_itself, std::move(after))};
}

// ---- constructors
// ------------------------------------------------------------------------------------------------------------------

Value LayerBuilder::closure(const Expression& e) {
  auto types = std::make_unique<CallTypes>();
  types->place = e.place;
  std::vector<Value> arguments;
  for (const auto& operand : e.operands) {
    arguments.push_back(value(*operand, false));
    types->arguments.push_back({arguments.back().type(), false});
  }
  const Memory out = layout_.temporary(Type::closure_color(), false);
  return {out, nodes_.make<MakeClosure>(e.shape, std::move(types), std::move(arguments), out)};
}

Value LayerBuilder::triple(const Expression& e, bool derivatives, const Memory* into) {
  const Value x = value(*e.operands[0], derivatives), y = value(*e.operands[1], derivatives),
              z = value(*e.operands[2], derivatives);
  const bool any = x.memory.derivatives() || y.memory.derivatives() || z.memory.derivatives();
  const Memory out = result_memory(e.type, derivatives && any, into);
  return {out, triple_node(nodes_, x, y, z, out)};
}

}  // namespace etendue::osl
