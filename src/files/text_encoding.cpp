#include "text_encoding.h"

#include <cstdint>

namespace etendue {

bool has_byte_order_mark(std::string_view text) {
  return text.starts_with("\xef\xbb\xbf") || text.starts_with("\xfe\xff") || text.starts_with("\xff\xfe");
}

std::string as_utf8(std::string_view text) {
  if (!has_byte_order_mark(text)) return std::string(text);
  if (text.starts_with("\xef\xbb\xbf")) return std::string(text.substr(3));
  const size_t high = text.starts_with("\xfe\xff") ? 0 : 1;
  const auto unit = [&](size_t i) {
    return std::uint32_t(static_cast<unsigned char>(text[i + high])) << 8 | static_cast<unsigned char>(text[i + 1 - high]);
  };
  std::string out;
  for (size_t i = 2; i + 1 < text.size(); i += 2) {
    std::uint32_t c = unit(i);
    if ((c & 0xfc00) == 0xd800 && i + 3 < text.size() && (unit(i + 2) & 0xfc00) == 0xdc00) {  // a surrogate pair
      c = 0x10000 + ((c & 0x3ff) << 10) + (unit(i + 2) & 0x3ff);
      i += 2;
    }
    const auto more = [&](int shift) { out += char(0x80 | (c >> shift & 0x3f)); };
    if (c < 0x80) {
      out += char(c);
    } else if (c < 0x800) {
      out += char(0xc0 | c >> 6);
      more(0);
    } else if (c < 0x10000) {
      out += char(0xe0 | c >> 12);
      more(6);
      more(0);
    } else {
      out += char(0xf0 | c >> 18);
      more(12);
      more(6);
      more(0);
    }
  }
  return out;
}

}  // namespace etendue
