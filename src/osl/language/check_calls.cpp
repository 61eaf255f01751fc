// Calls: which function a call means, and its arguments.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "checker.h"
#include "conversions.h"
#include "folding.h"
#include "parser.h"

namespace etendue::osl {

std::string Checker::shown(const std::string& name, const std::vector<Argument>& arguments) const {
  std::string text = name + " (";
  for (std::size_t i = 0; i < arguments.size(); ++i)
    text += (i ? ", " : "") + (arguments[i].value ? arguments[i].value->type.name() : std::string("{...}"));
  return text + ")";
}

// ---- which function

/// The sum of how well the arguments fit, 0 if one does not.
int Checker::score(const Candidate& c, const std::vector<Argument>& arguments) {
  const std::size_t fixed = c.function ? c.function->parameters.size() : c.signature->parameters.size();
  const bool closure = c.function ? c.function->closure : c.signature->closure >= 0;
  const bool more = closure || (c.signature && c.signature->variadic);
  if (arguments.size() < fixed || (arguments.size() > fixed && !more)) return 0;
  if (closure && arguments.size() > fixed) {  // pairs of a keyword and a value
    if ((arguments.size() - fixed) % 2 != 0) return 0;
    for (std::size_t i = fixed; i < arguments.size(); i += 2)
      if (!arguments[i].value || !arguments[i].value->type.is_string() ||
          arguments[i].value->kind != Expression::Kind::constant)
        return 0;
  }
  int sum = 1;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Argument& a = arguments[i];
    if (i >= fixed || (c.signature && c.signature->parameters[i].any)) {
      if (!a.value || a.value->type.is_void()) return 0;
      sum += any_fit;
      continue;
    }
    const Type t = c.function ? c.function->parameters[i].type : c.signature->parameters[i].type;
    const bool output = c.function ? c.function->parameters[i].output : c.signature->parameters[i].output;
    int fits = 0;
    if (a.list) {
      fits = !output && fits_list(*a.list, t) ? conversion_fit : 0;
    } else {
      fits = fit(t, a.value->type);
      if (t.is_closure() && !t.is_array() && fits == 0 && a.value->kind == Expression::Kind::constant &&
          !a.value->type.is_closure() && ((a.value->type.is_int() && a.value->constant.at<int>() == 0)))
        fits = conversion_fit;
      if (output && t.array == Type::unsized ? false : output && !equivalent(t, a.value->type)) fits = 0;
    }
    if (fits == 0) return 0;
    sum += fits;
  }
  return sum;
}

std::vector<Checker::Candidate> Checker::candidates(const std::string& name, const std::vector<Argument>& arguments) {
  std::vector<Candidate> best;
  const auto consider = [&](Candidate c) {
    c.score = score(c, arguments);
    if (c.score == 0 || (!best.empty() && c.score < best[0].score)) return;
    if (!best.empty() && c.score > best[0].score) best.clear();
    best.push_back(c);
  };
  const std::vector<FunctionEntry*> own = scope_->functions(name);
  const auto same = [](const auto& a, const auto& b) {
    return a.result == b.result &&
           std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(), b.parameters.end(),
                      [](const auto& x, const auto& y) { return x.type == y.type; });
  };
  for (std::size_t i = 0; i < own.size(); ++i) {
    const bool hidden =
        std::any_of(own.begin(), own.begin() + std::ptrdiff_t(i), [&](const FunctionEntry* f) { return same(*f, *own[i]); });
    if (!hidden) consider({own[i], nullptr, 0, own[i]->result});
  }
  for (const Signature& s : library_signatures(name)) {
    const bool hidden = std::any_of(own.begin(), own.end(), [&](const FunctionEntry* f) { return !s.variadic && same(*f, s); });
    if (!hidden) consider({nullptr, &s, 0, s.result});
  }
  return best;
}

