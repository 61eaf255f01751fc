#include "text_edits.h"

#include <algorithm>

#include "etendue/core/error.h"
#include "language/syntax.h"

namespace etendue::studio {

using language::Node;

namespace {

constexpr const char* indentation = "    ";

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }
bool blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

size_t line_begin(const std::string& text, size_t at) { return at == 0 ? 0 : text.rfind('\n', at - 1) + 1; }

/// The indentation of the line that contains a byte.
std::string indent_of(const std::string& text, size_t at) {
  const size_t begin = line_begin(text, at);
  size_t end = begin;
  while (end < text.size() && (text[end] == ' ' || text[end] == '\t')) ++end;
  return text.substr(begin, end - begin);
}

bool first_in_line(const std::string& text, size_t at) {
  size_t i = line_begin(text, at);
  while (i < at && blank(text[i])) ++i;
  return i == at;
}

/// The line ending used near a position.
std::string line_end(const std::string& text, size_t at) {
  const size_t next = std::min(text.find('\n', at), text.rfind('\n', at));
  return next != std::string::npos && next > 0 && text[next - 1] == '\r' ? "\r\n" : "\n";
}

/// What follows a position in its line: blanks, possibly a comma and a comment, the end of the line.
struct Rest {
  size_t comma = std::string::npos;
  bool comment = false;
  size_t end_of_line = std::string::npos;  ///< npos: something else follows in the line
  size_t behind = 0;                       ///< first byte after the blanks and the comma
};

Rest rest_of_line(const std::string& text, size_t at) {
  Rest rest;
  while (at < text.size() && blank(text[at])) ++at;
  if (at < text.size() && text[at] == ',') {
    rest.comma = at++;
    while (at < text.size() && blank(text[at])) ++at;
  }
  rest.behind = at;
  if (at < text.size() && text[at] == '#') {
    rest.comment = true;
    at = std::min(text.find('\n', at), text.size());
  }
  if (at < text.size() && text[at] != '\n') return rest;
  while (at > 0 && text[at - 1] == '\r') --at;
  rest.end_of_line = at;
  return rest;
}

std::string replaced(const std::string& text, size_t begin, size_t end, const std::string& insert) {
  return text.substr(0, begin) + insert + text.substr(end);
}

std::string with_first_item(const std::string& text, const Sequence& all, const std::string& item) {
  const std::string inside = text.substr(all.inside.begin, all.inside.size());
  const bool list = all.inside.begin > 0 && text[all.inside.begin - 1] == '[';
  if (std::all_of(inside.begin(), inside.end(), [](char c) { return c == ' ' || c == '\t'; }))
    return replaced(text, all.inside.begin, all.inside.end, list ? item : " " + item + " ");
  const std::string end = line_end(text, all.inside.begin), margin = indent_of(text, all.inside.begin);
  // There may be a comment inside, which must end before the closing bracket: the new item comes after it.
  const size_t last = text.find_last_not_of(" \t\r\n", all.inside.end - 1) + 1;
  if (last <= all.inside.begin) return replaced(text, all.inside.begin, all.inside.begin, end + margin + indentation + item);
  const bool closes_alone = first_in_line(text, all.inside.end);
  return replaced(text, last, last, end + margin + indentation + item + (closes_alone ? "" : end + margin));
}

}  // namespace

TextChange difference(const std::string& before, const std::string& after) {
  const size_t most = std::min(before.size(), after.size());
  size_t head = 0, tail = 0;
  while (head < most && before[head] == after[head]) ++head;
  while (head > 0 && ((head < before.size() && continues_character(before[head])) ||
                      (head < after.size() && continues_character(after[head]))))
    --head;
  while (tail < most - head && before[before.size() - 1 - tail] == after[after.size() - 1 - tail]) ++tail;
  while (tail > 0 && continues_character(before[before.size() - tail])) --tail;
  return {head, before.size() - tail, after.substr(head, after.size() - tail - head)};
}

