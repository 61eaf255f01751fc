#include "etendue/paths/path_expression.h"

#include <fmt/format.h>

#include <algorithm>

#include "etendue/core/error.h"

namespace etendue {
namespace {

constexpr PathEvents reflections =
    bit(PathEvent::diffuse_reflection) | bit(PathEvent::glossy_reflection) | bit(PathEvent::specular_reflection);
constexpr PathEvents transmissions =
    bit(PathEvent::diffuse_transmission) | bit(PathEvent::glossy_transmission) | bit(PathEvent::specular_transmission);
constexpr PathEvents diffuse = bit(PathEvent::diffuse_reflection) | bit(PathEvent::diffuse_transmission);
constexpr PathEvents glossy = bit(PathEvent::glossy_reflection) | bit(PathEvent::glossy_transmission);
constexpr PathEvents specular = bit(PathEvent::specular_reflection) | bit(PathEvent::specular_transmission);

/// The events that a letter for a type means; 0: it is none.
PathEvents type_of(char c) {
  switch (c) {
    case 'C': return bit(PathEvent::camera);
    case 'R': return reflections;
    case 'T': return transmissions;
    case 'V': return bit(PathEvent::volume);
    case 'L': return bit(PathEvent::light);
    case 'B': return bit(PathEvent::background);
    case 'O': return bit(PathEvent::emission);
    default: return 0;
  }
}

/// The same for a way of scattering. x: none.
PathEvents scattering_of(char c) {
  switch (c) {
    case 'D': return diffuse;
    case 'G': return glossy;
    case 'S': return specular;
    case 'x': return PathEvents(all_path_events & ~(diffuse | glossy | specular));
    default: return 0;
  }
}

}  // namespace

int PathLabelNames::index(const std::string& name) {
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    if (names.size() >= most_path_labels)
      throw Error(fmt::format("all expressions together may name {} objects, and '{}' is one more", most_path_labels, name));
    names.push_back(name);
    return int(names.size()) - 1;
  }
  return int(found - names.begin());
}

std::string PathExpression::place(std::string_view text, size_t at, const std::string& what) {
  constexpr size_t most = 200;
  const std::string shown = text.size() > most ? std::string(text.substr(0, most)) + "…" : std::string(text);
  return fmt::format("'{}', character {}: {}", shown, at + 1, what);
}

bool PathExpression::Test::matches(PathEvent event, PathLabels labels) const {
  const bool found = std::ranges::any_of(any, [&](const Alternative& a) {
    return (a.events & bit(event)) && std::ranges::all_of(a.labels, [&](const Alternative::Labels& wanted) {
             return ((labels & wanted.any) != 0) != wanted.negated;
           });
  });
  return found != negated;
}

/// Parses by recursive descent: each function reads one rule of the grammar, from `at_` on.
class PathExpressionParser {
 public:
  PathExpressionParser(PathExpression& made, PathLabelNames& names) : made_(made), text_(made.text_), names_(names) {}

  void parse() {
    made_.root_ = sequence(false);
    if (at_ < text_.size()) fail(at_, "')' closes nothing");
  }

 private:
  using Node = PathExpression::Node;
  using Test = PathExpression::Test;
  using Alternative = Test::Alternative;
  static constexpr int deepest = 64, most_times = 1000;
  static constexpr size_t most_nodes = 4096;

  [[noreturn]] void fail(size_t at, const std::string& what) const { throw Error(PathExpression::place(text_, at, what)); }

