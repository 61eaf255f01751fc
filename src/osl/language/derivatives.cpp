// Which variables must have derivatives.
//
// A graph: an edge from a variable, a function's result or a call to all variables of which its derivatives are made. What is
// taken (Dx, filterwidth, texture coordinates ...) and what the caller wants is marked, and all that is reached from there.

#include <cstring>
#include <unordered_map>

#include "tree.h"

namespace etendue::osl {

namespace {

bool may_have_derivatives(const Type& t) {
  if (!t.is_structure()) return t.float_based();
  for (const Field& f : t.structure->fields)
    if (may_have_derivatives(f.type)) return true;
  return false;
}

class Graph {
 public:
  explicit Graph(const Shader& shader) : shader_(shader), sources_(shader.symbols.size() + shader.functions.size() + 1) {
    taken_ = int(sources_.size()) - 1;
    for (std::size_t i = 0; i < shader.functions.size(); ++i)
      result_[shader.functions[i].get()] = int(shader.symbols.size() + i);
    for (const Symbol* p : shader.parameters) initial(*p);
    for (const auto& f : shader.functions) visit(f->body.get(), result_.at(f.get()));
    visit(shader.body.get(), nowhere);
  }

  std::vector<bool> reached(std::span<const Symbol* const> wanted) const {
    std::vector<bool> marked(sources_.size(), false);
    std::vector<int> open{taken_};
    marked[std::size_t(taken_)] = true;
    for (const Symbol* s : wanted)
      if (!marked[std::size_t(s->index)]) marked[std::size_t(s->index)] = true, open.push_back(s->index);
    while (!open.empty()) {
      const int node = open.back();
      open.pop_back();
      for (const int source : sources_[std::size_t(node)])
        if (!marked[std::size_t(source)]) marked[std::size_t(source)] = true, open.push_back(source);
    }
    marked.resize(shader_.symbols.size());
    for (std::size_t i = 0; i < marked.size(); ++i)
      if (!may_have_derivatives(shader_.symbols[i]->type)) marked[i] = false;
    return marked;
  }

 private:
  /// The value goes where no derivatives are used.
  static constexpr int nowhere = -1;

  void edge(int from, int to) {
    if (from != nowhere && from != to) sources_[std::size_t(from)].push_back(to);
  }
  int new_node() {
    sources_.emplace_back();
    return int(sources_.size()) - 1;
  }

  void initial(const Symbol& s) {
    if (s.initial) visit(s.initial.get(), s.index);
  }

  /// `result`: the node of the function's result.
  void visit(const Statement* s, int result) {
    if (!s) return;
    if (s->expression) visit(s->expression.get(), s->kind == Statement::Kind::leave ? result : nowhere);
    if (s->step) visit(s->step.get(), nowhere);
    for (const StatementPointer& inner : s->statements) visit(inner.get(), result);
    visit(s->body.get(), result);
    visit(s->otherwise.get(), result);
    if (s->symbol) initial(*s->symbol);
  }

  /// Adds the edges from `target`, into which the expression's value goes.
  void visit(const Expression* e, int target) {
    if (!e) return;
    if (!may_have_derivatives(e->type)) target = nowhere;
    const auto& o = e->operands;
    switch (e->kind) {
      case Expression::Kind::variable: edge(target, e->symbol->index); return;
      case Expression::Kind::assignment: {
        const int to = o[0]->root()->index;
        visit(o[0].get(), target);
        visit(o[1].get(), to);
        return;
      }
      case Expression::Kind::element:
      case Expression::Kind::component:
      case Expression::Kind::matrix_component:
        for (std::size_t i = 0; i < o.size(); ++i) visit(o[i].get(), i == 0 ? target : nowhere);
        return;
      case Expression::Kind::conditional:
        for (std::size_t i = 0; i < o.size(); ++i) visit(o[i].get(), i == 0 ? nowhere : target);
        return;
      case Expression::Kind::comma:
        for (std::size_t i = 0; i < o.size(); ++i) visit(o[i].get(), i + 1 < o.size() ? nowhere : target);
        return;
      case Expression::Kind::call: call(*e, target); return;
      case Expression::Kind::library: library(*e, target); return;
      case Expression::Kind::closure:
        for (const ExpressionPointer& a : o) visit(a.get(), nowhere);
        return;
      default:
        for (const ExpressionPointer& a : o) visit(a.get(), target);
    }
  }

  void call(const Expression& e, int target) {
    edge(target, result_.at(e.function));
    for (std::size_t i = 0; i < e.operands.size(); ++i) {
      const Symbol& parameter = *e.function->parameters[i];
      visit(e.operands[i].get(), parameter.index);
      if (parameter.role == Symbol::Role::output_argument) edge(e.operands[i]->root()->index, parameter.index);
    }
  }

  /// noise("perlin", ...) is an ordinary function; only "gabor" filters with the derivatives.
  static bool takes(const Expression& e) {
    if (e.row->derivatives != Derivatives::taken) return false;
    if (!std::strstr(e.row->signature, "noise(string")) return true;
    const Expression& name = *e.operands[0];
    return name.kind != Expression::Kind::constant || name.constant.at<const String*>()->text() == "gabor";
  }

  void library(const Expression& e, int target) {
    const auto is_output = [&](std::size_t i) { return i < 64 && (e.outputs >> i & 1); };
    const bool passed = e.row->derivatives != Derivatives::none, taken = takes(e);
    int made = passed ? target : nowhere;
    if (passed && e.outputs) {
      // All outputs and the result are made of all inputs.
      made = new_node();
      edge(target, made);
      for (std::size_t i = 0; i < e.operands.size(); ++i)
        if (is_output(i)) edge(e.operands[i]->root()->index, made);
    }
    for (std::size_t i = 0; i < e.operands.size(); ++i) {
      const Expression* a = e.operands[i].get();
      if (is_output(i)) {
        visit(a, nowhere);
        continue;
      }
      if (taken && (e.row->taken == 0 || (i < 32 && (e.row->taken >> i & 1)))) visit(a, taken_);
      visit(a, made);
    }
  }

  const Shader& shader_;
  std::vector<std::vector<int>> sources_;  // of each node: symbols, functions' results, taken_, calls
  std::unordered_map<const Function*, int> result_;
  int taken_ = 0;
};

}  // namespace

std::vector<bool> find_derivatives(const Shader& shader, std::span<const Symbol* const> wanted) {
  return Graph(shader).reached(wanted);
}

}  // namespace etendue::osl
