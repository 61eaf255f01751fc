// Evaluator: functions defined in a description.

#include <fmt/format.h>

#include <algorithm>

#include "language/evaluator.h"

namespace etendue::language {

class Evaluator::CallTrail : public Trail {
 public:
  CallTrail(const Trail* outer, const std::string& name, Location at) : Trail(outer), name_(name), at_(at) {}
  std::string words(const Location& seen_from) const override {
    return fmt::format("in '{}', called at {}", name_, place(at_, seen_from));
  }

 private:
  const std::string& name_;
  Location at_;
};

namespace {

/// The signature for messages: "tree(height, radius = …)"
std::string signature(const Definition& function) {
  std::string text;
  for (const Parameter& p : function.parameters) text += (text.empty() ? "" : ", ") + p.name.text + (p.standard ? " = …" : "");
  return function.name.text + "(" + text + ")";
}

}  // namespace

void Evaluator::not_a_function(const Entry& entry, const Node& call) {
  if (entry.definition.value.type == NodeType::bad || entry.state == State::failed) return;
  diagnostics_.add(Error(
      fmt::format("'{}' is not a function: it is a value, defined at {}", call.text, place(entry.definition.name.at, call.at)),
      call.at));
}

void Evaluator::unknown_function(const Node& node) {
  std::vector<std::string> own;
  for (const Entry& e : entries_)
    if (e.definition.function) own.push_back(name_seen_from(e, *space_));
  const std::string near = suggestion(node.text, own);
  if (near.empty())
    reporting(node.at, [&] { return call(node.text, {}, node.at, allow_files_); });  // reports suggestions
  else
    diagnostics_.add(Error(fmt::format("there is no function '{}'{}", node.text, near), node.at));
}

// The arguments in the order of the parameters; null for parameters with their default value.
std::optional<std::vector<Node*>> Evaluator::arguments_of(const Entry& entry, Node& call) {
  if (entry.definition.value.type == NodeType::bad) return std::nullopt;  // its parameters may be unknown, too
  const std::vector<Parameter>& parameters = entry.definition.parameters;
  std::vector<Node*> found(parameters.size());
  std::vector<std::string> known;
  for (const Parameter& p : parameters) known.push_back(p.name.text);
  bool named = false, good = true;
  const auto wrong = [&](const std::string& message, Location at) {
    diagnostics_.add(Error(message, at));
    good = false;
  };
  for (size_t i = 0; i < call.children.size(); ++i) {
    Node& child = call.children[i];
    if (child.type == NodeType::bad) return std::nullopt;
    if (child.type != NodeType::argument) {
      if (named)
        wrong("an argument by its place cannot follow one by its name", child.at);
      else if (i >= parameters.size()) {
        wrong(fmt::format("expects {}; {} {} given", signature(entry.definition), call.children.size(),
                          call.children.size() == 1 ? "argument was" : "arguments were"),
              child.at);
        break;
      } else
        found[i] = &child;
      continue;
    }
    named = true;
    const auto place = size_t(std::find(known.begin(), known.end(), child.text) - known.begin());
    if (place == known.size())
      wrong(fmt::format("'{}' has no parameter '{}'{}", call.text, child.text, suggestion(child.text, known)), child.at);
    else if (found[place])
      wrong(fmt::format("'{}' is given twice", child.text), child.at);
    else
      found[place] = &child.children[0];
  }
  for (size_t i = 0; good && i < parameters.size(); ++i)
    if (!found[i] && !parameters[i].standard)
      wrong(fmt::format("expects {}: '{}' is missing", signature(entry.definition), known[i]), call.at);
  return good ? std::optional(found) : std::nullopt;
}

// Evaluates a node; `height` is the height of the component tree in the value.
std::optional<Value> Evaluator::measured(Node& node, const Context& context, int& height) {
  const int outer = std::exchange(reach_, depth_);
  std::optional<Value> value = evaluate(node, context);
  height = value && keeps_parts(*value) ? reach_ - depth_ : 0;
  reach_ = std::max(outer, reach_);
  return value;
}

std::optional<Value> Evaluator::call_own(Entry& entry, Node& node, const Context& context) {
  entry.used = true;
  const std::optional<std::vector<Node*>> given = arguments_of(entry, node);
  if (!given || !check_function(entry)) return std::nullopt;
  if (calls_ >= call_limit) {
    diagnostics_.add(
        Error(fmt::format("'{}' is called within {} other calls: functions may call each other, and themselves, {} "
                          "deep",
                          node.text, calls_, call_limit),
              node.at));
    return std::nullopt;
  }
  std::vector<Parameter>& parameters = entry.definition.parameters;
  std::vector<Local> locals(parameters.size());
  bool good = true;
  ++repeating_;
  for (size_t i = 0; i < locals.size(); ++i) {
    if (!(*given)[i]) continue;
    std::optional<Value> value = measured(*(*given)[i], {nullptr, false, context.lenient}, locals[i].height);
    if (value)
      locals[i].value = std::move(*value);
    else
      good = false;
  }
  --repeating_;
  if (!good) return std::nullopt;

  const Trail* outer = diagnostics_.trail;
  const CallTrail trail(outer, node.text, node.at);
  const Elsewhere elsewhere(*this, *entry.space);
  ++repeating_;
  ++calls_;
  diagnostics_.trail = &trail;
  // Defaults may depend on the parameters before them.
  for (size_t i = 0; good && i < locals.size(); ++i) {
    if (!(*given)[i]) {
      std::optional<Value> value = measured(*parameters[i].standard, {}, locals[i].height);
      good = value.has_value();
      if (value) locals[i].value = std::move(*value);
    }
    locals[i].name = parameters[i].name.text;
    locals[i].outer = locals_;
    locals_ = &locals[i];
  }
  std::optional<Value> value;
  if (good) value = evaluate(entry.definition.value, {});
  --calls_;
  if (value) value->location = node.at;
  return value;
}

// count(list): the number of its entries.
std::optional<Value> Evaluator::count(Node& node, const Context& context) {
  if (node.children.size() != 1 || node.children[0].type == NodeType::argument) {
    diagnostics_.add(Error(fmt::format("expects count(list); {} arguments were given", node.children.size()), node.at));
    return std::nullopt;
  }
  Node& child = node.children[0];
  const Value* list = stored(child);
  std::optional<Value> made;
  if (!list) {
    made = evaluate(child, {nullptr, false, context.lenient});
    if (!made) return std::nullopt;
    list = &*made;
  }
  return reporting(child.at, [&] { return Value(Number{double(list_size(*list, child.at))}, node.at); });
}

}  // namespace etendue::language
