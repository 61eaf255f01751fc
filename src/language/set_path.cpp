// Sets a member that is addressed by a path from a component.

#include <fmt/format.h>

#include <charconv>
#include <unordered_set>

#include "describe/words.h"
#include "etendue/describe/registry.h"
#include "etendue/language/language.h"
#include "evaluator.h"
#include "lexer.h"
#include "set_path.h"

namespace etendue {
namespace {

using language::Diagnostics;

/// One name of a path with the list indices after it: objects[2].
struct PathStep {
  std::string name;
  std::vector<size_t> places;
  Location at;
};

/// A parsed path.
class Path {
 public:
  Path(const std::string& text, Location begin) : begin_(begin) {
    size_t i = 0;
    for (;;) {
      PathStep step{{}, {}, at(i)};
      while (i < text.size() && text[i] != '.' && text[i] != '[') step.name += text[i++];
      if (!language::is_name(step.name)) fail(fmt::format("expected the name of a member, not '{}'", step.name), step.at);
      while (i < text.size() && text[i] == '[') {
        size_t place = 0;
        const auto [end, error] = std::from_chars(text.data() + i + 1, text.data() + text.size(), place);
        const size_t close = size_t(end - text.data());
        if (error != std::errc() || close >= text.size() || text[close] != ']') fail("expected an index such as [0]", at(i));
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
  /// The location of a path character; if the text was not written by the user, the location of the whole option.
  Location at(size_t offset) const { return begin_.line == 0 ? begin_ : Location{begin_.file, 1, int(offset) + 1}; }

  std::vector<PathStep> steps;

 private:
  Location begin_;
};

/// Searches the parts of a component for the component with a name in the description; returns its path, or "".
std::string path_of_name(const Component& from, const std::string& name, std::unordered_set<const Component*>& seen,
                         int levels) {
  constexpr int most_levels = 100;
  if (levels > most_levels || !seen.insert(&from).second) return {};
  for (const Member& member : from.class_info().members) {
    if (member.kind != Kind::component) continue;
    const Value value = member.get(from, member);
    const auto within = [&](const Value& one, const std::string& path) -> std::string {
      const auto* part = one.as<Ref<Component>>();
      if (!part || !*part) return {};
      if ((*part)->origin && (*part)->origin->name == name) return path;
      const std::string rest = path_of_name(**part, name, seen, levels + 1);
      return rest.empty() ? rest : path + "." + rest;
    };
    const auto* list = value.as<Value::List>();
    for (size_t i = 0; i < (list ? list->size() : 1); ++i)
      if (std::string path = list ? within((*list)[i], fmt::format("{}[{}]", member.name, i)) : within(value, member.name);
          !path.empty())
        return path;
  }
  return {};
}

const Member& find_member(const Component& component, const PathStep& step) {
  const ClassInfo& info = component.class_info();
  if (const Member* member = info.find(step.name)) return *member;
  std::unordered_set<const Component*> seen;
  if (const std::string path = path_of_name(component, step.name, seen, 0); !path.empty())
    Path::fail(fmt::format("{} has no member '{}': a path consists of members, not names of the file; '{}' is {}", info.name,
                           step.name, step.name, path),
               step.at);
  Path::fail(no_member(info, step.name), step.at);
}

void check_place(const std::string& name, size_t count, size_t place, Location at) {
  if (place >= count)
    Path::fail(fmt::format("{} has {} {}: there is no [{}]", name, count, count == 1 ? "entry" : "entries", place), at);
}

/// The component that a step of a path leads to.
Ref<Component> follow(const Component& component, const PathStep& step) {
  const Member& member = find_member(component, step);
  Value value = member.get(component, member);
  std::string name = step.name;
  for (const size_t place : step.places) {
    const auto* list = value.as<Value::List>();
    if (!list) Path::fail(fmt::format("{} is not a list of components", name), step.at);
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

/// The member's value with one entry replaced.
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
  // Lists of numbers are stored in the member's unit without a dimension; vectors in base units.
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

/// Evaluates the new value. `at` is the location of the expression; without a line, that of the command line option.
Value read_expression(const std::string& path, const std::string& expression, Location at, const Member& member, bool entry) {
  const bool text = member.kind == Kind::string || member.kind == Kind::file;
  const size_t first = expression.find_first_not_of(" \t\r\n");
  const char begin = first == std::string::npos ? '\0' : expression[first];
  // File names need no quotes.
  if (text && begin != '"' && !(member.list && !entry && begin == '[')) return Value(expression, at);
  Diagnostics diagnostics;
  language::Evaluator evaluator(diagnostics, true);
  // A class name alone stands for a component with default values: on a command line, braces would need quotes.
  if (const std::string word = trimmed(expression);
      member.kind == Kind::component && language::is_name(word) && word != "none") {
    try {
      Value made(Registry::instance().create(word), at);
      return member.list && !entry ? Value(Value::List{made}, at) : made;
    } catch (const Error& e) {
      throw Error(e.what(), at);
    }
  }
  language::Source whole{at.file, {}, path + "=" + expression};
  if (at.line == 0) whole.columns.assign(whole.text.size() + 1, 0);
  if (language::invalid_utf8(whole.text)) throw Error("the text is not valid UTF-8", at);
  const auto node = language::parse_expression(whole, diagnostics, path.size() + 1);
  std::optional<Value> value;
  if (node) value = evaluator.evaluate(*node, {&member, true, false});
  diagnostics.raise();
  return value ? std::move(*value) : Value();
}

}  // namespace

namespace language {

void set_path_from(Component& root, const std::string& path, const std::string& expression, Location place) {
  const Path parsed(path, place);
  const Location expression_at = parsed.at(path.size() + 1);
  Component* component = &root;
  Ref<Component> held;  // keeps the visited component alive; the root belongs to the caller
  for (size_t i = 0; i + 1 < parsed.steps.size(); ++i) {
    held = follow(*component, parsed.steps[i]);
    component = held.get();
  }
  const PathStep& last = parsed.steps.back();
  const Member& member = find_member(*component, last);
  if (last.places.size() > 1) Path::fail(fmt::format("{} is not a list of lists", last.name), last.at);
  Value value;
  try {
    value = read_expression(path, expression, expression_at, member, !last.places.empty());
  } catch (const language::TooManyErrors&) {
    throw Error("the expression has too many errors", expression_at);
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

}  // namespace language

void set_path(Component& root, const std::string& path, const std::string& expression) {
  const char* source = intern("--set " + path);
  language::remember_text(source, path + "=" + expression);
  language::set_path_from(root, path, expression, {source, 1, 1});
}

}  // namespace etendue
