// The preprocessor: Boost.Wave, with limits, and with includes only from allowed folders.

#include "preprocess.h"

#include <fmt/format.h>

#include <boost/wave.hpp>
#include <boost/wave/cpplexer/cpp_lex_iterator.hpp>
#include <boost/wave/cpplexer/cpp_lex_token.hpp>
#include <cctype>
#include <filesystem>

#include "lexer.h"
#include "source_files.h"

namespace etendue::osl {

namespace {

namespace wave = boost::wave;

using WaveToken = wave::cpplexer::lex_token<>;
using WaveIterator = wave::cpplexer::lex_iterator<WaveToken>;
class Hooks;

/// Wave makes file names absolute; messages show them as they were given.
class Places {
 public:
  explicit Places(const std::string& name) {
    const std::filesystem::path given(name);
    std::error_code failed;
    whole_ = std::filesystem::absolute(given, failed).parent_path().lexically_normal().string() + "/";
    shown_ = given.parent_path().string();
    if (!shown_.empty() && shown_.back() != '/') shown_ += '/';
  }

  Location place(const std::string& file, std::size_t line, std::size_t column) {
    if (file != last_file_) {
      last_file_ = file;
      const std::string normal = std::filesystem::path(file).lexically_normal().string();
      last_ = intern(normal.starts_with(whole_) ? shown_ + normal.substr(whole_.size()) : normal);
    }
    return {last_, int(line), int(column)};
  }
  Location place(const wave::util::file_position_type& position) {
    return place(position.get_file().c_str(), position.get_line(), position.get_column());
  }
  Location place(const WaveToken& token) { return place(token.get_position()); }
  Location place(const wave::cpp_exception& e) { return place(e.file_name(), e.line_no(), e.column_no()); }

 private:
  std::string whole_, shown_, last_file_;
  const char* last_ = "";
};

/// Ends the preprocessor from within a hook.
struct TooMuch {
  std::string reason;
  Location place{};  ///< unless it is that of the last token
};

/// What the hooks and the reading of included files share.
struct State {
  State(const std::string& name, const CompileOptions& options, std::vector<std::string>& list, Diagnostics& d)
      : places(name), files(name, options.include_folders), read(list), diagnostics(d) {}

  Places places;
  SourceFiles files;
  std::vector<std::string>& read;
  Diagnostics& diagnostics;
  std::size_t bytes = 0, expanded = 0;
  Location directive{};  ///< where the last include stands

  /// The text of a file for Wave, which needs a line's end at the end.
  std::string load(const std::string& path) {
    std::string text;
    if (const auto standard = SourceFiles::standard_header(path)) {
      text = *standard;
    } else if (const auto own = SourceFiles::built_in(path)) {
      text = *own;
    } else {
      try {
        text = SourceFiles::read(path);
        check_source(text);
      } catch (const Error& e) {
        throw TooMuch{fmt::format("#include \"{}\": {}", path, e.what()), directive};
      }
      read.push_back(path);
    }
    bytes += text.size();
    if (bytes > most_source_bytes) throw TooMuch{fmt::format("more than {} bytes of source", most_source_bytes), directive};
    if (text.empty() || text.back() != '\n') text += '\n';
    return text;
  }

  static void check_source(const std::string& text);
};

/// Wave parses the expression of an `#if` by recursion: lines with too many brackets are refused before it sees them.
void State::check_source(const std::string& text) {
  constexpr int most_open = 100;
  if (text.find('\0') != std::string::npos) throw Error("it contains a zero byte");
  std::size_t at = 0;
  while (at < text.size()) {
    std::size_t end = text.find('\n', at);
    // Lines are continued behind a backslash.
    while (end != std::string::npos && end > at &&
           (text[end - 1] == '\\' || (text[end - 1] == '\r' && end > at + 1 && text[end - 2] == '\\')))
      end = text.find('\n', end + 1);
    if (end == std::string::npos) end = text.size();
    const std::size_t first = text.find_first_not_of(" \t\r\v\f", at);
    if (first < end && text[first] == '#') {
      int open = 0;
      for (std::size_t i = first; i < end; ++i)
        if (text[i] == '(' || text[i] == '!' || text[i] == '-' || text[i] == '~' || text[i] == '+' || text[i] == '?')
          if (++open > most_open) throw Error("a directive nests too deeply");
    }
    at = end + 1;
  }
}

/// How Wave gets the text of a file that is included: from SourceFiles, not from anywhere.
struct LoadAllowed {
  template <class IterContext>
  class inner {
   public:
    template <class Position>
    static void init_iterators(IterContext& context, const Position&, wave::language_support language) {
      context.instring = current().load(std::string(context.filename.c_str()));
      context.first = WaveIterator(context.instring.begin(), context.instring.end(),
                                   wave::util::file_position_type(context.filename), language);
      context.last = WaveIterator();
    }

