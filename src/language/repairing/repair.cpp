// Parser: guesses of the meaning where a bracket is missing, so that one mistake gives one error.

#include <fmt/format.h>

#include "describe/words.h"
#include "etendue/describe/registry.h"
#include "language/parser.h"

namespace etendue::language {

namespace {

const ClassInfo* class_of(const std::string& name) { return name.empty() ? nullptr : Registry::instance().find(name); }

}  // namespace

// Whether a '{' is missing after the name of a class: one of its members follows. In a new line this could also be a member of
// the enclosing block, so it must be a member of the class only.
bool Parser::misses_brace(const std::string& class_name) {
  if (token_.is('}') && open_.empty()) return misses_both_braces_but_one(class_name);
  if (token_.type != TokenType::name || !lexer_.followed_by(":")) return false;
  const ClassInfo* info = class_of(class_name);
  if (!info) return false;
  if (!token_.first_in_line) return true;
  if (!info->find(token_.text)) return false;
  const ClassInfo* outside = blocks_.empty() || !open_.empty() ? nullptr : class_of(blocks_.back().class_name);
  return !outside || !outside->find(token_.text);
}

// Before a '}' that may close either the class without a '{', as in "Sphere }", or the enclosing block. The member that
// follows, after further '}', shows how many blocks were closed.
bool Parser::misses_both_braces_but_one(const std::string& class_name) {
  if (blocks_.empty() || !class_of(class_name)) return false;
  int more = 0;
  const std::string next = lexer_.following_member(more);
  if (next.empty() || size_t(more) >= blocks_.size()) return false;
  const size_t level = blocks_.size() - size_t(more);  // open blocks if the first '}' closes the class
  const ClassInfo* inside = class_of(blocks_[level - 1].class_name);
  const ClassInfo* outside = level < 2 ? nullptr : class_of(blocks_[level - 2].class_name);
  return inside && inside->find(next) && (!outside || !outside->find(next));
}

// Some programs have two-word class names, such as "Principled BSDF".
bool Parser::two_words(const Token& class_name) {
  if (token_.type != TokenType::name || token_.first_in_line || !lexer_.followed_by("{")) return false;
  const std::string both = class_name.text + " " + token_.text;
  const std::string meant = translation(both, foreign_classes());
  if (meant.empty()) return false;
  report(fmt::format("there is no class '{}'{}", both, meant), class_name.at);
  take();
  return true;
}

Node Parser::component_without_brace(const Token& class_name) {
  report(fmt::format("expected '{{' after '{}', not {}", class_name.text, token_.words()), token_.at);
  return component(class_name, false);
}

// Where a member name is expected, but the current token continues the previous value, as for a list without its '['.
bool Parser::misses_bracket(Node& component) {
  if (component.children.empty() || token_.is('}') || token_.is(';') || token_.type == TokenType::bad) return false;
  if (!meant().empty()) return false;
  const bool name = token_.type == TokenType::name;
  if (name && !lexer_.followed_by("{,]") && !lexer_.ends_line()) return false;
  const std::string& member = component.labels.back().text;
  report(
      fmt::format("expected a member name or '}}', not {}: is a '[' missing before the value of '{}'?", token_.words(), member),
      token_.at);
  Node& value = component.children.back();
  value = {};
  value.type = NodeType::bad;
  take();
  // Skips to the ']' that closes the list, or the end of the line or of the block.
  skip({}, true, [&] { return token_.first_in_line || token_.is('}') || token_.is(']') || token_.is(')'); });
  if (token_.is(']') || token_.is(')')) skip_stray_bracket();
  return true;
}

// Skips a superfluous closing bracket, the unit after it, and the separator before the next member.
void Parser::skip_stray_bracket() {
  take();
  if (token_.type == TokenType::name && !token_.first_in_line && !lexer_.followed_by(":")) take();
  if (token_.is(',')) take();
}

void Parser::note_stranger(const Token& member) {
  if (stranger_ || blocks_.size() < 2) return;
  const Block& inner = blocks_.back();
  const ClassInfo* info = class_of(inner.class_name);
  if (!info || info->find(member.text)) return;
  for (size_t i = blocks_.size() - 1; i-- > 0;) {
    const ClassInfo* outer = class_of(blocks_[i].class_name);
    if (!outer || !outer->find(member.text)) continue;
    stranger_ = std::make_unique<Stranger>(Stranger{member.text, inner.class_name, outer->name, member.at, inner.opened});
    return;
  }
}

}  // namespace etendue::language
