#pragma once
// An XML file with the location of each of its nodes.

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "entities.h"
#include "etendue/core/error.h"

namespace etendue::mitsuba {

/// A parsed file. Entities that it declares as texts are expanded, within limits; nothing else of a document type declaration
/// is evaluated.
class XmlFile {
 public:
  /// `name` is the file's name in messages. Throws Error at the location of a mistake.
  XmlFile(const std::string& path, const char* name);

  pugi::xml_node root() const { return document_.document_element(); }
  Location at(const pugi::xml_node& node) const { return at(node.offset_debug()); }
  /// The location of an attribute's value.
  Location at(const pugi::xml_attribute&, const pugi::xml_node& of) const;
  /// The location of the first non-blank character of a text between elements.
  Location at_text(const pugi::xml_node&) const;
  size_t size() const { return text_.size(); }
  /// The location of its first entity declaration; unknown: it has none.
  Location entities() const { return entities_; }

 private:
  Location at(std::ptrdiff_t offset) const;

  const char* name_;
  std::string text_;  // modified by pugixml, which parses in place
  std::vector<Expansion> expansions_;
  Location entities_;
  std::vector<size_t> lines_;       // offset of each line
  std::vector<size_t> wide_bytes_;  // UTF-8 continuation bytes, which do not count as columns
  pugi::xml_document document_;
};

}  // namespace etendue::mitsuba
