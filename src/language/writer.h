#pragma once
// Writer: components and values as text.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "etendue/describe/registry.h"

namespace etendue::language {

/// The shortest text of a number that reads back as the same value. `value` is in base units, and `factor` base units are one
/// unit of the written number. `exact`: the value is a double that must be preserved; otherwise it comes from a float, which
/// must be preserved.
std::string number_text(double value, double factor, bool whole, bool exact = false);

/// A path as written in a text that lies in `folder`.
std::string path_text(const FilePath&, const std::string& folder);
/// A colour's expression, with the paths in it relative to a folder where that is shorter.
std::string color_text(const SpectralFunction&, const std::string& folder);

/// A valid name for a description: letters and digits; other characters become underscores. "": nothing remains.
std::string plain_name(const std::string&);

class Writer {
 public:
  Writer(bool all, std::string folder) : all_(all), folder_(std::move(folder)) {}

  std::string description(const Component& root);
  /// The parts of a component that have given names, with their names in its description.
  std::vector<std::pair<std::string, const Component*>> named_parts(const Component& root);
  /// A value as it is written after `column` characters in a line; further lines are indented by at least `indent`.
  std::string value(const Value&, const Member*, int indent, int column);

 protected:
  struct Part {
    int uses = 0;
    std::string name;  // empty: written where it is used
  };

  bool written(const Value&, const Member&) const;
  void collect(const Component&);
  void choose_names();
  std::string component(const Component&, int indent, int column);
  std::string part(const Component&, const Member*, int indent, int column);
  /// The member whose value can be written in place of the component, such as a constant map, if it reads back as an equal
  /// component; else null.
  const Member* literal(const Component&, const Member*) const;
  std::string numbers(const Numbers&, const Member*, int indent, int column) const;
  std::string unit_suffix(Dimension, const Member*, double& factor) const;

  bool all_;
  std::string folder_;
  std::map<const Component*, Part> parts_;
  std::vector<const Component*> order_;  // dependencies come before the components that use them
  std::set<std::string> plugins_;
};

}  // namespace etendue::language
