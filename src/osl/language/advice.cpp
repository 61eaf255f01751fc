#include "advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string_view>

namespace etendue::osl {

namespace {

/// Follows the text in the order in which it is evaluated. If the first that happens to a variable is that it is read, then it
/// has no value there, whichever way leads to it: what stands further down can only come first in a later turn of a loop.
class Follower {
 public:
  explicit Follower(const Shader& shader) : shader_(shader), states_(shader.symbols.size()) {
    for (const Symbol* s : shader.parameters) value(s->initial.get());
    statement(shader.body.get());
    for (const auto& function : shader.functions) statement(function->body.get());
  }

  std::vector<Diagnostic> take() {
    std::string unused;
    Location first;
    for (const auto& s : shader_.symbols) {
      if (states_[size_t(s->index)].read || !own(s->place)) continue;
      if (s->role == Symbol::Role::local) {
        const bool ever = states_[size_t(s->index)].written;
        warn(s->place, fmt::format("'{}' is {}", s->name, ever ? "given a value, but nothing reads it" : "never used"));
      } else if (s->role == Symbol::Role::parameter && !s->type.is_structure()) {
        unused += (unused.empty() ? "'" : ", '") + s->name + "'";
        if (!first.known()) first = s->place;
      }
    }
    if (!unused.empty())
      warn(first, fmt::format("nothing reads the parameter{} {}", unused.find(',') != std::string::npos ? "s" : "", unused));
    std::ranges::stable_sort(found_, {}, [](const Diagnostic& d) { return std::pair(d.place.line, d.place.column); });
    return std::move(found_);
  }

 private:
  struct State {
    bool read = false, written = false, told = false;
  };

  bool own(const Location& at) const { return std::string_view(at.file) == shader_.place.file; }
  /// A function is checked for each set of its arrays' lengths, and is told of once.
  void warn(const Location& at, std::string text) {
    if (told_.insert({at.line, at.column, text}).second) found_.push_back({true, at, std::move(text)});
  }

  void read(const Symbol& s, const Location& at) {
    State& state = states_[size_t(s.index)];
    state.read = true;
    if (s.role != Symbol::Role::local || state.written || state.told || s.type.is_structure() || s.type.is_closure()) return;
    state.told = true;
    if (own(at)) warn(at, fmt::format("'{}' has no value yet", s.name));
  }

  /// A part of a variable that is written; its indices are read.
  void target(const Expression* e, bool reads) {
    if (!e) return;
    for (size_t i = 1; i < e->operands.size(); ++i) value(e->operands[i].get());
    if (e->kind != Expression::Kind::variable) return e->operands.empty() ? void() : target(e->operands[0].get(), reads);
    if (reads) read(*e->symbol, e->place);
    states_[size_t(e->symbol->index)].written = true;
  }

  void value(const Expression* e) {
    if (!e) return;
    using Kind = Expression::Kind;
    switch (e->kind) {
      case Kind::variable: return read(*e->symbol, e->place);
      case Kind::assignment: value(e->operands[1].get()); return target(e->operands[0].get(), e->operation != Operator::none);
      case Kind::increment: return target(e->operands[0].get(), true);
      case Kind::array_length:
      case Kind::is_connected:
      case Kind::is_constant:
        if (const Symbol* root = e->operands.empty() || !e->operands[0] ? nullptr : e->operands[0]->root())
          states_[size_t(root->index)].read = true;
        return;
      case Kind::call:
      case Kind::library: {
        const auto output = [&](size_t i) {
          if (e->kind == Kind::library) return i < 64 && (e->outputs >> i & 1) != 0;
          return i < e->function->parameters.size() && e->function->parameters[i]->role == Symbol::Role::output_argument;
        };
        for (size_t i = 0; i < e->operands.size(); ++i)
          if (!output(i)) value(e->operands[i].get());
        for (size_t i = 0; i < e->operands.size(); ++i)
          if (output(i)) target(e->operands[i].get(), false);
        return;
      }
      default:
        for (const auto& operand : e->operands) value(operand.get());
    }
  }

  void statement(const Statement* s) {
    if (!s) return;
    if (s->kind == Statement::Kind::declaration && s->symbol) {
      value(s->symbol->initial.get());
      if (s->symbol->initial) states_[size_t(s->symbol->index)].written = true;
    }
    // The step of a loop comes after its body.
    if (s->kind == Statement::Kind::do_loop) statement(s->body.get());
    if (s->kind == Statement::Kind::loop)
      for (const auto& inner : s->statements) statement(inner.get());
    value(s->expression.get());
    if (s->kind != Statement::Kind::loop)
      for (const auto& inner : s->statements) statement(inner.get());
    if (s->kind != Statement::Kind::do_loop) statement(s->body.get());
    value(s->step.get());
    statement(s->otherwise.get());
  }

  const Shader& shader_;
  std::vector<State> states_;
  std::vector<Diagnostic> found_;
  std::set<std::tuple<int, int, std::string>> told_;
};

}  // namespace

std::vector<Diagnostic> advice(const Shader& shader) { return Follower(shader).take(); }

}  // namespace etendue::osl
