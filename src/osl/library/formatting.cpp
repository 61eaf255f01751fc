// Text by a format in the manner of C's printf.

#include "formatting.h"

#include <fmt/printf.h>

#include <algorithm>
#include <cctype>

#include "osl/values/closure.h"

namespace etendue::osl {

namespace {

/// One conversion: flags, width, precision, and the letter.
struct Conversion {
  std::string options;  ///< between % and the letter: "-6.2"
  char letter = 0;
};

/// Widths and precisions beyond any use are cut, so that a format cannot ask for gigabytes.
void append_number(std::string_view format, std::size_t& i, std::string& options) {
  int number = 0;
  bool any = false;
  for (; i < format.size() && std::isdigit(static_cast<unsigned char>(format[i])); ++i, any = true)
    number = std::min(number * 10 + (format[i] - '0'), 1000);
  if (any) options += std::to_string(number);
}

/// Reads a conversion behind a '%' at format[i - 1]; i comes to stand behind it. False if the format ends before.
bool read(std::string_view format, std::size_t& i, Conversion& c) {
  while (i < format.size() && std::string_view("-+ #0").find(format[i]) != std::string_view::npos) c.options += format[i++];
  append_number(format, i, c.options);
  if (i < format.size() && format[i] == '.') {
    c.options += format[i++];
    append_number(format, i, c.options);
  }
  while (i < format.size() && std::string_view("hlLqjzt").find(format[i]) != std::string_view::npos) ++i;
  if (i >= format.size()) return false;
  c.letter = format[i++];
  return true;
}

void append_float(std::string& text, const Conversion& c, float value) {
  const char letter = std::string_view("fFgGeEaA").find(c.letter) != std::string_view::npos ? c.letter : 'f';
  text += fmt::sprintf("%" + c.options + letter, double(value));
}

void append_int(std::string& text, const Conversion& c, int value) {
  const std::string_view unsigned_letters = "uoxX";
  if (unsigned_letters.find(c.letter) != std::string_view::npos)
    text += fmt::sprintf("%" + c.options + c.letter, unsigned(value));
  else
    text += fmt::sprintf("%" + c.options + 'd', value);
}

void append_string(std::string& text, const Conversion& c, const std::string& value) {
  if (c.options.empty())
    text += value;
  else
    text += fmt::sprintf("%" + c.options + 's', value);
}

void append_value(std::string& text, const Conversion& c, const Type& type, const void* value) {
  const auto repeat = [&](int count, auto&& one) {
    for (int i = 0; i < count && text.size() < string_limit; ++i) {
      if (i) text += ' ';
      one(i);
    }
  };
  const int n = type.elements();
  if (type.is_closure()) {
    repeat(n, [&](int i) { append_string(text, c, to_text(static_cast<const ClosureNode* const*>(value)[i])); });
  } else if (type.base == Base::string) {
    repeat(n, [&](int i) { append_string(text, c, static_cast<const String* const*>(value)[i]->text()); });
  } else if (type.base == Base::int_) {
    repeat(n, [&](int i) { append_int(text, c, static_cast<const int*>(value)[i]); });
  } else if (type.float_based()) {
    repeat(n * type.floats(), [&](int i) { append_float(text, c, static_cast<const float*>(value)[i]); });
  } else {
    text += type.name();
  }
}

}  // namespace

std::string formatted(const Call& call, int format_at) {
  const std::string_view format = call.string(format_at)->view();
  std::string text;
  int next = format_at + 1;
  for (std::size_t i = 0; i < format.size() && text.size() < string_limit;) {
    if (format[i] != '%') {
      text += format[i++];
      continue;
    }
    const std::size_t begin = i++;
    if (i < format.size() && format[i] == '%') {
      text += format[i++];
      continue;
    }
    Conversion c;
    if (!read(format, i, c) || next >= call.count()) {
      text += format.substr(begin, i - begin);
      continue;
    }
    append_value(text, c, call.type(next), call.arguments[next]);
    ++next;
  }
  if (text.size() > string_limit) text.resize(string_limit);
  return text;
}

}  // namespace etendue::osl
