#pragma once
// Classes that are declared at run time, by a script or a shading language. Their objects are of one C++ type for each
// interface; what distinguishes the classes is a ClassInfo made at run time (Registry::declare), and what distinguishes the
// objects are the values of their members, which they keep as values of the language.

#include <map>
#include <string>

#include "etendue/describe/registry.h"

namespace etendue {

/// The second base, besides an interface, of objects of declared classes: the values of the members that the declaration adds.
class DeclaredMembers {
 public:
  virtual ~DeclaredMembers();
  /// By the member's name. Converted and checked, in base units.
  std::map<std::string, Value, std::less<>> declared_values;
};

/// Completes a member of a declared class, whose objects derive from DeclaredMembers: its values are checked as those of a
/// compiled class are. Kind, list and component_class are set before.
void keep_as_value(Member&);

}  // namespace etendue
