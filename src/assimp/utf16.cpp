#include "utf16.h"

#include <cctype>
#include <cstdint>
#include <fstream>
#include <iterator>

namespace etendue::assimp_helper {

bool is_ase(const std::string& path) {
  std::string ending = path.size() > 4 ? path.substr(path.size() - 4) : std::string();
  for (char& c : ending) c = char(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".ase";
}

std::optional<std::string> utf16_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const auto byte = [&] { return std::uint32_t(file.get()) & 0xff; };
  const std::uint32_t first = byte(), second = byte();
  const bool marked = (first == 0xff && second == 0xfe) || (first == 0xfe && second == 0xff);
  const bool unmarked = (first == '<' && second == 0) || (first == 0 && second == '<');
  const bool little = first == 0xff || second == 0;
  if (!file || !(marked || unmarked)) return std::nullopt;
  if (unmarked) file.seekg(0);
  std::string text;
  std::uint32_t high = 0;  // first half of a surrogate pair
  for (;;) {
    const std::uint32_t a = byte(), b = byte();
    if (!file) return text;
    std::uint32_t c = little ? a | b << 8 : a << 8 | b;
    if (c >= 0xd800 && c < 0xdc00) {
      high = c;
      continue;
    }
    if (c >= 0xdc00 && c < 0xe000) c = high ? 0x10000 + ((high - 0xd800) << 10) + (c - 0xdc00) : '?';
    high = 0;
    if (c < 0x80) {
      text += char(c);
      continue;
    }
    const int more = c < 0x800 ? 1 : (c < 0x10000 ? 2 : 3);
    constexpr std::uint32_t heads[] = {0, 0xc0, 0xe0, 0xf0};
    text += char(heads[more] | c >> (6 * more));
    for (int k = more - 1; k >= 0; --k) text += char(0x80 | ((c >> (6 * k)) & 0x3f));
  }
}

}  // namespace etendue::assimp_helper