   private:
    std::string instring;
  };

  static thread_local State* state;
  static State& current() { return *state; }
};
thread_local State* LoadAllowed::state = nullptr;

using Context = wave::context<std::string::const_iterator, WaveIterator, LoadAllowed, Hooks>;

bool is_space(wave::token_id id) {
  return (unsigned(id) & unsigned(wave::TokenTypeMask)) == unsigned(wave::WhiteSpaceTokenType);
}

class Hooks : public wave::context_policies::eat_whitespace<WaveToken> {
 public:
  template <class C>
  bool locate_include_file(C& context, std::string& file, bool is_system, const char* current_name, std::string& folder,
                           std::string& native) {
    State& state = LoadAllowed::current();
    state.directive = state.places.place(context.get_main_pos());
    if (context.get_iteration_depth() >= std::size_t(most_include_depth))
      throw TooMuch{fmt::format("#include \"{}\": files include each other more than {} deep", file, most_include_depth),
                    state.directive};
    (void)current_name;
    if (SourceFiles::standard_header(file)) {
      native = folder = file;
      return true;
    }
    const std::string including = context.get_main_pos().get_file().c_str();
    SourceFiles::Found found = state.files.find(file, !is_system, including);
    if (found.missing) found.path = SourceFiles::built_in_path(file);
    if (found.path.empty()) throw TooMuch{fmt::format("#include \"{}\": {}", file, found.reason), state.directive};
    native = folder = found.path;
    return true;
  }

  /// Blanks around an argument are no part of it. Wave removes them for `#` and `##` of this macro only, so that a `#` of a
  /// macro further in would see them; the arguments are a local variable of Wave's that it reads again after this call. Those
  /// of `...` are one argument, with its commas and the blanks around them.
  template <class C, class Token, class Container, class Iterator>
  bool expanding_function_like_macro(const C&, const Token&, const std::vector<Token>& parameters, const Container&,
                                     const Token&, const std::vector<Container>& arguments, const Iterator&, const Iterator&) {
    auto& trimmed = const_cast<std::vector<Container>&>(arguments);
    const bool open = !parameters.empty() && wave::token_id(parameters.back()) == wave::T_ELLIPSIS;
    const std::size_t rest = open ? parameters.size() - 1 : arguments.size();  // where those of `...` begin
    const auto blank = [](const Token& token) { return is_space(wave::token_id(token)); };
    for (std::size_t i = 0; i < trimmed.size(); ++i) {
      Container& argument = trimmed[i];
      if (i <= rest)
        while (argument.size() > 1 && blank(argument.front())) argument.pop_front();
      if (i < rest || i + 1 == trimmed.size())
        while (argument.size() > 1 && blank(argument.back())) argument.pop_back();
    }
    return false;
  }

  template <class C, class Container>
  void expanded_macro(const C&, const Container& result) {
    count(result.size());
  }
  template <class C, class Container>
  void rescanned_macro(const C&, const Container& result) {
    count(result.size());
  }

  template <class C, class Exception>
  void throw_exception(const C&, const Exception& e) {
    boost::throw_exception(e);
  }

