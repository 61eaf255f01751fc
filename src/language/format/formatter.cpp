// Formatter: the layout of a description.

#include "formatter.h"

#include <algorithm>
#include <array>

#include "language/lexer.h"
#include "same_syntax.h"

namespace etendue::language {

namespace {

constexpr int step = 4;
constexpr size_t comment_gap = 2;
constexpr size_t widest_aligned = 100;  // comments after longer lines are not aligned

struct Line {
  int indent = 0;
  std::string code, comment;
  size_t width() const { return size_t(indent) + characters(code); }

  /// The number of characters of a UTF-8 text: continuation bytes do not count.
  static size_t characters(const std::string& text) {
    return size_t(
        std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
  }
};

class Formatter {
 public:
  explicit Formatter(const Source& source) : source_(source), lexer_(source, diagnostics_) {}

  std::string text() {
    size_t end = 0;
    for (;;) {
      const Token token = lexer_.next();
      between(end, token);
      if (token.type == TokenType::end) break;
      put(token);
      end = lexer_.position();
    }
    return joined();
  }

  const std::vector<std::string>& comments() const { return comments_; }

 private:
  struct Bracket {
    char symbol;
    int indent;  // indentation of the line where it was opened
  };

  static bool is_word(const Token& token) {
    static constexpr std::array words = {"and", "or", "not", "if", "then", "else", "in", "for"};
    return std::any_of(words.begin(), words.end(), [&](const char* word) { return token.is_word(word); });
  }
  static bool opens(const Token& token) { return token.is('{') || token.is('[') || token.is('('); }
  static bool closes(const Token& token) { return token.is('}') || token.is(']') || token.is(')'); }

  /// Adds the comments and line ends before a token.
  void between(size_t begin, const Token& token) {
    int ends = 0;
    const std::string& text = source_.text;
    for (size_t at = begin; at < token.begin; ++at) {
      if (text[at] == '\n') {
        ++ends;
      } else if (text[at] == '#') {
        const size_t end = std::min(text.find('\n', at), text.size());
        std::string comment = text.substr(at, end - at);
        while (comment.back() == ' ' || comment.back() == '\t' || comment.back() == '\r') comment.pop_back();
        comments_.push_back(comment);
        if (ends == 0 && !lines_.empty()) {
          lines_.back().comment = std::move(comment);
        } else {
          leave_blank(ends);
          lines_.push_back({indent(nullptr), {}, std::move(comment)});
        }
        at = end - 1;
        ends = 0;
      }
    }
    if (token.type == TokenType::end) return;
    if (!lines_.empty() && ends == 0 && lines_.back().comment.empty()) return;
    if (!closes(token)) leave_blank(ends);
    lines_.push_back({indent(&token), {}, {}});
  }

  /// Keeps one of several empty lines, but none at the beginning or after an opening bracket.
  void leave_blank(int ends) {
    const bool first = lines_.empty() || (!brackets_.empty() && lines_.back().comment.empty() && opens(previous_));
    if (ends > 1 && !first) lines_.emplace_back();
  }

  /// The indentation of a line that begins with this token; null: with a comment.
  int indent(const Token* token) const {
    if (token && closes(*token) && !brackets_.empty()) return brackets_.back().indent;
    const int base = brackets_.empty() ? 0 : brackets_.back().indent + step;
    if (!token || previous_.type == TokenType::end) return base;
    const bool unfinished = previous_.type == TokenType::symbol && !opens(previous_) && !closes(previous_) &&
                            !previous_.is(',') && !previous_.is(';');
    return base + (unfinished || token->is_word("then") || token->is_word("else") ? step : 0);
  }

  void put(const Token& token) {
    Line& line = lines_.back();
    const bool first = line.code.empty();
    const bool sign = token.is('-') && is_sign(first);
    if (!first && blank_before(token)) line.code += ' ';
    line.code.append(source_.text, token.begin, lexer_.position() - token.begin);
    if (opens(token)) brackets_.push_back({token.symbol, line.indent});
    if (closes(token) && !brackets_.empty()) brackets_.pop_back();
    previous_ = token;
    behind_sign_ = sign;
  }

  bool is_sign(bool first_in_line) const {
    const bool list_or_block = brackets_.empty() || brackets_.back().symbol != '(';
    if (first_in_line && list_or_block) return true;
    if (previous_.type == TokenType::end || is_word(previous_)) return true;
    return previous_.type == TokenType::symbol && !closes(previous_);
  }

  bool blank_before(const Token& token) const {
    if (behind_sign_ || token.is(',') || token.is(';') || token.is(':')) return false;
    if (token.is('}')) return !previous_.is('{');
    if (previous_.is('{')) return true;
    if (token.is(']') || token.is(')') || previous_.is('[') || previous_.is('(')) return false;
    if (token.is('[')) return !place(token);
    if (token.is('(')) return previous_.type != TokenType::name || is_word(previous_);
    if (token.is('^') || previous_.is('^')) return false;
    if (token.is(symbols::range)) return previous_.type == TokenType::number && previous_.text.ends_with('.');
    if (previous_.is(symbols::range)) return token.type == TokenType::number && token.text.starts_with('.');
    return true;
  }

  /// Whether a '[' begins an index: it directly follows the list.
  bool place(const Token& token) const {
    return token.joined && !is_word(previous_) && (previous_.type == TokenType::name || closes(previous_));
  }

  /// Joins the lines; comments after consecutive lines are aligned.
  std::string joined() const {
    std::string text;
    for (size_t i = 0; i < lines_.size();) {
      size_t end = i, width = 0;
      for (; end < lines_.size() && !lines_[end].code.empty() && !lines_[end].comment.empty(); ++end)
        if (lines_[end].width() <= widest_aligned) width = std::max(width, lines_[end].width());
      for (; i < end; ++i) write(lines_[i], width, text);
      if (i < lines_.size()) write(lines_[i++], 0, text);
    }
    return text;
  }

  static void write(const Line& line, size_t width, std::string& text) {
    if (!line.code.empty() || !line.comment.empty()) text.append(size_t(line.indent), ' ');
    text += line.code;
    if (!line.comment.empty() && !line.code.empty()) {
      const size_t own = line.width();
      text.append((own < width ? width - own : 0) + comment_gap, ' ');
    }
    text += line.comment + "\n";
  }

  const Source& source_;
  Diagnostics diagnostics_;
  Lexer lexer_;
  std::vector<Line> lines_;
  std::vector<Bracket> brackets_;
  std::vector<std::string> comments_;
  Token previous_;
  bool behind_sign_ = false;
};

}  // namespace

std::string formatted(const Source& source) {
  if (const auto wrong = invalid_utf8(source.text)) throw Error("the text is not valid UTF-8", {source.name, 0, 0});
  Diagnostics diagnostics;
  const Document before = parse_document(source, diagnostics);
  diagnostics.raise();
  Formatter formatter(source);
  Source after = source;
  after.text = formatter.text();
  const Document again = parse_document(after, diagnostics);
  Formatter once_more(after);
  if (!diagnostics.empty() || !same_syntax(before, again) || once_more.text() != after.text ||
      once_more.comments() != formatter.comments())
    throw Error(
        "its layout cannot be changed without changing what it means: this is a mistake of the program, and the file stays "
        "as it is",
        {source.name, 0, 0});
  return after.text;
}

}  // namespace etendue::language