Checker::Candidate Checker::choose(std::vector<Candidate>& best, Type expected, const std::string& name,
                                   const std::vector<Argument>& arguments, Location at) {
  if (best.size() > 1 && !expected.is_void()) {
    // Functions that differ in their result only: the one whose result fits what the value is for.
    int most = 0;
    for (const Candidate& c : best) most = std::max(most, fit(expected, c.result));
    if (most > 0) std::erase_if(best, [&](const Candidate& c) { return fit(expected, c.result) < most; });
  }
  if (best.size() == 1) return best[0];
  std::stable_sort(best.begin(), best.end(),
                   [](const Candidate& a, const Candidate& b) { return rank_of_result(a.result) < rank_of_result(b.result); });
  const bool own = std::all_of(best.begin(), best.end(), [](const Candidate& c) { return c.function != nullptr; });
  if (own) {
    std::string text = fmt::format("Ambiguous call to '{}'\n  Chosen function is:", shown(name, arguments));
    for (std::size_t i = 0; i < best.size(); ++i) {
      const FunctionEntry& f = *best[i].function;
      if (i == 1) text += "\n  Other candidates are:";
      const Location& place = f.declaration->place;
      text += fmt::format("\n    {}:{}\t{}{} {} (", place.file, place.line, f.result.is_structure() ? "struct " : "",
                          f.result.name(), name);
      for (std::size_t p = 0; p < f.parameters.size(); ++p) text += (p ? ", " : "") + f.parameters[p].type.name();
      text += ")";
    }
    diagnostics_.warning(at, text);
  }
  return best[0];
}

void Checker::refuse_call(const std::string& name, const std::vector<Argument>& arguments, Location at) {
  // A body does not see its own function: a call of the name would mean another one.
  const bool recursive = std::ranges::find(open_functions_, name) != open_functions_.end();
  std::string known;
  int count = 0;
  const auto list_one = [&](const std::string& text) {
    if (++count <= 6) known += "\n  " + text;
  };
  for (const FunctionEntry* f : scope_->functions(name)) {
    std::string text = f->result.name() + " " + name + " (";
    for (std::size_t i = 0; i < f->parameters.size(); ++i) text += (i ? ", " : "") + f->parameters[i].type.name();
    list_one(text + ")");
  }
  const Row* last = nullptr;
  for (const Signature& s : library_signatures(name)) {
    if (s.row && s.row != last) list_one(s.row->signature);
    if (!s.row) list_one(closures()[std::size_t(s.closure)].signature);
    last = s.row;
  }
  if (count == 0) {
    if (const Scope::Entry* e = scope_->find(name); e && e->symbol)
      refuse(at, fmt::format("'{}' is a variable, not a function", name));
    if (recursive) refuse(at, fmt::format("the function '{}' calls itself: recursion is not part of the language", name));
    refuse(at, fmt::format("there is no function '{}'", name));
  }
  refuse(at,
         fmt::format("no function fits the call '{}'; there {}{}", shown(name, arguments), count == 1 ? "is" : "are", known) +
             (recursive ? fmt::format("\n'{}' itself cannot be called here: recursion is not part of the language", name)
                        : std::string()));
}

// ---- calls

ExpressionPointer Checker::call(const syntax::Expression& e, Type expected) {
  if (auto done = special_call(e)) return std::move(*done);
  const Type simple = simple_type(e.name);
  const bool constructor = !simple.is_void() && scope_->functions(e.name).empty();
  std::vector<Argument> arguments;
  for (const syntax::ExpressionPointer& o : e.operands) {
    if (o->kind == syntax::Expression::Kind::list) {
      arguments.push_back({nullptr, o.get(), o->place});
      continue;
    }
    // A constructor of several parts takes floats: among functions that differ in the result, it means those.
    Type wanted;
    if (constructor) wanted = e.operands.size() == 1 ? simple : Type(Base::float_);
    arguments.push_back({value(*o, wanted), nullptr, o->place});
  }
  return call(e.name, std::move(arguments), expected, e.place);
}

