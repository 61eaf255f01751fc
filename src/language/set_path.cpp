// Setting a member that is found by a path from a component.

#include <fmt/format.h>

#include <charconv>

#include "describe/words.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "evaluator.h"
#include "lexer.h"

namespace etendue {
namespace {

using language::Diagnostics;

/// One name of a path with the places in lists behind it: objects[2].
struct PathStep {
  std::string name;
  std::vector<size_t> places;
  Location at;
};

/// Walks along a path; `whole` names it and the expression in messages.
class Path {
 public:
  Path(const std::string& text, const char* source) : source_(source) {
    size_t i = 0;
    for (;;) {
      PathStep step{{}, {}, at(i)};
      while (i < text.size() && text[i] != '.' && text[i] != '[') step.name += text[i++];
      if (!language::is_name(step.name)) fail(fmt::format("expected the name of a member, not '{}'", step.name), step.at);
      while (i < text.size() && text[i] == '[') {
        size_t place = 0;
        const auto [end, error] = std::from_chars(text.data() + i + 1, text.data() + text.size(), place);
        const size_t close = size_t(end - text.data());
        if (error != std::errc() || close >= text.size() || text[close] != ']')
          fail("expected a place in the list such as [0]", at(i));
        step.places.push_back(place);
        i = close + 1;
      }
      steps.push_back(std::move(step));
      if (i == text.size()) return;
      if (text[i] != '.') fail(fmt::format("expected '.' or the end of the path, not '{}'", text[i]), at(i));
      ++i;
    }
  }

  [[noreturn]] static void fail(const std::string& message, Location place) { throw Error(message, place); }
  Location at(size_t offset) const { return {source_, 1, int(offset) + 1}; }

  std::vector<PathStep> steps;

