#include "assistance.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "describe/reflection_values.h"
#include "etendue/describe/color.h"
#include "language/calls.h"
#include "language/lexer.h"

namespace etendue::studio {

using language::Token;
using language::TokenType;

namespace {

bool word_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// The open brackets at a position, and the last tokens before it.
struct Context {
  struct Block {
    char bracket = 0;
    std::string name;    ///< the class before a '{', the function before a '('
    std::string member;  ///< the member whose value is being written; "" if a member name is expected
    std::set<std::string> written;
  };
  std::vector<Block> open;
  Token last, before_last;
  bool line_begins = true;  ///< only blanks precede the position in its line
  std::vector<std::string> names;
};

/// Analyses the tokens before a position, whether the text is valid or not.
Context context_at(const std::string& text, size_t at) {
  Context context;
  const language::Source source{intern("typed text"), {}, text.substr(0, at)};
  language::Diagnostics unheard;
  bool quiet = true;
  language::Lexer lexer(source, unheard);
  lexer.set_quiet(&quiet);
  for (Token token = lexer.next(); token.type != TokenType::end; token = lexer.next()) {
    Context::Block* block = context.open.empty() ? nullptr : &context.open.back();
    if (token.is('{') || token.is('(') || token.is('[')) {
      context.open.push_back({token.symbol, context.last.type == TokenType::name ? context.last.text : "", "", {}});
    } else if (token.is('}') || token.is(')') || token.is(']')) {
      if (block) context.open.pop_back();
    } else if (block && block->bracket == '{' && token.is(':')) {
      block->member = context.last.text;
      block->written.insert(context.last.text);
    } else if (block && block->bracket == '{' && (token.is(',') || (token.first_in_line && !context.last.is(':')))) {
      block->member.clear();
    }
    context.before_last = std::exchange(context.last, token);
  }
  const size_t line = text.rfind('\n', at == 0 ? 0 : at - 1);
  const size_t first = text.find_first_not_of(" \t\r", line == std::string::npos ? 0 : line + 1);
  context.line_begins = first == std::string::npos || first >= at;
  return context;
}

std::string member_detail(const Member& m) {
  std::string text = type_text(m);
  if (const std::string unit = unit_text(m); !unit.empty()) text += " [" + unit + "]";
  return text + ": " + m.text;
}

const language::Function* find_function(const std::string& name) {
  for (const auto list : {language::color_functions(), language::transform_functions(), language::math_functions()})
    for (const language::Function& f : list)
      if (f.name == name) return &f;
  return nullptr;
}

/// The member of the innermost component block whose value is being written; null: none.
const Member* member_at(const Context& context) {
  for (auto block = context.open.rbegin(); block != context.open.rend(); ++block) {
    if (block->bracket == '(') return nullptr;
    if (block->bracket != '{') continue;
    const ClassInfo* info = Registry::instance().find(block->name);
    return info && !block->member.empty() ? info->find(block->member) : nullptr;
  }
  return nullptr;
}

class Collector {
 public:
  Collector(std::string prefix, size_t begin) : prefix_(std::move(prefix)), begin_(begin) {}
  void add(const std::string& label, const char* kind, const std::string& detail, const std::string& insert) {
    if (label.starts_with(prefix_) && seen_.insert(label).second) list.push_back({label, kind, detail, insert, begin_});
  }
  void classes(const ClassInfo* wanted) {
    for (const ClassInfo* info : wanted ? Registry::instance().subclasses(*wanted) : Registry::instance().all())
      if (!info->abstract()) add(info->name, "class", info->summary, info->name + " {}");
  }
  void names(const std::string& text) {
    const Outline outline(text, intern("typed text"));
    for (const language::Definition& d : outline.syntax().definitions)
      add(d.name.text, "name", outline.text({d.value.begin, std::min(d.value.end, d.value.begin + 60)}), d.name.text);
  }
  void functions() {
    for (const auto functions : {language::color_functions(), language::transform_functions(), language::math_functions()})
      for (const language::Function& f : functions) add(f.name, "function", f.usage, std::string(f.name) + "(");
  }
  std::vector<Completion> list;

