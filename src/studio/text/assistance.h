#pragma once
// Editor assistance: completions at a position, and explanations of a word. Both use the registry and the text, which need not
// be valid.

#include <optional>
#include <string>
#include <vector>

#include "outline.h"

namespace etendue::studio {

struct Completion {
  std::string label, kind, detail, insert;
  size_t begin = 0;  ///< beginning of the replaced word
};
std::vector<Completion> completions(const std::string& text, size_t at);

struct Explanation {
  std::string markdown;
  Span word;
};
std::optional<Explanation> explanation(const std::string& text, size_t at);

/// The word around a position; empty if there is none.
Span word_at(const std::string& text, size_t at);

}  // namespace etendue::studio
