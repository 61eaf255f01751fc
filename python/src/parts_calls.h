#pragma once
// Calls from the library into Python: arguments, checked results, and exceptions as
// Error.
//
// The library calls parts that are written in Python from its own threads. `Interpreter` takes the lock for such a call; no
// lock of the library may be held at that time, since a thread that holds the interpreter's lock may wait for it.

#include <nanobind/nanobind.h>

#include <array>
#include <initializer_list>
#include <span>
#include <string>

#include "etendue/core/error.h"
#include "etendue/core/spectrum.h"
#include "etendue/core/vector.h"
#include "interpreter.h"

namespace etendue::python {

namespace nb = nanobind;

/// The name of a method with its text as a Python string, made at the first call.
class MethodName {
 public:
  explicit MethodName(const char* text) : text(text) {}
  PyObject* object() const;  ///< borrowed; needs the interpreter's lock
  const char* const text;

 private:
  mutable PyObject* object_ = nullptr;
};

/// What is called, for messages: a class and one of its methods ("": the class itself).
struct Called {
  const std::string& class_name;
  const char* method;
  std::string text() const { return *method ? class_name + "." + method : class_name; }
  /// Throws Error: "Stripes.scalar returned nan; it must return a finite number", at the method's first line.
  [[noreturn]] void refuse(nb::handle returned, const std::string& wanted) const;
};

/// Throws the current Python exception as Error. It names class and method, and its location is the line of Python that raised
/// the exception, which becomes the cause of the Error that comes back to Python (cause_of).
[[noreturn]] void throw_python_error(const Called&);
/// The Python exception that an Error with this text comes from; invalid: none is known. Needs the interpreter's lock.
nb::object cause_of(const std::string& text);

/// Calls a method of a Python object, with positional arguments, and returns what it returns; throws Error.
nb::object call(PyObject* self, const MethodName&, const Called&, std::initializer_list<PyObject*> arguments);

// ---- arguments (new references) -------------------------------------------------------------------------------------------

nb::object tuple_of_numbers(std::span<const float>);
template <class T>
nb::object tuple_of(const T& v) {
  if constexpr (requires { v.z; })
    return tuple_of_numbers(std::array<float, 3>{v.x, v.y, v.z});
  else
    return tuple_of_numbers(std::array<float, 2>{v.x, v.y});
}
nb::object number(double x);
/// A tuple of the values at the wavelengths of a path.
nb::object tuple_of_spectrum(const Spectrum&);

// ---- results --------------------------------------------------------------------------------------------------------------

/// The number that was returned, which must be finite.
double to_number(nb::handle returned, const Called&);
/// So many finite numbers: of a tuple, a list, an array, or any other sequence.
void to_numbers(nb::handle returned, std::span<double> numbers, const Called&, const char* wanted);
Vector3 to_vector(nb::handle returned, const Called&, const char* wanted);
/// A number for all wavelengths, or one for each.
Spectrum to_spectrum(nb::handle returned, const Called&);
bool to_truth(nb::handle returned, const Called&);
std::string to_text(nb::handle returned, const Called&);

}  // namespace etendue::python
