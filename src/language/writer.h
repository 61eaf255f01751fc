#pragma once
// Components and values back into text.

#include <map>
#include <set>
#include <string>
#include <vector>

#include "etendue/describe/registry.h"

namespace etendue::language {

/// A number of a member as the shortest text that reads back to the same float (or double, if it has more digits) after
/// going through base units: `value` is in base units, `factor` of them make the unit that is written.
/// `exact`: of a double; else the number has been a float, and the text is the shortest that gives this float.
std::string number_text(double value, double factor, bool whole, bool exact = false);

/// A path for a text that lies in `folder`.
std::string path_text(const FilePath&, const std::string& folder);
/// A colour's expression with the paths in it relative to a folder where that is shorter.
std::string color_text(const SpectralFunction&, const std::string& folder);

/// A name as a description can have it: letters and digits, everything else becomes an underscore. "": nothing is left.
std::string plain_name(const std::string&);

class Writer {
 public:
  Writer(bool all, std::string folder) : all_(all), folder_(std::move(folder)) {}

  std::string description(const Component& root);
  /// The parts of a component that were given names, and what they are called in its description.
  std::vector<std::pair<std::string, const Component*>> named_parts(const Component& root);
  /// A value as it is written behind `column` characters in a line; further lines are indented by `indent` at least.
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
  /// The member that stands for a component such as a constant map, if its value alone reads back as the same; else null.
  const Member* literal(const Component&, const Member*) const;
  std::string numbers(const Numbers&, const Member*, int indent, int column) const;
  std::string unit_suffix(Dimension, const Member*, double& factor) const;

  bool all_;
  std::string folder_;
  std::map<const Component*, Part> parts_;
  std::vector<const Component*> order_;  // what a component refers to stands before it
  std::set<std::string> plugins_;
};

}  // namespace etendue::language
