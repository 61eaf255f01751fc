// Declarations: structures, functions, variables, the shader and its parameters.

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "checker.h"
#include "conversions.h"
#include "enter.h"
#include "folding.h"
#include "parser.h"

namespace etendue::osl {

Checker::Checker(Diagnostics& d) : diagnostics_(d) {}

void Checker::refuse(Location at, const std::string& text) {
  diagnostics_.error(at, text);
  throw Abandon{};
}

void Checker::count_node(Location at) {
  if (++nodes_ <= most_nodes) return;
  diagnostics_.error(at, fmt::format("the shader is larger than {} operations", most_nodes));
  throw Diagnostics::Stop{};
}

std::unique_ptr<Shader> Checker::check(const syntax::File& file, const std::string& file_name) {
  shader_ = std::make_unique<Shader>();
  Enter global(*this);
  declarations(file.before);
  if (file.shader)
    shader(*file.shader);
  else if (!diagnostics_.failed())
    diagnostics_.error({intern(file_name), 0, 0}, "there is no shader in it");
  declarations(file.after);
  if (!diagnostics_.failed()) resolve_pending();
  if (!diagnostics_.failed()) finish_functions();
  if (diagnostics_.failed()) return nullptr;
  return std::move(shader_);
}

void Checker::declarations(const std::vector<syntax::StatementPointer>& list) {
  for (const syntax::StatementPointer& s : list) {
    try {
      if (s->structure) declare_structure(*s->structure);
      if (s->function) declare_function(s->function);
    } catch (const Abandon&) {
    }
  }
}

void Checker::declare(const std::string& name, Scope::Entry entry) {
  entry.number = ++number_;
  scope_->names[name].push_back(entry);
}

Type Checker::type_of(const syntax::TypeName& t) {
  Type type = simple_type(t.name);
  if (t.name == "void" && !t.closure) return type;
  const Scope::Entry* own = nullptr;
  if (type.is_void() || t.name == "spectrum")
    if ((own = scope_->find(t.name)); own && own->structure) type = Type::of(own->structure);
  if (type.is_void()) refuse(t.place, fmt::format("there is no type '{}'", t.name));
  if (t.closure && type.base != Base::color)
    refuse(t.place, fmt::format("there is no 'closure {}', only 'closure color'", t.name));
  type.closure = t.closure;
  return type;
}

int Checker::array_length(const syntax::Declarator& d) {
  const ExpressionPointer length = value(*d.length);
  if (length->kind != Expression::Kind::constant || !length->type.is_int())
    refuse(d.length->place, fmt::format("the length of the array '{}' must be a constant int", d.name));
  const int n = length->constant.at<int>();
  if (n < 1 || n > most_array_elements)
    refuse(d.length->place,
           fmt::format("the length {} of the array '{}' is not between 1 and {}", n, d.name, most_array_elements));
  return n;
}

Type Checker::type_of(const syntax::Declarator& d) {
  const Type t = type_of(d.type);
  if (t.is_void()) refuse(d.place, fmt::format("'{}' cannot have the type void", d.name));
  if (!d.array) return t;
  return t.as_array(d.length ? array_length(d) : Type::unsized);
}

Symbol* Checker::make_symbol(const std::string& name, const Type& type, Symbol::Role role, Location at) {
  auto s = std::make_unique<Symbol>();
  s->name = name, s->type = type, s->role = role, s->place = at;
  s->index = int(shader_->symbols.size());
  memory_ += std::max<std::size_t>(type.size(), 64);
  if (memory_ > most_memory) {
    diagnostics_.error(at, fmt::format("the variables take more than {} bytes", most_memory));
    throw Diagnostics::Stop{};
  }
  shader_->symbols.push_back(std::move(s));
  return shader_->symbols.back().get();
}

void Checker::declare_structure(const syntax::StructDeclaration& d) {
  if (const auto same = scope_->names.find(d.name); same != scope_->names.end())
    diagnostics_.error(d.place, fmt::format("'{}' is already declared in this scope", d.name));
  auto type = std::make_unique<StructType>();
  type->name = d.name;
  for (const syntax::Declarator& f : d.fields) {
    const Type t = type_of(f);
    if (t.array == Type::unsized) refuse(f.place, fmt::format("the field '{}' must have a length", f.name));
    if (type->find(f.name)) refuse(f.place, fmt::format("the structure has two fields '{}'", f.name));
    type->add(f.name, t);
    if (type->size > most_memory)
      refuse(f.place, fmt::format("the structure '{}' takes more than {} bytes", d.name, most_memory));
  }
  if (type->fields.empty()) refuse(d.place, fmt::format("the structure '{}' has no fields", d.name));
  shader_->structures.push_back(std::move(type));
  declare(d.name, {0, nullptr, shader_->structures.back().get(), nullptr});
}

// ---- functions

namespace {

bool same_parameters(const FunctionEntry& a, const FunctionEntry& b) {
  return std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(), b.parameters.end(),
                    [](const auto& x, const auto& y) { return x.type == y.type; });
}

bool has_metadatum(const std::vector<syntax::Declarator>& list, const char* name) {
  return std::any_of(list.begin(), list.end(), [&](const syntax::Declarator& d) { return d.name == name; });
}

std::string signature_text(const FunctionEntry& f) {
  std::string text = f.result.name() + " " + f.declaration->name + " (";
  for (std::size_t i = 0; i < f.parameters.size(); ++i) text += (i ? ", " : "") + f.parameters[i].type.name();
  return text + ")";
}

}  // namespace