ExpressionPointer Checker::call(const std::string& name, std::vector<Argument> arguments, Type expected, Location at) {
  const Type simple = simple_type(name);
  if (!simple.is_void() && arguments.size() == 1 && scope_->functions(name).empty()) {
    Argument& a = arguments[0];
    if (a.list) return list(*a.list, simple);
    // type(value): the same as (type) value, except for what has a constructor of its own.
    const Type from = a.value->type;
    if (from == simple) return std::move(a.value);
    const bool own = simple.base == Base::spectrum && (from.is_string() || from.is_triple());
    if (!own) {
      if (!castable(simple, from) || from.is_array())
        refuse(at, fmt::format("a value of type '{}' cannot be converted to '{}'", from.name(), name));
      return convert(std::move(a.value), simple);
    }
  }
  std::vector<Candidate> best = candidates(name, arguments);
  if (best.empty()) refuse_call(name, arguments, at);
  const Candidate c = choose(best, expected, name, arguments, at);
  if (c.signature) {
    if (c.signature->closure < 0) return call_library(*c.signature, arguments, at);
    std::vector<Type> types;
    for (const Signature::Parameter& p : c.signature->parameters) types.push_back(p.type);
    return call_closure(name, c.signature->closure, types, c.signature, arguments, at);
  }
  if (c.function->closure) {
    std::vector<Type> types;
    for (const FunctionEntry::Parameter& p : c.function->parameters) types.push_back(p.type);
    return call_closure(name, -1, types, nullptr, arguments, at);
  }
  return call_function(*c.function, arguments, at);
}

/// What the language itself does: constructors of structures, arraylength, isconnected, isconstant.
std::optional<ExpressionPointer> Checker::special_call(const syntax::Expression& e) {
  if (e.name == "void") refuse(e.place, "there is no value of type void");
  if (const Scope::Entry* entry = scope_->find(e.name); entry && entry->structure) return structure(*entry->structure, e);
  const bool known = e.name == "arraylength" || e.name == "isconnected" || e.name == "isconstant" || e.name == "exit";
  if (!known || !scope_->functions(e.name).empty()) return std::nullopt;
  if (e.name == "exit") refuse(e.place, "exit() is a statement of its own");
  if (e.operands.size() != 1) refuse(e.place, fmt::format("'{}' has one argument", e.name));
  ExpressionPointer v = value(*e.operands[0]);
  if (e.name == "arraylength") {
    if (!v->type.is_array()) refuse(e.place, fmt::format("arraylength() of '{}', which is no array", v->type.name()));
    if (v->type.array != Type::unsized) {
      const int length = v->type.array;
      dropped_.push_back(std::move(v));
      return make_constant(e.place, length);
    }
    return make(Expression::Kind::array_length, Base::int_, e.place, std::move(v));
  }
  if (e.name == "isconnected") {
    const Symbol* root = v->root();
    const bool parameter = root && root->role != Symbol::Role::local && root->role != Symbol::Role::global;
    if (!parameter) refuse(e.place, "isconnected() takes a parameter");
    return make(Expression::Kind::is_connected, Base::int_, e.place, std::move(v));
  }
  return make(Expression::Kind::is_constant, Base::int_, e.place, std::move(v));
}

ExpressionPointer Checker::structure(const StructType& type, const syntax::Expression& e) {
  if (e.operands.size() != type.fields.size())
    refuse(e.place, fmt::format("'{}' has {} fields, not {}", type.name, type.fields.size(), e.operands.size()));
  ExpressionPointer out = make(Expression::Kind::aggregate, Type::of(&type), e.place);
  for (std::size_t i = 0; i < e.operands.size(); ++i)
    out->operands.push_back(value_as(*e.operands[i], type.fields[i].type, type.fields[i].name.c_str()));
  return fold(std::move(out));
}