 private:
  std::string prefix_;
  size_t begin_;
  std::set<std::string> seen_;
};

}  // namespace

Span word_at(const std::string& text, size_t at) {
  Span word{std::min(at, text.size()), std::min(at, text.size())};
  while (word.begin > 0 && word_character(text[word.begin - 1])) --word.begin;
  while (word.end < text.size() && word_character(text[word.end])) ++word.end;
  return word;
}

std::vector<Completion> completions(const std::string& text, size_t at) {
  size_t begin = at;
  while (begin > 0 && word_character(text[begin - 1])) --begin;
  const Context context = context_at(text, begin);
  Collector found(text.substr(begin, at - begin), begin);
  if (context.open.empty()) {
    if (context.last.is('=')) {
      found.names(text);
      found.classes(nullptr);
      found.functions();
    } else {
      for (const char* word : {"include", "plugin", "class", "param"}) found.add(word, "keyword", "", std::string(word) + " ");
      found.add("Job", "class", Registry::instance().find("Job")->summary, "Job {");
    }
    return found.list;
  }
  const Context::Block& block = context.open.back();
  const bool fresh_member = block.member.empty() || (context.line_begins && !context.last.is(':') && block.bracket == '{');
  if (block.bracket == '{' && fresh_member) {
    if (const ClassInfo* info = Registry::instance().find(block.name))
      for (const Member& m : info->members)
        if (!block.written.contains(m.name)) found.add(m.name, "member", member_detail(m), m.name + ": ");
    return found.list;
  }
  const Member* member = member_at(context);
  if (context.last.type == TokenType::number || context.last.is(']')) {
    const Unit* own = member ? find_unit(member->unit) : nullptr;
    for (const Unit& unit : units())
      if (!own || own->dimension == unit.dimension)
        found.add(std::string(unit.name), "unit", std::string(name(unit.dimension)), std::string(unit.name));
    return found.list;
  }
  if (member)
    for (const std::string& choice : member->choices) found.add(choice, "choice", "", choice);
  found.names(text);
  if (member && member->kind == Kind::component) found.classes(Registry::instance().find(member->component_class));
  if (!member || member->kind == Kind::boolean)
    for (const char* word : {"true", "false"}) found.add(word, "keyword", "", word);
  if (!member || member->kind == Kind::component) found.add("none", "keyword", "", "none");
  found.functions();
  return found.list;
}

std::optional<Explanation> explanation(const std::string& text, size_t at) {
  const Span word = word_at(text, at);
  const std::string name = text.substr(word.begin, word.size());
  if (name.empty()) return {};
  const Context context = context_at(text, word.begin);
  const size_t behind = text.find_first_not_of(" \t", word.end);
  const bool is_member = behind != std::string::npos && text[behind] == ':';
  if (is_member && !context.open.empty() && context.open.back().bracket == '{') {
    const ClassInfo* info = Registry::instance().find(context.open.back().name);
    const Member* m = info ? info->find(name) : nullptr;
    if (!m) return {};
    std::string told = fmt::format("**{}.{}**: {}", info->name, name, member_detail(*m));
    if (m->range) told += "; " + m->range->text();
    if (!m->choices.empty()) told += fmt::format("; one of {}", fmt::join(m->choices, ", "));
    told += m->required ? "; must be given" : "; default `" + value_text(m->default_value, *m) + "`";
    return Explanation{told, word};
  }
  if (const ClassInfo* info = Registry::instance().find(name))
    return Explanation{fmt::format("**{}**: {}{}", name, info->summary, info->source.empty() ? "" : "\n\n" + info->source),
                       word};
  if (const language::Function* f = find_function(name)) return Explanation{fmt::format("`{}`", f->usage), word};
  const Outline outline(text, intern("typed text"));
  if (const language::Definition* d = outline.definition(name)) {
    std::string value = outline.text({d->value.begin, d->value.end});
    if (value.size() > 400) value = value.substr(0, 400) + "…";
    return Explanation{fmt::format("```\n{} = {}\n```", name, value), word};
  }
  if (const Unit* unit = find_unit(name))
    return Explanation{fmt::format("`{}`: {}", name, etendue::name(unit->dimension)), word};
  return {};
}

}  // namespace etendue::studio