void Checker::declare_function(const std::shared_ptr<syntax::FunctionDeclaration>& d) {
  auto entry = std::make_unique<FunctionEntry>();
  FunctionEntry& f = *entry;
  f.declaration = d;
  f.scope = scope_;
  f.result = type_of(d->result);
  if (d->result_array) refuse(d->place, fmt::format("the function '{}' cannot return an array", d->name));
  for (const syntax::Declarator& p : d->parameters) f.parameters.push_back({type_of(p), p.output});
  if (const auto same = scope_->names.find(d->name); same != scope_->names.end())
    for (const Scope::Entry& e : same->second)
      if (!e.function) refuse(d->place, fmt::format("'{}' is already declared in this scope", d->name));

  if (!d->body && has_metadatum(d->metadata, "builtin")) {
    // As stdosl.h declares what the renderer has. Ours is known already; only closures can be new.
    if (!library_signatures(d->name).empty()) return;
    if (f.result.is_closure()) f.closure = true;
  }
  // A function with the same parameters that was only declared before is defined here.
  bool replaces = false;
  std::string previous;
  if (const auto same = scope_->names.find(d->name); same != scope_->names.end())
    for (const Scope::Entry& e : same->second) {
      if (!same_parameters(*e.function, f) || !(e.function->result == f.result)) continue;
      if (!d->body && !f.closure) return;  // declared once more
      if (!e.function->declaration->body && !e.function->definition) e.function->definition = &f;
      if (!e.function->declaration->body) continue;
      replaces = true;
      const Location& at = e.function->declaration->place;
      previous = fmt::format("\n    {}:{}", at.file, at.line) + previous;
    }
  if (d->body && scope_->parent == nullptr)
    for (const Signature& builtin : library_signatures(d->name)) {
      const bool same = builtin.result == f.result &&
                        std::equal(builtin.parameters.begin(), builtin.parameters.end(), f.parameters.begin(),
                                   f.parameters.end(), [](const auto& x, const auto& y) { return !x.any && x.type == y.type; });
      if (same) previous += "\n    built-in";
      if (same) replaces = true;
    }
  if (replaces && d->body)
    diagnostics_.warning(d->place, fmt::format("Function '{}' redefined in the same scope\n  Previous definitions:{}",
                                               signature_text(f), previous));
  entries_.push_back(std::move(entry));
  if (!d->body) {
    f.number = number_ + 1;
    declare(d->name, {0, nullptr, nullptr, &f});
    return;
  }
  // The body does not see the function itself: a call of the name means another one (or is recursion by way of a declaration).
  f.number = number_ + 1;
  std::vector<int> lengths;
  for (const FunctionEntry::Parameter& p : f.parameters)
    if (p.type.array == Type::unsized) lengths.push_back(Type::unsized);
  instance(f, lengths, d->place);
  declare(d->name, {0, nullptr, nullptr, &f});
}

Function* Checker::instance(FunctionEntry& f, const std::vector<int>& lengths, Location at) {
  Function*& known = f.instances[lengths];
  if (known) return known;
  if (shader_->functions.size() >= most_functions) {
    diagnostics_.error(at, fmt::format("more than {} functions", most_functions));
    throw Diagnostics::Stop{};
  }
  shader_->functions.push_back(std::make_unique<Function>());
  known = shader_->functions.back().get();
  Function& made = *known;
  made.name = f.declaration->name, made.result = f.result, made.place = f.declaration->place;
  check_body(f, made, lengths);
  return &made;
}

