#include "prepared.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "utf16.h"

namespace etendue::assimp_helper {
namespace {

std::vector<std::string>& all_left_out() {
  static auto* all = new std::vector<std::string>;
  return *all;
}

std::string small(std::string text) {
  for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Whether the XML declaration states an encoding of one byte per character.
bool is_latin(std::string_view xml) {
  const std::string head = small(std::string(xml.substr(0, std::min<size_t>(xml.find("?>"), 200))));
  return head.find("encoding=") != std::string::npos &&
         (head.find("8859-1") != std::string::npos || head.find("windows-1252") != std::string::npos ||
          head.find("latin") != std::string::npos);
}
std::string from_latin(std::string_view text) {
  std::string made;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      made += c;
    } else {
      made += char(0xc0 | byte >> 6);
      made += char(0x80 | (byte & 0x3f));
    }
  }
  return made;
}

/// The value of an attribute in a tag; nothing: the tag does not have it.
std::optional<std::string> attribute(std::string_view tag, const std::string& name) {
  for (const char quote : {'"', '\''}) {
    for (size_t at = 0; (at = tag.find(name + "=" + quote, at)) != std::string_view::npos; ++at) {
      if (std::isspace(static_cast<unsigned char>(tag[at - 1])) == 0) continue;
      const size_t begin = at + name.size() + 2, end = tag.find(quote, begin);
      if (end != std::string_view::npos) return std::string(tag.substr(begin, end - begin));
    }
  }
  return std::nullopt;
}

/// Adds a name to unnamed Collada cameras: Assimp 5.2 reads the optics only of cameras that have a name
/// (ColladaParser::ReadCamera).
std::string with_named_cameras(const std::string& xml) {
  const std::string_view opening = "<camera";
  std::string made;
  size_t done = 0;
  for (size_t at = 0; (at = xml.find(opening, at)) != std::string::npos;) {
    const size_t rest = at + opening.size(), end = xml.find('>', rest);
    at = rest;
    if (end == std::string::npos || std::isspace(static_cast<unsigned char>(xml[rest])) == 0) continue;
    const std::string_view tag = std::string_view(xml).substr(rest, end - rest);
    if (attribute(tag, "name")) continue;
    made.append(xml, done, rest - done);
    made += " name=\"" + attribute(tag, "id").value_or("camera") + "\"";
    done = rest;
  }
  return made.append(xml, done);
}

}  // namespace

const std::vector<std::string>& left_out() { return all_left_out(); }

std::optional<std::string> prepared(const std::string& path) {
  const std::string ending = small(std::filesystem::path(path).extension().string());
  std::optional<std::string> text = utf16_text(path);
  if (ending == ".dae" || ending == ".x3d") {
    if (!text) text = bytes_of(path);
    if (is_latin(*text)) text = from_latin(*text);
    if (ending == ".dae") text = with_named_cameras(trimmed_xml(*text));
  } else if (ending == ".lwo") {
    bool textures = false;
    text = lwob_as_lwo2(bytes_of(path), textures);
    if (textures) all_left_out().emplace_back("textures of LightWave's old format (LWOB) are left out");
  } else if (ending == ".3mf") {
    text = package_without_images(bytes_of(path));
  }
  return text;
}

// A '>' may appear inside quotes in a tag; comments, declarations and CDATA sections have their own ends.
std::string trimmed_xml(std::string_view xml) {
  const auto blank = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
  std::string made;
  made.reserve(xml.size());
  for (size_t at = 0; at < xml.size();) {
    if (xml[at] != '<') {
      size_t end = std::min(xml.find('<', at), xml.size());
      const size_t next = end;
      while (at < end && blank(xml[at])) ++at;
      while (end > at && blank(xml[end - 1])) --end;
      for (; at < end; ++at) made += blank(xml[at]) ? ' ' : xml[at];
      at = next;
      continue;
    }
    size_t end = at;
    const auto closed_by = [&](std::string_view opening, std::string_view closing) {
      if (xml.substr(at, opening.size()) != opening) return false;
      end = xml.find(closing, at + opening.size());
      end = end == std::string_view::npos ? xml.size() : end + closing.size();
      return true;
    };
    if (!closed_by("<!--", "-->") && !closed_by("<![CDATA[", "]]>") && !closed_by("<?", "?>")) {
      char quote = 0;
      for (; end < xml.size() && (quote || xml[end] != '>'); ++end)
        if (quote ? xml[end] == quote : xml[end] == '"' || xml[end] == '\'') quote = quote ? '\0' : xml[end];
      end = std::min(end + 1, xml.size());
    }
    made.append(xml.substr(at, end - at));
    at = end;
  }
  return made;
}

}  // namespace etendue::assimp_helper