ExpressionPointer Checker::argument(Argument& a, const Type& type, bool output, bool any, const std::string& function) {
  if (output) {
    must_be_writable(*a.value);
    return std::move(a.value);
  }
  if (any) return std::move(a.value);
  if (a.list) return fold(list(*a.list, type));
  if (type.is_array()) return std::move(a.value);
  return converted(std::move(a.value), type, function.c_str());
}

ExpressionPointer Checker::call_function(FunctionEntry& f, std::vector<Argument>& arguments, Location at) {
  ExpressionPointer out = make(Expression::Kind::call, f.result, at);
  std::vector<int> lengths;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const FunctionEntry::Parameter& p = f.parameters[i];
    out->operands.push_back(argument(arguments[i], p.type, p.output, false, f.declaration->name));
    if (p.type.array == Type::unsized) lengths.push_back(out->operands.back()->type.array);
  }
  if (f.declaration->body) {
    out->function = instance(f, lengths, at);
  } else {
    pending_.push_back({out.get(), &f, lengths});
  }
  return out;
}

void Checker::mark_output(Expression& call, std::size_t argument) {
  if (argument >= 64) refuse(call.place, "a call with more than 64 arguments");
  call.outputs |= std::uint64_t(1) << argument;
}

ExpressionPointer Checker::call_library(const Signature& s, std::vector<Argument>& arguments, Location at) {
  if (s.row->refused) refuse(at, fmt::format("'{}': {}", s.name, s.row->refused));
  ExpressionPointer out = make(Expression::Kind::library, s.result, at);
  out->row = s.row;
  const bool spline = s.name == "spline" || s.name == "splineinverse";
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    Argument& a = arguments[i];
    if (i < s.parameters.size()) {
      const Signature::Parameter& p = s.parameters[i];
      out->operands.push_back(argument(a, p.type, p.output, p.any, s.name));
      if (p.output) mark_output(*out, i);
      continue;
    }
    // Further knots have the type of the first ones.
    if (spline) {
      out->operands.push_back(converted(std::move(a.value), s.parameters.back().type, s.name.c_str()));
      continue;
    }
    if (s.output_variadic && out->operands.back()->kind == Expression::Kind::constant &&
        out->operands.back()->type.is_string()) {
      static constexpr std::array written = {"alpha", "dalphadx", "dalphady", "errormessage"};
      const std::string& option = out->operands.back()->constant.at<const String*>()->text();
      if (std::find(written.begin(), written.end(), option) != written.end()) {
        must_be_writable(*a.value);
        mark_output(*out, i);
      }
    }
    out->operands.push_back(std::move(a.value));
  }
  return fold(std::move(out));
}

ExpressionPointer Checker::call_closure(const std::string& name, int known, const std::vector<Type>& parameters,
                                        const Signature* s, std::vector<Argument>& arguments, Location at) {
  auto shape = std::make_unique<ClosureShape>();
  shape->name = intern_string(name), shape->known = known;
  ExpressionPointer out = make(Expression::Kind::closure, Type::closure_color(), at);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    out->operands.push_back(argument(arguments[i], parameters[i], false, false, name));
    shape->add(out->operands.back()->type);
  }
  for (std::size_t i = parameters.size(); i + 1 < arguments.size(); i += 2) {
    const String* keyword = arguments[i].value->constant.at<const String*>();
    ExpressionPointer v = std::move(arguments[i + 1].value);
    if (!v) refuse(at, "a list cannot be the value of a keyword");
    if (s)
      for (const auto& [word, type] : s->keywords)
        if (word == keyword->text()) v = converted(std::move(v), type, word.c_str());
    if (keyword->text() == "label" && !v->type.is_string()) refuse(at, "the label of a closure must be a string");
    shape->add(v->type, keyword);
    out->operands.push_back(std::move(arguments[i].value));
    out->operands.push_back(std::move(v));
  }
  out->shape = shape.get();
  shader_->shapes.push_back(std::move(shape));
  return out;
}

}  // namespace etendue::osl