 private:
  const char* source_;
};

const Member& find_member(const Component& component, const PathStep& step) {
  const ClassInfo& info = component.class_info();
  if (const Member* member = info.find(step.name)) return *member;
  Path::fail(no_member(info, step.name), step.at);
}

void check_place(const std::string& name, size_t count, size_t place, Location at) {
  if (place >= count)
    Path::fail(fmt::format("{} has {} {}: there is no [{}]", name, count, count == 1 ? "entry" : "entries", place), at);
}

/// The component that a step leads to.
Ref<Component> follow(const Component& component, const PathStep& step) {
  const Member& member = find_member(component, step);
  Value value = member.get(component, member);
  std::string name = step.name;
  for (const size_t place : step.places) {
    const auto* list = value.as<Value::List>();
    if (!list) Path::fail(fmt::format("{} is no list of components", name), step.at);
    check_place(name, list->size(), place, step.at);
    Value item = (*list)[place];
    value = std::move(item);
    name += fmt::format("[{}]", place);
  }
  const auto* next = value.as<Ref<Component>>();
  if (value.none() || (next && !*next)) Path::fail(fmt::format("{} is none: there is nothing in it to set", name), step.at);
  if (value.as<Value::List>()) Path::fail(fmt::format("{} is a list: say which entry, as in {}[0]", name, name), step.at);
  if (!next) Path::fail(fmt::format("{} is {}, which has no members", name, value.kind()), step.at);
  return *next;
}

/// The member's value with one entry of it replaced.
Value replaced(Value whole, const Value& entry, size_t place, const PathStep& step, const Member& member) {
  if (auto* list = std::get_if<Value::List>(&whole.data)) {
    check_place(step.name, list->size(), place, step.at);
    (*list)[place] = entry;
    return whole;
  }
  auto* numbers = std::get_if<Numbers>(&whole.data);
  if (!numbers) Path::fail(fmt::format("{} is {}, not a list", step.name, whole.kind()), step.at);
  check_place(step.name, numbers->rows(), place, step.at);
  Numbers row;
  if (const auto* number = entry.as<Number>()) {
    row = {{number->value}, 1, number->dimension};
  } else if (const auto* given = entry.as<Numbers>(); given && given->width == 1) {
    row = *given;
  }
  if (row.values.size() != size_t(numbers->width))
    Path::fail(fmt::format("an entry of {} is {}, not {}", step.name,
                           numbers->width == 1 ? "a number" : fmt::format("{} numbers", numbers->width), entry.kind()),
               entry.location);
  // Lists of numbers are read back plain, in the member's unit; vectors in base units.
  const Unit* unit = find_unit(member.unit);
  if (row.dimension != Dimension::none && (!unit || unit->dimension != row.dimension))
    Path::fail(fmt::format("{} does not take a {}", step.name, name(row.dimension)), entry.location);
  double factor = 1;
  if (unit && row.dimension == Dimension::none && numbers->dimension != Dimension::none) factor = unit->factor;
  if (unit && row.dimension != Dimension::none && numbers->dimension == Dimension::none) factor = 1 / unit->factor;
  for (size_t k = 0; k < row.values.size(); ++k) numbers->values[place * row.values.size() + k] = row.values[k] * factor;
  return whole;
}

std::string trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(" \t\r\n"), end = text.find_last_not_of(" \t\r\n");
  return begin == std::string::npos ? std::string() : text.substr(begin, end - begin + 1);
}

Value read_expression(const std::string& path, const std::string& expression, const char* source, const Member& member,
                      bool entry) {
  const Location at{source, 1, int(path.size()) + 2};
  const bool text = member.kind == Kind::string || member.kind == Kind::file;
  const size_t first = expression.find_first_not_of(" \t\r\n");
  const char begin = first == std::string::npos ? '\0' : expression[first];
  // Names of files need no quotes.
  if (text && begin != '"' && !(member.list && !entry && begin == '[')) return Value(expression, at);
  Diagnostics diagnostics;
  language::Evaluator evaluator(diagnostics, true);
  // A class alone stands for one of it with its defaults: on a command line braces need quotes.
  if (const std::string word = trimmed(expression);
      member.kind == Kind::component && language::is_name(word) && word != "none") {
    try {
      Value made(Registry::instance().create(word), at);
      return member.list && !entry ? Value(Value::List{made}, at) : made;
    } catch (const Error& e) {
      throw Error(e.what(), at);
    }
  }
  const language::Source whole{source, {}, path + "=" + expression};
  if (language::invalid_utf8(whole.text)) throw Error("the text is not valid UTF-8", at);
  const auto node = language::parse_expression(whole, diagnostics, path.size() + 1);
  std::optional<Value> value;
  if (node) value = evaluator.evaluate(*node, {&member, true, false});
  diagnostics.raise();
  return value ? std::move(*value) : Value();
}

}  // namespace

void set_path(Component& root, const std::string& path, const std::string& expression) {
  const char* source = intern("--set " + path);
  language::remember_text(source, path + "=" + expression);
  const Path parsed(path, source);
  Component* component = &root;
  Ref<Component> held;  // what is walked into stays alive; the root is the caller's
  for (size_t i = 0; i + 1 < parsed.steps.size(); ++i) {
    held = follow(*component, parsed.steps[i]);
    component = held.get();
  }
  const PathStep& last = parsed.steps.back();
  const Member& member = find_member(*component, last);
  if (last.places.size() > 1) Path::fail(fmt::format("{} is a list of one level", last.name), last.at);
  Value value;
  try {
    value = read_expression(path, expression, source, member, !last.places.empty());
  } catch (const language::TooManyErrors&) {
    throw Error("the expression is wrong in too many ways", {source, 1, int(path.size()) + 2});
  }
  const Location at = value.location;
  if (!last.places.empty()) value = replaced(member.get(*component, member), value, last.places.front(), last, member);
  value.location = at;
  set(*component, last.name, value);
  if (!component->origin) component->origin = std::make_unique<Component::Origin>();
  auto& members = component->origin->members;
  std::erase_if(members, [&](const auto& m) { return m.first == last.name; });
  members.emplace_back(last.name, at);
}

}  // namespace etendue
