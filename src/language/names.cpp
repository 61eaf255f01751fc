// Evaluator: definitions and lookup of names, and warnings about unused names.

#include <fmt/format.h>

#include <algorithm>

#include "evaluator.h"
#include "json.h"

namespace etendue::language {

size_t copied_size(const Value& value) {
  if (const auto* numbers = value.as<Numbers>()) return numbers->values.size();
  const auto* list = value.as<Value::List>();
  return list ? 8 * list->size() : 1;  // an entry takes as much memory as several numbers
}

Evaluator::Evaluator(Diagnostics& diagnostics, bool allow_files, std::optional<Moment> moment)
    : diagnostics_(diagnostics),
      allow_files_(allow_files),
      moment_(moment),
      root_(std::make_unique<Space>()),
      space_(root_.get()) {}

Evaluator::~Evaluator() = default;

Evaluator::Space* Evaluator::around(const Space& space) { return space.outer; }

std::optional<Value> Evaluator::evaluate_in(Space& space, Node& node) {
  const Elsewhere elsewhere(*this, space);
  return evaluate(node, {});
}

Evaluator::Space* Evaluator::make_space(Space& outer, const Label& label) {
  std::unique_ptr<Space>& inner = outer.inner[label.text];
  if (inner) {
    diagnostics_.add(Error(
        fmt::format("a file is included as '{}' already, at {}", label.text, place(inner->label.at, label.at)), label.at));
    return nullptr;
  }
  inner = std::make_unique<Space>();
  inner->outer = &outer;
  inner->label = label;
  spaces_.push_back(inner.get());
  return inner.get();
}

void Evaluator::define(Definition definition, Space& space) {
  const Label label = definition.name;
  if (definition.function && is_function(label.text)) {
    diagnostics_.add(
        Error(fmt::format("'{}' is a function of the language and cannot be defined again", label.text), label.at));
    return;
  }
  Entry*& known = space.names[label.text];
  if (known) {
    if (definition.value.type != NodeType::bad)
      diagnostics_.add(Error(
          fmt::format("'{}' is already defined at {}", label.text, place(known->definition.name.at, label.at)), label.at));
    return;
  }
  Entry& entry = entries_.emplace_back();
  entry.definition = std::move(definition);
  entry.home = entry.space = &space;
  known = &entry;
}

namespace {

/// The height of a component tree, including the root.
int height_of(const Value& value, std::unordered_map<const Component*, int>& known) {
  int height = 0;
  if (const auto* list = value.as<Value::List>()) {
    for (const Value& item : *list) height = std::max(height, height_of(item, known));
  } else if (const auto* part = value.as<Ref<Component>>(); part && *part) {
    if (const auto found = known.find(part->get()); found != known.end()) return found->second;
    for (const Member& member : (*part)->class_info().members)
      if (member.kind == Kind::component) height = std::max(height, height_of(member.get(**part, member), known));
    known[part->get()] = ++height;
  }
  return height;
}

}  // namespace

std::string Evaluator::prefix(const Space& space) { return space.prefix(); }

const bool* Evaluator::define_part(const Label& label, Value value, Space& space) {
  Entry*& known = space.names[label.text];
  if (known) {
    const Location& at = known->definition.name.at;
    diagnostics_.add(Error(fmt::format("'{}' is already defined at {}: include the file as a name of its own (… as name)",
                                       label.text, place(at, label.at)),
                           label.at));
    return nullptr;
  }
  Entry& entry = entries_.emplace_back();
  entry.definition.name = label;
  entry.home = entry.space = &space;
  entry.state = State::done;
  std::unordered_map<const Component*, int> heights;
  entry.height = height_of(value, heights);
  entry.value = std::move(value);
  known = &entry;
  return &entry.used;
}

void Evaluator::replace(Definition definition, Space& space, Space& written_in, const std::string& file) {
  const Label& label = definition.name;
  const auto found = space.names.find(label.text);
  Entry* entry = found == space.names.end() ? nullptr : found->second;
  if (!entry || !entry->definition.parameter) {
    std::vector<std::string> known;
    for (const auto& [name, other] : space.names)
      if (other->definition.parameter) known.push_back(name);
    std::sort(known.begin(), known.end());
    const std::string near = suggestion(label.text, known);
    const std::string wrong = entry ? fmt::format("'{}' of '{}' is not a param: only those can be replaced", label.text, file)
                                    : fmt::format("'{}' has no param '{}'", file, label.text);
    const std::string there = !near.empty() ? near : (known.empty() ? "" : fmt::format("; it has {}", fmt::join(known, ", ")));
    if (!incomplete_) diagnostics_.add(Error(wrong + there, label.at));
    return;
  }
  entry->given = label;
  entry->given_to = file;
  entry->definition.value = std::move(definition.value);
  entry->space = &written_in;
}

void Evaluator::redefine(const std::string& name, const std::string& text) {
  const Location at{intern("-D " + name), 0, 0};
  Entry* entry = find(name, *root_);
  if (!entry || !entry->definition.parameter) {
    std::vector<std::string> known;
    for (const Entry& e : entries_)
      if (e.definition.parameter) known.push_back(name_seen_from(e, *root_));
    const std::string wrong = entry ? "'{}' is not a param: only those can be replaced{}" : "there is no param '{}'{}";
    diagnostics_.add(Error(fmt::format(fmt::runtime(wrong), name, suggestion(name, known)), at));
    return;
  }
  entry->replaced = true;
  entry->space = entry->home;
  entry->given = {};  // warnings about unused params apply to this replacement only
  const Source& source = replacements_.emplace_back(Source{at.file, {}, text});
  remember_text(source.name, text);
  set_folder(source.name, {});
  Node& value = entry->definition.value;
  const size_t begin = text.find_first_not_of(" \t\r\n");
  // A JSON string is an expression; if that expression is a text, a text replaces it.
  if (value.type == NodeType::json_text && value.text.starts_with('"')) value.type = NodeType::string;
  if (value.type == NodeType::string && (begin == std::string::npos || text[begin] != '"')) {
    value.text = text;
    value.at = {source.name, 1, 1};
    return;
  }
  if (const auto wrong = invalid_utf8(text)) {
    diagnostics_.add(Error("is not valid UTF-8", at));
    value.type = NodeType::bad;
    return;
  }
  if (auto parsed = parse_expression(source, diagnostics_))
    value = std::move(*parsed);
  else
    value.type = NodeType::bad;
}

// Searches outwards from a namespace; a qualified name is searched only in the namespace before its point.
Evaluator::Entry* Evaluator::find(const std::string& text, Space& from) {
  const size_t point = text.find('.');
  if (point == std::string::npos) {
    for (Space* space = &from; space; space = space->outer)
      if (const auto found = space->names.find(text); found != space->names.end()) return found->second;
    return nullptr;
  }
  const std::string head = text.substr(0, point);
  for (Space* space = &from; space; space = space->outer) {
    const auto inner = space->inner.find(head);
    if (inner == space->inner.end()) continue;
    Space& within = *inner->second;
    within.used = true;
    std::string rest = text.substr(point + 1);
    if (rest.find('.') != std::string::npos)
      return within.inner.contains(rest.substr(0, rest.find('.'))) ? find(rest, within) : nullptr;
    const auto found = within.names.find(rest);
    return found == within.names.end() ? nullptr : found->second;
  }
  return nullptr;
}

std::string Evaluator::name_seen_from(const Entry& entry, const Space& space) const {
  for (const Space* outer = &space; outer; outer = outer->outer)
    if (entry.home == outer) return entry.definition.name.text;
  return entry.home->prefix() + entry.definition.name.text;
}

// The name of a component where all names share one namespace: small.trunk becomes small_trunk.
std::string Evaluator::given_name(const Entry& entry) {
  std::string name = entry.home->prefix() + entry.definition.name.text;
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

const Evaluator::Local* Evaluator::local(std::string_view name) const {
  for (const Local* one = locals_; one; one = one->outer)
    if (one->name == name) return one;
  return nullptr;
}

std::optional<Value> Evaluator::name(Node& node, const Context& context) {
  const std::string& text = node.text;
  const auto word = [&] {
    Value value(text, node.at);
    value.folder = folders_[node.at.file];
    return value;
  };
  const Member* member = context.member;
  const bool choice = member && member->kind == Kind::choice;
  if (choice && std::find(member->choices.begin(), member->choices.end(), text) != member->choices.end()) {
    // Warns if a definition with the name of the choice may have been meant instead: if its value might be a choice of the
    // member, or a number or truth value for someone who takes the member for a switch; not if it is a component, a list or a
    // colour. Decided by syntax, since nothing is evaluated for a warning.
    const auto may_be_meant = [&](const auto& again, const Entry& entry, int depth) -> bool {
      const auto fits = [&](const auto& self, const Node& value) -> bool {
        if (value.type == NodeType::number || value.type == NodeType::boolean) return true;
        if (value.type == NodeType::string) return std::ranges::count(member->choices, value.text) > 0;
        if (value.type == NodeType::conditional) return self(self, value.children[1]) || self(self, value.children[2]);
        constexpr int deepest = 8;  // limit for names that stand for names
        if (value.type != NodeType::name || depth == deepest) return false;
        const Entry* other = find(value.text);
        return other ? again(again, *other, depth + 1) : std::ranges::count(member->choices, value.text) > 0;
      };
      return !entry.definition.function && fits(fits, entry.definition.value);
    };
    if (const Entry* entry = find(text); entry && may_be_meant(may_be_meant, *entry, 0))
      warn(fmt::format("'{0}' is the choice here, not the '{0}' defined at {1}", text,
                       place(entry->definition.name.at, node.at)),
           node.at);
    return word();
  }
  if (const Local* found = local(text)) return bound(*found, node.at);
  if (text == "pi") return Value(Number{3.14159265358979323846}, node.at);
  if (Entry* entry = find(text)) return named(*entry, node.at);
  if (moment_ && (text == "frame" || text == "time")) {
    moment_used_ = true;
    return Value(text == "frame" ? Number{moment_->frame} : Number{moment_->seconds, Dimension::time}, node.at);
  }
  if (choice || context.words) return word();  // the member rejects unknown choices
  if (!context.lenient && !incomplete_) undefined(text, node.at);
  return std::nullopt;
}

std::optional<Value> Evaluator::bound(const Local& found, Location at) {
  if (depth_ + found.height >= height_limit) {
    diagnostics_.add(Error(fmt::format("'{}' is nested too deeply: its parts go {} levels down, and it stands at level {}; {} "
                                       "levels are the most in all",
                                       found.name, found.height, depth_, height_limit),
                           at));
    return std::nullopt;
  }
  reach_ = std::max(reach_, depth_ + found.height);
  charge(copied_size(found.value), at);
  Value value = found.value;
  value.location = at;
  return value;
}

// A named list is not copied to count it, to index it or to iterate over it.
const Value* Evaluator::stored(const Node& node) {
  if (node.type != NodeType::name) return nullptr;
  if (const Local* found = local(node.text)) return &found->value;
  Entry* entry = find(node.text);
  if (!entry || entry->definition.function || entry->state == State::active || entry->state == State::failed) return nullptr;
  entry->used = true;
  if (entry->state == State::waiting) settle_with_all_it_needs(*entry);
  if (entry->state != State::done) return nullptr;
  reach_ = std::max(reach_, depth_ + entry->height);
  return &entry->value;
}

namespace {

/// The constant true, false or none that is written differently in other languages; "" for other words.
std::string meant_constant(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (text == "null" || text == "none" || text == "nil" || text == "nullptr") return "none";
  return text == "true" || text == "false" ? text : std::string();
}

}  // namespace

void Evaluator::undefined(const std::string& text, Location at) {
  if (Registry::instance().find(text) && is_json(at.file)) {
    diagnostics_.add(Error(fmt::format("'{0}' is a class: write {{ \"class\": \"{0}\" }}", text), at));
  } else if (Registry::instance().find(text)) {
    diagnostics_.add(Error(fmt::format("'{0}' is a class: write {0} {{}}", text), at));
  } else if (is_function(text)) {
    diagnostics_.add(Error(fmt::format("'{0}' is a function: write {0}(…)", text), at));
  } else if (const std::string constant = meant_constant(text); !constant.empty()) {
    diagnostics_.add(Error(fmt::format("'{}' is not defined: here it is '{}'", text, constant), at));
  } else if (const size_t point = text.rfind('.'); point != std::string::npos && find(text.substr(0, point))) {
    diagnostics_.add(Error(fmt::format("'{}' is a value, and members of components cannot be read: give '{}' a name of its own",
                                       text.substr(0, point), text.substr(point + 1)),
                           at));
  } else {
    std::vector<std::string> known = {"true", "false", "none", "pi"};
    if (moment_) known.insert(known.end(), {"frame", "time"});
    for (const Local* one = locals_; one; one = one->outer) known.emplace_back(one->name);
    for (const Bound* one = bound_; one; one = one->outer) known.emplace_back(one->name);
    for (const Entry& e : entries_) known.push_back(name_seen_from(e, *space_));
    diagnostics_.add(Error(fmt::format("'{}' is not defined{}", text, suggestion(text, known)), at));
  }
}

// Reports an undefined name where a text in quotes is expected: illuminant(D65), rotate(30 deg, y).
bool Evaluator::lacks_quotes(const Node& call, const Node& argument, const Bound* bound) {
  if (argument.type != NodeType::name) return false;
  const std::string& text = argument.text;
  const bool first = &argument == &call.children.front();
  const bool known_by_name =
      first && (call.text == "illuminant" || call.text == "glass" || call.text == "metal" || call.text == "sensor");
  const bool axis = !first && call.text == "rotate" && (text == "x" || text == "y" || text == "z");
  if (!(known_by_name || axis) || find(call.text) || find(text) || local(text) || text == "pi") return false;
  if (moment_ && (text == "frame" || text == "time")) return false;
  for (const Bound* one = bound; one; one = one->outer)
    if (one->name == text) return false;
  if (!incomplete_)
    diagnostics_.add(Error(fmt::format("'{0}' is not defined: strings are written in quotes, \"{0}\"", text), argument.at));
  return true;
}

namespace {

/// Whether a value is a camera. An unused named camera is a saved view of the studio, and needs no warning.
bool is_saved_view(const Value& value) {
  const auto* part = value.as<Ref<Component>>();
  const ClassInfo* camera = Registry::instance().find("Camera");
  return part && *part && camera && (*part)->class_info().is_a(*camera);
}

}  // namespace

void Evaluator::check_unused(const char* source) {
  std::vector<Entry*> unused;
  for (Entry& entry : entries_)
    if (!entry.used) unused.push_back(&entry);
  for (Entry* entry : unused)
    if (entry->state == State::waiting) settle_with_all_it_needs(*entry);
  if (!diagnostics_.empty()) return;
  for (const Entry& entry : entries_)
    if (!entry.used && entry.given.at.known())
      diagnostics_.add(Error(
          fmt::format("has no effect: nothing in '{}' uses its param '{}'", entry.given_to, entry.given.text), entry.given.at));
  for (const Entry* entry : unused) {
    const Label& label = entry->definition.name;
    if (!entry->used && entry->replaced)
      warn(fmt::format("has no effect: nothing uses the param '{}'", entry->home->prefix() + label.text),
           {intern("-D " + entry->home->prefix() + label.text), 0, 0});
    else if (!entry->used && label.at.file == source && !is_saved_view(entry->value))
      warn(fmt::format("'{}' is defined but not used", label.text), label.at);
  }
  for (const Label& label : unused_parameters_)
    if (label.at.file == source) warn(fmt::format("the parameter '{}' is not used", label.text), label.at);
  for (const Space* space : spaces_)
    if (!space->used && space->label.at.file == source)
      warn(fmt::format("nothing uses what is included as '{}'", space->label.text), space->label.at);
}

}  // namespace etendue::language
