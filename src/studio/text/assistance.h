#pragma once
// What an editor of texts offers: words that may stand at a place, and what a word means. All of it comes from the registry and
// from the text, which need not be valid.

#include <optional>
#include <string>
#include <vector>

#include "outline.h"

namespace etendue::studio {

struct Completion {
  std::string label, kind, detail, insert;
  size_t begin = 0;  ///< of the word that it replaces
};
std::vector<Completion> completions(const std::string& text, size_t at);

struct Explanation {
  std::string markdown;
  Span word;
};
std::optional<Explanation> explanation(const std::string& text, size_t at);

/// The word around a place; empty when there is none.
Span word_at(const std::string& text, size_t at);

}  // namespace etendue::studio
