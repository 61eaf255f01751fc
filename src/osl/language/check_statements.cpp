// Statements.

#include <fmt/format.h>

#include "checker.h"
#include "conversions.h"
#include "enter.h"

namespace etendue::osl {

StatementPointer Checker::make(Statement::Kind kind, Location at) {
  count_node(at);
  auto s = std::make_unique<Statement>();
  s->kind = kind, s->place = at;
  return s;
}

StatementPointer Checker::statement(const syntax::Statement& s) {
  using Kind = syntax::Statement::Kind;
  const Deeper deeper(*this, s.place);
  switch (s.kind) {
    case Kind::block: return block(s);
    case Kind::variables: return variables(s);
    case Kind::function: declare_function(s.function); break;
    case Kind::structure: declare_structure(*s.structure); break;
    case Kind::branch: return branch(s);
    case Kind::loop:
    case Kind::do_loop: return loop(s);
    case Kind::leave: return leave(s);
    case Kind::break_loop:
    case Kind::continue_loop:
      if (body_.loops == 0)
        refuse(s.place, fmt::format("'{}' stands outside of a loop", s.kind == Kind::break_loop ? "break" : "continue"));
      return make(s.kind == Kind::break_loop ? Statement::Kind::break_loop : Statement::Kind::continue_loop, s.place);
    case Kind::expression: {
      const bool exits = s.expression->kind == syntax::Expression::Kind::call && s.expression->name == "exit" &&
                         s.expression->operands.empty() && scope_->functions("exit").empty();
      if (exits) return make(Statement::Kind::exit, s.place);
      StatementPointer out = make(Statement::Kind::expression, s.place);
      out->expression = value(*s.expression);
      return out;
    }
    case Kind::nothing: break;
  }
  return make(Statement::Kind::nothing, s.place);
}

StatementPointer Checker::block(const syntax::Statement& s) {
  StatementPointer out = make(Statement::Kind::block, s.place);
  Enter enter(*this);
  for (const syntax::StatementPointer& inner : s.statements) {
    try {
      out->statements.push_back(statement(*inner));
    } catch (const Abandon&) {
    }
  }
  return out;
}

/// Several declarations of one statement become a block without a scope of its own; one stays itself.
StatementPointer Checker::variables(const syntax::Statement& s) {
  std::vector<StatementPointer> list;
  for (const syntax::Declarator& d : s.variables) {
    try {
      StatementPointer one = make(Statement::Kind::declaration, d.place);
      one->symbol = declare_variable(d, Symbol::Role::local);
      list.push_back(std::move(one));
    } catch (const Abandon&) {
    }
  }
  if (list.size() == 1) return std::move(list[0]);
  StatementPointer all = make(Statement::Kind::block, s.place);
  all->statements = std::move(list);
  return all;
}

StatementPointer Checker::branch(const syntax::Statement& first) {
  StatementPointer out;
  StatementPointer* to = &out;
  for (const syntax::Statement* s = &first; s; s = s->otherwise.get()) {
    if (s->kind != syntax::Statement::Kind::branch) {
      Enter enter(*this);
      *to = statement(*s);
      break;
    }
    *to = make(Statement::Kind::branch, s->place);
    (*to)->expression = condition(*s->expression);
    {
      Enter enter(*this);
      (*to)->body = statement(*s->body);
    }
    to = &(*to)->otherwise;
  }
  return out;
}

StatementPointer Checker::loop(const syntax::Statement& s) {
  const bool tested_behind = s.kind == syntax::Statement::Kind::do_loop;
  StatementPointer out = make(tested_behind ? Statement::Kind::do_loop : Statement::Kind::loop, s.place);
  Enter enter(*this);
  for (const syntax::StatementPointer& first : s.statements) out->statements.push_back(statement(*first));
  if (s.expression && !tested_behind) out->expression = condition(*s.expression);
  if (s.step) out->step = value(*s.step);
  ++body_.loops;
  try {
    Enter inner(*this);
    out->body = statement(*s.body);
  } catch (const Abandon&) {
    --body_.loops;
    throw;
  }
  --body_.loops;
  if (tested_behind) out->expression = condition(*s.expression);
  return out;
}

StatementPointer Checker::leave(const syntax::Statement& s) {
  StatementPointer out = make(Statement::Kind::leave, s.place);
  if (!body_.function) {
    if (s.expression) refuse(s.place, "a shader returns no value");
    return out;
  }
  const Type result = body_.function->result;
  if (result.is_void()) {
    if (s.expression) refuse(s.place, fmt::format("the function '{}' is void and returns no value", body_.function->name));
    return out;
  }
  if (!s.expression)
    refuse(s.place, fmt::format("the function '{}' must return a value of type '{}'", body_.function->name, result.name()));
  out->expression = value_as(*s.expression, result, "the function's result");
  return out;
}

}  // namespace etendue::osl
