#pragma once
// Points of surfaces as Python objects, for the methods of maps, shaders and emissions.

#include "etendue/core/surface_point.h"
#include "parts.h"

namespace etendue::python {

/// What a Python object of a surface point holds. Its object is null after the call that the point was made for: the scene may
/// be gone when Python still has the point.
struct PointView {
  SurfacePoint point;
};

/// A point as an argument of a call. Needs the interpreter's lock, in its destructor too.
class PointArgument {
 public:
  explicit PointArgument(const SurfacePoint&);
  ~PointArgument();
  PointArgument(const PointArgument&) = delete;
  PointArgument& operator=(const PointArgument&) = delete;
  PyObject* ptr() const { return object.ptr(); }
  const nb::object object;
};

/// The value of an attribute of the class, or what its method of this name returns; None if the class has neither.
nb::object attribute_or_call(const PythonPart&, const MethodName&);
/// The same as a truth value; `otherwise` without such an attribute. Takes the interpreter's lock.
bool truth_of(const PythonPart&, const MethodName&, bool otherwise);
/// As a finite number.
float number_of(const PythonPart&, const MethodName&, float otherwise);

}  // namespace etendue::python