void Checker::check_body(FunctionEntry& f, Function& made, const std::vector<int>& lengths) {
  if (functions_deep_ >= most_nested_functions)
    refuse(f.declaration->place, fmt::format("functions call each other more than {} deep", most_nested_functions));
  ++functions_deep_;
  open_functions_.push_back(f.declaration->name);
  Scope* const outside = std::exchange(scope_, f.scope);
  const Body outer = std::exchange(body_, Body{&made, 0});
  struct Restore {
    Checker& c;
    Scope* s;
    Body b;
    int& depth;
    ~Restore() {
      c.scope_ = s, c.body_ = b, --depth;
      c.open_functions_.pop_back();
    }
  } const restore{*this, outside, outer, functions_deep_};
  Enter enter(*this);
  scope_->limit = f.number;
  std::size_t next_length = 0;
  for (std::size_t i = 0; i < f.parameters.size(); ++i) {
    const syntax::Declarator& d = f.declaration->parameters[i];
    Type t = f.parameters[i].type;
    if (t.array == Type::unsized) t.array = lengths[next_length++];
    const auto role = d.output ? Symbol::Role::output_argument : Symbol::Role::argument;
    if (scope_->names.count(d.name)) diagnostics_.error(d.place, fmt::format("two parameters are called '{}'", d.name));
    Symbol* s = make_symbol(d.name, t, role, d.place);
    declare(d.name, {0, s, nullptr, nullptr});
    made.parameters.push_back(s);
  }
  made.body = block(*f.declaration->body);
}

/// Calls of functions that were declared before they were defined.
void Checker::resolve_pending() {
  for (std::size_t i = 0; i < pending_.size(); ++i) {
    const Pending p = pending_[i];
    try {
      if (!p.function->definition)
        refuse(p.call->place, fmt::format("the function '{}' is declared, but has no body", p.function->declaration->name));
      p.call->function = instance(*p.function->definition, p.lengths, p.call->place);
    } catch (const Abandon&) {
    }
  }
}

namespace {

/// Lists the calls and the variables below a node.
struct Calls {
  std::vector<const Expression*> calls;
  std::unordered_set<const Symbol*>* symbols;

  void of(const Expression* e) {
    if (!e) return;
    if (e->kind == Expression::Kind::call) calls.push_back(e);
    if (e->symbol) symbols->insert(e->symbol);
    for (const ExpressionPointer& o : e->operands) of(o.get());
  }
  void of(const Statement* s) {
    if (!s) return;
    of(s->expression.get());
    of(s->step.get());
    for (const StatementPointer& inner : s->statements) of(inner.get());
    of(s->body.get());
    of(s->otherwise.get());
    if (!s->symbol) return;
    symbols->insert(s->symbol);
    of(s->symbol->initial.get());
  }
};

}  // namespace

/// Keeps the functions that are called, each behind those that it calls itself, with the variables in them, and refuses
/// recursion.
void Checker::finish_functions() {
  enum class State { unseen, open, done };
  std::unordered_map<const Function*, State> state;
  std::unordered_map<const Function*, std::vector<const Expression*>> calls_of;
  std::vector<const Function*> order;
  std::unordered_set<const Symbol*> used(shader_->parameters.begin(), shader_->parameters.end());
  const auto calls_in = [&](const Function* f) -> const std::vector<const Expression*>& {
    const auto [place, is_new] = calls_of.try_emplace(f);
    if (is_new) {
      Calls calls{{}, &used};
      used.insert(f->parameters.begin(), f->parameters.end());
      calls.of(f->body.get());
      place->second = std::move(calls.calls);
    }
    return place->second;
  };
  struct Visit {
    const Function* function;
    std::size_t next;
  };
  Calls roots{{}, &used};
  roots.of(shader_->body.get());
  for (const Symbol* p : shader_->parameters) roots.of(p->initial.get());
  for (const Expression* root : roots.calls) {
    if (state[root->function] != State::unseen) continue;
    std::vector<Visit> stack{{root->function, 0}};
    state[root->function] = State::open;
    while (!stack.empty()) {
      Visit& v = stack.back();
      const auto& calls = calls_in(v.function);
      if (v.next == calls.size()) {
        state[v.function] = State::done;
        order.push_back(v.function);
        stack.pop_back();
        continue;
      }
      const Expression* call = calls[v.next++];
      State& s = state[call->function];
      if (s == State::open) {
        diagnostics_.error(call->place, fmt::format("the function '{}' calls itself: recursion is not part of the language",
                                                    call->function->name));
        return;
      }
      if (s == State::unseen) {
        s = State::open;
        stack.push_back({call->function, 0});
      }
    }
  }
  std::unordered_map<const Function*, std::unique_ptr<Function>> owners;
  for (auto& f : shader_->functions) owners.emplace(f.get(), std::move(f));
  shader_->functions.clear();
  for (const Function* f : order) shader_->functions.push_back(std::move(owners.at(f)));
  for (const Symbol* g : shader_->globals)
    if (g) used.insert(g);
  std::erase_if(shader_->symbols, [&](const auto& s) { return !used.count(s.get()); });
  for (std::size_t i = 0; i < shader_->symbols.size(); ++i) shader_->symbols[i]->index = int(i);
}

