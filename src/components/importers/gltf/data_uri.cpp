#include "data_uri.h"

#include <array>
#include <cstdint>

#include "etendue/core/error.h"

namespace etendue::gltf {
namespace {

int hexadecimal(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

constexpr std::array<std::int8_t, 256> base64_digits = [] {
  std::array<std::int8_t, 256> digits{};
  digits.fill(-1);
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < letters.size(); ++i) digits[static_cast<unsigned char>(letters[i])] = std::int8_t(i);
  digits['-'] = 62;  // the URL-safe variant of base64
  digits['_'] = 63;
  return digits;
}();

/// Base64 decoding (RFC 4648).
std::string decode_base64(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=' || c == '\n' || c == '\r') continue;
    const int digit = base64_digits[static_cast<unsigned char>(c)];
    if (digit < 0) throw Error("a data: URI holds what is not base64");
    bits = bits << 6 | std::uint32_t(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += char(bits >> count & 255);
  }
  return bytes;
}

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.starts_with("data:"); }

std::string decode_percents(std::string_view uri) {
  std::string plain;
  for (size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hexadecimal(uri[i + 1]) : -1;
    const int low = high >= 0 ? hexadecimal(uri[i + 2]) : -1;
    if (low >= 0) {
      plain += char(high * 16 + low);
      i += 2;
    } else {
      plain += uri[i];
    }
  }
  return plain;
}

UriData decode_data_uri(std::string_view uri) {
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) throw Error("a data: URI has no comma");
  const std::string_view head = uri.substr(5, comma - 5), data = uri.substr(comma + 1);
  UriData decoded;
  decoded.type = std::string(head.substr(0, head.find(';')));
  decoded.bytes = head.ends_with(";base64") ? decode_base64(data) : decode_percents(data);
  return decoded;
}

}  // namespace etendue::gltf
