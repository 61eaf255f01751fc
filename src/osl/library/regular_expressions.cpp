// Regular expressions by PCRE2, with compiled patterns kept.

#include "regular_expressions.h"

#define PCRE2_CODE_UNIT_WIDTH 8
#include <pcre2.h>

#include <algorithm>
#include <memory>
#include <unordered_map>

namespace etendue::osl {

namespace {

struct Free {
  void operator()(pcre2_code* p) const { pcre2_code_free(p); }
  void operator()(pcre2_match_data* p) const { pcre2_match_data_free(p); }
  void operator()(pcre2_match_context* p) const { pcre2_match_context_free(p); }
};
template <class T>
using Owned = std::unique_ptr<T, Free>;

/// Steps of one match: about a tenth of a second.
constexpr std::uint32_t match_limit = 1'000'000;
constexpr std::size_t kept_patterns = 256;

std::string message(int code) {
  PCRE2_UCHAR text[256] = {};
  pcre2_get_error_message(code, text, sizeof text);
  return reinterpret_cast<const char*>(text);
}

struct Pattern {
  Owned<pcre2_code> code;
  Owned<pcre2_match_data> match;
  std::string fault;  ///< if it is no regular expression
};

/// A pattern of this thread, found by the address of its interned text. Shaders that make patterns as they run fill the table:
/// then it begins anew.
Pattern& compiled(const String& text) {
  thread_local std::unordered_map<const String*, Pattern> known;
  if (const auto found = known.find(&text); found != known.end()) return found->second;
  if (known.size() >= kept_patterns) known.clear();
  Pattern& made = known[&text];
  int code = 0;
  PCRE2_SIZE place = 0;
  made.code.reset(pcre2_compile(reinterpret_cast<PCRE2_SPTR>(text.text().data()), text.text().size(), PCRE2_DOTALL, &code,
                                &place, nullptr));
  if (made.code)
    made.match.reset(pcre2_match_data_create_from_pattern(made.code.get(), nullptr));
  else
    made.fault = message(code) + " at character " + std::to_string(place);
  return made;
}

pcre2_match_context* limits() {
  thread_local const Owned<pcre2_match_context> context = [] {
    Owned<pcre2_match_context> c(pcre2_match_context_create(nullptr));
    pcre2_set_match_limit(c.get(), match_limit);
    pcre2_set_heap_limit(c.get(), 64 * 1024);  // [KiB]
    return c;
  }();
  return context.get();
}

}  // namespace

bool find_regular_expression(const String& subject, const String& text, bool whole, int* places, int count,
                             std::string& fault) {
  const Pattern& pattern = compiled(text);
  const int none = int(text.text().size());
  std::fill_n(places, count, none);
  fault = pattern.fault;
  if (!pattern.code) return false;
  const std::uint32_t options = whole ? PCRE2_ANCHORED | PCRE2_ENDANCHORED : 0;
  const int groups = pcre2_match(pattern.code.get(), reinterpret_cast<PCRE2_SPTR>(subject.text().data()), subject.text().size(),
                                 0, options, pattern.match.get(), limits());
  if (groups < 0) {
    if (groups != PCRE2_ERROR_NOMATCH) fault = message(groups);
    return false;
  }
  const PCRE2_SIZE* ends = pcre2_get_ovector_pointer(pattern.match.get());
  const int all = 2 * int(pcre2_get_ovector_count(pattern.match.get()));
  // A group that took no part is, as in C++'s sub_match, empty at the end of the subject.
  for (int i = 0; i < std::min(count, all); ++i) places[i] = int(ends[i] == PCRE2_UNSET ? subject.text().size() : ends[i]);
  return true;
}

}  // namespace etendue::osl
