#include "named.h"

#include <algorithm>
#include <charconv>

#include "etendue/core/error.h"

namespace etendue {

namespace {

template <class T>
std::string shortest(T value) {
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

bool same(std::string_view a, std::string_view b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

std::string number_text(double value) { return shortest(value); }
std::string number_text(float value) { return shortest(value); }

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c == '\n')
      result += "\\n";
    else if (c == '\t')
      result += "\\t";
    else
      result += c;
  }
  return result + '"';
}

bool is_named(std::string_view given, std::string_view name, std::string_view aliases) {
  if (same(given, name)) return true;
  while (!aliases.empty()) {
    const size_t end = std::min(aliases.find(','), aliases.size());
    if (same(given, aliases.substr(0, end))) return true;
    aliases.remove_prefix(std::min(end + 1, aliases.size()));
  }
  return false;
}

void fail_unknown(const std::string& what, const std::string& given, const std::vector<std::string>& known,
                  const std::vector<std::string>& others) {
  std::string list;
  for (const std::string& name : known) list += (list.empty() ? "" : ", ") + ("'" + name + "'");
  std::vector<std::string> similar = known;
  for (std::string_view rest : others)
    while (!rest.empty()) {
      const size_t end = std::min(rest.find(','), rest.size());
      similar.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  throw Error("unknown " + what + " '" + given + "'" + suggestion(given, similar) + "; known are " + list);
}

}  // namespace etendue