  bool more() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
    return at_ < text_.size();
  }
  bool ahead(char c) { return more() && text_[at_] == c; }
  int add(Node node) {
    if (made_.nodes_.size() >= most_nodes) fail(at_, fmt::format("an expression has at most {} parts", most_nodes));
    made_.nodes_.push_back(std::move(node));
    return int(made_.nodes_.size()) - 1;
  }
  int add(Test test) {
    made_.tests_.push_back(std::move(test));
    return add(Node{.kind = Node::Kind::event, .test = int(made_.tests_.size()) - 1});
  }

  /// x y z …, up to the end or to ')'.
  int sequence(bool in_parentheses) {
    const size_t begin = at_;
    if (++depth_ > deepest) fail(at_, fmt::format("parentheses may be {} deep", deepest));
    Node all{.kind = Node::Kind::sequence};
    while (more() && text_[at_] != ')') all.parts.push_back(choice());
    --depth_;
    if (in_parentheses) {
      if (!more()) fail(begin - 1, "this '(' is not closed");
      ++at_;
    }
    if (all.parts.empty()) fail(begin, in_parentheses ? "there is nothing between '(' and ')'" : "an expression is missing");
    return add(std::move(all));
  }

  /// x|y|z
  int choice() {
    const int first = repeated();
    if (!ahead('|')) return first;
    Node any{.kind = Node::Kind::choice, .parts = {first}};
    while (ahead('|')) {
      ++at_;
      if (!more() || text_[at_] == ')' || text_[at_] == '|') fail(at_, "after '|' an event is missing");
      any.parts.push_back(repeated());
    }
    return add(std::move(any));
  }

  /// x with any number of * + ? {n,m}
  int repeated() {
    int x = item();
    for (int times = 0; more(); ++times) {
      int least = 0, most = -1;
      const char c = text_[at_];
      if (c == '{') {
        range(least, most);
      } else if (c == '*' || c == '+' || c == '?') {
        ++at_;
        if (c == '+') least = 1;
        if (c == '?') most = 1;
      } else {
        break;
      }
      if (times >= deepest) fail(at_ - 1, fmt::format("one event is repeated in more than {} ways", deepest));
      x = add(Node{.kind = Node::Kind::repeated, .parts = {x}, .least = least, .most = most});
    }
    return x;
  }

  void range(int& least, int& most) {
    const size_t begin = at_++;
    least = number(begin);
    most = least;
    if (ahead(',')) {
      ++at_;
      most = ahead('}') ? -1 : number(begin);
    }
    if (!ahead('}')) fail(at_, "a '}' is missing, as in {2} or {1,3}");
    ++at_;
    if (most >= 0 && most < least) fail(begin, fmt::format("{{{},{}}}: the second number is less than the first", least, most));
  }
  int number(size_t begin) {
    if (!more() || text_[at_] < '0' || text_[at_] > '9') fail(at_, "a number is missing, as in {2} or {1,3}");
    int n = 0;
    for (; at_ < text_.size() && text_[at_] >= '0' && text_[at_] <= '9'; ++at_) {
      n = 10 * n + (text_[at_] - '0');
      if (n > most_times) fail(begin, fmt::format("nothing is repeated more than {} times", most_times));
    }
    return n;
  }

  /// ( ), [ ], < > or a symbol.
  int item() {
    const char c = text_[at_];
    if (c == '(') {
      ++at_;
      return sequence(true);
    }
    if (c == '[') return add(set());
    return add(Test{.any = {event()}});
  }

  /// A symbol alone or < >: one alternative.
  Alternative event() {
    more();
    const char c = text_[at_];
    if (c == '<') return group();
    if (c == '\'') return {.labels = {{label()}}};
    const PathEvents events = c == '.' ? all_path_events : type_of(c) | scattering_of(c);
    if (!events) refuse(c);
    ++at_;
    return {.events = events};
  }

  /// [x y] and [^x y]
  Test set() {
    const size_t begin = at_++;
    Test test;
    if (ahead('^')) {
      test.negated = true;
      ++at_;
    }
    while (more() && text_[at_] != ']') test.any.push_back(event());
    if (!more()) fail(begin, "this '[' is not closed");
    ++at_;
    if (test.any.empty()) fail(begin, "an empty set matches no event");
    return test;
  }

  /// <type scattering labels>
  Alternative group() {
    const size_t begin = at_++;
    Alternative event;
    int part = 0;
    while (more() && text_[at_] != '>') {
      const size_t at = at_;
      const char c = text_[at_];
      if (c == '\'') {
        event.labels.push_back({label()});
        part = std::max(part, 2);
      } else if (c == '[' && (part >= 2 || set_of_labels())) {
        event.labels.push_back(label_set());
        part = std::max(part, 2);
      } else if (part < 2) {
        event.events &= c == '[' ? letters(part) : letter(part, true);
        ++part;
      } else if (c == '.') {
        ++at_;
      } else {
        fail(at, "after type and scattering there may be names, as in <RD'wall'>");
      }
      if (part >= 1 && !event.events) fail(at, "no event of this type scatters this way");
    }
    if (!more()) fail(begin, "this '<' is not closed");
    if (at_ == begin + 1) fail(begin, "there is nothing between '<' and '>'");
    ++at_;
    return event;
  }

  /// Part 0 of an event is its type, part 1 its scattering.
  PathEvents letter(int part, bool any) {
    const char c = text_[at_];
    if (any && c == '.') {
      ++at_;
      return all_path_events;
    }
    const PathEvents events = part == 0 ? type_of(c) : scattering_of(c);
    if (!events) {
      if (part == 0 && scattering_of(c))
        fail(at_, fmt::format("the type comes before the scattering, as in <R{}> or <.{}>", c, c));
      if (part == 1 && type_of(c)) fail(at_, "an event has one type; several are a set, as in <[RT]D>");
      refuse(c);
    }
    ++at_;
    return events;
  }
  PathEvents letters(int part) {
    const size_t begin = at_++;
    bool negated = false;
    PathEvents events = 0;
    if (ahead('^')) {
      negated = true;
      ++at_;
    }
    while (more() && text_[at_] != ']') events |= letter(part, false);
    if (!more()) fail(begin, "this '[' is not closed");
    ++at_;
    if (!events) fail(begin, "an empty set matches no event");
    return negated ? PathEvents(all_path_events & ~events) : events;
  }

  /// Whether the '[' here begins a set of names.
  bool set_of_labels() const {
    size_t i = at_ + 1;
    while (i < text_.size() && (text_[i] == ' ' || text_[i] == '^')) ++i;
    return i < text_.size() && text_[i] == '\'';
  }
  Alternative::Labels label_set() {
    const size_t begin = at_++;
    Alternative::Labels labels;
    if (ahead('^')) {
      labels.negated = true;
      ++at_;
    }
    while (more() && text_[at_] != ']') {
      if (text_[at_] != '\'') fail(at_, "in a set of names there are names alone, as in ['key''fill']");
      labels.any |= label();
    }
    if (!more()) fail(begin, "this '[' is not closed");
    ++at_;
    if (!labels.any) fail(begin, "an empty set matches no event");
    return labels;
  }
  PathLabels label() {
    const size_t begin = at_++;
    const size_t end = text_.find('\'', at_);
    if (end == text_.npos) fail(begin, "this name has no closing '");
    const std::string name = text_.substr(at_, end - at_);
    if (name.empty()) fail(begin, "a name is missing between the quotes");
    at_ = end + 1;
    made_.mentions_.push_back({name, begin});
    return PathLabels(1) << names_.index(name);
  }

  [[noreturn]] void refuse(char c) const {
    if (c == 's') fail(at_, "'s' (straight) never occurs: light that passes straight on is no event here, so leave it out");
    if (c == '*' || c == '+' || c == '?' || c == '{')
      fail(at_, fmt::format("'{}' repeats nothing: it follows an event, and stands outside of < > and [ ]", c));
    if (c == '|') fail(at_, "before '|' an event is missing");
    if (c == '>' || c == ']' || c == '}') fail(at_, fmt::format("'{}' closes nothing", c));
    fail(at_, "no event begins like this; there are C R T V L B O, D G S, '.', 'name', < >, [ ] and ( )");
  }

  PathExpression& made_;
  const std::string& text_;
  PathLabelNames& names_;
  size_t at_ = 0;
  int depth_ = 0;
};

PathExpression::PathExpression(std::string text, PathLabelNames& names) : text_(std::move(text)) {
  constexpr size_t longest = 10000;
  if (text_.size() > longest)
    throw Error(place(text_, longest, fmt::format("an expression has at most {} characters", longest)));
  PathExpressionParser(*this, names).parse();
}

}  // namespace etendue
