#pragma once
// The preprocessor and the lexer: a text, with all that it includes, as tokens.
//
// Boost.Wave does the directives and macros, and cuts the text into tokens; only preprocess.cpp includes it.

#include <string>
#include <vector>

#include "diagnostics.h"

namespace etendue::osl {

struct Token {
  enum class Kind : unsigned char {
    end,
    name,     ///< also keywords
    integer,  ///< decimal or hexadecimal
    real,
    text,  ///< a string, without quotes and escapes
    sign   ///< an operator or bracket
  };
  Kind kind = Kind::end;
  std::string text;
  Location place;

  bool is(const char* sign_or_name) const { return kind != Kind::text && text == sign_or_name; }
};

/// Limits of what one shader may be. Beyond them compilation ends with an error.
inline constexpr std::size_t most_source_bytes = std::size_t(64) << 20;  ///< of all files together
inline constexpr std::size_t most_tokens = 4'000'000;                    ///< after the preprocessor
inline constexpr std::size_t most_expanded_tokens = 4'000'000;           ///< made by macros on the way
inline constexpr int most_include_depth = 64;

/// The tokens of a text, the last of kind `end`. `name` is the file's name in messages; includes are searched from its folder.
/// Appends the files that it reads to `files`.
std::vector<Token> preprocess(const std::string& text, const std::string& name, const CompileOptions&,
                              std::vector<std::string>& files, Diagnostics&);

/// The tokens of a short text of our own, without directives: signatures.
std::vector<Token> cut(const std::string& text, Location);

}  // namespace etendue::osl
