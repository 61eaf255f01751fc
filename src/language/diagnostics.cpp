// Collects errors, and formats them together with their source line.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>

#include "etendue/language/language.h"
#include "files/regular_file.h"
#include "json.h"
#include "source.h"

namespace etendue {
namespace language {

namespace {

/// A message in which extremely long words, quoted from the text, are truncated.
std::string shortened(const std::string& message) {
  constexpr size_t longest = 1000, shown = 60;  // bytes; normal file paths are not truncated
  std::string text;
  for (size_t begin = 0; begin < message.size();) {
    const size_t end = std::min(message.find_first_of(" \n", begin), message.size() - 1) + 1;
    if (end - begin > longest) {
      size_t cut = begin + shown;
      while (cut > begin && (static_cast<unsigned char>(message[cut]) & 0xC0) == 0x80) --cut;
      text.append(message, begin, cut - begin).append("…");
      size_t rest = end - 10;  // the end of the word, with the closing quote and punctuation
      while (rest < end && (static_cast<unsigned char>(message[rest]) & 0xC0) == 0x80) ++rest;
      text.append(message, rest, end - rest);
    } else {
      text.append(message, begin, end - begin);
    }
    begin = end;
  }
  return text;
}

}  // namespace

std::string Diagnostics::words_of_trail(const Location& seen_from) const {
  constexpr int most = 6;  // for a recursive function the innermost calls are enough
  std::string text;
  int count = 0;
  for (const Trail* way = trail; way; way = way->outer()) {
    const std::string words = way->words(seen_from);
    if (words.empty() || text.find(words) != std::string::npos) continue;  // a recursive function
    if (++count > most) {
      text += ", …";
      break;
    }
    text += (text.empty() ? "" : ", ") + words;
  }
  return text.empty() ? text : " (" + text + ")";
}

void Diagnostics::add(const Error& error) {
  const std::string text = shortened(error.what());
  for (size_t i = 0; i < errors_.size(); ++i)
    if (errors_[i].location == error.location && bare_[i] == text) return;
  bare_.push_back(text);
  errors_.emplace_back(text + words_of_trail(error.location), error.location);
  if (errors_.size() >= limit) throw TooManyErrors{};
}

void Diagnostics::add(const Errors& list) {
  for (const Error& error : list.errors) add(error);
}

void Diagnostics::raise() {
  if (errors_.empty()) return;
  std::vector<const char*> files;  // in the order of their first errors
  const auto rank = [&](const Error& e) {
    const auto found = std::find(files.begin(), files.end(), e.location.file);
    if (found != files.end()) return found - files.begin();
    files.push_back(e.location.file);
    return std::ptrdiff_t(files.size()) - 1;
  };
  for (const Error& e : errors_) rank(e);
  std::stable_sort(errors_.begin(), errors_.end(), [&](const Error& a, const Error& b) {
    return std::tuple(rank(a), a.location.line, a.location.column) < std::tuple(rank(b), b.location.line, b.location.column);
  });
  throw Errors(std::move(errors_));
}

Error located(const Error& error, Location fallback) { return error.location.known() ? error : Error(error.what(), fallback); }

std::string read_text_file(const std::string& path, Location at) {
  constexpr std::uint64_t most = std::uint64_t(4) << 30;  // larger files are data, not descriptions
  try {
    return read_regular_file(path, most);
  } catch (const Error& e) {
    throw Error(fmt::format("cannot read '{}': {}", path, e.what()), at);
  } catch (const std::bad_alloc&) {
    throw Error(fmt::format("cannot read '{}': {}", path, no_memory_to_read), at);
  }
}

namespace {

struct Texts {
  std::mutex mutex;
  std::map<std::string, std::shared_ptr<const std::string>, std::less<>> by_name;
};

Texts& texts() {
  static Texts& all = *new Texts;  // never destroyed: errors may be shown while the program ends
  return all;
}

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// A part of a line around a column, and the index of this column in it.
struct Excerpt {
  std::string text;
  int caret = 0;
};

constexpr int characters_before = 70, characters_after = 40;

/// Reads the excerpt from a stream of characters; `next` returns a negative number at the end. Only the displayed part is
/// stored.
template <class Next>
std::optional<Excerpt> excerpt(const Location& at, Next next) {
  int line = 1;
  while (line < at.line) {
    const int c = next();
    if (c < 0) return std::nullopt;
    if (c == '\n') ++line;
  }
  // Lines that fit are shown completely; of longer lines the part around the column.
  const int first = at.column > characters_before + characters_after ? at.column - characters_before : 1;
  const int last = first + characters_before + characters_after;
  Excerpt found;
  int column = 0;
  bool more = false;
  for (int c = next(); c >= 0 && c != '\n'; c = next()) {
    const char byte = char(c);
    if (line == 1 && column == 0 && c == 0xEF) {  // a byte order mark is not a character
      next();
      next();
      continue;
    }
    if (!continues_character(byte)) ++column;
    if (column > last) {
      more = true;
      break;
    }
    if (column < first || byte == '\r') continue;
    found.text += static_cast<unsigned char>(byte) < 0x20 || byte == 0x7F ? ' ' : byte;  // a tab is shown as one blank
  }
  found.caret = std::max(at.column, 1) - first;
  if (first > 1) {
    found.text = "…" + found.text;
    ++found.caret;
  }
  if (more) found.text += "…";
  return found;
}

std::shared_ptr<const std::string> remembered(const Location& at) {
  const std::lock_guard lock(texts().mutex);
  const auto found = texts().by_name.find(std::string_view(at.file));
  return found == texts().by_name.end() ? nullptr : found->second;
}

/// The path through the objects and lists of a JSON text, followed by a colon; "" for other texts.
std::string path_in_json(const Location& at) {
  if (!is_json(at.file)) return {};
  try {
    const auto text = remembered(at);
    const std::string path = json_path(text ? *text : read_text_file(at.file, at), at);
    return path.empty() ? path : path + ": ";
  } catch (const Error&) {
    return {};  // the file has been deleted meanwhile
  }
}

std::optional<Excerpt> excerpt(const Location& at) {
  const std::shared_ptr<const std::string> text = remembered(at);
  if (text) {
    size_t position = 0;
    return excerpt(at, [&] { return position < text->size() ? int(static_cast<unsigned char>((*text)[position++])) : -1; });
  }
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(at.file, ignored)) return std::nullopt;
  std::ifstream file(at.file, std::ios::binary);
  std::streambuf* buffer = file.rdbuf();
  return file ? excerpt(at, [&] { return buffer->sbumpc(); }) : std::nullopt;
}

}  // namespace

void remember_text(const char* name, std::string text) {
  auto shared = std::make_shared<const std::string>(std::move(text));
  const std::lock_guard lock(texts().mutex);
  texts().by_name[name] = std::move(shared);
}

std::optional<size_t> invalid_utf8(const std::string& text) {
  const auto* s = reinterpret_cast<const unsigned char*>(text.data());
  const size_t size = text.size();
  for (size_t i = 0; i < size;) {
    std::uint64_t eight = 0;
    if (i + 8 <= size && (std::memcpy(&eight, s + i, 8), (eight & 0x8080808080808080ull) == 0)) {
      i += 8;
      continue;
    }
    const unsigned c = s[i];
    if (c < 0x80) {
      ++i;
      continue;
    }
    const size_t length = c >= 0xF0 ? 4 : (c >= 0xE0 ? 3 : 2);
    if (c < 0xC2 || c > 0xF4 || i + length > size) return i;
    std::uint32_t code = c & (0x7Fu >> length);
    for (size_t k = 1; k < length; ++k) {
      if ((s[i + k] & 0xC0) != 0x80) return i;
      code = code << 6 | (s[i + k] & 0x3Fu);
    }
    // Overlong forms, surrogate halves and code points above U+10FFFF are not valid UTF-8 either.
    if ((length == 3 && code < 0x800) || (length == 4 && code < 0x10000) || code > 0x10FFFF ||
        (code >= 0xD800 && code < 0xE000))
      return i;
    i += length;
  }
  return std::nullopt;
}

/// "7:27", or "7" for a line of a script, whose columns are not known.
std::string lines_text(const Location& at) {
  return at.column > 0 ? fmt::format("{}:{}", at.line, at.column) : std::to_string(at.line);
}

std::string place(const Location& at, const Location& seen_from) {
  const std::string position = lines_text(at);
  return at.file == seen_from.file ? "line " + position : fmt::format("{}:{}", at.file, position);
}

}  // namespace language

std::string show(const Error& error) {
  const Location& at = error.location;
  const std::string message = language::shortened(error.what());
  if (!at.known()) return message;
  if (at.line <= 0) return fmt::format("{}: {}", at.file, message);
  std::string result = fmt::format("{}:{}: {}{}", at.file, language::lines_text(at), language::path_in_json(at), message);
  if (const auto found = language::excerpt(at)) {
    const std::string number = std::to_string(at.line);
    result += fmt::format("\n    {} | {}", number, found->text);
    if (at.column > 0)
      result += fmt::format("\n    {} | {}^", std::string(number.size(), ' '), std::string(size_t(found->caret), ' '));
  }
  return result;
}

}  // namespace etendue
