#include "images.h"

#include <cctype>
#include <cstdio>
#include <string_view>
#include <utility>

namespace etendue::assimp_helper {
namespace {

/// Percent-encodes all but letters, digits and a few marks, so that the path arrives unchanged.
std::string encoded(const std::string& path) {
  std::string uri;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || c == '.' || c == '-' || c == '_' || c == '/') {
      uri += c;
    } else {
      char text[8];
      std::snprintf(text, sizeof text, "%%%02X", byte);
      uri += text;
    }
  }
  return uri;
}

/// The media type for a file name ending. It decides for formats that do not begin with bytes of their own, like Targa.
const char* media_type(const aiTexture& t) {
  std::string ending;
  for (const char* c = t.achFormatHint; *c && c < t.achFormatHint + HINTMAXTEXTURELEN; ++c)
    ending += char(std::tolower(static_cast<unsigned char>(*c)));
  using Row = std::pair<std::string_view, const char*>;
  for (const auto& [known, type] :
       {Row{"jpg", "image/jpeg"}, Row{"jpeg", "image/jpeg"}, Row{"tga", "image/x-tga"}, Row{"bmp", "image/bmp"}})
    if (ending == known) return type;
  return "image/png";
}

}  // namespace

size_t ImageWriter::index(const std::string& path) {
  if (const auto known = written_.find(path); known != written_.end()) return known->second;
  const aiTexture* inside = scene_.GetEmbeddedTexture(path.c_str());
  Json made;
  if (inside)
    made = inside->mHeight == 0 ? compressed(*inside) : uncompressed(*inside);
  else
    made = {{"uri", encoded(path)}};
  return written_[path] = glb_.add("images", made);
}

Json ImageWriter::compressed(const aiTexture& t) {
  return {{"bufferView", glb_.add_view(t.pcData, t.mWidth)}, {"mimeType", media_type(t)}};
}

Json ImageWriter::uncompressed(const aiTexture& t) {
  const std::uint32_t size = t.mWidth * t.mHeight * 4;
  std::string file = "BM";
  const auto word = [&](std::uint32_t x) { file.append(reinterpret_cast<const char*>(&x), 4); };
  word(54 + size);
  word(0);
  word(54);
  word(40);
  word(t.mWidth);
  word(t.mHeight);
  word(1 | 32 << 16);
  for (int i = 0; i < 6; ++i) word(i == 1 ? size : 0);
  for (unsigned y = t.mHeight; y-- > 0;)
    file.append(reinterpret_cast<const char*>(t.pcData + size_t(y) * t.mWidth), size_t(t.mWidth) * 4);
  return {{"bufferView", glb_.add_view(file.data(), file.size())}, {"mimeType", "image/bmp"}};
}

}  // namespace etendue::assimp_helper