// ---- variables

Symbol* Checker::declare_variable(const syntax::Declarator& d, Symbol::Role role) {
  Type type;
  try {
    type = type_of(d);
  } catch (const Abandon&) {
    // What uses the variable is not to be complained about, too.
    type = d.type.name == "string" ? Type(Base::string) : Type(Base::float_);
    declare(d.name, {0, make_symbol(d.name, type, role, d.place), nullptr, nullptr});
    throw;
  }
  const bool of_shader = role == Symbol::Role::parameter || role == Symbol::Role::output;
  if (const auto same = scope_->names.find(d.name); same != scope_->names.end())
    for (const Scope::Entry& e : same->second)
      if (e.symbol || e.structure) diagnostics_.error(d.place, fmt::format("'{}' is already declared in this scope", d.name));
  if (type.array == Type::unsized && !of_shader && !d.initial)
    diagnostics_.error(d.place, fmt::format("the array '{}' needs a length", d.name));
  Symbol* s = make_symbol(d.name, type, role, d.place);
  struct Declare {  // behind its own initial value
    Checker& c;
    const syntax::Declarator& d;
    Symbol* s;
    ~Declare() { c.declare(d.name, {0, s, nullptr, nullptr}); }
  } const declare_behind{*this, d, s};
  if (d.initial) initial_value(*s, *d.initial);
  if (of_shader) s->metadata = metadata(d.metadata);
  return s;
}

void Checker::initial_value(Symbol& s, const syntax::Expression& e) {
  Type type = s.type;
  if (e.kind == syntax::Expression::Kind::list) {
    if (type.array == Type::unsized) type.array = std::max(1, int(e.operands.size()));
    s.initial = fold(list(e, type));
  } else if (type.is_array()) {
    ExpressionPointer v = value(e, type);
    if (v->type.is_array()) {
      if (!assignable(type, v->type))
        refuse(e.place, fmt::format("'{} {}' cannot take {}", type.name(), s.name, v->type.name()));
      if (type.array == Type::unsized) type.array = v->type.array;
      s.initial = std::move(v);
    } else {
      // One value for the first element, without braces.
      ExpressionPointer all = make(Expression::Kind::aggregate, type.array == Type::unsized ? type.as_array(1) : type, e.place);
      all->operands.push_back(converted(std::move(v), type.element(), s.name.c_str()));
      if (type.array == Type::unsized) type.array = 1;
      s.initial = fold(std::move(all));
    }
  } else {
    s.initial = converted(value(e, type), type, s.name.c_str());
  }
  if (s.role == Symbol::Role::local) s.type = type;
}

std::vector<Metadatum> Checker::metadata(const std::vector<syntax::Declarator>& list_of) {
  std::vector<Metadatum> out;
  for (const syntax::Declarator& d : list_of) {
    try {
      Type t = type_of(d);
      if (t.is_structure() || t.is_closure()) refuse(d.place, fmt::format("metadata cannot have the type '{}'", t.name()));
      ExpressionPointer v;
      if (d.initial->kind == syntax::Expression::Kind::list) {
        if (t.array == Type::unsized) t.array = std::max(1, int(d.initial->operands.size()));
        v = fold(list(*d.initial, t));
      } else {
        v = converted(value(*d.initial, t), t, d.name.c_str());
      }
      if (v->kind != Expression::Kind::constant) refuse(d.place, fmt::format("the metadatum '{}' must be a constant", d.name));
      out.push_back({d.name, std::move(v->constant)});
    } catch (const Abandon&) {
    }
  }
  return out;
}

void Checker::shader(const syntax::ShaderDeclaration& d) {
  shader_->name = d.name, shader_->kind = d.kind, shader_->place = d.place;
  shader_->metadata = metadata(d.metadata);
  Enter enter(*this);
  for (const syntax::Declarator& p : d.parameters) {
    try {
      Symbol* s = declare_variable(p, p.output ? Symbol::Role::output : Symbol::Role::parameter);
      shader_->parameters.push_back(s);
    } catch (const Abandon&) {
    }
  }
  body_ = {};
  shader_->body = block(*d.body);
}

}  // namespace etendue::osl
