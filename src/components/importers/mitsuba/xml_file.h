#pragma once
// An XML file with the place of everything in it.

#include <pugixml.hpp>
#include <string>
#include <vector>

#include "entities.h"
#include "etendue/core/error.h"

namespace etendue::mitsuba {

/// A parsed file. Entities that it declares as texts are put in their places, within bounds; nothing else of a document type
/// declaration is followed.
class XmlFile {
 public:
  /// `name` is the file in messages. Throws Error with the place of what is wrong.
  XmlFile(const std::string& path, const char* name);

  pugi::xml_node root() const { return document_.document_element(); }
  Location at(const pugi::xml_node& node) const { return at(node.offset_debug()); }
  /// Where an attribute's value begins.
  Location at(const pugi::xml_attribute&, const pugi::xml_node& of) const;
  /// Where the first character is that is no blank, of text between elements.
  Location at_text(const pugi::xml_node&) const;
  size_t size() const { return text_.size(); }
  /// Where it declares entities; unknown: nowhere.
  Location entities() const { return entities_; }

 private:
  Location at(std::ptrdiff_t offset) const;

  const char* name_;
  std::string text_;  // as pugixml left it: it parses in place
  std::vector<Expansion> expansions_;
  Location entities_;
  std::vector<size_t> lines_;       // where each begins
  std::vector<size_t> wide_bytes_;  // those that begin no character (in UTF-8), for columns
  pugi::xml_document document_;
};

}  // namespace etendue::mitsuba
