#pragma once
// Reads Mitsuba's XML into plugins and properties.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "element.h"
#include "etendue/importer.h"
#include "values.h"
#include "xml_file.h"

namespace etendue::mitsuba {

/// Reads a scene with all files that it includes, and owns its elements. Throws Error at the first mistake.
class SceneReader {
 public:
  explicit SceneReader(Importing& importing) : importing_(importing) {}
  const Element& read();

 private:
  void read_file(const std::string& path, Element& into, Location from);
  void read_content(const pugi::xml_node&, Element& into);
  void read_child(const pugi::xml_node&, Element& into);
  bool read_directive(const pugi::xml_node&, Element& into);
  void read_include(const pugi::xml_node&, Element& into);
  void read_reference(const pugi::xml_node&, Element& into);
  void read_animation(const pugi::xml_node&, Element& into);
  ColorValue read_spectrum(const pugi::xml_node&, const Element& into);
  Element* read_plugin(const pugi::xml_node&, const std::string& tag);
  void read_scene_version(const pugi::xml_node&);

  std::optional<Text> attribute(const pugi::xml_node&, const char* name);
  Text required(const pugi::xml_node&, const char* name);
  Attributes attributes() {
    return [this](const pugi::xml_node& node, const char* name) { return attribute(node, name); };
  }
  PlaceOf places() const {
    return [this](const pugi::xml_node& node) { return at(node); };
  }
  Location at(const pugi::xml_node& node) const { return file_->at(node); }
  /// Throws Error for attributes that a tag does not have.
  void expect_attributes(const pugi::xml_node&, std::initializer_list<const char*> names);
  std::string with_parameters(const std::string& text, Location at);
  void name_element(const std::string& id, Element*, Location at);
  void add(Element& into, Property property);
  void resolve();

  Importing& importing_;
  const XmlFile* file_ = nullptr;
  std::string folder_;  // of the current file
  bool old_ = false;
  std::map<std::string, std::string, std::less<>> defaults_;
  std::map<std::string, Element*, std::less<>> by_id_;
  std::vector<std::unique_ptr<Element>> elements_;
  std::vector<std::string> open_files_;
  size_t depth_ = 0, bytes_ = 0, includes_ = 0;
};

/// A name in the spelling of Mitsuba 3: "toWorld" is "to_world", "intIOR" is "int_ior".
std::string modern_name(const std::string&);
/// The tag and the type of a plugin as Mitsuba 3 calls them.
std::string modern_tag(const std::string& tag);
std::string modern_type(const std::string& tag, const std::string& type);

}  // namespace etendue::mitsuba
