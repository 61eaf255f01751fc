#include "no_description.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "etendue/core/error.h"
#include "file_kind.h"
#include "gzip.h"

namespace etendue {

namespace {

constexpr std::string_view blanks = " \t\r\n";

void skip_blanks(std::string_view& text) { text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size())); }

/// Whether a text begins like a description: with a definition, an include or a component.
bool begins_as_description(std::string_view text, bool main) {
  const bool has_job = text.find("Job") != text.npos;
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  for (skip_blanks(text); text.starts_with('#'); skip_blanks(text)) text.remove_prefix(std::min(text.find('\n'), text.size()));
  if (text.empty()) return true;
  size_t end = 0;
  while (end < text.size() && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_')) ++end;
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end);
  skip_blanks(text);
  if (word.empty() || text.empty()) return false;
  if (word == "include" || word == "plugin" || word == "class") return text[0] == '"';
  if (word == "param") return std::isalpha(static_cast<unsigned char>(text[0])) || text[0] == '_';
  return (text[0] == '{' || text[0] == '(' || text[0] == '=') && (has_job || !main);
}

std::string endings_text(std::vector<std::string> all) {
  all.emplace_back("etd");
  all.emplace_back("json");
  std::ranges::sort(all);
  std::string text;
  for (const std::string& ending : all) text += (text.empty() ? "." : ", .") + ending;
  return text;
}

}  // namespace

std::string why_no_description(const std::string& path, std::string_view text, bool main,
                               const std::function<std::vector<std::string>()>& others) {
  const std::string ending = ending_of_contents(path);
  const bool known = ending.empty() || ending == "etd" || ending == "json";
  if (!known && !begins_as_description(text, main))
    return fmt::format("'{}': files ending in .{} are not read; these are: {}", path, ending, endings_text(others()));
  const std::string contents = mistaken_contents(text, ending == "json" ? ending : "etd");
  return contents.empty() ? contents : fmt::format("'{}' is no render description: {}", path, contents);
}

}  // namespace etendue
