#pragma once
// Common parts of HTML pages: their style, and escaping of text.

#include <string>
#include <string_view>

namespace etendue {

/// Escapes a text for use as HTML text or as an attribute value in double quotes.
inline std::string escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&': out += "&amp;"; break;
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  }
  return out;
}

/// The style of colours, type and headings that all pages share; each page adds its own.
inline constexpr std::string_view page_style = R"(
:root {
  color-scheme: light dark;
  --paper: #fcfcfa; --ink: #1d1f21; --quiet: #5f6368; --line: #d9d9d4; --panel: #f2f2ee;
  --good: #1a6b3c; --bad: #b2182b; --open: #8a5a00;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #17191b; --ink: #e4e4e0; --quiet: #a0a4a8; --line: #3a3d40; --panel: #212427;
    --good: #6fcf97; --bad: #ff7b86; --open: #e5b454;
  }
}
body { max-width: 76rem; margin: 2rem auto; padding: 0 1.25rem; background: var(--paper); color: var(--ink);
       font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.6rem; margin-bottom: .25rem; }
h2 { font-size: 1.25rem; margin-top: 2.5rem; padding-top: 1rem; border-top: 1px solid var(--line); }
p, li { max-width: 48rem; }
code { font-size: .9em; overflow-wrap: anywhere; }
.quiet { color: var(--quiet); }
.scroll { overflow-x: auto; }
)";

}  // namespace etendue
