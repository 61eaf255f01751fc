#include "parts_calls.h"

#include <fmt/format.h>

#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>

#include <cmath>
#include <deque>

namespace etendue::python {

PyObject* MethodName::object() const {
  if (!object_) object_ = PyUnicode_InternFromString(text);
  return object_;
}

// ---- exceptions -------------------------------------------------------------------------------------------------------------

namespace {

struct Cause {
  std::string text;
  nb::object exception;
};

/// The exceptions of the last failed calls, newest first. An Error passes through threads, schedules and other Errors before it
/// comes back to Python, so that its text alone identifies it. Never destroyed: the interpreter may have ended before.
std::deque<Cause>& causes() {
  static auto* all = new std::deque<Cause>;
  return *all;
}
constexpr size_t most_causes = 8;

nb::object helper(const char* name) { return nb::module_::import_("etendue._declare").attr(name); }

}  // namespace

void throw_python_error(const Called& called) {
  nb::python_error raised;  // takes the exception
  std::string text = called.text() + " failed";
  Location at;
  try {
    const nb::object told = helper("_explain")(raised.value(), called.class_name, called.method);
    text = nb::cast<std::string>(told[0]);
    at = {intern(nb::cast<std::string>(told[1])), nb::cast<int>(told[2]), nb::cast<int>(told[3])};
  } catch (nb::python_error&) {
    text += std::string(": ") + raised.what();
  }
  causes().push_front({text, nb::borrow(raised.value())});
  if (causes().size() > most_causes) causes().pop_back();
  throw Error(text, at);
}

nb::object cause_of(const std::string& text) {
  for (auto cause = causes().begin(); cause != causes().end(); ++cause)
    if (text.find(cause->text) != std::string::npos) {
      const nb::object exception = cause->exception;
      causes().erase(cause);
      return exception;
    }
  return {};
}

void Called::refuse(nb::handle returned, const std::string& wanted) const {
  std::string shown = "something";
  Location at;
  try {
    const nb::object told = helper("_refusal")(returned, class_name, method);
    shown = nb::cast<std::string>(told[0]);
    at = {intern(nb::cast<std::string>(told[1])), nb::cast<int>(told[2]), 0};
  } catch (nb::python_error&) {
  }
  throw Error(fmt::format("{} returned {}; it must return {}", text(), shown, wanted), at);
}

nb::object call(PyObject* self, const MethodName& name, const Called& called, std::initializer_list<PyObject*> arguments) {
  if (!self) throw Error(called.text() + ": the Python object has been destroyed");
  constexpr size_t most = 8;
  PyObject* all[most + 1] = {self};
  std::copy(arguments.begin(), arguments.end(), all + 1);
  PyObject* const returned = PyObject_VectorcallMethod(name.object(), all, arguments.size() + 1, nullptr);
  if (!returned) throw_python_error(called);
  return nb::steal(returned);
}

// ---- arguments --------------------------------------------------------------------------------------------------------------

nb::object number(double x) { return nb::steal(PyFloat_FromDouble(x)); }

nb::object tuple_of_numbers(std::span<const float> numbers) {
  PyObject* const tuple = PyTuple_New(Py_ssize_t(numbers.size()));
  for (size_t i = 0; i < numbers.size(); ++i) PyTuple_SetItem(tuple, Py_ssize_t(i), PyFloat_FromDouble(double(numbers[i])));
  return nb::steal(tuple);
}

nb::object tuple_of_spectrum(const Spectrum& s) {
  std::array<float, spectrum_size> values;
  for (int i = 0; i < spectrum_size; ++i) values[size_t(i)] = s[i];
  return tuple_of_numbers(values);
}

// ---- results ----------------------------------------------------------------------------------------------------------------

namespace {

/// Whether a number is finite, also as a float.
bool fits(double x) { return std::isfinite(float(x)); }

/// Reads a number; false: the object is none, or it is not finite.
bool read_number(PyObject* object, double& x) {
  if (PyFloat_Check(object)) {
    x = PyFloat_AsDouble(object);
    return fits(x);
  }
  if (PyUnicode_Check(object) || object == Py_None) return false;
  x = PyFloat_AsDouble(object);  // whatever has __float__ or __index__
  if (x == -1 && PyErr_Occurred()) {
    PyErr_Clear();
    return false;
  }
  return fits(x);
}

bool read_numbers(PyObject* object, std::span<double> numbers) {
  const auto count = Py_ssize_t(numbers.size());
  if (PyTuple_Check(object)) {
    if (PyTuple_Size(object) != count) return false;
    for (Py_ssize_t i = 0; i < count; ++i)
      if (!read_number(PyTuple_GetItem(object, i), numbers[size_t(i)])) return false;
    return true;
  }
  if (nb::ndarray_check(object)) {
    nb::ndarray<const double, nb::numpy, nb::c_contig, nb::ndim<1>> array;
    if (!nb::try_cast(nb::handle(object), array) || array.shape(0) != size_t(count)) return false;
    for (size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = array.data()[i];
      if (!fits(numbers[i])) return false;
    }
    return true;
  }
  if (!PySequence_Check(object) || PyUnicode_Check(object) || PySequence_Size(object) != count) {
    PyErr_Clear();
    return false;
  }
  for (Py_ssize_t i = 0; i < count; ++i) {
    const nb::object item = nb::steal(PySequence_GetItem(object, i));
    if (!item.is_valid()) PyErr_Clear();
    if (!item.is_valid() || !read_number(item.ptr(), numbers[size_t(i)])) return false;
  }
  return true;
}

}  // namespace

double to_number(nb::handle returned, const Called& called) {
  double x = 0;
  if (!read_number(returned.ptr(), x)) called.refuse(returned, "a finite number");
  return x;
}

void to_numbers(nb::handle returned, std::span<double> numbers, const Called& called, const char* wanted) {
  if (!read_numbers(returned.ptr(), numbers)) called.refuse(returned, wanted);
}

Vector3 to_vector(nb::handle returned, const Called& called, const char* wanted) {
  std::array<double, 3> v{};
  to_numbers(returned, v, called, wanted);
  return {float(v[0]), float(v[1]), float(v[2])};
}

Spectrum to_spectrum(nb::handle returned, const Called& called) {
  double all = 0;
  if (read_number(returned.ptr(), all)) return Spectrum(float(all));
  std::array<double, spectrum_size> values{};
  static const std::string wanted = fmt::format("a finite number, or {}: one for each wavelength", spectrum_size);
  to_numbers(returned, values, called, wanted.c_str());
  Spectrum s;
  for (int i = 0; i < spectrum_size; ++i) s.set(i, float(values[size_t(i)]));
  return s;
}

bool to_truth(nb::handle returned, const Called& called) {
  if (!PyBool_Check(returned.ptr())) called.refuse(returned, "True or False");
  return returned.ptr() == Py_True;
}

std::string to_text(nb::handle returned, const Called& called) {
  if (!PyUnicode_Check(returned.ptr())) called.refuse(returned, "a text");
  return nb::cast<std::string>(returned);
}

}  // namespace etendue::python