std::string applied_to(const std::string& text, const TextChange& change) {
  return replaced(text, change.begin, change.end, change.insert);
}

std::string lone_expression(const std::string& text) {
  const language::Source source{intern("value"), {}, text};
  language::remember_text(source.name, text);
  if (language::invalid_utf8(text)) throw Error("the text is not valid UTF-8");
  language::Diagnostics diagnostics;
  std::unique_ptr<Node> node;
  try {
    node = language::parse_expression(source, diagnostics);
  } catch (const language::TooManyErrors&) {
  }
  diagnostics.raise();
  if (!node) throw Error("there is no value");
  return text.substr(node->begin, node->end - node->begin);
}

std::string with_member(const Outline& outline, const Node& component, const std::string& member, const std::string& value) {
  if (const Node* written = Outline::member(component, member))
    return with_span(outline, {written->begin, written->end}, value);
  const Sequence all = outline.members(component);
  return with_item(outline, all, all.items.size(), member + ": " + value);
}

std::string without_member(const Outline& outline, const Node& component, const std::string& member) {
  for (size_t i = 0; i < component.labels.size(); ++i)
    if (component.labels[i].text == member) return without_item(outline, outline.members(component), i);
  return outline.text();
}

std::string with_item(const Outline& outline, const Sequence& all, size_t index, const std::string& item) {
  const std::string& text = outline.text();
  if (all.items.empty()) return with_first_item(text, all, item);
  if (index < all.items.size()) {
    const size_t at = all.items[index].begin;
    if (!first_in_line(text, at)) return replaced(text, at, at, item + ", ");
    return replaced(text, at, at, item + "," + line_end(text, at) + indent_of(text, at));
  }
  const Span last = all.items.back();
  const Rest rest = rest_of_line(text, last.end);
  const bool lines = rest.end_of_line < all.inside.end && first_in_line(text, last.begin);
  if (!lines) return replaced(text, last.end, last.end, ", " + item);
  const std::string line = line_end(text, last.begin) + indent_of(text, last.begin) + item;
  return replaced(text, rest.end_of_line, rest.end_of_line, line + (rest.comma != std::string::npos ? "," : ""));
}

std::string without_item(const Outline& outline, const Sequence& all, size_t index) {
  const std::string& text = outline.text();
  Span gone = all.items[index];
  const Rest rest = rest_of_line(text, gone.end);
  const bool comma = rest.comma < all.inside.end;
  if (first_in_line(text, gone.begin) && rest.end_of_line < all.inside.end) {
    // The item is alone in its lines: they are removed completely, except for a comment.
    if (rest.comment) return replaced(text, gone.begin, rest.behind, "");
    const size_t next = text.find('\n', rest.end_of_line);
    return replaced(text, line_begin(text, gone.begin), next == std::string::npos ? text.size() : next + 1, "");
  }
  if (comma) {
    gone.end = rest.behind;
    if (rest.end_of_line != std::string::npos && !rest.comment) gone.end = rest.comma + 1;
  } else if (index > 0 && text.find('\n', all.items[index - 1].end) >= gone.begin) {
    gone.begin = all.items[index - 1].end;  // includes the preceding comma; within one line there is no comment between
  }
  return replaced(text, gone.begin, gone.end, "");
}

std::string with_span(const Outline& outline, Span span, const std::string& insert) {
  return replaced(outline.text(), span.begin, span.end, insert);
}

std::string with_definition(const Outline& outline, const std::string& name, const std::string& value, size_t before) {
  const std::string& text = outline.text();
  size_t at = 0;
  for (const language::Definition& d : outline.syntax().definitions)
    if (d.name.begin <= before && before <= d.value.end) at = d.name.begin;
  for (const Node& c : outline.syntax().components)
    if (c.begin <= before && before < c.end) at = c.begin;
  at = line_begin(text, at);  // `param x = …` begins before its name
  return replaced(text, at, at, name + " = " + value + line_end(text, at));
}

}  // namespace etendue::studio
