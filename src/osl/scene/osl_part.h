#pragma once
// OslPart: the second base of objects of classes that are shaders: the values of their members, as a layer of a group.

#include "osl/language/group_description.h"
#include "osl_class.h"

namespace etendue::osl {

class OslPart : public DeclaredMembers {
 public:
  explicit OslPart(const ClassInfo&);

  const ClassInfo& info() const { return info_; }
  const OslClass& osl_class() const { return of_; }
  /// The object itself.
  virtual const Component& component() const = 0;
  /// The output that the object is as a map; "": it is none, or a displacement.
  virtual std::string map_output() const { return {}; }
  /// Whether light may go through the surface into the body, as the text says it and the members do not exclude it
  /// (OslClass::opaque).
  bool lets_in() const;

 private:
  const ClassInfo& info_;
  const OslClass& of_;
};

}  // namespace etendue::osl