 private:
  static void count(std::size_t tokens) {
    State& state = LoadAllowed::current();
    state.expanded += tokens + 1;
    if (state.expanded > most_expanded_tokens)
      throw TooMuch{fmt::format("macros expand to more than {} tokens", most_expanded_tokens)};
  }
};

constexpr const char* constants[] = {
    "M_PI=3.1415926535897932",
    "M_PI_2=1.5707963267948966",
    "M_PI_4=0.7853981633974483",
    "M_2_PI=0.6366197723675813",
    "M_2PI=6.2831853071795865",
    "M_4PI=12.566370614359173",
    "M_2_SQRTPI=1.1283791670955126",
    "M_E=2.7182818284590452",
    "M_LN2=0.6931471805599453",
    "M_LN10=2.3025850929940457",
    "M_LOG2E=1.4426950408889634",
    "M_LOG10E=0.4342944819032518",
    "M_SQRT2=1.4142135623730950",
    "M_SQRT1_2=0.7071067811865475",
    "STDOSL_H=1",
    "OSL_VERSION_MAJOR=1",
    "OSL_VERSION_MINOR=13",
    "OSL_VERSION_PATCH=0",
    "OSL_VERSION=11300",
};

void define(Context& context, const CompileOptions& options) {
  context.set_max_include_nesting_depth(std::size_t(most_include_depth) + 8);
  for (const char* constant : constants) context.add_macro_definition(std::string(constant), false);
  // Wave predefines macros of C and C++, which a shader's conditionals would see.
  for (const auto& [name, text] : options.definitions)
    context.add_macro_definition(text.empty() ? name + "=1" : name + "=" + text, false);
  for (const std::string& name : options.removed_definitions) context.remove_macro_definition(name, false);
}

/// What a `#pragma` line says; only `error` and `warning` have an effect.
void obey_pragma(const std::string& line, Location at, Diagnostics& diagnostics) {
  const std::size_t quote = line.find('"');
  const std::string word = line.substr(0, line.find_first_of(" \""));
  if (word != "error" && word != "warning") return;
  std::string text = quote == std::string::npos ? line : line.substr(quote + 1);
  if (!text.empty() && text.back() == '"') text.pop_back();
  word == "error" ? diagnostics.error(at, text) : diagnostics.warning(at, text);
}

void run(Context& context, State& state, std::vector<Token>& out) {
  Places& places = state.places;
  Diagnostics& diagnostics = state.diagnostics;
  std::string pragma;
  bool in_pragma = false;
  Location pragma_place;
  auto end = context.end();
  auto i = context.begin();
  while (i != end) {
    try {
      for (; i != end; ++i) {
        const WaveToken& token = *i;
        const wave::token_id id = wave::token_id(token);
        if (id == wave::T_EOI || id == wave::T_EOF) continue;
        if (id == wave::T_NEWLINE) {
          if (in_pragma) obey_pragma(pragma, pragma_place, diagnostics);
          in_pragma = false;
          continue;
        }
        const std::string text(token.get_value().begin(), token.get_value().end());
        if (id == wave::T_PP_PRAGMA) {
          in_pragma = true, pragma.clear(), pragma_place = places.place(token);
        } else if (in_pragma) {
          if (!pragma.empty() || !is_space(id)) pragma += text;
        } else if (!is_space(id) && id != wave::T_PP_LINE) {
          append_token(text, places.place(token), out, diagnostics);
          if (out.size() > most_tokens) throw TooMuch{fmt::format("more than {} tokens", most_tokens)};
        }
      }
    } catch (const wave::cpp_exception& e) {
      const Location at = places.place(e);
      const auto* preprocessing = dynamic_cast<const wave::preprocess_exception*>(&e);
      const bool recoverable = wave::is_recoverable(e);
      const bool line_end =
          preprocessing && preprocessing->get_errorcode() == wave::preprocess_exception::last_line_not_terminated;
      if (recoverable && line_end) continue;
      if (recoverable && preprocessing && preprocessing->get_severity() <= wave::util::severity_warning)
        diagnostics.warning(at, e.description());
      else
        diagnostics.error(at, e.description());
      if (!recoverable) throw Diagnostics::Stop{};
    }
  }
}

}  // namespace

std::vector<Token> preprocess(const std::string& text, const std::string& name, const CompileOptions& options,
                              std::vector<std::string>& files, Diagnostics& diagnostics) {
  State state(name, options, files, diagnostics);
  std::vector<Token> out;
  Places& places = state.places;
  const Location whole{intern(name), 0, 0};
  State* const outer = std::exchange(LoadAllowed::state, &state);
  struct Restore {
    State* outer;
    ~Restore() { LoadAllowed::state = outer; }
  } const restore{outer};
  try {
    std::string source = text;
    if (source.size() > most_source_bytes) throw TooMuch{fmt::format("more than {} bytes of source", most_source_bytes)};
    state.bytes = source.size();
    State::check_source(source);
    if (source.empty() || source.back() != '\n') source += '\n';
    Context context(source.cbegin(), source.cend(), name.c_str());
    context.set_language(wave::language_support(wave::support_c99 | wave::support_option_emit_pragma_directives |
                                                wave::support_option_single_line));
    define(context, options);
    run(context, state, out);
  } catch (const TooMuch& e) {
    diagnostics.error(e.place.known() ? e.place : (out.empty() ? whole : out.back().place), e.reason);
    throw Diagnostics::Stop{};
  } catch (const Error& e) {
    diagnostics.error(whole, e.what());
    throw Diagnostics::Stop{};
  } catch (const wave::cpp_exception& e) {
    diagnostics.error(places.place(e), e.description());
    throw Diagnostics::Stop{};
  } catch (const wave::cpplexer::cpplexer_exception& e) {
    diagnostics.error(places.place(e.file_name(), e.line_no(), e.column_no()), e.description());
    throw Diagnostics::Stop{};
  } catch (const std::exception& e) {
    diagnostics.error(whole, fmt::format("the preprocessor gives up: {}", e.what()));
    throw Diagnostics::Stop{};
  }
  Token last;
  last.place = out.empty() ? whole : out.back().place;
  out.push_back(last);
  join_texts(out);
  return out;
}

}  // namespace etendue::osl
