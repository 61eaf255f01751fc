// Regular expressions by Boost.Regex, with compiled patterns kept.

#include "regular_expressions.h"

#include <boost/regex.hpp>

#include <unordered_map>

namespace etendue::osl {

namespace {

/// Patterns of this thread, by the address of their interned text. Shaders that make patterns as they run fill it: then it
/// begins anew.
const boost::regex& compiled(const String& pattern) {
  thread_local std::unordered_map<const String*, boost::regex> known;
  const auto found = known.find(&pattern);
  if (found != known.end()) return found->second;
  if (known.size() >= 256) known.clear();
  return known.emplace(&pattern, boost::regex(pattern.text())).first->second;
}

}  // namespace

bool find_regular_expression(const String& subject, const String& pattern, bool whole, int* places, int count,
                             std::string& fault) {
  try {
    const boost::regex& expression = compiled(pattern);
    boost::smatch match;
    const std::string& text = subject.text();
    const bool found = whole ? boost::regex_match(text, match, expression) : boost::regex_search(text, match, expression);
    for (int i = 0; i < count; ++i) {
      const bool group = found && std::size_t(i / 2) < match.size();
      const auto at = group ? (i % 2 ? match[i / 2].second : match[i / 2].first) : text.begin();
      places[i] = group ? int(at - text.begin()) : int(pattern.text().size());
    }
    return found;
  } catch (const std::exception& e) {
    fault = e.what();
    return false;
  }
}

}  // namespace etendue::osl
