// Rows of the table: strings, and messages of shaders.

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "choose.h"
#include "formatting.h"
#include "parts.h"
#include "regular_expressions.h"
#include "services.h"

namespace etendue::osl {

namespace {

void print(const Call& c) { c.services.print(formatted(c, 0)); }
void print_to(const Call& c) { c.services.print_to(c.string(0), formatted(c, 1)); }
void warn(const Call& c) { c.services.warn(formatted(c, 0), c.types.place); }
void report_error(const Call& c) { c.services.error(formatted(c, 0), c.types.place); }

/// Interns a text that a shader made, unless it is too long or the process has too many.
const String* made(const Call& c, std::string_view text) {
  if (text.size() >= string_limit || interned_bytes() > interned_limit) {
    c.services.error(text.size() >= string_limit
                         ? fmt::format("The text is longer than {} bytes", string_limit)
                         : fmt::format("Shaders have made more than {} bytes of different texts", interned_limit),
                     c.types.place);
    return empty_string();
  }
  return intern_string(text);
}

void format_text(const Call& c) { c.give(made(c, formatted(c, 0))); }

void concatenate(const Call& c) {
  std::string text;
  for (int i = 0; i < c.count() && text.size() <= string_limit; ++i) {
    if (!c.type(i).is_string()) continue;  // the compiler lets only strings through
    text += c.string(i)->view();
  }
  c.give(made(c, text));
}

void length(const Call& c) { c.give(int(c.string(0)->view().size())); }
void starts_with(const Call& c) { c.give(int(c.string(0)->view().starts_with(c.string(1)->view()))); }
void ends_with(const Call& c) { c.give(int(c.string(0)->view().ends_with(c.string(1)->view()))); }

/// The text from the first character that may begin a number: blanks and a plus sign are skipped.
std::string_view number_part(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\n\v\f\r");
  if (begin == std::string_view::npos) return {};
  text.remove_prefix(begin);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

/// Clamped to the ints, as by C's strtol of 32 bits.
void to_int(const Call& c) {
  const std::string_view text = number_part(c.string(0)->view());
  int value = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (fault == std::errc::result_out_of_range) value = text[0] == '-' ? -2147483647 - 1 : 2147483647;
  c.give(value);
}

void to_float(const Call& c) {
  const std::string_view text = number_part(c.string(0)->view());
  float value = 0;
  double exact = 0;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), exact);
  if (fault == std::errc()) value = float(exact);
  c.give(value);
}

/// Fragments of a text, at most `most`, of which the last is all that is left. An empty separator means any blanks, which then
/// are no part of the fragments either.
std::vector<std::string_view> fragments(std::string_view text, std::string_view separator, std::size_t most) {
  constexpr std::string_view blanks = " \t\n\v\f\r";
  std::vector<std::string_view> all;
  if (separator.empty()) {
    while (all.size() < most) {
      text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
      if (text.empty()) break;
      const std::size_t end = all.size() + 1 == most ? text.size() : std::min(text.find_first_of(blanks), text.size());
      all.push_back(text.substr(0, end));
      text.remove_prefix(end);
    }
    return all;
  }
  while (all.size() < most) {
    const std::size_t end = all.size() + 1 == most ? std::string_view::npos : text.find(separator);
    all.push_back(text.substr(0, end));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + separator.size());
  }
  return all;
}

/// int split(string text, output string results[] [, string separator [, int most]])
void split(const Call& c) {
  const int room = c.type(1).elements(), most = c.count() > 3 ? std::clamp(c.at<int>(3), 0, room) : room;
  const std::string_view separator = c.count() > 2 ? c.string(2)->view() : std::string_view();
  const String** results = static_cast<const String**>(c.arguments[1]);
  int n = 0;
  if (!c.string(0)->view().empty())
    for (const std::string_view part : fragments(c.string(0)->view(), separator, std::size_t(most)))
      results[n++] = made(c, part);
  c.give(n);
}

/// string substr(string s, int start [, int length]); a negative start counts from the end.
void part(const Call& c) {
  const std::string_view text = c.string(0)->view();
  const long long size = (long long)(text.size());
  long long start = c.at<int>(1);
  if (start < 0) start += size;
  start = std::clamp(start, 0LL, size);
  const long long count = std::clamp(c.count() > 2 ? (long long)(c.at<int>(2)) : size, 0LL, size - start);
  c.give(made(c, text.substr(std::size_t(start), std::size_t(count))));
}

void character(const Call& c) {
  const std::string_view text = c.string(0)->view();
  const int i = c.at<int>(1);
  c.give(i >= 0 && std::size_t(i) < text.size() ? int(static_cast<unsigned char>(text[std::size_t(i)])) : 0);
}

void hash_of_string(const Call& c) { c.give(int(c.string(0)->hash())); }

/// int regex_search(string subject, string pattern), (string subject, int results[], string pattern), and regex_match.
template <bool whole>
void regular_expression(const Call& c) {
  const bool wants_places = c.count() > 2;
  const String* pattern = c.string(wants_places ? 2 : 1);
  int* places = wants_places ? static_cast<int*>(c.arguments[1]) : nullptr;
  std::string fault;
  const bool found =
      find_regular_expression(*c.string(0), *pattern, whole, places, wants_places ? c.type(1).elements() : 0, fault);
  if (!fault.empty())
    c.services.error(fmt::format("The regular expression \"{}\" failed: {}", pattern->text(), fault), c.types.place);
  c.give(int(found));
}

constexpr Derivatives none = Derivatives::none;

constexpr Row rows[] = {
    {"void printf(string format, ...)", always<print>, none, 0, nullptr, false},
    {"void fprintf(string file, string format, ...)", always<print_to>, none, 0, nullptr, false},
    {"void warning(string format, ...)", always<warn>, none, 0, nullptr, false},
    {"void error(string format, ...)", always<report_error>, none, 0, nullptr, false},
    {"string format(string format, ...)", always<format_text>, none},
    {"string concat(string a, string b, ...)", always<concatenate>, none},
    {"int strlen(string s)", always<length>, none},
    {"int startswith(string s, string prefix)", always<starts_with>, none},
    {"int endswith(string s, string suffix)", always<ends_with>, none},
    {"int stoi(string s)", always<to_int>, none},
    {"float stof(string s)", always<to_float>, none},
    {"int split(string s, output string results[], string separator, int most)", always<split>, none},
    {"int split(string s, output string results[], string separator)", always<split>, none},
    {"int split(string s, output string results[])", always<split>, none},
    {"string substr(string s, int start, int length)", always<part>, none},
    {"string substr(string s, int start)", always<part>, none},
    {"int getchar(string s, int index)", always<character>, none},
    {"int hash(string s)", always<hash_of_string>, none},
    {"int regex_search(string subject, string pattern)", always<regular_expression<false>>, none},
    {"int regex_search(string subject, output int results[], string pattern)", always<regular_expression<false>>, none},
    {"int regex_match(string subject, string pattern)", always<regular_expression<true>>, none},
    {"int regex_match(string subject, output int results[], string pattern)", always<regular_expression<true>>, none},
};

}  // namespace

std::span<const Row> string_rows() { return rows; }

}  // namespace etendue::osl
