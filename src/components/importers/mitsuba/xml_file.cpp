#include "xml_file.h"

#include <algorithm>
#include <optional>

#include "files/regular_file.h"

namespace etendue::mitsuba {

namespace {

constexpr std::uint64_t largest_file = std::uint64_t(1) << 30;  // [bytes]; scenes keep large data in other files

}  // namespace

XmlFile::XmlFile(const std::string& path, const char* name) : name_(name) {
  try {
    text_ = read_regular_file(path, largest_file);
  } catch (const Error& error) {
    throw Error("'" + path + "' cannot be read: " + error.what(), {name, 0, 0});
  }
  lines_.push_back(0);
  for (size_t i = 0; i < text_.size(); ++i) {
    const auto c = static_cast<unsigned char>(text_[i]);
    if (c == '\n') lines_.push_back(i + 1);
    if ((c & 0xc0) == 0x80) wide_bytes_.push_back(i);
    if (c == 0) throw Error("the file holds a zero byte: it is not XML in UTF-8", at(std::ptrdiff_t(i)));
  }
  if (text_.find_first_not_of(" \t\r\n") == std::string::npos) throw Error("'" + path + "' is empty", {name, 0, 0});
  try {
    std::optional<ExpandedText> expanded = expand_entities(text_);
    if (expanded) {
      entities_ = at(std::ptrdiff_t(expanded->declared));
      text_ = std::move(expanded->text);
      expansions_ = std::move(expanded->expansions);
    }
  } catch (const EntityError& error) {
    throw Error(error.what(), at(std::ptrdiff_t(error.place)));
  }
  const pugi::xml_parse_result result =
      document_.load_buffer_inplace(text_.data(), text_.size(), pugi::parse_default, pugi::encoding_utf8);
  if (!result) throw Error("this is not XML: " + std::string(result.description()), at(result.offset));
}

Location XmlFile::at(const pugi::xml_attribute& attribute, const pugi::xml_node& of) const {
  const std::ptrdiff_t offset = attribute.value() - text_.data();
  return offset > 0 && size_t(offset) < text_.size() ? at(offset) : at(of);
}

Location XmlFile::at_text(const pugi::xml_node& node) const {
  const std::string_view text = node.value();
  return at(text.data() - text_.data() + std::ptrdiff_t(std::min(text.find_first_not_of(" \t\r\n"), text.size())));
}

Location XmlFile::at(std::ptrdiff_t offset) const {
  const size_t place = written_at(expansions_, size_t(std::clamp(offset, std::ptrdiff_t(0), std::ptrdiff_t(text_.size()))));
  const auto line = std::ranges::upper_bound(lines_, place) - 1;
  const auto wide = std::ranges::lower_bound(wide_bytes_, place) - std::ranges::lower_bound(wide_bytes_, *line);
  return {name_, int(line - lines_.begin()) + 1, int(place - *line) - int(wide) + 1};
}

}  // namespace etendue::mitsuba
