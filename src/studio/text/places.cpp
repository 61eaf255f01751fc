#include "places.h"

#include <algorithm>

namespace etendue::studio {

namespace {

/// The UTF-16 units of the character that begins with a byte; 0 for continuation bytes.
size_t units_of(char c) {
  const auto byte = static_cast<unsigned char>(c);
  return (byte & 0xC0) == 0x80 ? 0 : (byte >= 0xF0 ? 2 : 1);
}

}  // namespace

Places::Places(const std::string& text) : text_(text), lines_{0} {
  const bool ascii = std::none_of(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
  for (size_t i = 0; i < text.size(); ++i) {
    if (!ascii && i % step == 0) marks_.push_back(units_);
    units_ += units_of(text[i]);
    if (text[i] == '\n') lines_.push_back(i + 1);
  }
}

size_t Places::units(size_t byte) const {
  byte = std::min(byte, text_.size());
  if (marks_.empty()) return byte;
  if (byte == text_.size()) return units_;
  size_t count = marks_[byte / step];
  for (size_t i = byte / step * step; i < byte; ++i) count += units_of(text_[i]);
  return count;
}

size_t Places::byte(size_t unit) const {
  if (unit > units_) return std::string::npos;
  if (unit == units_) return text_.size();
  if (marks_.empty()) return unit;
  const auto mark = std::upper_bound(marks_.begin(), marks_.end(), unit) - 1;
  size_t at = size_t(mark - marks_.begin()) * step, count = *mark;
  for (;; ++at) {
    const size_t here = units_of(text_[at]);
    if (here > 0 && count == unit) return at;
    if (here > 0 && count > unit) return std::string::npos;
    count += here;
  }
}

size_t Places::byte(const Location& at) const {
  if (at.line < 1) return 0;
  if (size_t(at.line) > lines_.size()) return text_.size();
  size_t i = lines_[size_t(at.line) - 1];
  if (at.line == 1 && text_.starts_with("\xEF\xBB\xBF")) i = 3;
  for (int column = 1; i < text_.size() && text_[i] != '\n'; ++i) {
    if (units_of(text_[i]) == 0) continue;
    if (column++ == at.column) break;
  }
  return i;
}

}  // namespace etendue::studio
