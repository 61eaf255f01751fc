#include "stated_encoding.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstdint>
#include <fstream>

namespace etendue {

namespace {

/// The beginning of a file. Bytes beyond it read as 0; `whole` is false for them.
class Bytes {
 public:
  explicit Bytes(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    bytes_.resize(most);
    in.read(bytes_.data(), most);
    bytes_.resize(size_t(in.gcount()));
  }
  bool whole(size_t at, size_t count) const { return at <= bytes_.size() && count <= bytes_.size() - at; }
  unsigned byte(size_t at) const { return at < bytes_.size() ? static_cast<unsigned char>(bytes_[at]) : 0; }
  std::uint32_t big(size_t at) const { return byte(at) << 24 | byte(at + 1) << 16 | byte(at + 2) << 8 | byte(at + 3); }
  std::uint32_t little(size_t at) const { return byte(at + 3) << 24 | byte(at + 2) << 16 | byte(at + 1) << 8 | byte(at); }
  std::string text(size_t at, size_t count) const { return whole(at, count) ? bytes_.substr(at, count) : std::string(); }
  /// The text up to the next 0; empty if it has more than 255 bytes.
  std::string name(size_t at) const {
    const size_t end = at < bytes_.size() ? bytes_.find('\0', at) : std::string::npos;
    return end == std::string::npos || end - at > 255 ? std::string() : bytes_.substr(at, end - at);
  }

 private:
  static constexpr size_t most = 1 << 20;
  std::string bytes_;
};

/// A name in which control characters and non-ASCII bytes are replaced by '?'.
std::string printable(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7F) c = '?';
  return text;
}

std::string chromaticities(const std::array<double, 8>& xy, const std::array<const char*, 4>& names) {
  std::string text = "chromaticities:";
  for (size_t i = 0; i < 4; ++i)
    text += fmt::format("{} {} {:.5g} {:.5g}", i == 0 ? "" : ",", names[i], xy[2 * i], xy[2 * i + 1]);
  return text;
}

/// A code of ITU-T H.273, with its name if it is one of `names`.
std::string named(unsigned code, std::initializer_list<std::pair<unsigned, const char*>> names) {
  for (const auto& [known, name] : names)
    if (known == code) return fmt::format("{} ({})", code, name);
  return std::to_string(code);
}

/// PNG (Third Edition), W3C 2025, 11.3.2: chunks of a length, a type, data and a checksum.
std::vector<std::string> png(const Bytes& file) {
  std::vector<std::string> lines;
  for (size_t at = 8; file.whole(at, 12);) {
    const size_t size = file.big(at), data = at + 8;
    const std::string type = file.text(at + 4, 4);
    if (type == "IDAT" || type == "IEND" || !file.whole(data, size)) break;
    if (type == "gAMA" && size == 4) {
      const double gamma = file.big(data) / 1e5;
      lines.push_back(gamma > 0 ? fmt::format("gAMA: {:.5g}, values are light to the power of 1 / {:.4g}", gamma, 1 / gamma)
                                : "gAMA: 0, which has no meaning");
    } else if (type == "sRGB" && size == 1) {
      constexpr std::array<const char*, 4> intents = {"perceptual", "relative colorimetric", "saturation",
                                                      "absolute colorimetric"};
      lines.push_back(fmt::format("sRGB: rendering intent {}", file.byte(data) < 4 ? intents[file.byte(data)] : "unknown"));
    } else if (type == "cHRM" && size == 32) {
      std::array<double, 8> xy{};
      for (size_t i = 0; i < 8; ++i) xy[i] = file.big(data + 4 * i) / 1e5;
      lines.push_back("cHRM: " + chromaticities(xy, {"white", "red", "green", "blue"}));
    } else if (type == "iCCP") {
      lines.push_back("iCCP: a profile called '" + printable(file.name(data)) + "'");
    } else if (type == "cICP" && size == 4) {
      lines.push_back(
          fmt::format("cICP: primaries {}, transfer {}, matrix {}, {} range",
                      named(file.byte(data), {{1, "BT.709"}, {9, "BT.2020"}, {11, "DCI-P3"}, {12, "Display P3"}}),
                      named(file.byte(data + 1), {{1, "BT.709"}, {8, "linear"}, {13, "sRGB"}, {16, "PQ"}, {18, "HLG"}}),
                      file.byte(data + 2), file.byte(data + 3) ? "full" : "narrow"));
    }
    at = data + size + 4;
  }
  return lines;
}

/// OpenEXR File Layout, 2013: the magic number and the version are followed by attributes, each a name, a type, a size and
/// data, until an empty name.
std::vector<std::string> exr(const Bytes& file) {
  std::vector<std::string> lines;
  for (size_t at = 8;;) {
    const std::string name = file.name(at);
    const std::string type = name.empty() ? name : file.name(at + name.size() + 1);
    const size_t data = at + name.size() + type.size() + 6;
    if (type.empty() || !file.whole(data, 0)) break;
    const size_t size = file.little(data - 4);
    if (name == "chromaticities" && size == 32 && file.whole(data, size)) {
      std::array<double, 8> xy{};
      for (size_t i = 0; i < 8; ++i) xy[i] = double(std::bit_cast<float>(file.little(data + 4 * i)));
      lines.push_back(chromaticities(xy, {"red", "green", "blue", "white"}));
    } else if (name == "whiteLuminance" && size == 4) {
      lines.push_back(fmt::format("whiteLuminance: {:.6g} cd/m2", std::bit_cast<float>(file.little(data))));
    }
    at = data + size;
  }
  return lines;
}

}  // namespace

std::vector<std::string> stated_encoding(const std::string& path) {
  const Bytes file(path);
  if (file.text(0, 8) == "\x89PNG\r\n\x1a\n") return png(file);
  if (file.little(0) == 20000630) return exr(file);
  return {};
}

}  // namespace etendue
