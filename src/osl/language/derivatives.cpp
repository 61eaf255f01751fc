// Which symbols must have derivatives: a fixed point of demands that flow backward, from what takes derivatives to what is
// assigned.

#include <algorithm>
#include <cstring>
#include <string_view>
#include <unordered_map>

#include "tree.h"

namespace etendue::osl {
namespace {

/// Values of these types are computed with derivatives; structures, because a field may be.
bool may_have_derivatives(const Type& type) { return type.float_based() || type.is_structure(); }

class Demands {
 public:
  Demands(const Shader& shader, std::vector<bool>& needed) : shader_(shader), needed_(needed) {}

  void find() {
    do {
      changed_ = false;
      for (const Symbol* parameter : shader_.parameters)
        if (parameter->initial) expression(*parameter->initial, needs(*parameter));
      for (const auto& function : shader_.functions) {
        function_ = function.get();
        if (function->body) statement(*function->body);
      }
      function_ = nullptr;
      if (shader_.body) statement(*shader_.body);
    } while (changed_);
  }

 private:
  bool needs(const Symbol& symbol) const { return needed_[std::size_t(symbol.index)]; }
  bool needs(const Expression& reference) const { return reference.root() && needs(*reference.root()); }

  void demand(const Symbol& symbol) {
    if (needs(symbol) || !may_have_derivatives(symbol.type)) return;
    needed_[std::size_t(symbol.index)] = changed_ = true;
  }

  void statement(const Statement& s) {
    for (const auto& inner : s.statements)
      if (inner) statement(*inner);
    if (s.symbol && s.kind == Statement::Kind::declaration && s.symbol->initial)
      expression(*s.symbol->initial, needs(*s.symbol));
    if (s.expression) expression(*s.expression, s.kind == Statement::Kind::leave && function_ && results_[function_]);
    if (s.step) expression(*s.step, false);
    if (s.body) statement(*s.body);
    if (s.otherwise) statement(*s.otherwise);
  }

  /// An expression whose derivatives are demanded or not.
  void expression(const Expression& e, bool wanted) {
    using Kind = Expression::Kind;
    wanted = wanted && may_have_derivatives(e.type);
    switch (e.kind) {
      case Kind::variable:
        if (wanted) demand(*e.symbol);
        return;
      case Kind::element:
      case Kind::component:
      case Kind::matrix_component:
        operand(e, 0, wanted);
        for (std::size_t i = 1; i < e.operands.size(); ++i) operand(e, i, false);
        return;
      case Kind::conditional: operand(e, 0, false), operand(e, 1, wanted), operand(e, 2, wanted); return;
      case Kind::comma:
        for (std::size_t i = 0; i < e.operands.size(); ++i) operand(e, i, wanted && i + 1 == e.operands.size());
        return;
      case Kind::assignment:
        operand(e, 0, wanted);
        operand(e, 1, needs(*e.operands[0]) || (wanted && !e.operands[0]->is_reference()));
        return;
      case Kind::call: call(e, wanted); return;
      case Kind::library: library_call(e, wanted); return;
      case Kind::closure:
        for (std::size_t i = 0; i < e.operands.size(); ++i) operand(e, i, false);
        return;
      case Kind::aggregate:
      case Kind::field:
      default:
        for (std::size_t i = 0; i < e.operands.size(); ++i) operand(e, i, wanted);
        return;
    }
  }

  void operand(const Expression& e, std::size_t i, bool wanted) {
    if (i >= e.operands.size() || !e.operands[i]) return;
    const Expression& operand = *e.operands[i];
    // The derivatives of a part are those of the whole variable.
    if (wanted && operand.is_reference() && may_have_derivatives(operand.type)) demand(*operand.root());
    expression(operand, wanted);
  }

  void call(const Expression& e, bool wanted) {
    bool& result = results_[e.function];
    if (wanted && !result) result = changed_ = true;
    for (std::size_t i = 0; i < e.function->parameters.size(); ++i) {
      const Symbol& parameter = *e.function->parameters[i];
      const bool output = parameter.role == Symbol::Role::output_argument;
      if (output && needs(*e.operands[i])) demand(parameter);
      operand(e, i, needs(parameter));
    }
  }

  void library_call(const Expression& e, bool wanted) {
    const Row& row = *e.row;
    for (std::size_t i = 0; i < e.operands.size(); ++i) wanted = wanted || (writes(row, i) && needs(*e.operands[i]));
    Derivatives how = row.derivatives;
    if (how == Derivatives::taken && std::strstr(row.signature, "noise(string name") &&
        e.operands[0]->kind == Expression::Kind::constant && e.operands[0]->constant.at<const String*>()->view() != "gabor")
      how = Derivatives::passed;  // of the noises that are chosen by name only "gabor" takes them
    for (std::size_t i = 0; i < e.operands.size(); ++i) {
      const bool taken = how == Derivatives::taken && (row.taken == 0 || (i < 32 && (row.taken >> i & 1)));
      operand(e, i, taken || (wanted && how != Derivatives::none));
    }
  }

  /// Whether the function writes its i-th argument.
  static bool writes(const Row& row, std::size_t i) {
    std::string_view text = row.signature;
    text.remove_prefix(text.find('(') + 1);
    for (; i > 0; --i) {
      const std::size_t comma = text.find(',');
      if (comma == std::string_view::npos) break;
      text.remove_prefix(comma + 1);
    }
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    return text.starts_with("output ");
  }

  const Shader& shader_;
  std::vector<bool>& needed_;
  std::unordered_map<const Function*, bool> results_;  // whether a call demands the result's derivatives
  const Function* function_ = nullptr;
  bool changed_ = false;
};

}  // namespace

std::vector<bool> find_derivatives(const Shader& shader, std::span<const Symbol* const> wanted) {
  std::vector<bool> needed(shader.symbols.size());
  for (const Symbol* symbol : wanted)
    if (may_have_derivatives(symbol->type)) needed[std::size_t(symbol->index)] = true;
  Demands(shader, needed).find();
  return needed;
}

}  // namespace etendue::osl
